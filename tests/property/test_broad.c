/* The broad phase against comparing everything with everything, on random small worlds (thesis
 * rows 3, 17, 37). SEED=n runs another set. */
#include "collider/broad.h"

#include "tests/support/fixture.h"
#include "world/reach.h"
#include "world/square.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WORLDS    2400
#define ROWS_MAX  64
#define FIXED_MAX 48
#define SLACK_M   0.05 /* boxes may be larger than exact by this, and never smaller */

/* Kinds: small to huge on land, an aircraft, a munition. */
enum { KIND_GRAIN, KIND_CAR, KIND_TANK, KIND_SHIP, KIND_GIANT, KIND_JET, KIND_ROUND, KINDS };

struct small_world {
    struct params params;
    struct kind kinds[KINDS];
    struct fixed_object fixed[FIXED_MAX];
    uint8_t damage[FIXED_MAX];
    float posts[4];
    uint8_t cover[4];
    uint32_t *reach_start, *reach;
    void *memory;
    struct entities e;
    struct path path[ROWS_MAX];
    uint32_t rows;
    struct world world;
};

static void begin(struct small_world *w)
{
    static const double radii[KINDS] = {0.01, 1.6, 3.0, 20.0, 400.0, 7.0, 0.1};
    memset(w, 0, sizeof *w);
    for (int i = 0; i < KINDS; i++)
        w->kinds[i].radius_m = radii[i];
    w->kinds[KIND_JET].domain = DOMAIN_AIR;
    w->kinds[KIND_ROUND].domain = DOMAIN_MUNITION;
    w->params.capacity = ROWS_MAX;
    w->params.collision.threshold_height_m = 60.0;
    w->memory = aligned_alloc(COLUMN_ALIGN, entities_bytes(ROWS_MAX));
    assert_non_null(w->memory);
    entities_bind(&w->e, ROWS_MAX, w->memory);
    w->world = (struct world){.params = &w->params,
                              .counts = {.kinds = KINDS},
                              .terrain = {w->posts, w->cover, 2, WORLD_SIDE_M},
                              .kinds = w->kinds,
                              .fixed = w->fixed};
}

static void end(struct small_world *w)
{
    free(w->memory);
}

/* --- drawing worlds ----------------------------------------------------------------------------*/

/* Where the world's bodies are: its middle and its size. */
struct place {
    double x, z, extent;
};

static struct place draw_place(uint64_t *random)
{
    static const double extents[] = {0.0, 3.0, 40.0, 300.0, 3000.0};
    struct place place = {fixture_uniform(random, 0, WORLD_SIDE_M),
                          fixture_uniform(random, 0, WORLD_SIDE_M),
                          extents[fixture_random(random) % 5]};
    switch (fixture_random(random) % 4) {
    case 0: /* on a corner of four squares */
        place.x = SQUARE_SIDE_M * floor(place.x / SQUARE_SIDE_M);
        place.z = SQUARE_SIDE_M * floor(place.z / SQUARE_SIDE_M);
        break;
    case 1: /* on a border */
        place.x = SQUARE_SIDE_M * floor(place.x / SQUARE_SIDE_M);
        break;
    case 2: /* at the world's corner, and past it */
        place.x = place.z = fixture_random(random) & 1 ? 0.0 : WORLD_SIDE_M;
        break;
    default:
        break;
    }
    return place;
}

static struct vec3 draw_point(const struct place *place, uint64_t *random)
{
    double half = 0.5 * place->extent;
    struct vec3 p = {place->x + fixture_uniform(random, -half, half),
                     fixture_uniform(random, 0.0, 0.2 * place->extent + 1.0),
                     place->z + fixture_uniform(random, -half, half)};
    if (fixture_random(random) % 8 == 0) /* exactly on a border */
        p.x = SQUARE_SIDE_M * floor(p.x / SQUARE_SIDE_M);
    return p;
}

static void draw_fixed(struct small_world *w, const struct place *place, uint64_t *random)
{
    static const double radii[] = {0.01, 0.4, 1.8, 9.0, 130.0};
    uint32_t count = (uint32_t)(fixture_random(random) % (FIXED_MAX + 1));
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 p = draw_point(place, random);
        w->fixed[i] = (struct fixed_object){
            .x = maths_clamp(p.x, 0.0, WORLD_SIDE_M),
            .z = maths_clamp(p.z, 0.0, WORLD_SIDE_M),
            .y = (float)fixture_uniform(random, 0.0, 5.0),
            .radius_m = (float)radii[fixture_random(random) % 5],
        };
        w->damage[i] = (uint8_t)(fixture_random(random) % 8 == 0 ? DAMAGE_HIGH : DAMAGE_MED);
    }
    w->world.counts.fixed = count;
    assert_int_equal(reach_build(w->fixed, count, w->kinds, &w->reach_start, &w->reach), 0);
    w->world.reach_start = w->reach_start;
    w->world.reach = w->reach;
}

