/* The collider sets land vehicles on the ground as the mover does. */
#include "world/terrain/rest_pose.h"

#include "tests/support/steps.h"
#include "world/course_lift.h"
#include "world/terrain/crater.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static const char *const kinds[] = {"jeep", "tank", "truck"};

static struct fixture f;

static double waves(double x, double z, const void *context)
{
    double sine, cosine;
    (void)context;
    maths_sincos(0.004 * x + 0.007 * z, &sine, &cosine);
    return FIXTURE_GROUND_M + 40.0 * sine + 0.05 * (x - 25000.0);
}

/* Returns the greatest difference of the row's pose, which holds its course, from
 * course_lift_pose() [m, rad]. */
static double difference(const struct entities *e, uint32_t row)
{
    struct rest_pose pose =
        course_lift_pose(&f.view.world, &f.stepper.mover.craters, e->row[row].kind, e->row[row].x,
                         e->row[row].z, e->row[row].heading);
    double y = fabs(pose.y_m - e->row[row].y), pitch = fabs(pose.pitch_rad - e->row[row].pitch);
    return maths_max(y, maths_max(pitch, fabs(pose.roll_rad - e->row[row].roll)));
}

static void test_it_is_the_pose_that_the_mover_gives(void **state)
{
    uint64_t random = fixture_seed(134);
    (void)state;
    fixture_open(&f, "");
    steps_ground(&f, waves, NULL);
    struct state now = fixture_state(&f);
    now.craters[0] =
        (struct crater){.x = 25020.0, .z = 25010.0, .radius_m = 30.0f, .depth_m = 4.0f};
    now.head->crater_count = 1;
    for (uint32_t i = 0; i < 40; i++) {
        double x = 24900.0 + 30.0 * (i % 8), z = 24950.0 + 30.0 * (i / 8);
        struct vec3 to = fixture_direction(&random);
        fixture_put(&f, (struct fixture_entity){.kind = kinds[i % 3],
                                                .at = {x, 100.0, z},
                                                .velocity = {to.x, 0, to.z}});
    }
    fixture_run(&f, 2);
    struct entities e = steps_rows(&f);
    double steepest = 0.0;
    for (uint32_t row = 0; row < 40; row++) {
        assert_true(difference(&e, row) <= 1e-12);
        steepest = maths_max(steepest, fabs(e.row[row].pitch));
    }
    assert_true(steepest > 0.1);
    assert_true(crater_offset(&f.stepper.mover.craters, e.row[20].x, e.row[20].z) < -0.5);
    double ground =
        terrain_height(&f.view.world.terrain, &f.stepper.mover.craters, e.row[20].x, e.row[20].z);
    assert_true(e.row[20].y > ground + 0.01); /* it stands on its corners */
    fixture_close(&f);
}

/* On a plane all is exact: nose up where the ground rises ahead, right side down where it falls to
 * the right. */
static void test_signs_on_a_slope(void **state)
{
    (void)state;
    fixture_open(&f, "");
    steps_plane(&f, 0.2, 0.0); /* rises to the east */
    const struct terrain *terrain = &f.view.world.terrain;
    const struct crater_index *craters = &f.stepper.mover.craters;
    const struct kind *tank = &f.view.world.kinds[fixture_kind(&f, "tank")];
    struct rest_pose pose = rest_pose_of(terrain, craters, tank, 25010.0, 25000.0, HALF_PI);
    assert_true(fabs(pose.y_m - 102.0) < 1e-4 && fabs(pose.roll_rad) < 1e-6);
    assert_true(fabs(pose.pitch_rad - maths_atan2(0.2, 1.0)) < 1e-4);
    pose = rest_pose_of(terrain, craters, tank, 25010.0, 25000.0, 0.0);
    assert_true(fabs(pose.roll_rad + maths_atan2(0.2, 1.0)) < 1e-4 && fabs(pose.pitch_rad) < 1e-6);
    fixture_close(&f);
}

/* The body's roll follows its pitch, so a vehicle that is slantwise on a steep plane lies on it:
 * its corners are as high as the ground there. */
static void test_corners_are_on_a_plane(void **state)
{
    (void)state;
    fixture_open(&f, "");
    steps_plane(&f, 0.6, 0.5);
    const struct terrain *terrain = &f.view.world.terrain;
    const struct kind *tank = &f.view.world.kinds[fixture_kind(&f, "tank")];
    for (int i = 0; i < 16; i++) {
        const double heading = i * TWO_PI / 16.0;
        const struct rest_pose pose = rest_pose_of(terrain, NULL, tank, 25010.0, 25000.0, heading);
        const struct mat3 turn =
            rotation_matrix(rotation_of(heading, pose.pitch_rad, pose.roll_rad));
        for (int n = 0; n < 4; n++) {
            const struct vec3 corner = {(n & 1 ? 0.5 : -0.5) * tank->length_m, 0.0,
                                        (n & 2 ? 0.5 : -0.5) * tank->width_m};
            const struct vec3 at =
                vec3_add((struct vec3){25010.0, pose.y_m, 25000.0}, rotation_apply(&turn, corner));
            assert_true(fabs(at.y - terrain_height(terrain, NULL, at.x, at.z)) < 1e-3);
        }
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_it_is_the_pose_that_the_mover_gives),
        cmocka_unit_test(test_signs_on_a_slope),
        cmocka_unit_test(test_corners_are_on_a_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
