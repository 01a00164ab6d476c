/* Lines of the log: one a second over all subjects, which take turns. */
#include "gateway/notices.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

struct subject {
    unsigned news, told;
};

static bool tell(void *subject, uint64_t now_ns)
{
    struct subject *self = subject;
    (void)now_ns;
    if (self->news == 0)
        return false;
    self->news = 0;
    self->told++;
    return true;
}

static void test_a_line_a_second(void **state)
{
    struct subject subjects[4] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    struct notices notices = {0};
    uint64_t now_ns = 5000000000u;
    (void)state;
    for (unsigned i = 0; i < 4; i++)
        notices_add(&notices, tell, &subjects[i]);
    for (unsigned i = 0; i < 10000;
         i++) { /* 10 s, and three subjects that have news all the time */
        subjects[0].news++;
        subjects[1].news++;
        subjects[3].news++;
        notices_tell(&notices, now_ns);
        now_ns += 1000000u;
    }
    assert_int_equal(subjects[0].told + subjects[1].told + subjects[3].told, 10);
    assert_in_range(subjects[0].told, 3, 4);
    assert_in_range(subjects[1].told, 3, 4);
    assert_in_range(subjects[3].told, 3, 4);
    assert_int_equal(subjects[2].told, 0);
}

static void test_news_are_told_at_once(void **state)
{
    struct subject subjects[2] = {{0, 0}, {0, 0}};
    struct notices notices = {0};
    (void)state;
    notices_add(&notices, tell, &subjects[0]);
    notices_add(&notices, tell, &subjects[1]);
    notices_tell(&notices, 1);
    subjects[1].news = 1;
    notices_tell(&notices, 2);
    assert_int_equal(subjects[1].told, 1);
    subjects[0].news = 1;
    notices_tell(&notices, 3);
    assert_int_equal(subjects[0].told, 0);
    notices_tell(&notices, 2 + NOTICES_EVERY); /* it waits, and is not forgotten */
    assert_int_equal(subjects[0].told, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_line_a_second),
        cmocka_unit_test(test_news_are_told_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
