/* Interpolation: bodies move evenly and turn by the shorter arc, and nothing else changes early. */
#include "renderer/scene/frame/frame_interpolation.h"

#include "tests/support/fixture.h"
#include "world/checksum.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define CAPACITY 64u
#define DT_S     (1.0 / 60.0)

struct frame_of {
    struct state_head head;
    struct entities entities;
    void *columns;
    struct frame_view frame_view;
};

struct stage {
    struct params params;
    struct world world;
    struct frame_of a, b;
    struct frame_interpolation interpolation;
};

static uint64_t seed;

static double draw(double low, double high)
{
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static void open_frame(struct frame_of *frame, const struct world *world, uint64_t number)
{
    frame->columns = aligned_alloc(TABLE_ALIGN, entities_bytes(CAPACITY));
    assert_non_null(frame->columns);
    memset(frame->columns, 0, entities_bytes(CAPACITY));
    entities_bind(&frame->entities, CAPACITY, frame->columns);
    frame->head = (struct state_head){.frame = number, .tick = number, .used = CAPACITY};
    frame->frame_view =
        (struct frame_view){.world = world, .head = &frame->head, .entities = &frame->entities};
}

/* A table of moving and turning bodies, and the same one frame later. */
static int open_stage(void **context)
{
    struct stage *s = calloc(1, sizeof *s);
    assert_non_null(s);
    seed = fixture_seed(3);
    s->params = (struct params){.dt_s = DT_S, .hz = 60.0, .capacity = CAPACITY};
    s->world.params = &s->params;
    open_frame(&s->a, &s->world, 100);
    open_frame(&s->b, &s->world, 101);
    assert_int_equal(frame_interpolation_init(&s->interpolation, CAPACITY), 0);
    for (uint32_t i = 0; i < CAPACITY; i++) {
        const struct entities *e = &s->a.entities;
        e->row[i].id = i + 1;
        e->row[i].state = i % 5 == 4 ? ENTITY_WRECK : ENTITY_ACTIVE;
        entities_set_position(e, i, (struct vec3){draw(0, 5e4), draw(0, 1e3), draw(0, 5e4)});
        entities_set_velocity(e, i, (struct vec3){draw(-90, 90), draw(-9, 9), draw(-90, 90)});
        e->row[i].heading = draw(0.0, TWO_PI);
        e->row[i].pitch = draw(-1.0, 1.0);
        e->row[i].roll = draw(-PI, PI);
        entities_copy(&s->b.entities, e, i, 1);
        e = &s->b.entities;
        struct vec3 direction = vec3_scale(entities_velocity(e, i), DT_S);
        entities_set_position(e, i, vec3_add(entities_position(e, i), direction));
        e->row[i].heading = maths_wrap_turn(e->row[i].heading + draw(-0.3, 0.3));
        e->row[i].pitch += draw(-0.1, 0.1);
        e->row[i].roll = maths_wrap_half(e->row[i].roll + draw(-0.3, 0.3));
    }
    *context = s;
    return 0;
}

static int close_stage(void **context)
{
    struct stage *s = *context;
    frame_interpolation_free(&s->interpolation);
    free(s->a.columns);
    free(s->b.columns);
    free(s);
    return 0;
}

static struct frame_view at(struct stage *s, double share)
{
    return frame_interpolation_between(&s->interpolation, &s->a.frame_view, &s->b.frame_view,
                                       share);
}

static double turn(double from, double to)
{
    return fabs(maths_wrap_half(to - from));
}

/* --- the state -------------------------------------------------------------------------------- */

static void test_ends_are_the_frames_themselves(void **context)
{
    struct stage *s = *context;
    static const double ends[][2] = {{0.0, 0}, {-0.5, 0}, {1.0, 1}, {1.5, 1}, {NAN, 1}};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        struct frame_view frame_view = at(s, ends[i][0]);
        const struct frame_of *frame = ends[i][1] == 0.0 ? &s->a : &s->b;
        assert_memory_equal(&frame_view, &frame->frame_view, sizeof frame_view);
    }
}

/* Rows in use may be fewer in the later frame: the bodies that are left move on, the others stay.
 */
static void test_bodies_move_evenly_when_the_end_of_the_table_falls_back(void **context)
{
    struct stage *s = *context;
    s->b.head.used = CAPACITY / 2;
    struct frame_view frame_view = at(s, 0.5);
    for (uint32_t i = 0; i < CAPACITY; i++) {
        double ax = s->a.entities.row[i].x, bx = s->b.entities.row[i].x;
        double x = i < CAPACITY / 2 ? 0.5 * (ax + bx) : ax;
        assert_true(fabs(frame_view.entities->row[i].x - x) < 1e-6);
    }
}

