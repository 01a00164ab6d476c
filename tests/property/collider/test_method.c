/* Occupancy, hopcroft and swept against brute force on random worlds (thesis rows 44, 45): the same
 * pairs, each once. SEED=n runs another set. */
#include "collider/broad_phase/broad_phase.h"
#include "collider/method/method.h"

#include "tests/support/fixture.h"
#include "tests/support/small_world.h"
#include "tests/support/spread.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define WORLDS      120000
#define SMALL_ROWS  40
#define SMALL_FIXED 16
#define CROWDS      24
#define CROWD_ROWS  1000
#define CROWD_FIXED 600
#define SWEPT_EVERY 100 /* its squares' reach costs more than all the rest */

/* --- drawing worlds ----------------------------------------------------------------------------*/

static enum small_kind draw_kind(uint64_t *random)
{
    enum small_kind kind = (enum small_kind)(fixture_random(random) % SMALL_TREE);
    return kind == SMALL_GIANT && fixture_random(random) % 4 != 0 ? SMALL_CAR : kind;
}

/* Two spheres, or their boxes, that touch along one axis. */
static struct vec3 beside(const struct small_world *w, uint32_t row, enum small_kind kind,
                          uint64_t *random)
{
    struct vec3 at = w->path[row].at;
    double reach = w->kinds[w->e.row[row].kind].radius_m + w->kinds[kind].radius_m;
    double *axis[] = {&at.x, &at.y, &at.z};
    *axis[fixture_random(random) % 3] += fixture_random(random) & 1 ? reach : -reach;
    return at;
}

static void draw_row(struct small_world *w, const struct spread *place, uint64_t *random)
{
    static const double speeds[] = {0.0, 0.0, 1.0, 30.0, 300.0, 1500.0};
    double along = speeds[fixture_random(random) % 6];
    enum small_kind kind = draw_kind(random);
    struct vec3 at = spread_point(place, random);
    struct vec3 way = {along * fixture_uniform(random, -1, 1),
                       along * fixture_uniform(random, -0.1, 0.1),
                       along * fixture_uniform(random, -1, 1)};
    uint64_t how = w->rows > 0 ? fixture_random(random) % 8 : 7;
    if (how == 0) { /* coincident */
        at = w->path[w->rows - 1].at;
        way = w->path[w->rows - 1].along;
    } else if (how == 1) {
        at = beside(w, w->rows - 1, kind, random);
    } else if (kind == SMALL_JET) {
        at.y += fixture_uniform(random, 0.0, 120.0);
    }
    uint32_t row = small_world_row(w, kind, at, way);
    if (fixture_random(random) % 10 == 0)
        w->e.row[row].state = ENTITY_FREE;
    if (kind == SMALL_ROUND && row > 0) { /* shot by another row, or by an entity that is gone */
        w->e.row[row].owner_slot = (uint32_t)(fixture_random(random) % row);
        w->e.row[row].owner_id =
            w->e.row[row].owner_slot + 1 + (fixture_random(random) % 4 == 0 ? 1000u : 0u);
    }
}

static void draw_world(struct small_world *w, uint32_t rows, uint32_t fixed, double widest,
                       uint64_t *random)
{
    static const double radii[] = {0.01, 0.4, 1.8, 9.0, 130.0};
    struct spread place = spread_draw(random, widest);
    small_world_empty(w);
    w->params->collision.shape = fixture_random(random) % 3 == 0 ? SHAPE_MODEL : SHAPE_SPHERE;
    for (uint32_t i = 0; i < fixed; i++) {
        struct vec3 p = spread_point(&place, random);
        p.x = maths_clamp(p.x, 0.0, WORLD_SIDE_DEFAULT_M);
        p.y = fixture_uniform(random, 0.0, 5.0);
        p.z = maths_clamp(p.z, 0.0, WORLD_SIDE_DEFAULT_M);
        uint32_t object = small_world_tree(w, p, radii[fixture_random(random) % 5]);
        w->damage[object] = (uint8_t)(fixture_random(random) % 8 == 0 ? DAMAGE_HIGH : DAMAGE_MED);
    }
    for (uint32_t i = 0; i < rows; i++)
        draw_row(w, &place, random);
}

/* --- comparing ---------------------------------------------------------------------------------*/

