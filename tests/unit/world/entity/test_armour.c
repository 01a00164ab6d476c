/* Armour: what penetrates which side from where, what glances off, and the effects behind it. */
#include "world/entity/armour.h"

#include "mover/weapon/fire.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static const struct kind sabot = {.penetration_mm = 400.0, .penetration_loss = 25.0};
static const struct kind heat = {.penetration_mm = 380.0};
static const struct kind m60 = {.armour_mm = {250.0, 60.0, 40.0, 30.0}, .resistance_j = 12e6};
static const struct kind m1 = {.armour_mm = {375.0, 70.0, 40.0, 30.0}, .resistance_j = 12e6};

/* A round that flies level and comes from `bearing_deg` off the bow strikes the side that it sees
 * best; the surface there stands upright. */
static struct armour_hit hit_from(const struct kind *vehicle, const struct kind *round,
                                  double range_m, double bearing_deg, struct vec3 outwards)
{
    double sine, cosine;
    maths_sincos(bearing_deg * RAD_PER_DEG, &sine, &cosine);
    return armour_hit_of(vehicle, armour_penetration(round, range_m),
                         (struct vec3){-cosine, 0.0, -sine}, outwards);
}

static const struct vec3 bow = {1.0, 0.0, 0.0}, right = {0.0, 0.0, 1.0}, stern = {-1.0, 0.0, 0.0};

static void row(const char *what, const struct kind *vehicle, const struct kind *round,
                double range_m, double bearing_deg, struct vec3 outwards, double low, double high)
{
    struct armour_hit hit = hit_from(vehicle, round, range_m, bearing_deg, outwards);
    print_message("%-34s %5.0f mm against %5.0f mm: %.2f (%.2f to %.2f)\n", what,
                  armour_penetration(round, range_m), hit.path_mm, hit.probability, low, high);
    if (!(hit.probability >= low && hit.probability <= high))
        fail_msg("%s", what);
}

static void test_penetration_by_range_and_aspect(void **state)
{
    (void)state;
    row("sabot, 1 km, M60 front", &m60, &sabot, 1000.0, 0.0, bow, 1.0, 1.0);
    row("sabot, 2 km, M60 front at 40 deg", &m60, &sabot, 2000.0, 40.0, bow, 0.8, 1.0);
    row("sabot, 2 km, M60 side", &m60, &sabot, 2000.0, 90.0, right, 1.0, 1.0);
    row("sabot, 0 km, M1 front", &m1, &sabot, 0.0, 0.0, bow, 0.7, 0.95);
    row("sabot, 2 km, M1 front", &m1, &sabot, 2000.0, 0.0, bow, 0.1, 0.3);
    row("sabot, 3 km, M1 front", &m1, &sabot, 3000.0, 0.0, bow, 0.0, 0.0);
    row("sabot, 2 km, M1 side", &m1, &sabot, 2000.0, 90.0, right, 1.0, 1.0);
    row("sabot, 2 km, M1 rear", &m1, &sabot, 2000.0, 180.0, stern, 1.0, 1.0);
    row("HEAT, 3 km, M60 front", &m60, &heat, 3000.0, 0.0, bow, 1.0, 1.0);
    row("HEAT, 3 km, M1 front", &m1, &heat, 3000.0, 0.0, bow, 0.4, 0.7);
    row("HEAT, 3 km, M1 front at 30 deg", &m1, &heat, 3000.0, 30.0, bow, 0.0, 0.0);
}

static void test_the_struck_side_is_the_one_that_the_round_comes_from(void **state)
{
    const struct vec3 bow_plate = {0.4, 0.9165, 0.0}; /* as steep as that of an M1 */
    const struct vec3 steep = {-0.3, -0.954, 0.0};
    (void)state;
    assert_int_equal(hit_from(&m1, &sabot, 0.0, 0.0, bow_plate).aspect, ASPECT_FRONT);
    assert_int_equal(armour_hit_of(&m1, 400.0, steep, bow_plate).aspect, ASPECT_TOP);
    assert_int_equal(hit_from(&m1, &sabot, 0.0, 50.0, right).aspect, ASPECT_SIDE);
    assert_int_equal(hit_from(&m1, &sabot, 0.0, 50.0, bow).aspect, ASPECT_FRONT);
    assert_int_equal(hit_from(&m1, &sabot, 0.0, -50.0, (struct vec3){0.0, 0.0, -1.0}).aspect,
                     ASPECT_SIDE);
    assert_int_equal(hit_from(&m1, &sabot, 0.0, 170.0, stern).aspect, ASPECT_REAR);
}

