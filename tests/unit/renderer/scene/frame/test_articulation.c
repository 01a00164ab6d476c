/* Articulation: wheels roll, turrets and guns follow the world, wrecks do not move. */
#include "renderer/scene/frame/articulation.h"

#include "renderer/scene/frame/frame_view.h"
#include "world/entity/kind.h"
#include "world/maths/maths.h"
#include "world/params.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CAPACITY 4u
#define DT_S     0.05

static const struct kind kinds[] = {
    {.name = "truck", .domain = DOMAIN_LAND, .length_m = 6.0, .width_m = 2.0},
};

/* A truck in slot 0 and a target in slot 1. */
struct stage {
    struct params params;
    struct world world;
    struct state_head head;
    struct entities e;
    struct frame_view frame_view;
    struct articulation articulation;
    void *columns;
};

static int open_stage(void **context)
{
    struct stage *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->params.dt_s = DT_S;
    s->world.params = &s->params;
    s->world.kinds = kinds;
    s->world.counts.kinds = 1;
    s->columns = aligned_alloc(TABLE_ALIGN, entities_bytes(CAPACITY));
    assert_non_null(s->columns);
    memset(s->columns, 0, entities_bytes(CAPACITY));
    entities_bind(&s->e, CAPACITY, s->columns);
    s->head.used = 2;
    for (uint32_t i = 0; i < 2; i++) {
        s->e.row[i].id = i + 1;
        s->e.row[i].state = ENTITY_ACTIVE;
        s->e.row[i].target_slot = SLOT_NONE;
    }
    s->e.row[1].x = 1000.0;
    s->frame_view = (struct frame_view){.world = &s->world, .head = &s->head, .entities = &s->e};
    assert_int_equal(articulation_init(&s->articulation, CAPACITY), 0);
    articulation_note(&s->articulation, &s->frame_view);
    *context = s;
    return 0;
}

static int close_stage(void **context)
{
    struct stage *s = *context;
    articulation_free(&s->articulation);
    free(s->columns);
    free(s);
    return 0;
}

/* Advances a step: forward and to the right by these distances. */
static struct articulation_state drive(struct stage *s, double travel_m, double turn_rad)
{
    const struct entities *e = &s->e;
    e->row[0].heading += turn_rad;
    e->row[0].x += travel_m * maths_sin(e->row[0].heading);
    e->row[0].z -= travel_m * maths_cos(e->row[0].heading);
    s->head.tick++;
    articulation_note(&s->articulation, &s->frame_view);
    return articulation_of(&s->articulation, &s->frame_view, 0);
}

/* A wheel rolls by distance over radius: one turn for its circumference. */
static void test_travel_is_the_distance_driven(void **context)
{
    struct stage *s = *context;
    double radius = 0.5, circumference = TWO_PI * radius;
    struct articulation_state state = articulation_of(&s->articulation, &s->frame_view, 0);
    assert_true(state.travel_m[0] == 0.0 && state.travel_m[1] == 0.0);
    s->e.row[0].heading = 2.1;
    articulation_note(&s->articulation, &s->frame_view);
    double from = articulation_of(&s->articulation, &s->frame_view, 0).travel_m[0];
    for (int i = 0; i < 20; i++)
        state = drive(s, circumference / 20.0, 0.0);
    assert_true(fabs((state.travel_m[0] - from) / radius - TWO_PI) < 1e-9);
    for (int i = 0; i < 20; i++)
        state = drive(s, -circumference / 20.0, 0.0);
    assert_true(fabs(state.travel_m[0] - from) < 1e-9);
}

static void test_a_parked_vehicle_does_not_roll(void **context)
{
    struct stage *s = *context;
    struct articulation_state before = drive(s, 3.0, 0.0), after = before;
    for (int i = 0; i < 30; i++)
        after = drive(s, 0.0, 0.0);
    assert_true(after.travel_m[0] == before.travel_m[0] && after.travel_m[1] == before.travel_m[1]);
    /* A vehicle pushed sideways does not roll. */
    s->e.row[0].x += 2.0; /* it heads north */
    after = drive(s, 0.0, 0.0);
    assert_true(fabs(after.travel_m[0] - before.travel_m[0]) < 1e-9);
}

