/* The particles of the software back end: which pixels they cover, and how strongly. */
#include "tests/support/fixture.h"
#include "tests/support/soft_stage.h"
#include "renderer/soft/soft_particles.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>

#define BLUE  0xff804020u /* the background: red 0x20, green 0x40, blue 0x80 */
#define FAR_M 100.0f

static struct soft_particles *particles;

static int open_particles(void **context)
{
    struct error_text error;
    (void)context;
    particles = soft_particles_open(&error);
    return particles != NULL ? 0 : -1;
}

static int close_particles(void **context)
{
    (void)context;
    soft_particles_close(particles);
    return 0;
}

static void open_stage(struct soft_stage *stage)
{
    const struct soft_kernels *builds[2];
    soft_stage_builds(builds);
    soft_stage_open(stage, builds[1]);
    soft_stage_clear(stage, BLUE, FAR_M);
}

static void draw(struct soft_stage *stage)
{
    assert_int_equal(soft_particles_prepare(particles, &stage->frame), 0);
    for (uint32_t band = 0; band < stage->frame.bands; band++) {
        struct soft_target target = soft_stage_band(stage, band);
        stage->frame.kernels->soft_particles_fill(particles, &stage->frame, &target);
    }
}

static struct draw_list_particle *add(struct soft_stage *stage, float x, float y, float far_m,
                                      float size)
{
    struct draw_list_particle *particle = &stage->list.particles[stage->list.particle_count++];
    *particle = (struct draw_list_particle){.at = {x, y, -far_m},
                                            .size = size,
                                            .picture = (float)PARTICLE_SMOKE_A,
                                            .colour = {1.0f, 1.0f, 1.0f, 1.0f}};
    return particle;
}

static uint32_t byte_at(const struct soft_stage *stage, uint32_t x, uint32_t y, uint32_t shift)
{
    return soft_stage_colour(stage, x, y) >> shift & 255u;
}

/* A particle of 2 m radius at 20 m is 40 pixels wide, in the middle of the picture and nowhere
 * else. */
static void test_covers_its_circle(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    add(&stage, 0.0f, 0.0f, 20.0f, 2.0f);
    draw(&stage);
    uint32_t middle_x = STAGE_WIDTH / 2, middle_y = STAGE_HEIGHT / 2;
    assert_true(byte_at(&stage, middle_x, middle_y, 0) > 0x60);
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++) {
            float dx = (float)x + 0.5f - (float)middle_x, dy = (float)y + 0.5f - (float)middle_y;
            if (dx * dx + dy * dy > 21.0f * 21.0f)
                assert_int_equal(soft_stage_colour(&stage, x, y), BLUE);
        }
    /* Most of the circle of 20 pixels is smoke. */
    assert_true(soft_stage_painted(&stage, BLUE) > 700);
    soft_stage_close(&stage);
}

static void test_nothing_without_alpha(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    for (uint32_t i = 0; i < PARTICLE_PICTURE_COUNT; i++) {
        struct draw_list_particle *particle = add(&stage, (float)i - 3.0f, 0.0f, 10.0f, 2.0f);
        particle->picture = (float)i;
        particle->colour[3] = 0.0f;
        particle->glow = (float)i / PARTICLE_PICTURE_COUNT;
    }
    draw(&stage);
    assert_int_equal(soft_stage_painted(&stage, BLUE), 0);
    soft_stage_close(&stage);
}

/* A particle is a ball: it is visible in front of surfaces up to its near side. */
static void test_depth_of_a_ball(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    soft_stage_clear(&stage, BLUE, 9.0f);
    add(&stage, 0.0f, 0.0f, 10.0f, 2.0f);
    draw(&stage);
    assert_true(soft_stage_painted(&stage, BLUE) > 0);
    soft_stage_clear(&stage, BLUE, 7.5f);
    draw(&stage);
    assert_int_equal(soft_stage_painted(&stage, BLUE), 0);
    soft_stage_close(&stage);
}

static void test_none_behind_the_eye(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    add(&stage, 0.0f, 0.0f, -5.0f, 4.0f);
    add(&stage, 0.0f, 0.0f, 0.5f, 4.0f);
    struct draw_list_particle *streak = add(&stage, 0.0f, 0.5f, -3.0f, 0.5f);
    streak->axis[0] = 2.0f;
    draw(&stage);
    assert_int_equal(soft_stage_painted(&stage, BLUE), 0);
    soft_stage_close(&stage);
}

/* The nearer particle is drawn later and covers the other where both are dense. */
static void test_later_over_earlier(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    struct draw_list_particle *red = add(&stage, 0.0f, 0.0f, 12.0f, 2.0f);
    struct draw_list_particle *green = add(&stage, 0.0f, 0.0f, 10.0f, 2.0f);
    red->colour[1] = red->colour[2] = green->colour[0] = green->colour[2] = 0.0f;
    draw(&stage);
    uint32_t x = STAGE_WIDTH / 2, y = STAGE_HEIGHT / 2;
    assert_true(byte_at(&stage, x, y, 8) > byte_at(&stage, x, y, 0) + 40);
    soft_stage_close(&stage);
}