static void draw_row(struct small_world *w, uint32_t i, const struct place *place, uint64_t *random)
{
    static const double speeds[] = {0.0, 0.0, 1.0, 30.0, 300.0, 1500.0};
    struct entities *e = &w->e;
    double along = speeds[fixture_random(random) % 6];
    uint32_t kind = (uint32_t)(fixture_random(random) % KINDS);
    if (kind == KIND_GIANT && fixture_random(random) % 4 != 0)
        kind = KIND_CAR;
    entities_clear(e, i);
    e->id[i] = i + 1;
    e->kind[i] = (uint16_t)kind;
    e->state[i] = (uint8_t)(fixture_random(random) % 10 == 0 ? ENTITY_FREE : ENTITY_ACTIVE);
    e->behaviour[i] = kind == KIND_ROUND ? BEHAVIOUR_FLIGHT : BEHAVIOUR_HOLD;
    if (kind == KIND_ROUND && i > 0) { /* somebody's, or of somebody who is gone */
        e->owner_slot[i] = (uint32_t)(fixture_random(random) % i);
        e->owner_id[i] = e->owner_slot[i] + 1 + (fixture_random(random) % 4 == 0 ? 1000u : 0u);
    }
    w->path[i] = (struct path){.at = draw_point(place, random),
                               .along = {along * fixture_uniform(random, -1, 1),
                                         along * fixture_uniform(random, -0.1, 0.1),
                                         along * fixture_uniform(random, -1, 1)}};
    if (kind == KIND_JET)
        w->path[i].at.y += fixture_uniform(random, 0.0, 120.0);
    if (i > 0 && fixture_random(random) % 8 == 0) /* coincident */
        w->path[i] = w->path[i - 1];
}

static void draw_world(struct small_world *w, uint64_t *random)
{
    struct place place = draw_place(random);
    w->rows = (uint32_t)(2 + fixture_random(random) % (ROWS_MAX - 1));
    draw_fixed(w, &place, random);
    for (uint32_t i = 0; i < w->rows; i++)
        draw_row(w, i, &place, random);
}

/* --- the oracle --------------------------------------------------------------------------------*/

struct box {
    double low[3], high[3];
};

static struct box box_of(const struct path *path, double grow)
{
    struct vec3 p = path_at(path, path->since), q = path_at(path, 1.0);
    return (struct box){
        {maths_min(p.x, q.x) - grow, maths_min(p.y, q.y) - grow, maths_min(p.z, q.z) - grow},
        {maths_max(p.x, q.x) + grow, maths_max(p.y, q.y) + grow, maths_max(p.z, q.z) + grow}};
}

static bool overlap(const struct box *a, const struct box *b)
{
    for (int axis = 0; axis < 3; axis++) {
        if (a->low[axis] > b->high[axis] || b->low[axis] > a->high[axis])
            return false;
    }
    return true;
}

static bool rests(const struct path *path)
{
    return vec3_length(path->along) == 0.0;
}

static bool fires(const struct entities *e, uint32_t round, uint32_t shooter)
{
    return e->behaviour[round] == BEHAVIOUR_FLIGHT && e->owner_slot[round] == shooter &&
           e->owner_id[round] == e->id[shooter];
}

static bool excluded(const struct small_world *w, uint32_t a, uint32_t b)
{
    const struct entities *e = &w->e;
    bool rounds = e->behaviour[a] == BEHAVIOUR_FLIGHT && e->behaviour[b] == BEHAVIOUR_FLIGHT;
    return e->state[a] == ENTITY_FREE || e->state[b] == ENTITY_FREE || fires(e, a, b) ||
           fires(e, b, a) || (rounds && e->owner_id[a] != 0 && e->owner_id[a] == e->owner_id[b]) ||
           (rests(&w->path[a]) && rests(&w->path[b]));
}

/* The ground is at 0. Between both ends the height is between theirs. */
static bool flies_above(const struct small_world *w, uint32_t row)
{
    const struct path *path = &w->path[row];
    double limit = w->params.collision.threshold_height_m;
    return w->kinds[w->e.kind[row]].domain == DOMAIN_AIR && path->at.y > limit &&
           path_at(path, 1.0).y > limit;
}

