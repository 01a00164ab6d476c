/* Random manoeuvres at 10 and at 60 Hz: the same vehicles turn over. Controls change every fifth of
 * a second, so that both get the same at the same times. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define MANOEUVRES 160
#define SECONDS    8
#define CHANGES    (5 * SECONDS)

/* A ramp that a vehicle may meet with one side, a washboard, a bank and a trench. */
#define WORKS                                                                                      \
    "earthworks = ("                                                                               \
    "{ shape = \"ramp\"; at = [25000.0, 24960.0]; length_m = 10.0; width_m = 3.0; height_m = "     \
    "1.2; },"                                                                                      \
    "{ shape = \"washboard\"; at = [25010.0, 24960.0]; length_m = 30.0; width_m = 8.0;"            \
    " height_m = 0.2; wave_m = 3.0; },"                                                            \
    "{ shape = \"table\"; at = [25022.0, 24960.0]; length_m = 40.0; width_m = 14.0; height_m = "   \
    "3.0;"                                                                                         \
    " edge_m = 4.0; },"                                                                            \
    "{ shape = \"trench\"; at = [24990.0, 24960.0]; length_m = 2.0; width_m = 12.0; depth_m = "    \
    "1.0;"                                                                                         \
    " edge_m = 0.2; } );"

static struct fixture fast, slow; /* 60 and 10 Hz */

struct manoeuvre {
    const char *kind;
    double x, mps, load; /* load: height of the centre of mass over that of the kind */
    enum cover cover;
    float throttle[CHANGES], steer[CHANGES], hand[CHANGES], brake[CHANGES];
};

static struct manoeuvre draw(uint64_t *random)
{
    static const char *const kinds[] = {"truck", "jeep", "hamburger", "carrier", "tank"};
    static const enum cover covers[] = {COVER_ROAD, COVER_ROAD, COVER_GRASS, COVER_ROCK};
    struct manoeuvre drawn = {.kind = kinds[fixture_random(random) % 5],
                              .x = 25000.0 + fixture_uniform(random, -16.0, 24.0),
                              .mps = fixture_uniform(random, 6.0, 22.0),
                              .load = fixture_uniform(random, 1.0, 1.6),
                              .cover = covers[fixture_random(random) % 4]};
    float throttle = 1.0f, steer = 0.0f, hand = 0.0f, brake = 0.0f;
    for (int n = 0; n < CHANGES; n++) {
        if (fixture_random(random) % 5 == 0) {
            steer = (float)fixture_uniform(random, -1.5, 1.5);
            steer = steer > 1.0f ? 1.0f : steer < -1.0f ? -1.0f : steer;
            throttle = fixture_random(random) % 3 ? 1.0f : 0.0f;
            hand = fixture_random(random) % 6 ? 0.0f : 1.0f;
            brake = fixture_random(random) % 8 ? 0.0f : 1.0f;
        }
        drawn.throttle[n] = throttle;
        drawn.steer[n] = steer;
        drawn.hand[n] = hand;
        drawn.brake[n] = brake;
    }
    return drawn;
}

struct ending {
    bool over;
    double x, z;
};

/* Drives it. hz: 10 or 60. */
static struct ending drive(struct fixture *f, uint32_t hz, const struct manoeuvre *drawn)
{
    steps_empty(f);
    steps_cover(f, drawn->cover, 20000.0, 20000.0, 30000.0, 30000.0);
    struct kind *kind = steps_kind(f, drawn->kind);
    double height = kind->centre_height_m, resistance = kind->resistance_j;
    kind->centre_height_m *= drawn->load;
    kind->resistance_j = 1e15; /* it turns over, or it lives */
    uint32_t row = fixture_put(
        f, (struct fixture_entity){.kind = drawn->kind,
                                   .at = {drawn->x, steps_ground_at(f, drawn->x, 25000.0), 25000.0},
                                   .velocity = {0.0, 0.0, -drawn->mps},
                                   .behaviour = BEHAVIOUR_DRIVEN});
    for (int n = 0; n < CHANGES && steps_rows(f).state[row] == ENTITY_ACTIVE; n++) {
        struct entities e = steps_rows(f);
        e.throttle[row] = drawn->throttle[n];
        e.steer[row] = drawn->steer[n];
        e.climb[row] = drawn->hand[n];
        e.brake[row] = drawn->brake[n];
        fixture_run(f, hz / 5);
    }
    kind->centre_height_m = height;
    kind->resistance_j = resistance;
    struct entities e = steps_rows(f);
    return (struct ending){e.state[row] == ENTITY_WRECK, e.x[row], e.z[row]};
}

static void test_10_and_60_hz_agree_on_what_turns_over(void **state)
{
    uint64_t random = fixture_seed(14);
    int over = 0, differ = 0, near = 0;
    (void)state;
    fixture_open(&fast, WORKS);
    fixture_open(&slow, "world = { hz = 10; };" WORKS);
    for (int n = 0; n < MANOEUVRES; n++) {
        struct manoeuvre drawn = draw(&random);
        struct ending a = drive(&fast, 60, &drawn), b = drive(&slow, 10, &drawn);
        over += a.over;
        near += fabs(a.x - b.x) + fabs(a.z - b.z) < 0.1;
        if (a.over != b.over)
            printf("%d: %s at %.1f m/s: %s at 60 Hz, %s at 10 Hz\n", n, drawn.kind, drawn.mps,
                   a.over ? "over" : "upright", b.over ? "over" : "upright");
        differ += a.over != b.over;
    }
    printf("%d of %d turn over; %d differ; %d end within 0.1 m\n", over, MANOEUVRES, differ, near);
    fixture_close(&fast);
    fixture_close(&slow);
    assert_int_equal(differ, 0);
    assert_true(over > MANOEUVRES / 10 && over < MANOEUVRES * 9 / 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_10_and_60_hz_agree_on_what_turns_over),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