static void test_glow_adds(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    struct draw_list_particle *glow = add(&stage, 0.0f, 0.0f, 10.0f, 2.0f);
    glow->picture = (float)PARTICLE_GLOW;
    glow->glow = 1.0f;
    glow->colour[2] = 0.0f;
    draw(&stage);
    uint32_t painted = 0;
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++) {
            assert_true(byte_at(&stage, x, y, 0) >= 0x20 && byte_at(&stage, x, y, 8) >= 0x40 &&
                        byte_at(&stage, x, y, 16) >= 0x80);
            painted += byte_at(&stage, x, y, 0) > 0x20;
        }
    assert_true(painted > 500);
    soft_stage_close(&stage);
}

/* A streak along x is long along x and narrow across. One that starts behind the eye is clipped. */
static void test_streak(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    struct draw_list_particle *streak = add(&stage, 0.0f, 0.0f, 20.0f, 0.3f);
    streak->picture = (float)PARTICLE_GLOW;
    streak->glow = 1.0f;
    streak->axis[0] = 4.0f;
    draw(&stage);
    uint32_t x = STAGE_WIDTH / 2, y = STAGE_HEIGHT / 2;
    assert_true(byte_at(&stage, x - 20, y, 0) > 0x28);
    assert_true(byte_at(&stage, x + 19, y, 0) > 0x28);
    assert_int_equal(soft_stage_colour(&stage, x, y - 5), BLUE);
    assert_int_equal(soft_stage_colour(&stage, x, y + 5), BLUE);
    assert_int_equal(soft_stage_colour(&stage, x - 45, y), BLUE);

    soft_stage_clear(&stage, BLUE, FAR_M);
    streak->axis[0] = 0.0f;
    streak->axis[1] = -1.0f;
    streak->axis[2] = 25.0f;
    draw(&stage);
    assert_true(soft_stage_painted(&stage, BLUE) > 20);
    soft_stage_close(&stage);
}

static void random_particles(struct soft_stage *stage, uint64_t seed)
{
    for (uint32_t i = 0; i < 300; i++) {
        float far_m = 100.0f / (float)fixture_uniform(&seed, 1.0, 60.0);
        float aside = (float)fixture_uniform(&seed, -0.7, 0.7) * far_m;
        struct draw_list_particle *particle =
            add(stage, aside, (float)fixture_uniform(&seed, -0.4, 0.4) * far_m, far_m,
                (float)fixture_uniform(&seed, 0.01, 3.0));
        particle->picture = (float)(i % PARTICLE_PICTURE_COUNT);
        particle->turn_rad = (float)fixture_uniform(&seed, -10.0, 10.0);
        particle->glow = i % 3 == 0 ? (float)fixture_uniform(&seed, 0.0, 1.0) : 0.0f;
        for (uint32_t c = 0; c < 4; c++)
            particle->colour[c] = (float)fixture_uniform(&seed, 0.0, 1.0);
        for (uint32_t c = 0; c < 3 && i % 7 == 0; c++)
            particle->axis[c] = (float)fixture_uniform(&seed, -5.0, 5.0);
    }
}

/* Both builds of the kernels, and bands in any order, give the same bits. */
static void test_same_everywhere(void **context)
{
    const struct soft_kernels *builds[2];
    struct soft_stage stages[2];
    uint64_t seed = fixture_seed(11);
    (void)context;
    soft_stage_builds(builds);
    for (uint32_t i = 0; i < 2; i++) {
        soft_stage_open(&stages[i], builds[i]);
        soft_stage_clear(&stages[i], BLUE, 12.0f);
        random_particles(&stages[i], seed);
    }
    draw(&stages[0]);
    assert_int_equal(soft_particles_prepare(particles, &stages[1].frame), 0);
    for (uint32_t band = stages[1].frame.bands; band-- > 0;) {
        struct soft_target target = soft_stage_band(&stages[1], band);
        builds[1]->soft_particles_fill(particles, &stages[1].frame, &target);
    }
    assert_true(soft_stage_painted(&stages[0], BLUE) > 5000);
    soft_stage_assert_same(&stages[0], &stages[1]);
    soft_stage_close(&stages[0]);
    soft_stage_close(&stages[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_covers_its_circle),
        cmocka_unit_test(test_nothing_without_alpha),
        cmocka_unit_test(test_depth_of_a_ball),
        cmocka_unit_test(test_none_behind_the_eye),
        cmocka_unit_test(test_later_over_earlier),
        cmocka_unit_test(test_glow_adds),
        cmocka_unit_test(test_streak),
        cmocka_unit_test(test_same_everywhere),
    };
    return cmocka_run_group_tests_name("soft_particles", tests, open_particles, close_particles);
}
