/* Vehicles that fell trees, poles and houses and drive on through the debris, with random kinds,
 * speeds and sides: what falls, falls away from its striker; no energy and no momentum comes from
 * nowhere; debris comes to rest; and the same again gives the same bits. SEED=n runs another set.
 */
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/terrain/fallen.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define DRIVES 200
#define FRAMES 240

struct drive {
    const char *kind;
    uint32_t object;
    double heading, mps, off_m;
};

struct outcome_of {
    uint64_t hash;
    bool fell, pushed;
};

static struct fixture f;

static double energy(const struct state *now, uint32_t row, double mass)
{
    const struct entities *e = &now->entities;
    const struct kind *kind = &f.view.world.kinds[e->row[row].kind];
    double turning = (kind->length_m * kind->length_m + kind->width_m * kind->width_m) / 12.0;
    double sum = 0.5 * mass *
                 (e->row[row].vx * e->row[row].vx + e->row[row].vz * e->row[row].vz +
                  turning * e->row[row].spin_y * e->row[row].spin_y);
    for (uint32_t i = 0; i < now->head->debris_count; i++) {
        const struct debris *d = &now->head->debris[i];
        double half = (double)d->half_length_m * (double)d->spin_rps;
        sum += 0.5 * (double)d->mass_kg *
               ((double)d->vx * (double)d->vx + (double)d->vz * (double)d->vz + half * half / 3.0);
    }
    return sum;
}

static uint32_t start(const struct drive *drive)
{
    const struct fixed_object *object = &f.view.world.fixed[drive->object];
    double sine = maths_sin(drive->heading), cosine = maths_cos(drive->heading);
    double away = (double)object->radius_m + 8.0, off = drive->off_m;
    steps_empty(&f);
    for (uint32_t i = 0; i < f.view.world.counts.fixed; i++)
        f.view.w[0].fixed_damage[i] = f.view.w[1].fixed_damage[i] = DAMAGE_NONE;
    return fixture_put(
        &f, (struct fixture_entity){.kind = drive->kind,
                                    .at = {object->x - away * sine + off * cosine, 100.0,
                                           object->z + away * cosine + off * sine},
                                    .velocity = {drive->mps * sine, 0.0, -drive->mps * cosine}});
}

static void check_fall(const struct state *now, const struct drive *drive)
{
    const struct fixed_object *object = &f.view.world.fixed[drive->object];
    const struct kind *kind = &f.view.world.kinds[object->kind];
    double x = maths_sin(drive->heading), z = -maths_cos(drive->heading);
    const struct debris *d = debris_find(now->head->debris, now->head->debris_count, drive->object);
    assert_non_null(d);
    if (!fallen_is_trunk(kind))
        return;
    uint8_t stored = now->fixed_damage[drive->object];
    assert_true(stored >= FALLEN_FIRST);
    double heading = fallen_heading(stored);
    assert_true(maths_sin(heading) * x - maths_cos(heading) * z > 0.0);
    assert_true((d->x - object->x) * x + (d->z - object->z) * z > 0.0);
}

static struct outcome_of run(const struct drive *drive)
{
    struct outcome_of outcome = {0};
    uint32_t row = start(drive);
    double mass = steps_kind(&f, drive->kind)->mass_kg, x = 0.0, z = 0.0;
    double before = 0.5 * mass * drive->mps * drive->mps;
    for (int frame = 0; frame < FRAMES; frame++) {
        fixture_run(&f, 1);
        struct state now = fixture_state(&f);
        double after = energy(&now, row, mass);
        assert_true(after <= before * (1.0 + 1e-6) + 1e-3);
        before = after;
        outcome.hash = outcome.hash * 31 + steps_state_hash(&f, &now);
        if (now.head->debris_count == 0)
            continue;
        if (!outcome.fell)
            check_fall(&now, drive);
        const struct debris *d = now.head->debris;
        outcome.pushed |= outcome.fell && d->vx * d->vx + d->vz * d->vz > x * x + z * z;
        outcome.fell = true;
        x = (double)d->vx;
        z = (double)d->vz;
    }
    struct entities e = steps_rows(&f);
    entities_clear(&e, row);
    for (int frame = 0; frame < FRAMES; frame++)
        fixture_run(&f, 1); /* nobody pushes it */
    const struct debris *d = fixture_state(&f).head->debris;
    assert_true(d->vx == 0.0f && d->vz == 0.0f && d->spin_rps == 0.0f);
    return outcome;
}

static void test_debris_falls_away_is_pushed_and_comes_to_rest(void **state)
{
    static const char *const kinds[] = {"jeep", "truck", "tank"};
    uint64_t random = fixture_seed(20261124);
    uint32_t fell = 0, pushed = 0;
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"pole\"; at = [25000.0, 25000.0]; },\n"
                     "            { kind = \"tree\"; at = [26000.0, 25000.0]; },\n"
                     "            { kind = \"building\"; at = [27000.0, 25000.0]; } );\n"
                     "collision = { shape = \"model\"; };");
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++)
        steps_kind(&f, kinds[n])->resistance_j = 1e12;
    for (uint32_t n = 0; n < DRIVES; n++) {
        const struct drive drive = {
            kinds[fixture_random(&random) % 3], (uint32_t)(fixture_random(&random) % 3),
            fixture_uniform(&random, 0.0, TWO_PI), fixture_uniform(&random, 8.0, 25.0),
            fixture_uniform(&random, -1.0, 1.0)};
        const struct outcome_of outcome = run(&drive);
        fell += outcome.fell;
        pushed += outcome.pushed;
        if (n % 20 == 0)
            assert_int_equal(run(&drive).hash, outcome.hash);
    }
    print_message("%u of %u fell, %u were pushed on\n", fell, DRIVES, pushed);
    assert_true(fell > DRIVES / 5 && pushed > DRIVES / 20);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_debris_falls_away_is_pushed_and_comes_to_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
