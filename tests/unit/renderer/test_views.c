/* Reading lists of views: valid ones, and the reasons for refusing others. */
#include "renderer/views.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct views views;
static struct error_text error;

static void check_view(uint32_t i, enum view_mode mode, uint32_t vehicle, const char *name)
{
    assert_true(i < views.count);
    assert_int_equal(views.spec[i].mode, mode);
    assert_int_equal(views.spec[i].vehicle, vehicle);
    assert_string_equal(views.spec[i].name, name);
}

static void test_one_and_several(void **state)
{
    (void)state;
    assert_int_equal(views_read(&views, "overhead", &error), 0);
    assert_int_equal(views.count, 1);
    check_view(0, VIEW_OVERHEAD, 0, "overhead");
    assert_int_equal(views_read(&views, "map,inside,chase:4294967295,chase", &error), 0);
    assert_int_equal(views.count, 4);
    check_view(0, VIEW_MAP, 0, "map");
    check_view(1, VIEW_INSIDE, 0, "inside");
    check_view(2, VIEW_CHASE, UINT32_MAX, "chase.4294967295");
    check_view(3, VIEW_CHASE, 0, "chase");
}

static void test_both_is_two(void **state)
{
    (void)state;
    assert_int_equal(views_read(&views, "both:17,orbit", &error), 0);
    assert_int_equal(views.count, 3);
    check_view(0, VIEW_CHASE, 17, "chase.17");
    check_view(1, VIEW_MAP, 17, "map.17");
    check_view(2, VIEW_ORBIT, 0, "orbit");
}

static void test_what_is_wrong_is_said(void **state)
{
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"", "is not one of"},
        {"chas", "chas is not one of chase, map"},
        {"chases", "is not one of"},
        {"chase,,map", "is not one of"},
        {"chase,map,", "is not one of"},
        {"Chase", "is not one of"},
        {"map,chase:", "chase:: after the colon"},
        {"chase:0", "after the colon"},
        {"chase:4294967296", "after the colon"},
        {"chase:18446744073709551617", "after the colon"},
        {"chase:-1", "after the colon"},
        {"chase:1x", "after the colon"},
        {"chase:1:2", "after the colon"},
        {"chase,both", "twice"},
        {"map:3,map:3", "twice"},
        {"map:1,map:2,map:3,map:4,map:5,map:6,map:7,both", "more than 8"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        assert_int_equal(views_read(&views, rows[i].text, &error), -1);
        if (strstr(error.text, rows[i].says) == NULL)
            fail_msg("\"%s\": %s", rows[i].text, error.text);
    }
}

static void test_bits(void **state)
{
    (void)state;
    views_of_bits(&views, 1u << VIEW_FREE | 1u << VIEW_MAP | 1u << VIEW_CHASE);
    assert_int_equal(views.count, 3);
    check_view(0, VIEW_CHASE, 0, "chase");
    check_view(1, VIEW_MAP, 0, "map");
    check_view(2, VIEW_FREE, 0, "free");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_and_several),
        cmocka_unit_test(test_both_is_two),
        cmocka_unit_test(test_what_is_wrong_is_said),
        cmocka_unit_test(test_bits),
    };
    return cmocka_run_group_tests_name("views", tests, NULL, NULL);
}
