/* The broad phase against comparing everything with everything, on random small worlds (thesis
 * rows 3, 17, 37). SEED=n runs another set. */
#include "collider/broad_phase/broad_phase.h"

#include "collider/broad_phase/body_boxes.h"
#include "tests/support/fixture.h"
#include "tests/support/spread.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/terrain/fixed_index.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WORLDS     1500
#define ROWS_MAX   160
#define FIXED_MAX  48
#define LONG_M     64.0  /* pairs with a longer path in x may be dropped if they never touch */
#define ROUNDING_M 0.01  /* of boxes far from the origin */
#define CROWD      10000 /* rows enough for several threads */
#define CROWD_SIDE 9000.0

/* Kinds: small to huge on land, an aircraft, a munition. */
enum { KIND_GRAIN, KIND_CAR, KIND_TANK, KIND_SHIP, KIND_GIANT, KIND_JET, KIND_ROUND, KINDS };

struct small_world {
    uint32_t capacity;
    struct params params;
    struct kind kinds[KINDS];
    struct fixed_object fixed[FIXED_MAX];
    uint8_t damage[FIXED_MAX];
    float posts[4];
    uint8_t cover[4];
    uint32_t *reach_start, *reach;
    void *memory;
    struct entities e;
    struct path *path; /* [capacity] */
    uint32_t rows;
    struct world world;
};

static void begin(struct small_world *w, uint32_t capacity)
{
    static const double radii[KINDS] = {0.01, 1.6, 3.0, 20.0, 400.0, 7.0, 0.1};
    memset(w, 0, sizeof *w);
    for (int i = 0; i < KINDS; i++) {
        w->kinds[i].radius_m = radii[i];
        w->kinds[i].bound_m = w->kinds[i].reach_m = 1.1 * radii[i];
        w->kinds[i].level_m = 1.3 * radii[i];
        w->kinds[i].low_m = -0.2 * radii[i];
        w->kinds[i].high_m = 1.7 * radii[i];
    }
    w->kinds[KIND_JET].domain = DOMAIN_AIR;
    w->kinds[KIND_ROUND].domain = DOMAIN_MUNITION;
    w->params.capacity = w->capacity = capacity;
    w->params.dt_s = 1.0 / 60.0;
    w->params.collision.threshold_height_m = 60.0;
    w->memory = aligned_alloc(TABLE_ALIGN, entities_bytes(capacity));
    w->path = calloc(capacity, sizeof *w->path);
    assert_true(w->memory && w->path);
    entities_bind(&w->e, capacity, w->memory);
    w->world = (struct world){.params = &w->params,
                              .counts = {.kinds = KINDS},
                              .terrain = {w->posts, w->cover, 2, WORLD_SIDE_DEFAULT_M,
                                          .squares = GRIDSQUARES_DEFAULT_INIT},
                              .kinds = w->kinds,
                              .fixed = w->fixed};
}

static void end(struct small_world *w)
{
    free(w->memory);
    free(w->path);
}

/* --- drawing worlds ----------------------------------------------------------------------------*/

static void draw_fixed(struct small_world *w, const struct spread *place, uint64_t *random)
{
    static const double radii[] = {0.01, 0.4, 1.8, 9.0, 130.0};
    uint32_t count = (uint32_t)(fixture_random(random) % (FIXED_MAX + 1));
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 p = spread_point(place, random);
        w->fixed[i] = (struct fixed_object){
            .x = maths_clamp(p.x, 0.0, WORLD_SIDE_DEFAULT_M),
            .z = maths_clamp(p.z, 0.0, WORLD_SIDE_DEFAULT_M),
            .y = (float)fixture_uniform(random, 0.0, 5.0),
            .radius_m = (float)radii[fixture_random(random) % 5],
        };
        w->damage[i] = (uint8_t)(fixture_random(random) % 8 == 0 ? DAMAGE_HIGH : DAMAGE_MED);
    }
    w->world.counts.fixed = count;
    assert_int_equal(fixed_index_build(&GRIDSQUARES_DEFAULT, w->fixed, count, w->kinds,
                                       &w->reach_start, &w->reach),
                     0);
    w->world.reach_start = w->reach_start;
    w->world.reach = w->reach;
}

