/* Output queues: the order of pictures, dropping, waiting, and that no reference is lost. */
#include "renderer/output/output_queue.h"

#include "tests/support/fixture.h"
#include "world/maths/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define TAKEN_MAX 4096u

/* A worker that continues only when the test lets it. */
struct taker {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool held, inside;
    uint32_t fail_at; /* the picture that fails, 0: none */
    uint32_t count;
    char view[TAKEN_MAX];
    uint64_t frame[TAKEN_MAX];
};

static struct taker taker;
static struct picture_pool pool;
static struct output_queue queue;
static struct error_text error;

static int take(void *self, const struct picture *picture, struct error_text *detail)
{
    struct taker *t = self;
    pthread_mutex_lock(&t->lock);
    t->inside = true;
    pthread_cond_broadcast(&t->changed);
    while (t->held)
        pthread_cond_wait(&t->changed, &t->lock);
    t->inside = false;
    t->view[t->count] = picture->view[0];
    t->frame[t->count++] = picture->frame;
    bool fails = t->count == t->fail_at;
    pthread_mutex_unlock(&t->lock);
    return fails ? error_text_set(detail, "no room") : 0;
}

static void hold(bool held)
{
    pthread_mutex_lock(&taker.lock);
    taker.held = held;
    pthread_cond_broadcast(&taker.changed);
    pthread_mutex_unlock(&taker.lock);
}

static void wait_inside(void)
{
    pthread_mutex_lock(&taker.lock);
    while (!taker.inside)
        pthread_cond_wait(&taker.changed, &taker.lock);
    pthread_mutex_unlock(&taker.lock);
}

static void start(uint32_t depth, bool lossless)
{
    taker = (struct taker){.lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};
    picture_pool_init(&pool);
    assert_int_equal(output_queue_start(&queue, &(struct output_queue_work){.self = &taker,
                                                                            .take = take,
                                                                            .depth = depth,
                                                                            .lossless = lossless}),
                     0);
}

/* Every picture must have been released. */
static int end(void)
{
    int result = output_queue_end(&queue, &error);
    picture_pool_free(&pool);
    return result;
}

static void put(const char *view, uint64_t frame)
{
    struct image image;
    assert_int_equal(image_init(&image, 4, 4), 0);
    image.pixels[0] = (uint8_t)frame;
    struct picture *picture = picture_make(&pool, &image, view, "");
    assert_non_null(picture);
    assert_int_equal(picture->image.pixels[0], (uint8_t)frame);
    picture->frame = frame;
    output_queue_put(&queue, picture);
    picture_release(picture);
    image_free(&image);
}

static void check_taken(const char *expected)
{
    char text[256] = "";
    for (uint32_t i = 0; i < taker.count; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%c%d ", taker.view[i],
                 (int)taker.frame[i]);
    assert_string_equal(text, expected);
}

static void test_a_slow_outlet_keeps_the_first_and_the_newest_of_each_view(void **state)
{
    (void)state;
    start(2, false);
    hold(true);
    put("chase", 1);
    wait_inside();
    put("map", 1);
    for (uint64_t frame = 2; frame <= 9; frame++) {
        put("chase", frame);
        put("map", frame);
    }
    hold(false);
    assert_int_equal(end(), 0);
    check_taken("c1 m1 c2 m9 c9 ");
    assert_int_equal(queue.taken, 5);
    assert_int_equal(queue.dropped, 13);
}

static void test_a_patient_one_takes_every_picture(void **state)
{
    (void)state;
    start(3, true);
    for (uint64_t frame = 1; frame <= 1000; frame++)
        put("chase", frame);
    assert_int_equal(end(), 0);
    assert_int_equal(taker.count, 1000);
    for (uint32_t i = 0; i < 1000; i++)
        assert_int_equal(taker.frame[i], i + 1);
    assert_int_equal(queue.dropped, 0);
}

static void test_after_a_failure_nothing_more_is_taken(void **state)
{
    (void)state;
    start(1, true);
    taker.fail_at = 3;
    for (uint64_t frame = 1; frame <= 20; frame++)
        put("chase", frame);
    assert_true(output_queue_failed(&queue, &error));
    assert_int_equal(end(), -1);
    assert_string_equal(error.text, "no room");
    check_taken("c1 c2 c3 ");
    assert_int_equal(queue.taken, 2);
}

/* However it falls: each view's pictures come in order, the last of each at last, and every picture
 * is either taken or counted. */
static void test_order_and_counts_hold_at_any_pace(void **state)
{
    uint64_t seed = fixture_seed(5);
    (void)state;
    for (uint64_t turn = 0; turn < 20; turn++) {
        uint64_t last[2] = {0, 0}, seen[2] = {0, 0}, count = 0;
        start(1 + (uint32_t)turn % 3, false);
        for (uint64_t i = 1; i <= 200; i++, count++) {
            uint64_t draw = random_u64(seed, turn, i, RANDOM_NOISE);
            put(draw & 1 ? "map" : "chase", i);
            last[draw & 1] = i;
            if (draw % 17 == 0)
                hold(draw & 2);
        }
        hold(false);
        assert_int_equal(end(), 0);
        assert_int_equal(queue.taken + queue.dropped, count);
        for (uint32_t i = 0; i < taker.count; i++) {
            int view = taker.view[i] == 'm';
            assert_true(taker.frame[i] > seen[view]);
            seen[view] = taker.frame[i];
        }
        assert_int_equal(seen[0], last[0]);
        assert_int_equal(seen[1], last[1]);
    }
}

/* Memory is bounded: no more than PICTURE_POOL_MAX pictures can be made. */
static void test_a_pool_has_an_end(void **state)
{
    struct picture *made[PICTURE_POOL_MAX];
    struct image image;
    (void)state;
    assert_int_equal(image_init(&image, 4, 4), 0);
    picture_pool_init(&pool);
    for (uint32_t i = 0; i < PICTURE_POOL_MAX; i++)
        assert_non_null(made[i] = picture_make(&pool, &image, "chase", ""));
    assert_null(picture_make(&pool, &image, "chase", ""));
    assert_non_null(image.pixels);
    picture_release(made[0]);
    assert_non_null(made[0] = picture_make(&pool, &image, "chase", ""));
    for (uint32_t i = 0; i < PICTURE_POOL_MAX; i++)
        picture_release(made[i]);
    image_free(&image);
    assert_int_equal(image_init(&image, 8, 8), 0);
    assert_non_null(made[0] = picture_make(&pool, &image, "chase", ""));
    assert_int_equal(made[0]->image.width, 8);
    picture_release(made[0]);
    image_free(&image);
    picture_pool_free(&pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_slow_outlet_keeps_the_first_and_the_newest_of_each_view),
        cmocka_unit_test(test_a_patient_one_takes_every_picture),
        cmocka_unit_test(test_after_a_failure_nothing_more_is_taken),
        cmocka_unit_test(test_order_and_counts_hold_at_any_pace),
        cmocka_unit_test(test_a_pool_has_an_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