static void test_bodies_move_evenly_and_turn_by_the_shorter_arc(void **context)
{
    struct stage *s = *context;
    const struct entities *a = &s->a.entities, *b = &s->b.entities;
    for (int n = 0; n < 50; n++) {
        double share = draw(0.001, 0.999);
        struct frame_view frame_view = at(s, share);
        assert_true(fabs(frame_view_time_s(&frame_view) - (100.0 + share) * DT_S) < 1e-12);
        for (uint32_t i = 0; i < CAPACITY; i++) {
            const struct entities *e = frame_view.entities;
            struct vec3 from = entities_position(a, i), to = entities_position(b, i);
            struct vec3 here = entities_position(e, i);
            double direction = vec3_length(vec3_sub(to, from));
            assert_true(fabs(vec3_length(vec3_sub(here, from)) - share * direction) < 1e-6);
            assert_true(fabs(vec3_length(vec3_sub(to, here)) - (1.0 - share) * direction) < 1e-6);
            assert_true(e->row[i].heading >= 0.0 && e->row[i].heading < TWO_PI);
            const double angle[][3] = {{a->row[i].heading, b->row[i].heading, e->row[i].heading},
                                       {a->row[i].pitch, b->row[i].pitch, e->row[i].pitch},
                                       {a->row[i].roll, b->row[i].roll, e->row[i].roll}};
            for (int k = 0; k < 3; k++) {
                double whole = turn(angle[k][0], angle[k][1]);
                assert_true(fabs(turn(angle[k][0], angle[k][2]) - share * whole) < 1e-9);
                assert_true(fabs(turn(angle[k][2], angle[k][1]) - (1.0 - share) * whole) < 1e-9);
            }
        }
    }
}

static void test_turning_past_north_takes_the_shorter_arc(void **context)
{
    struct stage *s = *context;
    s->a.entities.row[0].heading = TWO_PI - 0.1;
    s->b.entities.row[0].heading = 0.1;
    assert_true(turn(at(s, 0.5).entities->row[0].heading, 0.0) < 1e-9);
    assert_true(turn(at(s, 0.25).entities->row[0].heading, -0.05) < 1e-9);
}

/* All other columns of the table are the earlier frame's. */
static void test_nothing_else_changes_early(void **context)
{
    struct stage *s = *context;
    s->b.entities.row[0].damage = 3;
    s->b.entities.row[1].rounds = 7;
    s->b.entities.row[2].fuel_l = 9.0;
    struct frame_view frame_view = at(s, 0.9);
    assert_ptr_equal(frame_view.head, s->a.frame_view.head);
    const uint64_t pose = FIELD_BIT(x) | FIELD_BIT(y) | FIELD_BIT(z) | FIELD_BIT(heading) |
                          FIELD_BIT(pitch) | FIELD_BIT(roll);
    for (uint32_t i = 0; i < CAPACITY; i++)
        assert_int_equal(
            entity_differing(&frame_view.entities->row[i], &s->a.entities.row[i]) & ~pose, 0);
}

static void check_stays(struct stage *s, uint32_t slot)
{
    struct frame_view frame_view = at(s, 0.7);
    struct vec3 before = entities_position(&s->a.entities, slot);
    struct vec3 between = entities_position(frame_view.entities, slot);
    assert_memory_equal(&before, &between, sizeof before);
    assert_int_equal(frame_view.entities->row[slot].state, s->a.entities.row[slot].state);
    assert_int_equal(frame_view.entities->row[slot].id, s->a.entities.row[slot].id);
}

static void test_rows_that_change_are_not_interpolated(void **context)
{
    struct stage *s = *context;
    s->a.entities.row[0].state = ENTITY_FREE; /* appears */
    s->b.entities.row[1].state = ENTITY_FREE; /* is gone */
    s->b.entities.row[2].id = 999;            /* another in its slot */
    s->b.entities.row[3].state = ENTITY_WRECK;
    s->b.entities.row[5].x += 30.0;
    s->b.entities.row[6].y -= 30.0;
    static const uint32_t slots[] = {0, 1, 2, 3, 5, 6};
    for (size_t i = 0; i < sizeof slots / sizeof slots[0]; i++)
        check_stays(s, slots[i]);
    struct vec3 still = entities_position(&s->a.entities, 7);
    struct vec3 moved = entities_position(at(s, 0.7).entities, 7);
    assert_true(vec3_length(vec3_sub(still, moved)) > 0.0); /* the others do move */
}