static void draw_row(struct small_world *w, uint32_t i, const struct spread *place,
                     uint64_t *random)
{
    static const double speeds[] = {0.0, 0.0, 1.0, 30.0, 300.0, 1500.0};
    struct entities *e = &w->e;
    double along = speeds[fixture_random(random) % 6];
    double since = fixture_random(random) % 4 == 0 ? fixture_uniform(random, 0.0, 1.0) : 0.0;
    uint32_t kind = (uint32_t)(fixture_random(random) % KINDS);
    if (kind == KIND_GIANT && fixture_random(random) % 4 != 0)
        kind = KIND_CAR;
    entities_clear(e, i);
    e->row[i].id = i + 1;
    e->row[i].kind = (uint16_t)kind;
    e->row[i].state = (uint8_t)(fixture_random(random) % 10 == 0 ? ENTITY_FREE : ENTITY_ACTIVE);
    e->row[i].behaviour = kind == KIND_ROUND ? BEHAVIOUR_FLIGHT : BEHAVIOUR_HOLD;
    if (kind == KIND_ROUND && i > 0) { /* shot by another row, or by an entity that is gone */
        e->row[i].owner_slot = (uint32_t)(fixture_random(random) % i);
        e->row[i].owner_id =
            e->row[i].owner_slot + 1 + (fixture_random(random) % 4 == 0 ? 1000u : 0u);
    }
    w->path[i] = (struct path){.at = spread_point(place, random),
                               .along = {along * fixture_uniform(random, -1, 1),
                                         along * fixture_uniform(random, -0.1, 0.1),
                                         along * fixture_uniform(random, -1, 1)},
                               .since = since};
    if (kind == KIND_JET)
        w->path[i].at.y += fixture_uniform(random, 0.0, 120.0);
    if (i > 0 && fixture_random(random) % 8 == 0) /* coincident */
        w->path[i] = w->path[i - 1];
}

static struct spread draw_world(struct small_world *w, uint64_t *random)
{
    struct spread place = spread_draw(random, 3000.0);
    w->rows = (uint32_t)(2 + fixture_random(random) % (w->capacity - 1));
    w->params.collision.shape = fixture_random(random) & 1 ? SHAPE_MODEL : SHAPE_SPHERE;
    draw_fixed(w, &place, random);
    for (uint32_t i = 0; i < w->rows; i++)
        draw_row(w, i, &place, random);
    return place;
}

static void drop_world(struct small_world *w)
{
    free(w->reach_start);
    free(w->reach);
}

static struct method_input input_of(const struct small_world *w)
{
    return (struct method_input){.world = &w->world,
                                 .entities = &w->e,
                                 .path = w->path,
                                 .fixed_damage = w->damage,
                                 .rows = w->rows};
}

/* --- the oracle --------------------------------------------------------------------------------*/

enum wanted { NEVER, MAYBE, ALWAYS };

/* Returns true if the spheres of two paths touch; one of them may be at rest. */
static bool impact(const struct path *a, const struct path *b, double reach)
{
    double from = maths_max(a->since, b->since);
    struct vec3 gap = vec3_sub(path_at(b, from), path_at(a, from));
    struct vec3 along = vec3_scale(vec3_sub(b->along, a->along), 1.0 - from);
    double square = vec3_dot(along, along), time = 0.0;
    if (square > 0.0)
        time = maths_clamp(-vec3_dot(gap, along) / square, 0.0, 1.0);
    return vec3_length(vec3_add(gap, vec3_scale(along, time))) <= reach;
}

static bool is_long(const struct small_world *w, uint32_t row)
{
    return fabs(w->path[row].along.x) > LONG_M;
}

/* Returns how far the ranges of two bodies are apart along an axis [m]. */
static double apart(double p, double along_p, double q, double along_q)
{
    double low_p = maths_min(p, p + along_p), high_p = maths_max(p, p + along_p);
    double low_q = maths_min(q, q + along_q), high_q = maths_max(q, q + along_q);
    return maths_max(0.0, maths_max(low_q - high_p, low_p - high_q));
}

