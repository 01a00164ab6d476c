/* Dead reckoning: the worked case, each model against small steps of its differential equation, and
 * slow turns (SEED=n draws others). */
#include "world/maths/dead_reckoning.h"

#include "gateway/earth/euler.h"
#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define STEPS 20000

static double apart(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

static void test_the_worked_case(void **state)
{
    struct dead_reckoning reckoning = {.model = DEAD_RECKONING_RVW,
                                       .position = {100, 200, 300},
                                       .velocity = {10, -4, 2},
                                       .acceleration = {0.5, 1, -0.25},
                                       .rates = {0.05, -0.1, 0.3},
                                       .matrix = euler_matrix((struct euler){0.4, -0.3, 0.2})};
    struct vec3 position;
    struct mat3 matrix;
    (void)state;
    dead_reckoning_at(&reckoning, 4.0, &position, &matrix);
    assert_true(apart(position, (struct vec3){144, 192, 306}) < 1e-12);
    struct euler angles = euler_of(&matrix);
    assert_true(fabs(angles.psi - 1.812319063) < 1e-9);
    assert_true(fabs(angles.theta + 0.683537500) < 1e-9);
    assert_true(fabs(angles.phi + 0.346929635) < 1e-9);
}

/* What a model says of an entity, in steps of the midpoint rule: the attitude turns at the rates,
 * the body velocity grows by the body acceleration. */
static void integrate(const struct dead_reckoning *state, double time_s, bool turns, bool body,
                      bool accelerated, struct vec3 *position, struct mat3 *matrix)
{
    *position = state->position;
    *matrix = state->matrix;
    double dt_s = time_s / STEPS;
    struct vec3 half = vec3_scale(state->rates, 0.5 * dt_s);
    struct dead_reckoning step = {.model = DEAD_RECKONING_RPW};
    for (int i = 0; i < STEPS; i++) {
        struct vec3 velocity = state->velocity, none;
        struct mat3 middle = *matrix;
        if (accelerated)
            velocity = vec3_add(velocity, vec3_scale(state->acceleration, (i + 0.5) * dt_s));
        step.matrix = *matrix;
        step.rates = vec3_scale(half, 1.0);
        if (turns) {
            dead_reckoning_at(&step, 1.0, &none, &middle);
            step.rates = vec3_scale(half, 2.0);
            dead_reckoning_at(&step, 1.0, &none, matrix);
        }
        *position = vec3_add(*position,
                             vec3_scale(body ? rotation_apply(&middle, velocity) : velocity, dt_s));
    }
}

static void test_each_model(void **state)
{
    static const struct {
        bool moves, turns, body, accelerated;
    } models[] = {[2] = {true, false, false, false},
                  [3] = {true, true, false, false},
                  [4] = {true, true, false, true},
                  [5] = {true, false, false, true},
                  [6] = {true, false, true, false},
                  [7] = {true, true, true, false},
                  [8] = {true, true, true, true},
                  [9] = {true, false, true, true},
                  [11] = {0}};
    uint64_t random = fixture_seed(9);
    (void)state;
    for (uint8_t model = 0; model < 12; model++) {
        struct dead_reckoning reckoning = {.model = model,
                                           .position = {1e3, -2e3, 5e2},
                                           .velocity = vec3_scale(fixture_direction(&random), 30.0),
                                           .acceleration =
                                               vec3_scale(fixture_direction(&random), 3.0),
                                           .rates = vec3_scale(fixture_direction(&random), 0.5),
                                           .matrix = euler_matrix((struct euler){1.0, 0.5, -2.0})};
        struct vec3 position, right = reckoning.position;
        struct mat3 matrix, turned = reckoning.matrix;
        dead_reckoning_at(&reckoning, 5.0, &position, &matrix);
        if (models[model].moves)
            integrate(&reckoning, 5.0, models[model].turns, models[model].body,
                      models[model].accelerated, &right, &turned);
        assert_true(apart(position, right) < 1e-5);
        assert_true(euler_angle_between(&matrix, &turned) < 1e-8);
    }
}

/* Slow turns use series. Both forms agree where one takes over from the other. */
static void test_slow_turns(void **state)
{
    (void)state;
    for (uint8_t model = DEAD_RECKONING_RPB; model <= DEAD_RECKONING_RVB; model++) {
        struct dead_reckoning reckoning = {.model = model,
                                           .velocity = {20, 1, -2},
                                           .acceleration = {1, 2, 3},
                                           .matrix = euler_matrix((struct euler){1.0, 0.5, -2.0})};
        struct vec3 below, above;
        struct mat3 below_matrix, above_matrix;
        reckoning.rates = (struct vec3){0.018, 0.024, 0.0}; /* 0.03 rad */
        dead_reckoning_at(&reckoning, 1.0 - 1e-12, &below, &below_matrix);
        dead_reckoning_at(&reckoning, 1.0 + 1e-12, &above, &above_matrix);
        assert_true(apart(below, above) < 1e-9);
        assert_true(euler_angle_between(&below_matrix, &above_matrix) < 1e-11);
        reckoning.rates = (struct vec3){0};
        dead_reckoning_at(&reckoning, 2.0, &below, &below_matrix);
        struct vec3 way = {40, 2, -4};
        if (model == DEAD_RECKONING_RVB)
            way = vec3_add(way, (struct vec3){2, 4, 6});
        assert_true(apart(below, rotation_apply(&reckoning.matrix, way)) < 1e-12);
    }
}

static void test_absurd_rates(void **state)
{
    struct dead_reckoning reckoning = {.model = DEAD_RECKONING_RVB,
                                       .velocity = {1, 0, 0},
                                       .rates = {1e30, -1e30, 1e30},
                                       .matrix = euler_matrix((struct euler){0, 0, 0})};
    struct vec3 position;
    struct mat3 matrix;
    (void)state;
    dead_reckoning_at(&reckoning, 10.0, &position, &matrix);
    assert_true(apart(position, (struct vec3){10, 0, 0}) < 1e-12);
    assert_true(euler_angle_between(&matrix, &reckoning.matrix) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_worked_case),
        cmocka_unit_test(test_each_model),
        cmocka_unit_test(test_slow_turns),
        cmocka_unit_test(test_absurd_rates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
