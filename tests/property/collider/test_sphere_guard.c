/* Bodies that collide as spheres end no frame deeper in each other than they began it: vehicles
 * that drive into a heap, and aircraft among them. SEED=n draws others. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define BODIES   40u
#define FRAMES   300u
#define DEEPER_M 2e-5 /* less is rounding */
#define PARTS_M  0.02 /* pairs that are deeper have to part first */

static const char *const kinds[] = {"tank", "truck", "jeep", "carrier"};

static struct fixture f;

static double gap_of(const struct entities *e, uint32_t a, uint32_t b)
{
    struct vec3 off = vec3_sub(entities_position(e, b), entities_position(e, a));
    const struct kind *known = f.view.world.kinds;
    return vec3_length(off) - known[e->row[a].kind].radius_m - known[e->row[b].kind].radius_m;
}

static void put_ring(uint64_t *random)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        double angle = TWO_PI * (i + fixture_uniform(random, 0.0, 0.2)) / BODIES, sine, cosine;
        double far = fixture_uniform(random, 40.0, 60.0);
        maths_sincos(angle, &sine, &cosine);
        double x = 25000.0 + far * sine, z = 25000.0 - far * cosine;
        fixture_put(&f, (struct fixture_entity){.kind = kinds[i % 4],
                                                .behaviour = BEHAVIOUR_HOLD,
                                                .at = {x, steps_ground_at(&f, x, z), z},
                                                .heading_rad = maths_wrap_turn(angle + PI)});
    }
}

/* All go inwards, whatever has stopped them. */
static void press(uint64_t *random)
{
    struct entities e = steps_rows(&f);
    for (uint32_t i = 0; i < BODIES; i++) {
        double x = 25000.0 - e.row[i].x, z = 25000.0 - e.row[i].z, far = sqrt(x * x + z * z);
        double speed = fixture_uniform(random, 4.0, 12.0);
        e.row[i].vx = speed * x / far;
        e.row[i].vz = speed * z / far;
    }
}

static void run(const char *hz, uint64_t *random)
{
    static double before[BODIES][BODIES];
    char text[160];
    double worst = 0.0;
    uint32_t touching = 0;
    snprintf(text, sizeof text, "world = { hz = %s; }; collision = { shape = \"sphere\"; };", hz);
    fixture_open(&f, text);
    put_ring(random);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        if (frame % 30 == 0)
            press(random);
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (uint32_t a = 0; a < BODIES; a++) {
            for (uint32_t b = a + 1; b < BODIES; b++) {
                double gap = gap_of(&e, a, b), began = maths_min(before[a][b], 0.0);
                touching += gap < 0.01;
                before[a][b] = gap;
                if (frame > 0 && began > -PARTS_M)
                    worst = maths_max(worst, began - gap);
            }
        }
    }
    print_message("%s Hz: %u pairs touch in all frames, worst growth %.3f mm\n", hz, touching,
                  1e3 * worst);
    assert_true(touching > FRAMES);
    assert_true(worst <= DEEPER_M);
    fixture_close(&f);
}

static void test_nobody_gets_deeper(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    run("60.0", &random);
    run("10.0", &random);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_nobody_gets_deeper)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