/* Returns how much farther apart the boxes around two paths are than both bodies reach, on the map
 * [m]. */
static double corners_apart(const struct small_world *w, uint32_t a, uint32_t b)
{
    const struct path *p = &w->path[a], *q = &w->path[b];
    double x =
        apart(p->at.x, p->along.x * (1.0 - p->since), q->at.x, q->along.x * (1.0 - q->since));
    double z =
        apart(p->at.z, p->along.z * (1.0 - p->since), q->at.z, q->along.z * (1.0 - q->since));
    return sqrt(x * x + z * z) - pair_filter_margin(&w->world, &w->kinds[w->e.row[a].kind]) -
           pair_filter_margin(&w->world, &w->kinds[w->e.row[b].kind]);
}

static enum wanted oracle(const struct small_world *w, uint32_t a, uint32_t b)
{
    struct method_input input = input_of(w);
    if (!pair_filter_there(&input, a) || !pair_filter_there(&input, b) ||
        pair_excluded(&input, a, b))
        return NEVER;
    struct path_box box_a = pair_filter_box(&input, a), box_b = pair_filter_box(&input, b);
    if (!pair_filter_boxes_meet(&box_a, &box_b))
        return NEVER;
    double reach = pair_filter_row_reach(&input, a) + pair_filter_row_reach(&input, b);
    double corners = corners_apart(w, a, b);
    if (corners > ROUNDING_M)
        return NEVER;
    if (!is_long(w, a) && !is_long(w, b))
        return corners > -ROUNDING_M ? MAYBE : ALWAYS;
    return impact(&w->path[a], &w->path[b], reach) ? ALWAYS : MAYBE;
}

static enum wanted oracle_fixed(const struct small_world *w, uint32_t a, uint32_t index)
{
    struct method_input input = input_of(w);
    const struct fixed_object *object = &w->fixed[index];
    if (!pair_filter_there(&input, a) || !pair_filter_stands(&input, index) ||
        !pair_filter_tests_fixed(&input, a))
        return NEVER;
    struct path_box box = pair_filter_box(&input, a);
    if (!pair_filter_box_meets_fixed(&input, &box, object))
        return NEVER;
    struct path still = {.at = {object->x, (double)object->y, object->z}};
    double reach = pair_filter_row_reach(&input, a) + pair_filter_fixed_reach(&w->world, object);
    return !is_long(w, a) || impact(&w->path[a], &still, reach) ? ALWAYS : MAYBE;
}

/* --- the tests ---------------------------------------------------------------------------------*/

struct found {
    uint8_t moving[ROWS_MAX][ROWS_MAX], fixed[ROWS_MAX][FIXED_MAX];
};

static void collect(const struct broad_phase *broad, struct found *found)
{
    memset(found, 0, sizeof *found);
    for (int list = 0; list < THREAD_POOL_MAX; list++) {
        for (uint32_t n = 0; n < broad->list[list].count; n++) {
            struct pair pair = broad->list[list].pair[n];
            if (pair.b & PAIR_FIXED)
                found->fixed[pair.a][pair.b & ~PAIR_FIXED]++;
            else {
                assert_true(pair.a < pair.b);
                found->moving[pair.a][pair.b]++;
            }
        }
    }
}

struct census {
    uint64_t moving, fixed, dropped;
};

static void check(int world, uint32_t a, uint32_t b, enum wanted wanted, int times,
                  struct census *tally)
{
    if (times > 1 || (wanted == NEVER && times > 0) || (wanted == ALWAYS && times == 0))
        fail_msg("world %d: pair %u, %s%u found %d times, wanted %d", world, a,
                 b & PAIR_FIXED ? "fixed " : "", b & ~PAIR_FIXED, times, (int)wanted);
    *(b & PAIR_FIXED ? &tally->fixed : &tally->moving) += wanted == ALWAYS;
    tally->dropped += wanted == MAYBE && times == 0;
}

