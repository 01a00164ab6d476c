/* What aircraft and their wrecks do beside what real ones do, as a table: quantity, real, ours. The
 * sources are in docs/motion.md. Ships, missiles and loads have such tables in test_ship.c,
 * test_missile.c and test_airframe.c. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 60

static struct fixture f;

static void row_of(const char *quantity, const char *real, double low, double high, double ours)
{
    print_message("| %-36s | %-30s | %7.1f |\n", quantity, real, ours);
    if (!(ours >= low && ours <= high))
        fail_msg("%s: %g; right would be %g to %g", quantity, ours, low, high);
}

static uint32_t put(const char *kind, double height_m, double speed_mps, enum behaviour behaviour)
{
    steps_empty(&f);
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind,
                                    .at = {25000.0, FIXTURE_GROUND_M + height_m, 25000.0},
                                    .velocity = {speed_mps, 0.0, 0.0},
                                    .heading_rad = HALF_PI,
                                    .behaviour = behaviour});
}

static void seconds(double s)
{
    fixture_run(&f, (uint32_t)(s * HZ + 0.5));
}

static struct vec3 velocity_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return entities_velocity(&e, row);
}

/* --- aircraft ----------------------------------------------------------------------------------*/

static double top_speed(const char *kind, double height_m)
{
    uint32_t row = put(kind, height_m, 0.7 * steps_kind(&f, kind)->max_speed_mps, BEHAVIOUR_IDLE);
    steps_drive(&f, row, 1.0, 0.0, 0.0);
    seconds(60.0);
    return vec3_length(velocity_of(row));
}

static double climb(const char *kind, double speed_mps)
{
    uint32_t row = put(kind, 300.0, speed_mps, BEHAVIOUR_IDLE);
    steps_drive(&f, row, speed_mps / steps_kind(&f, kind)->max_speed_mps, 0.0, 1.0);
    seconds(8.0);
    return velocity_of(row).y;
}

/* The speed at which an aeroplane that slows down begins to sink. */
static double stall(const char *kind)
{
    uint32_t row = put(kind, 2000.0, 1.3 * steps_kind(&f, kind)->min_speed_mps, BEHAVIOUR_IDLE);
    steps_pedals(&f, row, 0.0, 1.0, GEAR_AUTOMATIC);
    double speed = 0.0;
    for (int frame = 0; frame < 30 * HZ && velocity_of(row).y > -0.05; frame++) {
        speed = velocity_of(row).x;
        fixture_run(&f, 1);
    }
    return speed;
}

/* How far a helicopter flies from a speed until it hovers. */
static double stops_in(const char *kind, double speed_mps)
{
    uint32_t row = put(kind, 100.0, speed_mps, BEHAVIOUR_IDLE);
    steps_drive(&f, row, 0.0, 0.0, 0.0);
    for (int frame = 0; frame < 60 * HZ && velocity_of(row).x > 1.0; frame++)
        fixture_run(&f, 1);
    return steps_rows(&f).row[row].x - 25000.0;
}

static void test_aircraft(void **state)
{
    (void)state;
    row_of("jet, stalls below m/s", "62 (A-10) to 75 (F-4E)", 60.0, 75.0, stall("jet"));
    row_of("jet, climb m/s", "30 (A-10) to 200 (F-4E)", 30.0, 200.0, climb("jet", 200.0));
    row_of("helicopter, top speed m/s", "63 (AH-1S) to 77 (AH-64A)", 63.0, 77.5,
           top_speed("helicopter", 100.0));
    row_of("helicopter, climb m/s", "8 (AH-1S) to 15 (AH-64A)", 8.0, 15.0,
           climb("helicopter", 30.0));
    row_of("helicopter, 60 m/s to hover, m", "180 to 400 (30 to 10 degrees)", 180.0, 400.0,
           stops_in("helicopter", 60.0));
}

/* --- wrecks ------------------------------------------------------------------------------------*/

static uint32_t put_wreck(const char *kind, double height_m, double speed_mps)
{
    uint32_t row = put(kind, height_m, speed_mps, BEHAVIOUR_HOLD);
    struct entities e = steps_rows(&f);
    e.row[row].state = ENTITY_WRECK;
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
    return row;
}

static double slide(const char *kind, double speed_mps)
{
    uint32_t row = put_wreck(kind, 2.0, speed_mps);
    seconds(60.0);
    return steps_rows(&f).row[row].x - 25000.0;
}

/* The most by which a wreck's pitch, roll or heading changes in a frame, over 30 s [degrees]. */
static double hardest_turn(const char *kind, double speed_mps)
{
    uint32_t row = put_wreck(kind, 40.0, speed_mps);
    steps_rows(&f).row[row].spin_x = 2.0;
    steps_rows(&f).row[row].spin_z = 1.0;
    double hardest = 0.0;
    for (int frame = 0; frame < 30 * HZ; frame++) {
        struct entities e = steps_rows(&f);
        struct quat before = rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll);
        fixture_run(&f, 1);
        e = steps_rows(&f);
        struct quat after = rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll);
        double cosine =
            fabs(before.w * after.w + before.x * after.x + before.y * after.y + before.z * after.z);
        double angle = 2.0 * acos(maths_min(cosine, 1.0));
        hardest = maths_max(hardest, angle);
    }
    return hardest * DEG_PER_RAD;
}

static void test_wrecks(void **state)
{
    (void)state;
    row_of("jet wreck slides from 278 m/s, m", "500 to 1,200", 500.0, 1200.0, slide("jet", 277.8));
    row_of("wishbone wreck from 60 m/s, m", "150 to 480", 150.0, 480.0, slide("wishbone", 60.0));
    row_of("turn of a jet wreck in a frame, deg", "at most 11.5 (12 rad/s)", 0.0, 11.5,
           hardest_turn("jet", 120.0));
}

int main(void)
{
    fixture_open(&f, "");
    print_message("| quantity | real | ours |\n");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_aircraft),
        cmocka_unit_test(test_wrecks),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    fixture_close(&f);
    return failed;
}
