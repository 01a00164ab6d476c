/* What the wheels of a body on its springs do: grip of the ground under each, hand brake, steering
 * wheel, engine brake, hard landings, and frames of different length. And when it needs no springs.
 */
#include "mover/motion/chassis_run.h"
#include "mover/motion/chassis.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 60u

static struct fixture f;

static int open_world(void **state)
{
    *state = &f;
    fixture_open(&f, "");
    return 0;
}

static void reopen(const char *text)
{
    fixture_close(&f);
    fixture_open(&f, text);
}

/* Puts a driven vehicle that heads east. */
static uint32_t put(const char *kind, double x, double z, double height_m, double mps)
{
    return fixture_put(&f,
                       (struct fixture_entity){.kind = kind,
                                               .at = {x, steps_ground_at(&f, x, z) + height_m, z},
                                               .velocity = {mps, 0.0, 0.0},
                                               .heading_rad = HALF_PI,
                                               .behaviour = BEHAVIOUR_DRIVEN});
}

static double speed_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return sqrt(e.row[row].vx * e.row[row].vx + e.row[row].vz * e.row[row].vz);
}

/* --- grip --------------------------------------------------------------------------------------*/

static const char half_ice[] = "earthworks = ( { shape = \"skid_pan\"; at = [25000.0, 25051.0];"
                               " length_m = 100.0; width_m = 1000.0; grip = 0.1; } );";

static void test_wheels_on_two_grounds_turn_a_vehicle_that_brakes(void **state)
{
    (void)state;
    reopen(half_ice); /* under the wheels on the right: the south */
    uint32_t row = put("jeep", 24900.0, 25001.0, 0.0, 12.0);
    for (uint32_t frame = 0; frame < HZ; frame++)
        steps_pedals(&f, row, 0.0, 1.0, GEAR_AUTOMATIC);
    double turned = maths_wrap_half(steps_rows(&f).row[row].heading - HALF_PI);
    printf("braking with the right wheels on ice: %.1f degrees, %.1f m/s after 1 s\n",
           turned * DEG_PER_RAD, speed_of(row));
    assert_true(turned < -0.1); /* to the wheels that hold */
    assert_true(speed_of(row) > 12.0 - 0.6 * GRAVITY_MPS2 && speed_of(row) < 10.0);
}

static double stops_in(enum cover cover)
{
    reopen("");
    steps_cover(&f, cover, 0.0, 0.0, 50000.0, 50000.0);
    uint32_t row = put("jeep", 25000.0, 25000.0, 0.0, 15.0);
    for (uint32_t frame = 0; frame < 6 * HZ; frame++)
        steps_pedals(&f, row, 0.0, 1.0, GEAR_AUTOMATIC);
    return steps_rows(&f).row[row].x - 25000.0;
}

static void test_brakes_are_as_good_as_the_ground(void **state)
{
    double road = stops_in(COVER_ROAD), rock = stops_in(COVER_ROCK);
    double grass = stops_in(COVER_GRASS), sand = stops_in(COVER_SAND);
    (void)state;
    printf("jeep, stop from 15 m/s: road %.1f, rock %.1f, grass %.1f, sand %.1f m\n", road, rock,
           grass, sand);
    assert_true(road < rock && rock < grass && grass < sand);
}

/* Returns the speed that a vehicle loses in a second after the throttle is released [m/s]. */
static double slows_by(const char *kind, enum cover cover)
{
    reopen("");
    steps_cover(&f, cover, 0.0, 0.0, 50000.0, 50000.0);
    uint32_t row = put(kind, 25000.0, 25000.0, 0.0, 12.0);
    steps_pedals(&f, row, 12.0 / steps_kind(&f, kind)->max_speed_mps, 0.0, GEAR_AUTOMATIC);
    double before = speed_of(row);
    for (uint32_t frame = 0; frame < HZ; frame++)
        steps_pedals(&f, row, 0.0, 0.0, GEAR_AUTOMATIC);
    return before - speed_of(row);
}