static enum armour_effect effect(const struct kind *round, double bearing_deg)
{
    struct armour_hit hit = hit_from(&m60, round, 1000.0, bearing_deg, right);
    return armour_effect_of(&m60, round, &hit, 0.5);
}

static void test_rounds_glance_off_at_72_degrees_and_charges_do_not(void **state)
{
    (void)state;
    assert_int_equal(effect(&sabot, 90.0), ARMOUR_PENETRATED);
    assert_int_equal(effect(&sabot, 90.0 - 71.0), ARMOUR_PENETRATED);
    assert_int_equal(effect(&sabot, 90.0 - 73.0), ARMOUR_DEFLECTS);
    assert_int_equal(effect(&heat, 90.0 - 73.0), ARMOUR_PENETRATED);
    assert_int_equal(effect(&heat, 90.0 - 84.0), ARMOUR_HOLDS);
}

static void test_thin_skins_and_rounds_without_a_figure_have_no_rule(void **state)
{
    const struct kind truck = {.armour_mm = {5.0, 5.0, 5.0, 5.0}}, bomb = {0};
    struct armour_hit hit = hit_from(&truck, &sabot, 0.0, 0.0, bow);
    (void)state;
    assert_int_equal(armour_effect_of(&truck, &sabot, &hit, 0.5), ARMOUR_NONE);
    hit = hit_from(&m60, &bomb, 0.0, 0.0, bow);
    assert_int_equal(armour_effect_of(&m60, &bomb, &hit, 0.5), ARMOUR_NONE);
}

static void test_effects_behind_armour(void **state)
{
    (void)state;
    assert_true(armour_harm(&m60, 15e6, 0.0) == 0.35 * m60.resistance_j);
    assert_true(armour_harm(&m60, 15e6, 0.31) == 0.65 * m60.resistance_j);
    assert_true(armour_harm(&m60, 15e6, 0.61) == m60.resistance_j);
    assert_true(armour_harm(&m60, 80e3, 0.99) < 0.03 * m60.resistance_j); /* a bullet */
}

/* --- in a world --------------------------------------------------------------------------------*/

/* Fires shells at a tank from this bearing off its bow, each in a world of its own, and counts the
 * damage. */
static void shoot(double bearing_deg, const char *munition, unsigned count[DAMAGE_COUNT],
                  unsigned *broken)
{
    struct fixture f;
    fixture_open(&f, "world = { seed = 7; capacity = 256; }; collision = { shape = \"model\"; };");
    double sine, cosine;
    maths_sincos(bearing_deg * RAD_PER_DEG, &sine, &cosine);
    *broken = 0;
    for (int n = 0; n < 60; n++) {
        steps_empty(&f);
        fixture_run(&f, (uint32_t)n % 7);
        uint32_t tank =
            fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                    .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                                    .behaviour = BEHAVIOUR_IDLE});
        double speed = steps_kind(&f, munition)->max_speed_mps;
        fixture_put(&f, (struct fixture_entity){.kind = munition,
                                                .at = {25000.0 + 15.0 * sine,
                                                       FIXTURE_GROUND_M + 0.9 + 0.01 * n,
                                                       25000.0 - 15.0 * cosine},
                                                .velocity = {-speed * sine, 0.0, speed * cosine}});
        steps_rows(&f).row[1].id = (uint32_t)(100 + n);
        fixture_run(&f, 2);
        const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
        assert_non_null(event);
        assert_int_equal(event->detonation.struck, STRUCK_VEHICLE);
        *broken += event->detonation.explosive_kg == 0.0f;
        enum damage damage = steps_rows(&f).row[tank].damage;
        count[damage]++;
        /* Only a round that strikes the gun alone does high damage at once. */
        assert_true(((steps_rows(&f).row[tank].flags & ENTITY_FLAG_DISARMED) != 0) ==
                    (damage == DAMAGE_HIGH));
    }
    fixture_close(&f);
}

static void expect_share(const char *what, double low, double high, double share)
{
    print_message("%-40s %.2f to %.2f  %.2f\n", what, low, high, share);
    if (!(share >= low && share <= high))
        fail_msg("%s: %g", what, share);
}

