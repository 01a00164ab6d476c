/* What a receiver makes of batches of motions. */
#include "ipc/topics/motion_mirror.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define RUN 7u

static struct motion_mirror mirror;

static int close_mirror(void **state)
{
    (void)state;
    motion_mirror_close(&mirror);
    return 0;
}

static void assert_near(double value, double expected, double most)
{
    assert_true(fabs(value - expected) <= most);
}

struct one {
    uint32_t row, id;
    double x_m;
    float vx_mps;
};

static jolon_Entity sent_entity[4];
static uint32_t sent_row[4];
static jolon_Course sent_course[4];

/* Makes a batch of one part of these entities, which have no courses; id 0: the row gets empty. */
static jolon_MotionBatch batch_of(bool whole, double time_s, uint32_t count, const struct one *ones)
{
    jolon_MotionBatch batch = {.parts = 1,
                               .run = RUN,
                               .frame = (uint64_t)(time_s * 60.0),
                               .sim_time_s = time_s,
                               .whole = whole};
    for (uint32_t i = 0; i < count; i++) {
        sent_row[i] = ones[i].row;
        sent_entity[i] =
            (jolon_Entity){.id = ones[i].id,
                           .state = ones[i].id ? jolon_ENTITY_ACTIVE : jolon_ENTITY_FREE,
                           .x_m = ones[i].x_m,
                           .vx_mps = ones[i].vx_mps};
    }
    batch.rows._buffer = sent_row;
    batch.entities._buffer = sent_entity;
    batch.courses._buffer = sent_course;
    batch.rows._length = batch.entities._length = count;
    return batch;
}

static bool take(bool whole, double time_s, uint32_t count, const struct one *ones)
{
    jolon_MotionBatch batch = batch_of(whole, time_s, count, ones);
    return motion_mirror_take(&mirror, &batch);
}

static const struct one three[] = {{0, 1, 10.0, 0.0F}, {2, 5, 20.0, 4.0F}, {3, 6, 30.0, 0.0F}};

static void test_nothing_is_known_before_a_whole_batch(void **state)
{
    (void)state;
    assert_false(take(false, 1.0, 3, three));
    assert_true(take(true, 2.0, 3, three));
    assert_int_equal(mirror.count, 3);
}

static void test_what_is_not_told_goes_on(void **state)
{
    const struct one other = {3, 6, 31.0, 0.0F};
    jolon_Entity seen[3];
    (void)state;
    assert_true(take(true, 2.0, 3, three));
    assert_true(take(false, 2.5, 1, &other));
    assert_int_equal(mirror.count, 3);
    motion_mirror_entities(&mirror, seen);
    assert_near(seen[0].x_m, 10.0, 0.0);
    assert_near(seen[1].x_m, 22.0, 1e-9);
    assert_near(seen[2].x_m, 31.0, 0.0);
    assert_true(take(false, 3.0, 0, NULL)); /* nothing new, half a second later */
    motion_mirror_entities(&mirror, seen);
    assert_near(seen[1].x_m, 24.0, 1e-9);
}

static void test_courses_belong_to_their_entities(void **state)
{
    jolon_Entity seen[3];
    jolon_MotionBatch batch = batch_of(true, 2.0, 3, three);
    (void)state;
    sent_course[0] = (jolon_Course){.entity = 1, .lasts_s = 1.0F, .climb_mps2 = 2.0F};
    batch.courses._length = 1;
    assert_true(motion_mirror_take(&mirror, &batch));
    assert_true(take(false, 3.0, 0, NULL));
    motion_mirror_entities(&mirror, seen);
    assert_near(seen[0].y_m, 0.0, 0.0);
    assert_near(seen[1].y_m, 1.0, 1e-9);
    assert_near((double)seen[1].vy_mps, 2.0, 1e-6);
    assert_true(take(false, 3.0, 1, &three[1])); /* told again, without a course */
    assert_true(take(false, 4.0, 0, NULL));
    motion_mirror_entities(&mirror, seen);
    assert_near(seen[1].y_m, 0.0, 0.0);
}

static void test_entities_leave_and_rows_get_others(void **state)
{
    const struct one changes[] = {{0, 0, 0.0, 0.0F}, {2, 9, 70.0, 0.0F}};
    jolon_Entity seen[3];
    (void)state;
    assert_true(take(true, 2.0, 3, three));
    assert_true(take(false, 2.1, 2, changes));
    assert_int_equal(mirror.count, 2);
    motion_mirror_entities(&mirror, seen);
    assert_int_equal(seen[0].id, 9);
    assert_int_equal(seen[1].id, 6);
    assert_true(take(false, 2.2, 1, changes)); /* told once more that it is empty */
    assert_int_equal(mirror.count, 2);
}

