/* A crowd: vehicles of all sorts drive into one heap and press on each other (thesis rows 36, 39,
 * 46). The collider's step alone conserves momentum, adds no energy, loses no body, is the same on
 * any number of threads and ends in time. SEED=n runs another crowd. */
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#define VEHICLES 90
#define FRAMES   160
#define SLOW_S   5.0 /* of the processor, a frame: sanitizers are slow */
/* Momentum is summed over positions. The centre of mass of a wreck that leans by some 1e-7 rad
 * moves otherwise when its spin changes. */
#define MOMENTUM 1e-7

static const char *const kinds[] = {"tank", "jeep", "truck"};

static struct fixture f;

/* Rings of vehicles that all drive more or less inwards. */
static void open_crowd(const char *shape, uint32_t threads, uint64_t random)
{
    char text[256];
    snprintf(text, sizeof text,
             "world = { seed = 1; capacity = 1024; };\n"
             "collision = { shape = \"%s\"; response = \"impulse\"; };\n",
             shape);
    fixture_open(&f, text);
    fixture_threads(&f, threads);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        steps_kind(&f, kinds[i])->explosive_kg = 0.0;  /* explosions add momentum */
        steps_kind(&f, kinds[i])->resistance_j = 1e12; /* the ground slows wrecks */
    }
    for (uint32_t i = 0; i < VEHICLES; i++) {
        uint32_t ring = i / 20;
        double angle = TWO_PI * ((i % 20) + 0.5 * (ring % 2)) / 20.0, sine, cosine;
        double off = angle + PI + fixture_uniform(&random, -0.6, 0.6);
        double far = 40.0 + 8.0 * ring + fixture_uniform(&random, -2.0, 2.0);
        double speed = fixture_uniform(&random, 8.0, 20.0);
        maths_sincos(angle, &sine, &cosine);
        struct vec3 at = {25000.0 + far * sine, FIXTURE_GROUND_M, 25000.0 - far * cosine};
        maths_sincos(off, &sine, &cosine);
        fixture_put(&f, (struct fixture_entity){.kind = kinds[fixture_random(&random) % 3],
                                                .at = at,
                                                .velocity = {speed * sine, 0.0, -speed * cosine}});
    }
}

struct sums {
    double x, z, size; /* [N s] */
    double energy;     /* [J] */
};

/* Of rows with these velocities that turn so fast about the vertical. */
static struct sums sums_of(const struct entities *e, const double yaw[VEHICLES])
{
    struct sums sums = {0.0, 0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < VEHICLES; i++) {
        const struct kind *kind = &f.view.world.kinds[e->row[i].kind];
        double v2 = e->row[i].vx * e->row[i].vx + e->row[i].vz * e->row[i].vz;
        sums.x += kind->mass_kg * e->row[i].vx;
        sums.z += kind->mass_kg * e->row[i].vz;
        sums.size += kind->mass_kg * sqrt(v2);
        sums.energy +=
            0.5 * kind->mass_kg * v2 + 0.5 * mass_properties_of(kind).moment.y * yaw[i] * yaw[i];
    }
    return sums;
}

static void check_rows(const struct entities *e)
{
    for (uint32_t i = 0; i < VEHICLES; i++) {
        assert_true(isfinite(e->row[i].x) && isfinite(e->row[i].y) && isfinite(e->row[i].z));
        assert_true(isfinite(e->row[i].vx) && isfinite(e->row[i].vy) && isfinite(e->row[i].vz));
        assert_true(isfinite(e->row[i].heading) && isfinite(e->row[i].pitch) &&
                    isfinite(e->row[i].roll));
        assert_true(isfinite(e->row[i].spin_y) && isfinite(e->row[i].harm_j));
        assert_true(e->row[i].x >= 0.0 && e->row[i].x <= WORLD_SIDE_DEFAULT_M);
        assert_true(e->row[i].z >= 0.0 && e->row[i].z <= WORLD_SIDE_DEFAULT_M);
    }
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* One frame, and what the collider's step alone made of the moved table. */
static double step(void)
{
    double yaw[2][VEHICLES], began = now_s();
    fixture_run(&f, 1);
    double took = now_s() - began;
    struct state next = fixture_state(&f);
    const struct entities *m = &f.view.m.entities, *n = &next.entities;
    const struct entities *w = &f.view.w[(next.head->frame - 1) & 1].entities;
    for (uint32_t i = 0; i < VEHICLES; i++) {
        yaw[0][i] =
            -maths_wrap_half(m->row[i].heading - w->row[i].heading) * f.view.world.params->hz;
        yaw[1][i] = yaw[0][i] + n->row[i].spin_y - m->row[i].spin_y;
    }
    struct sums before = sums_of(m, yaw[0]), after = sums_of(n, yaw[1]);
    check_rows(n);
    assert_true(fabs(after.x - before.x) <= MOMENTUM * before.size);
    assert_true(fabs(after.z - before.z) <= MOMENTUM * before.size);
    assert_true(after.energy <= before.energy * (1.0 + 1e-9));
    return took;
}

static void run(const char *shape, uint32_t threads, uint64_t seed, uint64_t digest[FRAMES])
{
    double longest = 0.0, sum = 0.0;
    open_crowd(shape, threads, seed);
    for (int i = 0; i < FRAMES; i++) {
        double took = step();
        longest = maths_max(longest, took);
        sum += took;
        digest[i] = fixture_digest(&f);
    }
    struct state now = fixture_state(&f);
    print_message("%s, %u threads: %.2f ms a frame, %.1f ms at most, %u collisions\n", shape,
                  threads, 1e3 * sum / FRAMES, 1e3 * longest, (uint32_t)now.head->tally.collisions);
    assert_true(now.head->tally.collisions > VEHICLES); /* else nothing was tried */
    assert_true(longest < SLOW_S);
    fixture_close(&f);
}

static void compare(const char *shape)
{
    static uint64_t digest[2][FRAMES];
    uint64_t seed = fixture_seed(36);
    run(shape, 1, seed, digest[0]);
    run(shape, 4, seed, digest[1]);
    assert_memory_equal(digest[0], digest[1], sizeof digest[0]);
}

static void test_rows_36_39_46_a_crowd_of_spheres(void **state)
{
    (void)state;
    compare("sphere");
}

static void test_rows_36_39_46_a_crowd_of_models(void **state)
{
    (void)state;
    compare("model");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_36_39_46_a_crowd_of_spheres),
        cmocka_unit_test(test_rows_36_39_46_a_crowd_of_models),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