static void test_the_engine_brakes_on_all_grounds(void **state)
{
    static const char *const kinds[] = {"jeep", "truck", "tank", "carrier"};
    static const enum cover covers[] = {COVER_ROAD, COVER_GRASS, COVER_ROCK, COVER_SAND};
    (void)state;
    for (size_t k = 0; k < 4; k++) {
        for (size_t c = 0; c < 4; c++) {
            double lost = slows_by(kinds[k], covers[c]);
            const struct kind *kind = steps_kind(&f, kinds[k]);
            struct ground_grip grip = ground_grip_of(covers[c]);
            double rolling = GRAVITY_MPS2 * (kind->tracked ? grip.tracks : grip.wheels);
            printf("%s: %.2f m/s, of it %.2f by rolling\n", kinds[k], lost, rolling);
            /* The engine adds its own drag. */
            assert_true(fabs(lost - rolling - 0.5 * kind->acceleration_mps2) < 0.15);
        }
    }
}

/* --- controls ----------------------------------------------------------------------------------*/

static void test_the_hand_brake_holds_the_rear_wheels(void **state)
{
    (void)state;
    uint32_t row = put("jeep", 25000.0, 25000.0, 0.0, 15.0);
    for (uint32_t frame = 0; frame < HZ; frame++)
        steps_drive(&f, row, 0.0, 0.0, 1.0);
    double slowed = 15.0 - speed_of(row);
    printf("hand brake: %.1f m/s2 straight on\n", slowed);
    assert_true(slowed > 3.0 && slowed < 6.0); /* half of the wheels */
    double turned[2];
    for (int hand = 0; hand < 2; hand++) {
        steps_empty(&f);
        row = put("jeep", 25000.0, 25000.0, 0.0, 14.0);
        for (uint32_t frame = 0; frame < HZ; frame++)
            steps_drive(&f, row, 0.0, 1.0, hand);
        turned[hand] =
            fabs(maths_wrap_half(steps_rows(&f).row[row].heading - HALF_PI)) * DEG_PER_RAD;
    }
    printf("full wheel at 14 m/s for 1 s: %.0f degrees, with the hand brake %.0f\n", turned[0],
           turned[1]);
    assert_true(turned[1] > 1.5 * turned[0]); /* its tail comes round */
}

static void test_the_hand_brake_holds_a_vehicle_in_neutral_on_a_slope(void **state)
{
    static const char *const kinds[] = {"jeep", "truck", "tank"};
    (void)state;
    for (size_t n = 0; n < 3; n++) {
        steps_empty(&f);
        steps_plane(&f, 0.15, 0.0);
        uint32_t row = put(kinds[n], 25000.0, 25000.0, 0.0, 0.0);
        steps_pedals(&f, row, 0.0, 0.0, GEAR_NEUTRAL);
        steps_rows(&f).row[row].climb = 1.0f;
        fixture_run(&f, 5 * HZ);
        assert_true(speed_of(row) < 0.01 && steps_rows(&f).row[row].x > 24999.5);
        steps_rows(&f).row[row].climb = 0.0f;
        fixture_run(&f, 5 * HZ);
        assert_true(speed_of(row) > 1.0);
    }
}

static void test_the_wheel_takes_half_a_second_to_the_stop(void **state)
{
    (void)state;
    uint32_t row = put("jeep", 25000.0, 25000.0, 0.0, 2.0);
    for (uint32_t frame = 1; frame <= HZ; frame++) {
        steps_drive(&f, row, 2.0 / 29.0, -1.0, 0.0);
        double wheel = -(double)steps_rows(&f).row[row].dodge, share = 2.0 * frame / HZ;
        assert_true(fabs(wheel - maths_min(1.0, share)) < 1e-5);
    }
}

/* --- hard landings -----------------------------------------------------------------------------*/

static enum damage falls(const char *world, uint32_t hz, const char *kind, double metres)
{
    reopen(world);
    uint32_t row = put(kind, 25000.0, 25000.0, metres, 0.0);
    fixture_run(&f, 4 * hz);
    return (enum damage)steps_rows(&f).row[row].damage;
}

