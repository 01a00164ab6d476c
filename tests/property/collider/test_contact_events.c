/* Contacts are told in few events, and in as many at every frame rate: pairs of vehicles meet on
 * level ground, or a vehicle meets a house, at 5 to 240 Hz (thesis rows 34, 39). SEED=n runs other
 * pairs. */
#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define PAIRS   100u
#define SECONDS 8.0

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* Bodies that do not touch at the end of one frame have parted if the frame is longer than 0.1 s,
 * so that a few more impacts are events. */
#define RENEWS_HZ 10.0
#define RENEWED   0.1

static const double rates_hz[] = {5.0, 30.0, 60.0, 240.0};
static const double other_rates_hz[] = {5.0, 30.0, 240.0};

static struct fixture f;

/* --- what is told ------------------------------------------------------------------------------*/

/* Events and contacts of one run. */
struct told {
    uint32_t begins, others; /* collisions */
    uint32_t ends;
    uint32_t impacts; /* by the ends */
};

static void count_event(struct told *told, const struct event *event)
{
    if (event->type == EVENT_COLLISION) {
        told->begins += event->collision.begins;
        told->others += !event->collision.begins;
    } else if (event->type == EVENT_CONTACT_END) {
        told->ends++;
        told->impacts += event->contact_end.impacts;
    }
}

/* Runs the world and counts. In each frame there are as many contacts as have begun and not
 * ended. */
static struct told run(double seconds)
{
    struct told told = {0};
    uint64_t next = 0, slots = f.view.header->event_slots;
    uint32_t frames = (uint32_t)(seconds * f.view.world.params->hz);
    for (uint32_t frame = 0; frame < frames; frame++) {
        fixture_continue(&f, 1);
        struct state now = fixture_state(&f);
        for (; next < now.head->event_end; next++)
            count_event(&told, &f.view.events[next & (slots - 1)]);
        assert_int_equal(told.begins, told.ends + now.head->contact_count);
        assert_int_equal(now.head->tally.collisions, told.begins + told.others);
    }
    return told;
}

static void print(const char *method, const char *response, const char *shape, double hz,
                  const struct told *told)
{
    print_message("%-7s %-7s %-6s %3g Hz: %u begins, %u others, %u ends\n", method, response, shape,
                  hz, told->begins, told->others, told->ends);
}

/* Asserts that a value is within this share of the first, or of the pairs. */
static void assert_near(uint32_t value, uint32_t first, double share)
{
    double off = fabs((double)value - (double)first);
    assert_true(off <= share * maths_max(first, PAIRS));
}

/* --- pairs of vehicles -------------------------------------------------------------------------*/

/* Puts a vehicle that would be about at x, z after meet_s. */
static void put_vehicle(uint64_t *random, double x, double z, double heading, double meet_s)
{
    static const char *const kinds[] = {"tank", "jeep", "truck"};
    double sine, cosine, speed = fixture_uniform(random, 3.0, 20.0);
    double off = fixture_uniform(random, -1.0, 1.0), back = speed * meet_s;
    maths_sincos(heading, &sine, &cosine);
    fixture_put(&f, (struct fixture_entity){.kind = kinds[fixture_random(random) % COUNT(kinds)],
                                            .at = {x - back * sine + off * cosine, FIXTURE_GROUND_M,
                                                   z + back * cosine + off * sine},
                                            .velocity = {speed * sine, 0.0, -speed * cosine}});
}

static void open_world(const char *method, const char *response, const char *shape, double hz,
                       const char *more)
{
    char text[512];
    snprintf(text, sizeof text,
             "world = { seed = 1; hz = %g; capacity = 1024; };\n"
             "collision = { method = \"%s\"; shape = \"%s\"; response = \"%s\"; };\n%s",
             hz, method, shape, response, more);
    fixture_open(&f, text);
}

static void put_pairs(uint64_t random)
{
    for (uint32_t i = 0; i < PAIRS; i++) {
        double x = 10000.0 + 1000.0 * (i % 10), z = 10000.0 + 1000.0 * (i / 10);
        double heading = fixture_uniform(&random, 0.0, TWO_PI);
        double meet_s = fixture_uniform(&random, 1.0, 2.0);
        put_vehicle(&random, x, z, heading, meet_s);
        put_vehicle(&random, x, z, heading + fixture_uniform(&random, 0.5, TWO_PI - 0.5), meet_s);
    }
}

static struct told run_pairs(const char *method, const char *response, const char *shape, double hz,
                             uint64_t random)
{
    open_world(method, response, shape, hz, "");
    put_pairs(random);
    struct told told = run(SECONDS);
    print(method, response, shape, hz, &told);
    fixture_close(&f);
    return told;
}

