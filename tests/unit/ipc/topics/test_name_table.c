/* Names of a world and the markings of remote entities: by rising id, no more than there is room
 * for. */
#include "ipc/topics/name_table.h"

#include "tests/support/remotes.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f;

static void test_markings_follow_the_names(void **state)
{
    static const char *const markings[] = {"ABRAMS 1", "", "TWELVE CHARS"};
    struct name_table names = {0};
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; remotes_max = 8; };"
                     "vehicles = ({ kind = \"tank\"; name = \"Padre\"; at = [1000.0, 1000.0]; });");
    for (uint16_t i = 0; i < 3; i++) {
        struct remote_record record =
            remotes_track(&f, remote_id(7, 1, (uint16_t)(1 + i)),
                          (struct vec3){25000.0 + 50.0 * i, FIXTURE_GROUND_M, 25000.0});
        memcpy(record.marking, markings[i], strlen(markings[i]));
        remotes_send(&f, record);
    }
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_true(name_table_read_world(&names, &f.view.world, 1));
    assert_int_equal(names.count, 1);
    assert_true(name_table_add_markings(&names, &e, fixture_state(&f).head->used));
    assert_int_equal(names.count, 3); /* one has no marking */
    assert_string_equal(name_table_of(&names, 1), "Padre");
    assert_string_equal(name_table_of(&names, 2), "ABRAMS 1");
    assert_string_equal(name_table_of(&names, 3), "");
    assert_string_equal(name_table_of(&names, 4), "TWELVE CHARS");
    assert_int_equal(name_table_find(&names, "ABRAMS 1"), 2);
    for (uint32_t i = 1; i < names.count; i++)
        assert_true(names.entry[i - 1].id < names.entry[i].id);
    name_table_close(&names);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_markings_follow_the_names)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