/* In a right turn the left side rolls farther; on the spot the sides roll in opposite
 * directions. */
static void test_outer_side_rolls_farther(void **context)
{
    struct stage *s = *context;
    struct articulation_state before = drive(s, 5.0, 0.0), after = drive(s, 1.0, 0.1);
    double left = after.travel_m[0] - before.travel_m[0],
           right = after.travel_m[1] - before.travel_m[1];
    assert_true(left > right + 0.1);
    assert_true(after.steer_rad > 0.0f);
    before = after;
    after = drive(s, 0.0, 0.2);
    left = after.travel_m[0] - before.travel_m[0];
    right = after.travel_m[1] - before.travel_m[1];
    assert_true(left > 0.1 && fabs(left + right) < 1e-9);
}

static void test_travel_wraps_without_a_jump(void **context)
{
    struct stage *s = *context;
    struct articulation_state state;
    double sum = 0.0;
    for (int i = 0; i < 500; i++) {
        state = drive(s, 10.0, 0.0);
        sum += 10.0;
        assert_true(state.travel_m[0] >= 0.0 && state.travel_m[0] < ARTICULATION_WRAP_M);
    }
    assert_true(fabs(state.travel_m[0] - fmod(sum, ARTICULATION_WRAP_M)) < 1e-6);
}

/* They are those of the world, seen before or not. */
static void test_turret_and_gun_are_the_worlds(void **context)
{
    struct stage *s = *context;
    for (int i = 0; i < 20; i++) {
        s->e.row[0].turret = -1.5f + 0.15f * (float)i;
        s->e.row[0].gun = 0.01f * (float)i;
        struct articulation_state noted = drive(s, 0.5, 0.0),
                                  frustum = articulation_of(NULL, &s->frame_view, 0);
        assert_true(noted.turret_rad == s->e.row[0].turret && noted.gun_rad == s->e.row[0].gun);
        assert_true(frustum.turret_rad == s->e.row[0].turret && frustum.gun_rad == s->e.row[0].gun);
    }
}

/* A wreck keeps its turret, its wheels do not roll, and its gun sinks. */
static void test_wreck_stands_still(void **context)
{
    struct stage *s = *context;
    s->e.row[0].turret = 0.8f;
    s->e.row[0].gun = 0.2f;
    struct articulation_state before = drive(s, 4.0, 0.0), after = before;
    s->e.row[0].state = ENTITY_WRECK;
    for (int i = 0; i < 40; i++) {
        float gun = after.gun_rad;
        after = drive(s, 0.3, 0.0); /* it is pushed */
        assert_true(after.gun_rad <= gun && after.gun_rad >= gun - 0.36f * (float)DT_S);
    }
    assert_true(after.turret_rad == before.turret_rad);
    assert_true(after.travel_m[0] == before.travel_m[0]);
    assert_true(after.gun_rad < -0.1f);
    assert_true(articulation_of(NULL, &s->frame_view, 0).gun_rad < -0.1f);
}

/* Another vehicle in the slot, a time set back or a long gap: the state starts anew. */
static void test_state_restarts(void **context)
{
    struct stage *s = *context;
    assert_true(drive(s, 4.0, 0.0).travel_m[0] > 3.9);
    s->head.tick += (uint64_t)(3.0 / DT_S);
    assert_true(drive(s, 4.0, 0.0).travel_m[0] == 0.0);
    assert_true(drive(s, 4.0, 0.0).travel_m[0] > 3.9);
    s->head.tick -= 10;
    assert_true(drive(s, 4.0, 0.0).travel_m[0] == 0.0);
    assert_true(drive(s, 4.0, 0.0).travel_m[0] > 3.9);
    s->e.row[0].id = 7;
    assert_true(articulation_of(&s->articulation, &s->frame_view, 0).travel_m[0] == 0.0);
    assert_true(drive(s, 4.0, 0.0).travel_m[0] == 0.0);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, open_stage, close_stage)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_travel_is_the_distance_driven),
        TEST(test_a_parked_vehicle_does_not_roll),
        TEST(test_outer_side_rolls_farther),
        TEST(test_travel_wraps_without_a_jump),
        TEST(test_turret_and_gun_are_the_worlds),
        TEST(test_wreck_stands_still),
        TEST(test_state_restarts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
