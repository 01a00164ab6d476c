/* Rows into strips: the same from columns as from computed paths, and paths are computed only for
 * rows that need one. */
#include "collider/broad_phase/body_boxes.h"

#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROWS   900 /* the last block is not full */
#define ROUNDS 40

static struct fixture f;
static struct state *next;
static struct body_motion *motion;
static struct broad_phase *broad;
static struct path way[ROWS];
static struct path_box box[ROWS];
static struct pair expected[65536], found[65536];

static int open_world(void **state)
{
    static const char *const kinds[] = {"tank", "jeep", "helicopter", "shell", "jet"};
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 1024; }; collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f, (struct fixture_entity){.kind = kinds[i % 5], .at = {25000.0, 100.0, 0}});
    motion = &f.stepper.collider.motion;
    broad = &f.stepper.collider.broad;
    return 0;
}

/* Where a row was, where it is now, and special cases: at rest, rotating at rest, far away at once,
 * another entity in the row, an empty row. */
static void draw_row(uint64_t *random, uint32_t row)
{
    const struct entities *w = &f.view.w[0].entities, *n = &next->entities;
    double reach = fixture_random(random) % 8 ? 30.0 : 900.0;
    struct vec3 was = {25000.0 + fixture_uniform(random, -400.0, 400.0),
                       fixture_uniform(random, 95.0, 160.0),
                       25000.0 + fixture_uniform(random, -150.0, 150.0)};
    struct vec3 is = vec3_add(was, (struct vec3){fixture_uniform(random, -reach, reach),
                                                 fixture_uniform(random, -reach, reach),
                                                 fixture_uniform(random, -reach, reach)});
    uint64_t now = fixture_random(random) % 8;
    w->row[row].state = n->row[row].state = ENTITY_ACTIVE;
    n->row[row].id = w->row[row].id = row + 1;
    entities_set_position(w, row, was);
    entities_set_position(n, row, now < 3 ? was : is);
    w->row[row].roll = n->row[row].roll = 0.0;
    if (now == 1)
        n->row[row].roll = 0.1;
    else if (now == 4)
        n->row[row].id += 5000;
    else if (now == 5)
        n->row[row].state = row % 5 == 2 ? ENTITY_WRECK : ENTITY_FREE;
}

static int by_bodies(const void *p, const void *q)
{
    const struct pair *a = p, *b = q;
    return a->a != b->a ? (a->a < b->a ? -1 : 1) : (a->b > b->b) - (a->b < b->b);
}

static uint32_t take_pairs(struct pair *to)
{
    uint32_t count = 0;
    for (int i = 0; i < THREAD_POOL_MAX; i++) {
        for (uint32_t n = 0; n < broad->list[i].count; n++)
            to[count++] = broad->list[i].pair[n];
    }
    qsort(to, count, sizeof *to, by_bodies);
    return count;
}

static bool ends(const struct pair_list *fliers, uint32_t row)
{
    for (uint32_t i = 0; i < fliers->count; i++) {
        if (fliers->pair[i].a == row)
            return true;
    }
    return false;
}

/* Rows whose path may end: rounds, and aircraft that may reach the ground. */
static uint32_t check_fliers(const struct method_input *input)
{
    const struct entities *e = &next->entities;
    uint32_t left_out = 0;
    for (uint32_t row = 0; row < ROWS; row++) {
        bool round = e->row[row].behaviour == BEHAVIOUR_FLIGHT;
        bool air = input->world->kinds[e->row[row].kind].domain == DOMAIN_AIR;
        bool listed = ends(&broad->sweeper[0].fliers, row);
        double toi;
        if (e->row[row].state != ENTITY_ACTIVE || !(round || air)) {
            assert_false(listed);
            continue;
        }
        assert_true(listed || !(round || analytic_impact_ground(&input->world->terrain,
                                                                input->craters, &way[row], &toi)));
        assert_true(!listed || motion->computed[row]);
        left_out += !listed;
    }
    return left_out;
}

static void test_columns_give_the_same_as_computed_paths(void **state)
{
    uint64_t random = fixture_seed(64);
    uint32_t pairs = 0, computed = 0, left_out = 0;
    struct response_context context;
    (void)state;
    steps_respond(&f, &context);
    next = &f.view.w[1];
    for (int round = 0; round < ROUNDS; round++) {
        const struct method_input *input = &context.input.detect;
        for (uint32_t row = 0; row < ROWS; row++)
            draw_row(&random, row);
        f.view.w[0].head->used = round % 2 ? ROWS : ROWS - 100; /* the rest is new */
        body_motion_begin(motion, &f.view.w[0], next, NULL);
        for (uint32_t row = 0; row < ROWS; row++)
            body_motion_compute(motion, row);
        memcpy(way, motion->path, sizeof way);
        broad_phase_pairs(broad, input);
        memcpy(box, broad->box, sizeof box);
        uint32_t count = take_pairs(expected);
        memset(broad->box, 0x55, sizeof box);
        memset(motion->path, 0x55, sizeof way);
        body_motion_begin(motion, &f.view.w[0], next, NULL);
        broad_phase_pairs_moved(broad, input, motion, NULL, NULL);
        assert_int_equal(take_pairs(found), count);
        assert_memory_equal(found, expected, count * sizeof *found);
        for (uint32_t row = 0; row < ROWS; row++) {
            if (next->entities.row[row].state != ENTITY_FREE)
                assert_memory_equal(&broad->box[row], &box[row], sizeof *box);
            if (motion->computed[row])
                assert_true(motion->path[row].at.x == way[row].at.x &&
                            motion->path[row].along.z == way[row].along.z &&
                            motion->path[row].rotates == way[row].rotates);
            computed += motion->computed[row];
        }
        left_out += check_fliers(input);
        pairs += count;
    }
    print_message("%u pairs, %u of %u ways drawn, %u aircraft high enough\n", pairs, computed,
                  ROUNDS * ROWS, left_out);
    assert_true(pairs > 1000 * ROUNDS && computed < ROUNDS * ROWS * 2 / 3 && left_out > ROUNDS);
    f.view.w[0].head->used = ROWS;
    steps_respond_end(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate_setup_teardown(test_columns_give_the_same_as_computed_paths,
                                                 open_world, fixture_teardown, &f),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