static void compare(const struct small_world *w, const struct broad_phase *broad, int world,
                    struct census *tally)
{
    static struct found found;
    collect(broad, &found);
    for (uint32_t a = 0; a < w->rows; a++) {
        for (uint32_t b = a + 1; b < w->rows; b++)
            check(world, a, b, oracle(w, a, b), found.moving[a][b], tally);
        for (uint32_t b = 0; b < w->world.counts.fixed; b++)
            check(world, a, b | PAIR_FIXED, oracle_fixed(w, a, b), found.fixed[a][b], tally);
    }
}

static void same_boxes(const struct small_world *w, const struct broad_phase *broad)
{
    struct method_input input = input_of(w);
    for (uint32_t i = 0; i < w->rows; i++) {
        struct path_box box = pair_filter_box(&input, i);
        if (pair_filter_there(&input, i))
            assert_memory_equal(&broad->box[i], &box, sizeof box);
    }
}

static void test_every_pair_is_found_exactly_once(void **state)
{
    static struct small_world w;
    struct broad_phase broad;
    uint64_t random = fixture_seed(37);
    struct census tally = {0};
    (void)state;
    begin(&w, ROWS_MAX);
    for (int world = 0; world < WORLDS; world++) {
        draw_world(&w, &random);
        const struct method_input input = input_of(&w);
        assert_int_equal(broad_phase_init(&broad, &w.world, NULL), 0);
        broad_phase_pairs(&broad, &input);
        compare(&w, &broad, world, &tally);
        same_boxes(&w, &broad);
        broad_phase_free(&broad);
        drop_world(&w);
    }
    print_message("%llu pairs of moving bodies, %llu with fixed objects; %llu dropped that never "
                  "touch\n",
                  (unsigned long long)tally.moving, (unsigned long long)tally.fixed,
                  (unsigned long long)tally.dropped);
    assert_true(tally.moving > 100000 && tally.fixed > 100000 && tally.dropped > 1000);
    end(&w);
}

/* --- rows in contacts --------------------------------------------------------------------------*/

/* Checks that each body whose box meets the wider one of a row is a pair with it. */
static void check_wider(const struct small_world *w, const struct broad_phase *broad, uint32_t row,
                        const struct found *found)
{
    struct method_input input = input_of(w);
    struct path_box exact = pair_filter_box(&input, row);
    const struct path_box *box = &broad->box[row];
    assert_true(fabs((double)(exact.min_x - box->min_x) - BODY_BOX_WIDER_M) < 0.02 &&
                fabs((double)(box->max_z - exact.max_z) - BODY_BOX_WIDER_M) < 0.02);
    for (uint32_t other = 0; broad_phase_has_all(broad, row) && other < w->rows; other++) {
        uint32_t a = row < other ? row : other, b = row < other ? other : row;
        if (other != row && pair_filter_there(&input, other) && !is_long(w, other) &&
            !pair_same_shooter(&w->e, a, b) && pair_filter_boxes_meet(box, &broad->box[other]) &&
            corners_apart(w, a, b) < BODY_BOX_WIDER_M - ROUNDING_M)
            assert_int_equal(found->moving[a][b], 1);
    }
    for (uint32_t i = 0; broad_phase_has_all(broad, row) && i < w->world.counts.fixed; i++) {
        if (pair_filter_stands(&input, i) && pair_filter_box_meets_fixed(&input, box, &w->fixed[i]))
            assert_int_equal(found->fixed[row][i], 1);
    }
}