/* 1: must be a pair; 0: must not; -1: may. */
static int oracle(const struct small_world *w, uint32_t a, uint32_t b)
{
    double radius = w->kinds[w->e.kind[a]].radius_m;
    struct box exact = box_of(&w->path[a], radius), wide = box_of(&w->path[a], radius + SLACK_M);
    struct box other_exact, other_wide;
    if (b & PAIR_FIXED) {
        const struct fixed_object *object = &w->fixed[b & ~PAIR_FIXED];
        struct path still = {.at = {object->x, (double)object->y, object->z}};
        if (w->e.state[a] == ENTITY_FREE || w->damage[b & ~PAIR_FIXED] >= DAMAGE_HIGH ||
            rests(&w->path[a]) || flies_above(w, a))
            return 0;
        other_exact = box_of(&still, (double)object->radius_m);
        other_wide = box_of(&still, (double)object->radius_m + SLACK_M);
    } else {
        if (excluded(w, a, b))
            return 0;
        radius = w->kinds[w->e.kind[b]].radius_m;
        other_exact = box_of(&w->path[b], radius);
        other_wide = box_of(&w->path[b], radius + SLACK_M);
    }
    if (overlap(&exact, &other_exact))
        return 1;
    return overlap(&wide, &other_wide) ? -1 : 0;
}

/* --- the tests ---------------------------------------------------------------------------------*/

struct found {
    uint8_t moving[ROWS_MAX][ROWS_MAX], fixed[ROWS_MAX][FIXED_MAX];
};

static void collect(const struct broad *broad, struct found *found)
{
    memset(found, 0, sizeof *found);
    for (int list = 0; list < WORKERS_MAX; list++) {
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

static void check(int world, uint32_t a, uint32_t b, int wanted, int times)
{
    if (times > 1 || (wanted >= 0 && times != wanted))
        fail_msg("world %d: pair %u, %s%u found %d times, wanted %d", world, a,
                 b & PAIR_FIXED ? "fixed " : "", b & ~PAIR_FIXED, times, wanted);
}

static void compare(const struct small_world *w, const struct broad *broad, int world,
                    uint64_t pairs[2])
{
    static struct found found;
    collect(broad, &found);
    for (uint32_t a = 0; a < w->rows; a++) {
        for (uint32_t b = a + 1; b < w->rows; b++) {
            int wanted = oracle(w, a, b);
            pairs[0] += wanted == 1;
            check(world, a, b, wanted, found.moving[a][b]);
        }
        for (uint32_t b = 0; b < w->world.counts.fixed; b++) {
            int wanted = oracle(w, a, b | PAIR_FIXED);
            pairs[1] += wanted == 1;
            check(world, a, b | PAIR_FIXED, wanted, found.fixed[a][b]);
        }
    }
}

static void test_every_pair_is_found_exactly_once(void **state)
{
    static struct small_world w;
    struct broad broad;
    uint64_t random = fixture_seed(37), pairs[2] = {0, 0};
    (void)state;
    begin(&w);
    assert_int_equal(broad_init(&broad, &w.world, NULL), 0);
    for (int world = 0; world < WORLDS; world++) {
        draw_world(&w, &random);
        const struct detect_input input = {.world = &w.world,
                                           .entities = &w.e,
                                           .path = w.path,
                                           .fixed_damage = w.damage,
                                           .rows = w.rows};
        assert_int_equal(broad_pairs(&broad, &input), 0);
        compare(&w, &broad, world, pairs);
        free(w.reach_start);
        free(w.reach);
    }
    print_message("%llu pairs of moving bodies, %llu with fixed objects\n",
                  (unsigned long long)pairs[0], (unsigned long long)pairs[1]);
    assert_true(pairs[0] > 100000 && pairs[1] > 100000);
    broad_free(&broad);
    end(&w);
}

/* The blast looks for its victims this way. */
static void test_a_square_lists_every_row_that_touches_it(void **state)
{
    static struct small_world w;
    struct broad broad;
    uint64_t random = fixture_seed(38);
    (void)state;
    begin(&w);
    assert_int_equal(broad_init(&broad, &w.world, NULL), 0);
    for (int world = 0; world < WORLDS / 10; world++) {
        draw_world(&w, &random);
        const struct detect_input input = {.world = &w.world,
                                           .entities = &w.e,
                                           .path = w.path,
                                           .fixed_damage = w.damage,
                                           .rows = w.rows};
        assert_int_equal(broad_pairs(&broad, &input), 0);
        for (uint32_t i = 0; i < w.rows; i++) {
            if (w.e.state[i] == ENTITY_FREE)
                continue;
            struct box box = box_of(&w.path[i], w.kinds[w.e.kind[i]].radius_m);
            struct square_box squares =
                square_box_of(box.low[0], box.low[2], box.high[0], box.high[2]);
            for (int32_t row = squares.z0; row <= squares.z1; row++) {
                for (int32_t column = squares.x0; column <= squares.x1; column++) {
                    const struct bin_entry *entry;
                    uint32_t count = broad_square(&broad, square_index(column, row), &entry);
                    uint32_t times = 0;
                    for (uint32_t n = 0; n < count; n++)
                        times += entry[n].row == i;
                    assert_int_equal(times, 1);
                }
            }
        }
        free(w.reach_start);
        free(w.reach);
    }
    broad_free(&broad);
    end(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_pair_is_found_exactly_once),
        cmocka_unit_test(test_a_square_lists_every_row_that_touches_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