/* A reader that missed that an entity left learns it from the next whole batch. */
static void test_a_whole_batch_drops_what_it_does_not_hold(void **state)
{
    jolon_Entity seen[3];
    (void)state;
    assert_true(take(true, 2.0, 3, three));
    assert_true(take(true, 3.0, 1, &three[2]));
    assert_int_equal(mirror.count, 1);
    motion_mirror_entities(&mirror, seen);
    assert_int_equal(seen[0].id, 6);
}

static void test_a_whole_batch_without_a_part_drops_nothing(void **state)
{
    jolon_MotionBatch batch;
    (void)state;
    assert_true(take(true, 2.0, 3, three));
    batch = batch_of(true, 3.0, 1, &three[0]);
    batch.parts = 3;
    assert_false(motion_mirror_take(&mirror, &batch));
    batch.part = 2; /* part 1 is lost */
    assert_true(motion_mirror_take(&mirror, &batch));
    assert_int_equal(mirror.count, 3);
}

/* A false writer's numbers stay within what readers expect. */
static void test_what_leads_nowhere_stays(void **state)
{
    const struct one fast = {0, 1, 1e15, 1e15F};
    jolon_Entity seen[1];
    (void)state;
    assert_true(take(true, 2.0, 1, &fast));
    assert_true(take(false, 2e14, 0, NULL));
    motion_mirror_entities(&mirror, seen);
    assert_near(seen[0].x_m, 1e15, 0.0);
}

static bool take_from(struct motion_mirrors *mirrors, uint64_t writer, bool whole, uint32_t count,
                      const struct one *ones)
{
    jolon_MotionBatch batch = batch_of(whole, 2.0, count, ones);
    return motion_mirror_take(motion_mirrors_for(mirrors, writer), &batch);
}

/* Who tells what is false leaves nothing behind, and no true writer is forgotten for it. */
static void test_writers_are_kept_apart(void **state)
{
    static struct motion_mirrors mirrors;
    const struct one false_one = {2, 99, 0.0, 0.0F};
    jolon_Entity seen[3];
    (void)state;
    assert_true(take_from(&mirrors, 7, true, 3, three));
    assert_true(take_from(&mirrors, 8, true, 1, &false_one));
    for (uint64_t writer = 9; writer < 40; writer++) {
        assert_true(take_from(&mirrors, writer, true, 1, &false_one));
        assert_true(take_from(&mirrors, 7, false, 1, &three[0]));
    }
    assert_int_equal(motion_mirrors_for(&mirrors, 7)->count, 3);
    motion_mirror_entities(motion_mirrors_for(&mirrors, 7), seen);
    assert_int_equal(seen[1].id, 5);
    assert_false(take_from(&mirrors, 8, false, 1, &false_one)); /* forgotten by now */
    motion_mirrors_close(&mirrors);
}

static void test_another_run_begins_anew(void **state)
{
    jolon_MotionBatch batch;
    (void)state;
    assert_true(take(true, 2.0, 3, three));
    batch = batch_of(false, 0.1, 1, &three[0]);
    batch.run = RUN + 1;
    assert_false(motion_mirror_take(&mirror, &batch));
    batch.whole = true;
    assert_true(motion_mirror_take(&mirror, &batch));
    assert_int_equal(mirror.count, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_nothing_is_known_before_a_whole_batch, close_mirror),
        cmocka_unit_test_teardown(test_what_is_not_told_goes_on, close_mirror),
        cmocka_unit_test_teardown(test_courses_belong_to_their_entities, close_mirror),
        cmocka_unit_test_teardown(test_entities_leave_and_rows_get_others, close_mirror),
        cmocka_unit_test_teardown(test_a_whole_batch_drops_what_it_does_not_hold, close_mirror),
        cmocka_unit_test_teardown(test_a_whole_batch_without_a_part_drops_nothing, close_mirror),
        cmocka_unit_test_teardown(test_what_leads_nowhere_stays, close_mirror),
        cmocka_unit_test(test_writers_are_kept_apart),
        cmocka_unit_test_teardown(test_another_run_begins_anew, close_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