static void test_rows_in_contacts_have_all_pairs_of_wider_boxes(void **state)
{
    static struct small_world w;
    static struct found found;
    static struct persistent_contact contact[ROWS_MAX / 4];
    struct broad_phase broad;
    uint64_t random = fixture_seed(40);
    uint32_t all = 0;
    (void)state;
    begin(&w, ROWS_MAX);
    for (int world = 0; world < WORLDS / 3; world++) {
        draw_world(&w, &random);
        const struct method_input input = input_of(&w);
        uint32_t count = w.rows / 4;
        for (uint32_t i = 0; i < count; i++)
            contact[i] = (struct persistent_contact){
                .a_row = i, .b_row = i + 1, .b_id = i % 5 == 0 ? PERSISTENT_CONTACT_FIXED : 1};
        assert_int_equal(broad_phase_init(&broad, &w.world, NULL), 0);
        broad_phase_widen(&broad, contact, count);
        broad_phase_pairs(&broad, &input);
        collect(&broad, &found);
        for (uint32_t i = 0; i < count; i++) {
            if (!pair_filter_there(&input, i))
                continue;
            check_wider(&w, &broad, i, &found);
            all += broad_phase_has_all(&broad, i);
        }
        broad_phase_widen(&broad, NULL, 0);
        broad_phase_pairs(&broad, &input);
        same_boxes(&w, &broad);
        broad_phase_free(&broad);
        drop_world(&w);
    }
    assert_true(all > 1000);
    end(&w);
}

/* --- queries -----------------------------------------------------------------------------------*/

static struct path_box draw_box(const struct spread *place, uint64_t *random)
{
    static const double sizes[] = {0.0, 0.5, 10.0, 200.0, 2000.0};
    struct path along = {.at = spread_point(place, random)};
    return pair_filter_path_box(&along, sizes[fixture_random(random) % 5]);
}

/* A query finds all rows whose boxes meet, except those with long paths, which may pass by. */
static void check_query(const struct small_world *w, const struct broad_phase *broad,
                        const struct path_box *box, struct pair_list *found)
{
    struct method_input input = input_of(w);
    uint32_t n = 1; /* behind the pair that was there before */
    for (uint32_t row = 0; row < w->rows; row++) {
        bool listed = n < found->count && found->pair[n].a == row && found->pair[n].b == 0;
        bool meets =
            pair_filter_there(&input, row) && pair_filter_boxes_meet(box, &broad->box[row]);
        assert_true(meets || !listed);
        assert_true(listed || !meets || is_long(w, row));
        n += listed;
    }
    assert_int_equal(n, found->count);
}

static void check_query_fixed(const struct small_world *w, const struct path_box *box,
                              struct pair_list *found)
{
    struct method_input input = input_of(w);
    uint32_t n = 1;
    for (uint32_t i = 0; i < w->world.counts.fixed; i++) {
        bool listed =
            n < found->count && found->pair[n].b == (i | PAIR_FIXED) && found->pair[n].a == 0;
        assert_int_equal(listed, pair_filter_box_meets_fixed(&input, box, &w->fixed[i]));
        n += listed;
    }
    assert_int_equal(n, found->count);
}

static void test_a_query_finds_every_row_and_object_once_in_order(void **state)
{
    static struct small_world w;
    struct broad_phase broad;
    struct pair_list found = {0};
    uint64_t random = fixture_seed(38), rows = 0, objects = 0;
    (void)state;
    begin(&w, ROWS_MAX);
    for (int world = 0; world < WORLDS / 3; world++) {
        struct spread place = draw_world(&w, &random);
        const struct method_input input = input_of(&w);
        assert_int_equal(broad_phase_init(&broad, &w.world, NULL), 0);
        broad_phase_pairs(&broad, &input);
        assert_int_equal(pair_list_init(&found, broad_phase_found_most(&w.world)), 0);
        for (int i = 0; i < 20; i++) {
            struct path_box box = draw_box(&place, &random);
            if (i == 10) /* from here on by the index */
                broad_phase_expect_queries(&broad, UINT32_MAX);
            assert_true(broad.index.built == (i >= 10));
            found.count = 0;
            pair_list_add(&found, 7, 7);
            broad_phase_query(&broad, &input, &box, &found);
            check_query(&w, &broad, &box, &found);
            rows += found.count - 1;
            found.count = 1;
            broad_phase_query_fixed(&broad, &input, &box, &found);
            check_query_fixed(&w, &box, &found);
            assert_true(found.pair[0].a == 7 && found.pair[0].b == 7);
            objects += found.count - 1;
        }
        pair_list_free(&found);
        broad_phase_free(&broad);
        drop_world(&w);
    }
    assert_true(rows > 10000 && objects > 10000);
    end(&w);
}