/* How often each pair was found; all zero between two comparisons. */
static uint8_t (*times)[CROWD_ROWS + CROWD_FIXED];

static uint8_t *times_of(struct pair pair)
{
    return &times[pair.a][pair.b & PAIR_FIXED ? CROWD_ROWS + (pair.b & ~PAIR_FIXED) : pair.b];
}

static void count_pairs(const struct pair_list *pairs)
{
    for (uint32_t n = 0; n < pairs->count; n++) {
        assert_true((pairs->pair[n].b & PAIR_FIXED) || pairs->pair[n].a < pairs->pair[n].b);
        ++*times_of(pairs->pair[n]);
    }
}

static void compare(const char *name, uint64_t world, const struct pair_list *wanted,
                    const struct pair_list *found)
{
    count_pairs(found);
    for (uint32_t n = 0; n < wanted->count; n++) {
        uint8_t *count = times_of(wanted->pair[n]);
        if (*count != 1)
            fail_msg("%s: world %llu, pair %u %x found %u times", name, (unsigned long long)world,
                     wanted->pair[n].a, wanted->pair[n].b, *count);
        *count = 0;
    }
    if (wanted->count != found->count)
        fail_msg("%s: world %llu, %u pairs instead of %u", name, (unsigned long long)world,
                 found->count, wanted->count);
}

/* The broad phase leaves out bodies that a long path never comes near: each pair is wanted, and
 * none is found twice. */
static void within(uint64_t world, const struct pair_list *wanted, const struct pair_list *found)
{
    count_pairs(found);
    for (uint32_t n = 0; n < wanted->count; n++) {
        uint8_t *count = times_of(wanted->pair[n]);
        if (*count > 1)
            fail_msg("swept: world %llu, pair %u %x found %u times", (unsigned long long)world,
                     wanted->pair[n].a, wanted->pair[n].b, *count);
        *count = 0;
    }
    for (uint32_t n = 0; n < found->count; n++) {
        if (*times_of(found->pair[n]) != 0)
            fail_msg("swept: world %llu, pair %u %x is none", (unsigned long long)world,
                     found->pair[n].a, found->pair[n].b);
    }
}

/* Every pair of spheres that touch is a candidate, so no contact is missed. */
static uint64_t check_touching(const struct small_world *w, uint64_t world,
                               const struct pair_list *wanted)
{
    const struct method_input input = small_world_input(w);
    uint64_t touching = 0;
    double toi;
    if (w->params->collision.shape != SHAPE_SPHERE)
        return 0;
    count_pairs(wanted);
    for (uint32_t a = 0; a < w->rows; a++) {
        for (uint32_t b = a + 1; b < w->rows; b++) {
            double reach = pair_filter_row_reach(&input, a) + pair_filter_row_reach(&input, b);
            if (!pair_filter_there(&input, a) || !pair_filter_there(&input, b) ||
                pair_excluded(&input, a, b) ||
                !analytic_impact_spheres(&w->path[a], &w->path[b], reach, 0.0, &toi))
                continue;
            touching++;
            if (!*times_of((struct pair){a, b}))
                fail_msg("world %llu: %u and %u touch at %g", (unsigned long long)world, a, b, toi);
        }
    }
    for (uint32_t n = 0; n < wanted->count; n++)
        *times_of(wanted->pair[n]) = 0;
    return touching;
}

/* --- the tests ---------------------------------------------------------------------------------*/

struct lists {
    struct pair_list wanted, found;
    struct method_workspace *workspace;
    uint64_t pairs, fixed, touching;
};

static void begin_lists(struct lists *lists, const struct small_world *w, uint32_t fixed)
{
    struct world world = w->world; /* its objects are yet to come */
    world.counts.fixed = fixed;
    *lists = (struct lists){.workspace = method_workspace_create(&world, NULL)};
    assert_non_null(lists->workspace);
    assert_int_equal(pair_list_init(&lists->wanted, pair_filter_pairs_first(&world)), 0);
    assert_int_equal(pair_list_init(&lists->found, pair_filter_pairs_first(&world)), 0);
}

static void run(method_pairs_function *method, struct small_world *w,
                struct method_workspace *workspace, struct pair_list *pairs)
{
    const struct method_input input = small_world_input(w);
    pairs->count = 0;
    method(&input, workspace, pairs);
}

