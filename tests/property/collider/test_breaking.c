/* What breaks, on random masses, speeds and strengths: energy and momentum of vehicle and debris
 * never grow, energy balances, and the outcome is monotone. SEED=n runs another set. */
#include "collider/response/breaking.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define CASES 200000

/* A number from 10^low to 10^high. */
static double draw_power(uint64_t *random, double low, double high)
{
    return pow(10.0, fixture_uniform(random, low, high));
}

static struct breaking_input draw(uint64_t *random)
{
    return (struct breaking_input){
        .striker_kg = draw_power(random, 0.0, 6.0),
        .closing_mps = draw_power(random, -2.0, 2.5),
        .strength_j = fixture_random(random) % 8 == 0 ? 0.0 : draw_power(random, 0.0, 8.0),
        .debris_kg = fixture_random(random) % 8 == 0 ? 0.0 : draw_power(random, 0.0, 6.0)};
}

static void check_balance(const struct breaking_input *in, const struct breaking *b)
{
    double before = 0.5 * in->striker_kg * in->closing_mps * in->closing_mps;
    double after = 0.5 * (in->striker_kg + in->debris_kg) * b->speed_mps * b->speed_mps;
    assert_true(fabs(before - after - b->lost_j) <= 1e-9 * before);
    assert_true(after <= before * (1.0 + 1e-12) && b->lost_j >= in->strength_j);
    double momentum = in->striker_kg * in->closing_mps;
    assert_true((in->striker_kg + in->debris_kg) * b->speed_mps <= momentum * (1.0 + 1e-12));
    assert_true(b->speed_mps >= 0.0 && b->speed_mps <= in->closing_mps);
    assert_true(fabs(momentum - b->impulse_ns - in->striker_kg * b->speed_mps) <= 1e-9 * momentum);
}

/* Returns the speed afterwards; a vehicle that does not break the object is stopped. */
static double speed(struct breaking_input in)
{
    const struct breaking b = breaking_of(&in);
    return b.breaks ? b.speed_mps : 0.0;
}

static void check_monotone(struct breaking_input in)
{
    double here = speed(in), slack = 1e-12 * in.closing_mps;
    struct breaking_input faster = in, heavier = in, stronger = in, more = in;
    faster.closing_mps *= 1.3;
    heavier.striker_kg *= 1.3;
    stronger.strength_j *= 1.3;
    more.debris_kg *= 1.3;
    assert_true(speed(faster) >= here - slack);
    assert_true(speed(faster) / faster.closing_mps >= here / in.closing_mps - 1e-12);
    assert_true(speed(heavier) >= here - slack);
    assert_true(speed(stronger) <= here + slack && speed(more) <= here + slack);
}

static void test_energy_and_momentum_balance_and_the_outcome_is_monotone(void **state)
{
    uint64_t random = fixture_seed(20261123);
    uint32_t broke = 0;
    (void)state;
    for (uint32_t n = 0; n < CASES; n++) {
        const struct breaking_input in = draw(&random);
        const struct breaking b = breaking_of(&in);
        if (b.breaks)
            check_balance(&in, &b);
        else
            assert_true(0.5 * in.striker_kg * in.closing_mps * in.closing_mps < in.strength_j);
        check_monotone(in);
        broke += b.breaks;
    }
    assert_true(broke > CASES / 10 && broke < CASES - CASES / 10);
}

/* --- whole frames ------------------------------------------------------------------------------*/

#define DRIVES 300

/* Drives a vehicle at a tree from a random side. The kinetic energy of the vehicle, spin included,
 * falls by what the event says it lost at least. */
static void test_no_vehicle_gains_from_what_it_breaks(void **state)
{
    uint64_t random = fixture_seed(20261123);
    uint32_t broken = 0;
    struct fixture f;
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"pole\"; at = [25000.0, 25000.0]; } );"
                     "collision = { shape = \"model\"; };");
    steps_kind(&f, "truck")->resistance_j = 1e12;
    for (uint32_t n = 0; n < DRIVES; n++) {
        double heading = fixture_uniform(&random, 0.0, TWO_PI);
        double mps = fixture_uniform(&random, 5.0, 25.0), off = fixture_uniform(&random, -1.5, 1.5);
        double sine = maths_sin(heading), cosine = maths_cos(heading);
        steps_empty(&f);
        f.view.w[0].fixed_damage[0] = f.view.w[1].fixed_damage[0] = DAMAGE_NONE;
        uint32_t row = fixture_put(
            &f, (struct fixture_entity){.kind = "truck",
                                        .at = {25000.0 - 6.0 * sine + off * cosine, 100.0,
                                               25000.0 + 6.0 * cosine + off * sine},
                                        .velocity = {mps * sine, 0.0, -mps * cosine}});
        const struct kind *truck = steps_kind(&f, "truck");
        double turning = (truck->length_m * truck->length_m + truck->width_m * truck->width_m) / 12;
        double before = mps * mps;
        for (int frame = 0; frame < 40; frame++) {
            fixture_run(&f, 1);
            struct entities e = steps_rows(&f);
            double after = e.row[row].vx * e.row[row].vx + e.row[row].vz * e.row[row].vz +
                           turning * e.row[row].spin_y * e.row[row].spin_y;
            assert_true(after <= before * (1.0 + 1e-9));
            before = after;
        }
        broken += fixture_state(&f).fixed_damage[0] >= DAMAGE_HIGH;
    }
    assert_true(broken > DRIVES / 20 && broken < DRIVES);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energy_and_momentum_balance_and_the_outcome_is_monotone),
        cmocka_unit_test(test_no_vehicle_gains_from_what_it_breaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