static void test_a_fall_does_damage_by_its_height(void **state)
{
    static const char *const kinds[] = {"jeep", "truck", "carrier", "tank"};
    static const double heights[] = {0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0};
    (void)state;
    for (size_t k = 0; k < 4; k++) {
        enum damage last = DAMAGE_NONE;
        printf("%s falls from", kinds[k]);
        for (size_t h = 0; h < 7; h++) {
            enum damage fast = falls("", HZ, kinds[k], heights[h]);
            enum damage slow = falls("world = { hz = 10; };", 10, kinds[k], heights[h]);
            printf(" %.1f m: %d,", heights[h], fast);
            assert_true(fast == slow && fast >= last);
            assert_true(heights[h] > 0.6 || fast == DAMAGE_NONE);
            last = fast;
        }
        printf("\n");
        assert_int_equal(last, DAMAGE_DESTROYED);
    }
}

/* A vehicle that drives squarely into a bank of 2 m takes the harm of a building, and an event
 * tells so. */
static void test_a_bank_harms_as_a_building_does(void **state)
{
    static const struct {
        const char *kind;
        double mps;
        enum damage most;
    } rows[] = {
        {"truck", 8.0, DAMAGE_LOW}, {"carrier", 9.0, DAMAGE_MED}, {"jeep", 13.0, DAMAGE_MED}};
    (void)state;
    for (size_t n = 0; n < sizeof rows / sizeof rows[0]; n++) {
        reopen("terrain = { source = \"flat\"; height_m = 100.0; };"
               "earthworks = ( { shape = \"table\"; at = [25016.0, 25000.0]; heading_deg = 90.0;"
               "    length_m = 20.0; width_m = 20.0; height_m = 2.0; edge_m = 0.25; } );");
        uint32_t row = put(rows[n].kind, 25000.0, 25000.0, 0.0, rows[n].mps);
        fixture_run(&f, 4 * HZ);
        enum damage damage = (enum damage)steps_rows(&f).row[row].damage;
        uint32_t told = fixture_event_count(&f, EVENT_COLLISION);
        printf("%s into a bank at %.0f m/s: damage %d, told %u times\n", rows[n].kind, rows[n].mps,
               damage, told);
        assert_true(damage >= DAMAGE_LOW && damage <= rows[n].most);
        assert_true(told >= 1 && told <= (uint32_t)damage);
        const struct event *event = fixture_event(&f, EVENT_COLLISION, told - 1);
        assert_true(event->collision.b.id == 0 && event->collision.b.fixed == 1);
        assert_int_equal(event->collision.a.damage, damage);
        assert_true(event->collision.closing_mps > 0.3f * (float)rows[n].mps);
        assert_int_equal(event->collision.response, RESPONSE_STOP);
    }
}

/* --- frames of different length ----------------------------------------------------------------*/

/* A frame of 1/10 s is six of 1/60 s: at the same times the heights are the same. What a test that
 * looks once a frame sees of a jounce is not: it misses the lowest point between two frames. */
static void test_a_drop_is_the_same_at_10_and_60_hz(void **state)
{
    static const char *const kinds[] = {"truck", "tank", "jeep", "carrier"};
    double height[2][40], worst = 0.0;
    (void)state;
    for (size_t k = 0; k < 4; k++) {
        for (uint32_t fast = 0; fast < 2; fast++) {
            reopen(fast ? "" : "world = { hz = 10; };");
            uint32_t row = put(kinds[k], 25000.0, 25000.0, 0.3, 4.0);
            for (uint32_t n = 0; n < 40; n++) {
                fixture_run(&f, fast ? 6 : 1);
                height[fast][n] = steps_rows(&f).row[row].y;
            }
        }
        for (uint32_t n = 0; n < 40; n++)
            worst = maths_max(worst, fabs(height[0][n] - height[1][n]));
    }
    printf("heights at 10 and at 60 Hz differ by %.2g m at most\n", worst);
    assert_true(worst == 0.0);
}

/* A jeep in the air rolls once about its long axis in a tenth of a second. It is upright again when
 * the frame at 10 Hz ends, but it has lain on its roof in between. */