/* --- crowds ------------------------------------------------------------------------------------*/

static int by_pair(const void *p, const void *q)
{
    const struct pair *a = p, *b = q;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    return (a->b > b->b) - (a->b < b->b);
}

/* All pairs of the lists, in order. */
static struct pair_list all_pairs(const struct broad_phase *broad)
{
    struct pair_list all;
    assert_int_equal(pair_list_init(&all, pair_filter_pairs_first(broad->world)), 0);
    for (int list = 0; list < THREAD_POOL_MAX; list++) {
        for (uint32_t n = 0; n < broad->list[list].count; n++)
            pair_list_add(&all, broad->list[list].pair[n].a, broad->list[list].pair[n].b);
    }
    qsort(all.pair, all.count, sizeof *all.pair, by_pair);
    return all;
}

static void draw_crowd(struct small_world *w, uint64_t *random)
{
    struct spread place = {25000.0, 25000.0, CROWD_SIDE};
    draw_fixed(w, &place, random);
    w->rows = w->capacity;
    for (uint32_t i = 0; i < w->rows; i++) {
        draw_row(w, i, &place, random);
        if (w->e.row[i].kind == KIND_GIANT)
            w->e.row[i].kind = KIND_CAR;
        /* A third stands in a throng. */
        if (i % 3 == 0)
            w->path[i].at = vec3_add(
                (struct vec3){24000.0, 0.0, 26000.0},
                vec3_scale(vec3_sub(w->path[i].at, (struct vec3){25000.0, 0.0, 25000.0}), 0.03));
    }
}

static void test_a_crowd_has_the_same_pairs_on_any_threads(void **state)
{
    static struct small_world w;
    struct broad_phase broad;
    struct pair_list first = {0};
    uint64_t random = fixture_seed(39);
    struct census tally = {0};
    (void)state;
    begin(&w, CROWD);
    draw_crowd(&w, &random);
    const struct method_input input = input_of(&w);
    for (uint32_t threads = 1; threads <= 4; threads++) {
        struct thread_pool *workers = thread_pool_create(threads);
        assert_non_null(workers);
        assert_int_equal(broad_phase_init(&broad, &w.world, workers), 0);
        for (int again = 0; again < 2; again++) {
            broad_phase_pairs(&broad, &input);
            struct pair_list all = all_pairs(&broad);
            if (!first.pair)
                first = all;
            assert_int_equal(all.count, first.count);
            assert_memory_equal(all.pair, first.pair, all.count * sizeof *all.pair);
            if (all.pair != first.pair)
                pair_list_free(&all);
        }
        broad_phase_free(&broad);
        thread_pool_destroy(workers);
    }
    struct path_box *box = malloc(w.rows * sizeof *box);
    assert_non_null(box);
    for (uint32_t i = 0; i < w.rows; i++)
        box[i] = pair_filter_box(&input, i);
    uint32_t n = 0;
    for (uint32_t a = 0; a < w.rows; a++) {
        for (uint32_t b = a + 1; b < w.rows; b++) {
            bool listed = n < first.count && first.pair[n].a == a && first.pair[n].b == b;
            if (listed || pair_filter_boxes_meet(&box[a], &box[b]))
                check(0, a, b, oracle(&w, a, b), listed, &tally);
            n += listed;
        }
        for (; n < first.count && first.pair[n].a == a; n++)
            assert_true(first.pair[n].b & PAIR_FIXED);
    }
    assert_int_equal(n, first.count);
    print_message("%llu pairs in a crowd\n", (unsigned long long)tally.moving);
    assert_true(tally.moving > 50000);
    free(box);
    pair_list_free(&first);
    drop_world(&w);
    end(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_pair_is_found_exactly_once),
        cmocka_unit_test(test_rows_in_contacts_have_all_pairs_of_wider_boxes),
        cmocka_unit_test(test_a_query_finds_every_row_and_object_once_in_order),
        cmocka_unit_test(test_a_crowd_has_the_same_pairs_on_any_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