static void test_shells_in_a_world(void **state)
{
    unsigned side[DAMAGE_COUNT] = {0}, front[DAMAGE_COUNT] = {0}, broken;
    unsigned bullets[DAMAGE_COUNT] = {0};
    (void)state;
    shoot(90.0, "shell", side, &broken);
    expect_share("shell, side: mobility", 0.15, 0.45, side[DAMAGE_MED] / 60.0);
    expect_share("  fire", 0.15, 0.45, side[DAMAGE_HIGH] / 60.0);
    expect_share("  loss", 0.25, 0.55, side[DAMAGE_DESTROYED] / 60.0);
    assert_int_equal(broken, 0); /* none glances off */
    shoot(0.0, "shell", front, &broken);
    expect_share("shell, 20 m, front: held (0.17)", 0.05, 0.35,
                 (front[DAMAGE_NONE] + front[DAMAGE_LOW]) / 60.0);
    shoot(180.0, "bullet", bullets, &broken);
    assert_int_equal(bullets[DAMAGE_NONE], 60);
}

/* A shell along the side of a tank strikes it at 8 degrees. */
static void test_a_shell_along_the_side_breaks_up(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "world = { seed = 7; capacity = 64; }; collision = { shape = \"model\"; };");
    uint32_t tank = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                            .at = {25000.0, 100.0, 25000.0},
                                                            .behaviour = BEHAVIOUR_IDLE});
    /* Heading north; its right side is at x + 1.85. */
    fixture_put(&f, (struct fixture_entity){.kind = "shell",
                                            .at = {25000.0 + 1.85 + 20.0 * 0.14, 100.9, 25020.0},
                                            .velocity = {-1500.0 * 0.14, 0.0, -1480.0}});
    fixture_run(&f, 2);
    const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
    assert_non_null(event);
    assert_int_equal(event->detonation.struck, STRUCK_VEHICLE);
    assert_true(event->detonation.explosive_kg == 0.0f);
    assert_int_equal(event->detonation.struck_party.damage, DAMAGE_NONE);
    assert_int_equal(steps_rows(&f).row[tank].damage, DAMAGE_NONE);
    assert_true(steps_rows(&f).row[tank].harm_j == 0.0);
    fixture_close(&f);
}

/* --- hit rates ---------------------------------------------------------------------------------*/

static void test_hit_rates_by_dispersion(void **state)
{
    static const double rates[2][3] = {{0.96, 0.56, 0.31}, {0.56, 0.19, 0.09}};
    enum { SHOTS = 1500 };
    static double off[SHOTS][2];
    (void)state;
    for (int moving = 0; moving < 2; moving++) {
        struct fixture f;
        struct step_context step;
        struct serial_context context;
        fixture_open(&f, "world = { seed = 1; capacity = 2048; };");
        uint32_t tank = fixture_put(
            &f, (struct fixture_entity){
                    .kind = "tank",
                    .at = {25000.0, 5000.0, 25000.0},
                    .velocity = {0.0, 0.0, moving ? -steps_kind(&f, "tank")->max_speed_mps : 0.0}});
        steps_rows(&f).row[tank].rounds = SHOTS;
        steps_serial_context(&f, &step, &context);
        for (uint32_t n = 0; n < SHOTS; n++) {
            assert_true(fire_shoot(&context, tank, SLOT_NONE, KIND_NONE));
            off[n][0] = maths_wrap_half(f.view.m.entities.row[n + 1].heading);
            off[n][1] = f.view.m.entities.row[n + 1].pitch;
        }
        for (int km = 1; km <= 3; km++) {
            int hits = 0;
            for (int n = 0; n < SHOTS; n++)
                hits +=
                    fabs(off[n][0]) * km * 1000.0 < 1.15 && fabs(off[n][1]) * km * 1000.0 < 1.15;
            char what[64];
            (void)snprintf(what, sizeof what, "2.3 m square at %d km, %s", km,
                           moving ? "moving" : "halted");
            double real = rates[moving][km - 1];
            expect_share(what, real - 0.04, real + 0.04, (double)hits / SHOTS);
        }
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_penetration_by_range_and_aspect),
        cmocka_unit_test(test_the_struck_side_is_the_one_that_the_round_comes_from),
        cmocka_unit_test(test_rounds_glance_off_at_72_degrees_and_charges_do_not),
        cmocka_unit_test(test_thin_skins_and_rounds_without_a_figure_have_no_rule),
        cmocka_unit_test(test_effects_behind_armour),
        cmocka_unit_test(test_shells_in_a_world),
        cmocka_unit_test(test_a_shell_along_the_side_breaks_up),
        cmocka_unit_test(test_hit_rates_by_dispersion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