static void test_what_turns_over_within_a_frame_is_a_wreck(void **state)
{
    (void)state;
    for (uint32_t fast = 0; fast < 2; fast++) {
        reopen(fast ? "" : "world = { hz = 10; };");
        uint32_t row = put("jeep", 25000.0, 25000.0, 20.0, 4.0);
        steps_rows(&f).row[row].spin_x = 10.0 * TWO_PI;
        fixture_run(&f, fast ? 6 : 1);
        struct entities e = steps_rows(&f);
        printf("rolled by %.2f at %s Hz: state %d\n", e.row[row].roll, fast ? "60" : "10",
               e.row[row].state);
        assert_int_equal(e.row[row].state, ENTITY_WRECK);
        assert_int_equal(e.row[row].damage, DAMAGE_DESTROYED);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    }
}

/* --- calm --------------------------------------------------------------------------------------*/

/* Slopes that meet in edges across its way, 62 m apart, by an angle of 0.06 rad. */
static double edges(double x, double z, const void *context)
{
    double place = (x - 25000.0) / 62.5;
    (void)z, (void)context;
    return 100.0 + 1.875 * fabs(place - 2.0 * floor(0.5 * place) - 1.0);
}

/* Its springs move at each edge, and so does a vehicle that follows the ground. */
static void test_it_goes_back_to_uneven_ground_while_it_drives_on(void **state)
{
    static const char *const kinds[] = {"tank", "jeep", "truck"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        reopen("");
        steps_ground(&f, edges, NULL);
        uint32_t row = put(kinds[n], 25000.0, 25000.0, 0.0, 12.0), frame = 0;
        struct entities e = steps_rows(&f);
        e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
        e.row[row].goal_x = 29000.0, e.row[row].goal_z = 25000.0;
        e.row[row].throttle = 0.7f;
        e.row[row].flags |= ENTITY_FLAG_CHASSIS;
        for (; frame < 10 * HZ && e.row[row].flags & ENTITY_FLAG_CHASSIS; frame++) {
            fixture_run(&f, 1);
            e = steps_rows(&f);
        }
        printf("%s on springs for %.1f s at %.1f m/s\n", kinds[n], frame / (double)HZ,
               speed_of(row));
        assert_true(frame < 8 * HZ && speed_of(row) > 8.0);
    }
}

/* Returns true if the tyres of a kind hold it on dirt. */
static bool holds(const char *kind, double pitch_deg, double roll_deg, double gain_mps2,
                  double lateral_mps2)
{
    const struct chassis_slope slope = {pitch_deg * RAD_PER_DEG, roll_deg * RAD_PER_DEG, gain_mps2,
                                        lateral_mps2};
    return chassis_holds(steps_kind(&f, kind), 0.65, &slope);
}

static void test_tyres_hold_it_on_a_slope_up_to_their_grip(void **state)
{
    (void)state;
    assert_true(holds("tank", 29.0, 0.0, 0.0, 0.0) && holds("tank", -29.0, 0.0, 0.0, 0.0));
    assert_true(holds("tank", 0.0, 29.0, 0.0, 0.0) && holds("tank", 0.0, -29.0, 0.0, 0.0));
    assert_false(holds("tank", 34.0, 0.0, 0.0, 0.0) || holds("tank", 0.0, -34.0, 0.0, 0.0));
    assert_false(holds("tank", 26.0, 26.0, 0.0, 0.0));
    /* Down the slope brakes need grip, and up it the engine does; across it turns uphill do. */
    assert_false(holds("tank", -29.0, 0.0, -2.0, 0.0) || holds("tank", 29.0, 0.0, 2.0, 0.0));
    assert_true(holds("tank", -29.0, 0.0, 2.0, 0.0) && holds("tank", 29.0, 0.0, -2.0, 0.0));
    assert_false(holds("tank", 0.0, 29.0, 0.0, -2.0) || holds("tank", 0.0, -29.0, 0.0, 2.0));
    assert_true(holds("tank", 0.0, 29.0, 0.0, 2.0) && holds("tank", 0.0, -29.0, 0.0, -2.0));
    steps_kind(&f, "truck")->centre_height_m = 2.0; /* it would lean over before it slides */
    assert_true(holds("truck", 28.0, 0.0, 0.0, 0.0) && !holds("truck", 0.0, 28.0, 0.0, 0.0));
}