/* Vehicles that pass through each other: one beginning and one end a passage. */
static void test_a_passage_has_one_beginning_and_one_end(void **state)
{
    static const char *const shapes[] = {"model", "sphere"};
    uint64_t seed = fixture_seed(43);
    (void)state;
    for (size_t s = 0; s < COUNT(shapes); s++) {
        for (size_t h = 0; h < COUNT(rates_hz); h++) {
            struct told told = run_pairs("swept", "none", shapes[s], rates_hz[h], seed);
            assert_true(told.begins >= PAIRS * 9 / 10 && told.begins <= PAIRS);
            assert_int_equal(told.ends, told.begins);
            assert_int_equal(told.others, 0);
            assert_int_equal(told.impacts, told.begins);
        }
    }
}

/* Vehicles that collide bounce and meet again, and small differences grow: the numbers of such
 * second contacts differ a little. */
static void test_the_rate_does_not_change_how_much_is_told(void **state)
{
    static const struct {
        const char *method, *response, *shape;
        double share; /* by which the numbers may differ */
    } rows[] = {{"swept", "mps", "model", 0.02},     {"swept", "mps", "sphere", 0.02},
                {"swept", "figure8", "model", 0.03}, {"swept", "figure8", "sphere", 0.03},
                {"swept", "impulse", "model", 0.12}, {"swept", "impulse", "sphere", 0.12},
                {"swept", "spring", "model", 0.15},  {"swept", "spring", "sphere", 0.12},
                {"npsnet2", "none", "sphere", 0.03}, {"npsnet2", "figure8", "sphere", 0.03},
                {"npsnet2", "mps", "sphere", 0.03},  {"mps", "mps", "sphere", 0.02}};
    uint64_t seed = fixture_seed(43);
    (void)state;
    for (size_t r = 0; r < COUNT(rows); r++) {
        const char *method = rows[r].method, *response = rows[r].response, *shape = rows[r].shape;
        struct told first = run_pairs(method, response, shape, 60.0, seed);
        for (size_t h = 0; h < COUNT(other_rates_hz); h++) {
            struct told told = run_pairs(method, response, shape, other_rates_hz[h], seed);
            assert_near(told.begins, first.begins, rows[r].share);
            assert_near(told.ends, first.ends, rows[r].share);
            assert_near(told.begins + told.others, first.begins + first.others,
                        rows[r].share + (other_rates_hz[h] < RENEWS_HZ ? RENEWED : 0.0));
        }
    }
}

/* --- a house -----------------------------------------------------------------------------------*/

/* A slow vehicle drives through a house. Hulls of one enter hulls of the other one after the
 * other. */
static void test_a_passage_through_an_object_is_one_contact(void **state)
{
    static const char *const responses[] = {"none", "mps"};
    (void)state;
    for (size_t r = 0; r < COUNT(responses); r++) {
        for (size_t h = 0; h < COUNT(rates_hz); h++) {
            open_world("swept", responses[r], "model", rates_hz[h],
                       "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 125.0; };\n"
                       "objects = ( { kind = \"building\"; at = [25000.0, 25000.0]; } );\n");
            fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                    .at = {25002.0, FIXTURE_GROUND_M, 25020.0},
                                                    .velocity = {0.0, 0.0, -3.0}});
            struct told told = run(25.0);
            print("swept", responses[r], "house", rates_hz[h], &told);
            assert_int_equal(told.begins, 1);
            assert_int_equal(told.others, 0);
            assert_int_equal(told.ends, 1);
            fixture_close(&f);
        }
    }
}

/* --- a full table ------------------------------------------------------------------------------*/

/* Tanks in a ring drive inwards, in a world with room for four contacts. */
static uint64_t run_full(uint32_t threads, struct told *told)
{
    open_world("swept", "impulse", "model", 60.0, "");
    steps_params(&f)->contact_slots = 4;
    fixture_threads(&f, threads);
    for (uint32_t i = 0; i < 18; i++) {
        double sine, cosine, radius = i < 6 ? 9.0 : 18.0;
        maths_sincos(TWO_PI * i / (i < 6 ? 6.0 : 12.0), &sine, &cosine);
        fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                .at = {25000.0 + radius * sine, FIXTURE_GROUND_M,
                                                       25000.0 - radius * cosine},
                                                .velocity = {-8.0 * sine, 0.0, 8.0 * cosine}});
    }
    *told = run(3.0);
    struct state now = fixture_state(&f);
    assert_int_equal(now.head->contact_count, 4);
    print_message("%u begins, %u others, %u ends, %llu without room\n", told->begins, told->others,
                  told->ends, (unsigned long long)now.head->tally.contacts_refused);
    assert_true(now.head->tally.contacts_refused > 100);
    assert_true(told->begins + told->others < 60);
    uint64_t digest = fixture_digest(&f);
    fixture_close(&f);
    return digest;
}

/* What has no room is counted and hardly told, and is the same on any number of threads. */
static void test_a_full_table_tells_little(void **state)
{
    struct told one, four;
    (void)state;
    assert_int_equal(run_full(1, &one), run_full(4, &four));
    assert_memory_equal(&one, &four, sizeof one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_passage_has_one_beginning_and_one_end),
        cmocka_unit_test(test_the_rate_does_not_change_how_much_is_told),
        cmocka_unit_test(test_a_passage_through_an_object_is_one_contact),
        cmocka_unit_test(test_a_full_table_tells_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