static void try_world(struct lists *lists, struct small_world *w, uint64_t world)
{
    run(method_brute_pairs, w, lists->workspace, &lists->wanted);
    run(method_occupancy_pairs, w, lists->workspace, &lists->found);
    compare("occupancy", world, &lists->wanted, &lists->found);
    run(method_hopcroft_pairs, w, lists->workspace, &lists->found);
    compare("hopcroft", world, &lists->wanted, &lists->found);
    lists->pairs += lists->wanted.count;
    for (uint32_t n = 0; n < lists->wanted.count; n++)
        lists->fixed += (lists->wanted.pair[n].b & PAIR_FIXED) != 0;
}

static void try_swept(struct lists *lists, struct small_world *w, uint64_t world)
{
    const struct method_input input = small_world_input(w);
    struct broad_phase broad;
    small_world_index(w);
    assert_int_equal(broad_phase_init(&broad, &w->world, NULL), 0);
    broad_phase_pairs(&broad, &input);
    within(world, &lists->wanted, &broad.list[0]);
    lists->touching += check_touching(w, world, &broad.list[0]);
    broad_phase_free(&broad);
}

static int begin_times(void **state)
{
    (void)state;
    times = calloc(CROWD_ROWS, sizeof *times);
    return times ? 0 : -1;
}

static int end_times(void **state)
{
    (void)state;
    free(times);
    return 0;
}

static void free_lists(struct lists *lists)
{
    print_message("%llu pairs, %llu of them with fixed objects; %llu touch\n",
                  (unsigned long long)lists->pairs, (unsigned long long)lists->fixed,
                  (unsigned long long)lists->touching);
    pair_list_free(&lists->wanted);
    pair_list_free(&lists->found);
    method_workspace_free(lists->workspace);
}

static void test_rows_44_45_the_methods_find_the_same_in_small_worlds(void **state)
{
    struct small_world w;
    struct lists lists;
    uint64_t random = fixture_seed(44);
    (void)state;
    small_world_begin(&w, SMALL_ROWS, SMALL_FIXED);
    begin_lists(&lists, &w, SMALL_FIXED);
    for (uint64_t world = 0; world < WORLDS; world++) {
        uint32_t most = world % 8 == 0 ? SMALL_ROWS - 1 : 9;
        draw_world(&w, (uint32_t)(2 + fixture_random(&random) % most),
                   (uint32_t)(fixture_random(&random) % (most > 9 ? SMALL_FIXED + 1 : 4)), 3000.0,
                   &random);
        try_world(&lists, &w, world);
        if (world % 4 == 0)
            lists.touching += check_touching(&w, world, &lists.wanted);
        if (world % SWEPT_EVERY == 0)
            try_swept(&lists, &w, world);
    }
    assert_true(lists.pairs > 1000000 && lists.fixed > 300000 && lists.touching > 50000);
    free_lists(&lists);
    small_world_end(&w);
}

static void test_rows_44_45_the_methods_find_the_same_in_crowds(void **state)
{
    struct small_world w;
    struct lists lists;
    uint64_t random = fixture_seed(45);
    (void)state;
    small_world_begin(&w, CROWD_ROWS, CROWD_FIXED);
    begin_lists(&lists, &w, CROWD_FIXED);
    for (uint64_t world = 0; world < CROWDS; world++) {
        draw_world(&w, (uint32_t)(CROWD_ROWS / 2 + fixture_random(&random) % (CROWD_ROWS / 2)),
                   (uint32_t)(fixture_random(&random) % (CROWD_FIXED + 1)), WORLD_SIDE_DEFAULT_M,
                   &random);
        try_world(&lists, &w, world);
        lists.touching += check_touching(&w, world, &lists.wanted);
        try_swept(&lists, &w, world);
    }
    assert_true(lists.pairs > 1000000 && lists.touching > 100000);
    free_lists(&lists);
    small_world_end(&w);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, begin_times, end_times)
    const struct CMUnitTest tests[] = {
        TEST(test_rows_44_45_the_methods_find_the_same_in_small_worlds),
        TEST(test_rows_44_45_the_methods_find_the_same_in_crowds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