#define SIDE_DEG 28.0

/* Puts an agent's vehicle that comes from its springs on a side slope that rises to the east. It
 * drives to the north and wants to turn uphill harder than its tyres hold it. */
static uint32_t put_on_side_slope(const char *kind, double mps)
{
    reopen("");
    steps_plane(&f, maths_sin(SIDE_DEG * RAD_PER_DEG) / maths_cos(SIDE_DEG * RAD_PER_DEG), 0.0);
    uint32_t row = put(kind, 25000.0, 25000.0, 0.0, 0.0);
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
    e.row[row].goal_x = 29000.0, e.row[row].goal_z = 25000.0;
    e.row[row].heading = 0.0;
    e.row[row].roll = -SIDE_DEG * RAD_PER_DEG;
    e.row[row].vx = 0.0, e.row[row].vz = -mps;
    e.row[row].throttle = 0.5f, e.row[row].steer = 1.0f;
    e.row[row].flags |= ENTITY_FLAG_CHASSIS;
    e.row[row].jolt_tick = (uint32_t)fixture_state(&f).head->tick - 2 * HZ;
    return row;
}

/* Returns the energy of its motion on the map and of its turn over its mass [J/kg]. */
static double motion_jpkg(const char *name, uint32_t row)
{
    const struct kind *kind = steps_kind(&f, name);
    const double speed = speed_of(row), spin = steps_rows(&f).row[row].spin_y;
    const double square = kind->length_m * kind->length_m + kind->width_m * kind->width_m;
    return 0.5 * speed * speed + spin * spin * square / 24.0;
}

/* A vehicle that follows the ground turns at once. Where that throws it back on its springs, they
 * turn it as its tyres can. */
static void test_it_gets_no_turn_at_once_where_it_cannot_go_back(void **state)
{
    static const char *const kinds[] = {"howitzer", "flak", "truck", "hamburger"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        uint32_t row = put_on_side_slope(kinds[n], 7.0), sprung = 0;
        double before = motion_jpkg(kinds[n], row), most = 0.0;
        for (uint32_t frame = 0; frame < HZ; frame++) {
            steps_rows(&f).row[row].steer = 1.0f;
            fixture_run(&f, 1);
            double now = motion_jpkg(kinds[n], row);
            bool springs = steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS;
            sprung += springs;
            most = maths_max(most, springs ? now - before : 0.0);
            before = now;
        }
        printf("%s on springs for %u frames gains %.2f J/kg in a frame at most\n", kinds[n], sprung,
               most);
        assert_true(sprung > HZ / 2 && most < 0.4);
    }
}

int main(void)
{
#define T(name) cmocka_unit_test_setup_teardown(name, open_world, fixture_teardown)
    const struct CMUnitTest tests[] = {
        T(test_wheels_on_two_grounds_turn_a_vehicle_that_brakes),
        T(test_brakes_are_as_good_as_the_ground),
        T(test_the_engine_brakes_on_all_grounds),
        T(test_the_hand_brake_holds_the_rear_wheels),
        T(test_the_hand_brake_holds_a_vehicle_in_neutral_on_a_slope),
        T(test_the_wheel_takes_half_a_second_to_the_stop),
        T(test_a_fall_does_damage_by_its_height),
        T(test_a_bank_harms_as_a_building_does),
        T(test_a_drop_is_the_same_at_10_and_60_hz),
        T(test_what_turns_over_within_a_frame_is_a_wreck),
        T(test_it_goes_back_to_uneven_ground_while_it_drives_on),
        T(test_tyres_hold_it_on_a_slope_up_to_their_grip),
        T(test_it_gets_no_turn_at_once_where_it_cannot_go_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
