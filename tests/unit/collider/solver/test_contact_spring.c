/* The temporary spring against one that is stepped through time: row 43. */
#include "collider/solver/contact_spring.h"

#include "world/maths/maths.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include <cmocka.h>

static bool near(double value, double right, double relative)
{
    return fabs(value - right) <= relative * fabs(right);
}

/* The same spring by small steps (velocity Verlet): the given stiffness in compression; in the
 * rebound stiffer by the square of restitution, with the dent that this leaves; it ends when it no
 * longer pushes. */
static struct contact_spring_impact stepped(const struct contact_spring *s)
{
    struct contact_spring_impact spring = {0};
    double back = s->stiffness_npm / (s->restitution * s->restitution);
    double dt = 1e-4 * sqrt(s->reduced_kg / back);
    double depth = 0.0, speed = s->closing_mps, force = 0.0;
    do {
        depth += dt * (speed - 0.5 * dt * force / s->reduced_kg);
        spring.depth_m = maths_max(spring.depth_m, depth);
        double before = force;
        force = speed > 0.0 ? s->stiffness_npm * depth
                            : s->stiffness_npm * spring.depth_m - back * (spring.depth_m - depth);
        speed -= 0.5 * dt * (before + force) / s->reduced_kg;
        spring.force_n = maths_max(spring.force_n, force);
        spring.impulse_ns += 0.5 * dt * (before + force);
        spring.duration_s += dt;
    } while (force > 0.0);
    spring.left_m = depth;
    return spring;
}

static void test_row_43_it_agrees_with_a_stepped_spring(void **state)
{
    static const double restitutions[] = {0.1, 0.4, 0.8, 1.0};
    (void)state;
    for (size_t n = 0; n < 4; n++) {
        const struct contact_spring s = {1078.0, 6.0, 2.0e6, restitutions[n]};
        struct contact_spring_impact spring = contact_spring_impact(&s), slow = stepped(&s);
        assert_true(near(spring.impulse_ns, slow.impulse_ns, 1e-3));
        assert_true(near(spring.depth_m, slow.depth_m, 1e-3));
        assert_true(near(spring.force_n, slow.force_n, 1e-3));
        assert_true(near(spring.duration_s, slow.duration_s, 1e-3));
        assert_true(fabs(spring.left_m - slow.left_m) < 1e-3 * spring.depth_m);
    }
}

/* Two bodies that get the impulse keep their momentum and part at restitution times the speed. */
static void test_row_43_momentum_is_kept_and_restitution_comes_back(void **state)
{
    (void)state;
    for (double e = 0.0; e <= 1.0; e += 0.125) {
        double ma = 57000.0, mb = 1100.0, va = 6.0, vb = -4.0;
        const struct contact_spring s = {ma * mb / (ma + mb), va - vb, 5e6, e};
        double impulse = contact_spring_impact(&s).impulse_ns;
        double va_after = va - impulse / ma, vb_after = vb + impulse / mb;
        assert_true(fabs(ma * va_after + mb * vb_after - (ma * va + mb * vb)) < 1e-9 * ma * va);
        assert_true(fabs(vb_after - va_after - e * (va - vb)) < 1e-9);
    }
}

static void test_half_a_period_when_all_comes_back(void **state)
{
    const struct contact_spring s = {100.0, 3.0, 4e4, 1.0};
    struct contact_spring_impact spring = contact_spring_impact(&s);
    (void)state;
    assert_true(near(spring.duration_s, PI * 0.05, 1e-12)); /* 20 radians a second */
    assert_true(near(spring.depth_m, 0.15, 1e-12) && spring.left_m == 0.0);
}

static void test_nothing_is_returned_without_restitution(void **state)
{
    const struct contact_spring s = {100.0, 3.0, 4e4, 0.0};
    struct contact_spring_impact spring = contact_spring_impact(&s);
    (void)state;
    assert_true(near(spring.impulse_ns, 300.0, 1e-12));
    assert_true(near(spring.duration_s, HALF_PI * 0.05, 1e-12));
    assert_true(spring.left_m == spring.depth_m);
}

static void test_row_26_the_stiffer_the_shorter_shallower_and_harder(void **state)
{
    struct contact_spring_impact last = {0};
    (void)state;
    for (double stiffness = 1e4; stiffness < 1e9; stiffness *= 3.0) {
        const struct contact_spring s = {1000.0, 5.0, stiffness, 0.3};
        struct contact_spring_impact spring = contact_spring_impact(&s);
        if (last.depth_m > 0.0) {
            assert_true(spring.duration_s < last.duration_s && spring.depth_m < last.depth_m);
            assert_true(spring.force_n > last.force_n);
            assert_true(near(spring.impulse_ns, last.impulse_ns, 1e-12));
        }
        last = spring;
    }
}

static void test_two_skins_are_softer_than_either(void **state)
{
    (void)state;
    assert_true(near(contact_spring_in_series(3e6, 6e6), 2e6, 1e-12));
    assert_true(contact_spring_in_series(3e6, 6e6) == contact_spring_in_series(6e6, 3e6));
    assert_true(near(contact_spring_in_series(1e3, 1e12), 1e3, 1e-8)); /* the soft one gives way */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_43_it_agrees_with_a_stepped_spring),
        cmocka_unit_test(test_row_43_momentum_is_kept_and_restitution_comes_back),
        cmocka_unit_test(test_half_a_period_when_all_comes_back),
        cmocka_unit_test(test_nothing_is_returned_without_restitution),
        cmocka_unit_test(test_row_26_the_stiffer_the_shorter_shallower_and_harder),
        cmocka_unit_test(test_two_skins_are_softer_than_either),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
