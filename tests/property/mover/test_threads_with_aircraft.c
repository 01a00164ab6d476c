/* The digest of every frame is the same on 1, 2 and 4 threads for aircraft, ships and missiles, all
 * of which fight. SEED=n runs another battle, FRAMES=n a shorter one. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define FRAMES_MAX 160
#define EACH       900u /* of every kind, of both sides: more rows than a thread takes in one piece */
#define HZ         20

static const char *const kinds[] = {"jet", "helicopter", "ship", "missile-carrier", "wishbone"};
#define KINDS (sizeof kinds / sizeof kinds[0])

/* What a run must have seen, or its digests would prove little. */
struct seen {
    uint32_t missiles, hits;
};

static uint32_t frame_count(void)
{
    const char *text = getenv("FRAMES");
    uint32_t frames = text ? (uint32_t)strtoul(text, NULL, 10) : FRAMES_MAX;
    return frames < FRAMES_MAX ? frames : FRAMES_MAX;
}

/* Ships in the west, which is water; the others in the east. All are within reach of each other. */
static void put_one(struct fixture *f, uint64_t *random, const char *name, enum force force)
{
    const struct kind *kind = steps_kind(f, name);
    double west = kind->domain == DOMAIN_SEA ? 22500.0 : 25100.0;
    double heading = fixture_uniform(random, 0.0, TWO_PI), speed = 0.6 * kind->max_speed_mps;
    uint32_t row =
        fixture_put(f, (struct fixture_entity){.kind = name,
                                               .at = {fixture_uniform(random, west, west + 2400.0),
                                                      FIXTURE_GROUND_M + kind->cruise_altitude_m,
                                                      fixture_uniform(random, 22500.0, 27500.0)},
                                               .velocity = {speed * maths_sin(heading), 0.0,
                                                            -speed * maths_cos(heading)},
                                               .heading_rad = heading,
                                               .force = force});
    struct entities e = steps_rows(f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
    e.row[row].flags = ENTITY_FLAG_FIRE_AT_WILL;
}

static void open_battle(struct fixture *f, uint64_t seed)
{
    char text[96];
    (void)snprintf(text, sizeof text, "world = { seed = %u; hz = 20.0; capacity = 8192; };",
                   (unsigned)(seed & 0xffffffff));
    fixture_open(f, text);
    steps_cover(f, COVER_LAKE, 22000.0, 22000.0, 25000.0, 28000.0);
    uint64_t random = seed;
    for (uint32_t n = 0; n < EACH * KINDS; n++)
        put_one(f, &random, kinds[n % KINDS], n / KINDS % 2 ? FORCE_RED : FORCE_BLUE);
}

static void count(const struct fixture *f, struct seen *seen)
{
    for (uint32_t n = 0; n < fixture_event_count(f, EVENT_FIRE); n++) {
        const struct event *event = fixture_event(f, EVENT_FIRE, n);
        seen->missiles +=
            f->view.world.kinds[event->fire.munition.kind].guidance == GUIDANCE_HOMING;
    }
    for (uint32_t n = 0; n < fixture_event_count(f, EVENT_DETONATION); n++)
        seen->hits += fixture_event(f, EVENT_DETONATION, n)->detonation.struck == STRUCK_VEHICLE;
}

static void run(uint64_t seed, uint32_t threads, uint32_t frames, uint64_t *digest)
{
    struct fixture f;
    struct seen seen = {0, 0};
    open_battle(&f, seed);
    fixture_threads(&f, threads);
    for (uint32_t i = 0; i < frames; i++) {
        (threads == 1 ? fixture_run : fixture_continue)(&f, 1);
        digest[i] = fixture_digest(&f);
    }
    count(&f, &seen);
    print_message("%u threads: %u missiles, %u hits\n", threads, seen.missiles, seen.hits);
    if (frames == FRAMES_MAX)
        assert_true(seen.missiles > 50 && seen.hits > 20);
    fixture_close(&f);
}

static void test_digests_do_not_depend_on_threads(void **state)
{
    static const uint32_t threads[3] = {1, 2, 4};
    static uint64_t digest[3][FRAMES_MAX];
    uint64_t seed = fixture_seed(14);
    uint32_t frames = frame_count();
    (void)state;
    for (int i = 0; i < 3; i++) {
        run(seed, threads[i], frames, digest[i]);
        for (uint32_t frame = 0; frame < frames; frame++) {
            if (digest[i][frame] != digest[0][frame])
                fail_msg("frame %u differs on %u threads: %016llx, and %016llx on one", frame + 1,
                         threads[i], (unsigned long long)digest[i][frame],
                         (unsigned long long)digest[0][frame]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_digests_do_not_depend_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