static void test_frames_far_apart_give_the_later(void **context)
{
    struct stage *s = *context;
    static const uint64_t ticks[] = {100, 99, 0, 100 + (uint64_t)FRAME_INTERPOLATION_STEPS_MAX + 1};
    for (size_t i = 0; i < sizeof ticks / sizeof ticks[0]; i++) {
        s->b.head.tick = ticks[i];
        struct frame_view frame_view = at(s, 0.5);
        assert_memory_equal(&frame_view, &s->b.frame_view, sizeof frame_view);
    }
}

/* --- the clock -------------------------------------------------------------------------------- */

/* A world of 60 frames a second, seen up to a frame late, and pictures at some rate. */
static void test_time_advances_evenly(void **context)
{
    (void)context;
    static const double rates[] = {24.0, 30.0, 59.94, 60.0, 75.0, 120.0};
    seed = fixture_seed(5);
    for (size_t r = 0; r < sizeof rates / sizeof rates[0]; r++) {
        struct frame_interpolation_clock clock = {.set = false};
        double before = 0.0, start = draw(1e3, 1e6);
        for (int i = 0; i < 2000; i++) {
            double now = start + i / rates[r];
            double newest = floor(i / rates[r] * 60.0 + 0.37) * DT_S;
            double shown = frame_interpolation_time(&clock, now, newest, DT_S, 1.0);
            assert_true(shown <= newest);
            assert_true(newest - shown < 2.1 * DT_S);
            if (i > 400 && fabs(shown - before - 1.0 / rates[r]) > 0.05 * DT_S)
                fail_msg("%.0f a second: picture %d is %.3f ms after the one before", rates[r], i,
                         1e3 * (shown - before));
            before = shown;
        }
    }
}

static void test_the_clock_does_not_pass_a_late_world(void **context)
{
    struct frame_interpolation_clock clock = {.set = false};
    double newest = 10.0, before = 0.0;
    (void)context;
    for (int i = 0; i < 600; i++) { /* at half the rate, then paused */
        if (i < 200 || i > 300)
            newest += 0.5 * DT_S;
        double shown = frame_interpolation_time(&clock, 50.0 + i * DT_S, newest, DT_S, 1.0);
        assert_true(shown <= newest && newest - shown < 3.0 * DT_S);
        assert_true(shown >= before);
        before = shown;
    }
}

/* After a long delay the clock begins anew, one step behind a frame that may be shown already. */
static void test_time_does_not_go_back_after_a_delay(void **context)
{
    struct frame_interpolation_clock clock = {.set = false};
    (void)context;
    frame_interpolation_time(&clock, 50.0, 10.0, DT_S, 1.0);
    assert_true(frame_interpolation_time(&clock, 50.0 + 2.0 * DT_S, 10.0, DT_S, 1.0) == 10.0);
    assert_true(frame_interpolation_time(&clock, 51.0, 10.0, DT_S, 1.0) == 10.0);
    assert_true(frame_interpolation_time(&clock, 51.0 + DT_S, 3.0, DT_S, 1.0) <= 3.0); /* rewound */
}

static void test_a_paused_world_shows_its_frame(void **context)
{
    struct frame_interpolation_clock clock = {.set = false};
    (void)context;
    frame_interpolation_time(&clock, 1.0, 5.0, DT_S, 1.0);
    assert_true(frame_interpolation_time(&clock, 1.1, 5.1, DT_S, 0.0) == 5.1);
    assert_false(clock.set);
    /* Continues at another rate without a jump. */
    double shown = frame_interpolation_time(&clock, 9.0, 5.2, DT_S, 0.25);
    assert_true(shown <= 5.2 && shown >= 5.2 - DT_S - 1e-9);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, close_stage)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_ends_are_the_frames_themselves),
        TEST(test_bodies_move_evenly_when_the_end_of_the_table_falls_back),
        TEST(test_bodies_move_evenly_and_turn_by_the_shorter_arc),
        TEST(test_turning_past_north_takes_the_shorter_arc),
        TEST(test_nothing_else_changes_early),
        TEST(test_rows_that_change_are_not_interpolated),
        TEST(test_frames_far_apart_give_the_later),
        cmocka_unit_test(test_time_advances_evenly),
        cmocka_unit_test(test_the_clock_does_not_pass_a_late_world),
        cmocka_unit_test(test_time_does_not_go_back_after_a_delay),
        cmocka_unit_test(test_a_paused_world_shows_its_frame),
    };
    return cmocka_run_group_tests_name("blend", tests, NULL, NULL);
}
