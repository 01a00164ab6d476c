/* How dents come back: row 47. */
#include "world/entity/dent.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static void test_row_47_a_dent_comes_back_as_it_should(void **state)
{
    double before = 0.2;
    (void)state;
    assert_true(crush_elastic_left(0.2, 0.0) == 0.2);
    assert_true(fabs(crush_elastic_left(1.0, DENT_RETURN_S) - exp(-1.0)) < 0.002);
    assert_true(crush_elastic_left(1.0, 10.0 * DENT_RETURN_S) < 0.002);
    assert_true(crush_elastic_left(1.0, 1e6) >= 0.0 && crush_elastic_left(1.0, 1e6) < 1e-20);
    for (double age = 0.01; age < 5.0; age += 0.01) {
        double left = crush_elastic_left(0.2, age);
        assert_true(left < before); /* never goes in again */
        assert_true(left >= 0.2 * exp(-age / DENT_RETURN_S));
        before = left;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_47_a_dent_comes_back_as_it_should),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
