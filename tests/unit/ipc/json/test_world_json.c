/* Events as JSON, as the event log has them. */
#include "ipc/json/world_json.h"

#include "tests/support/fixture.h"
#include "world/entity/event.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void check(const struct world *world, struct event event, const char *text)
{
    cJSON *object = json_event(world, &event);
    char *written = cJSON_PrintUnformatted(object);
    assert_string_equal(written, text);
    cJSON_free(written);
    cJSON_Delete(object);
}

static void test_the_end_of_a_contact(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    const struct event end = {
        .frame = 150,
        .tick = 120,
        .index = 3,
        .type = EVENT_CONTACT_END,
        .contact_end = {.a = {.id = 12, .kind = fixture_kind(&f, "tank")},
                        .b = {.id = 7, .kind = fixture_kind(&f, "tree"), .fixed = 1},
                        .lasted_s = 1.5,
                        .impacts = 2,
                        .impulse_ns = 2.5f,
                        .because = CONTACT_END_GONE}};
    check(&f.view.world, end,
          "{\"frame\":150,\"index\":3,\"time_s\":2,\"type\":\"contact_end\","
          "\"a\":{\"id\":12,\"kind\":\"tank\",\"fixed\":false},"
          "\"b\":{\"id\":7,\"kind\":\"tree\",\"fixed\":true},\"lasted_s\":1.5,"
          "\"impacts\":2,\"impulse_ns\":2.5,\"because\":\"gone\"}");
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_end_of_a_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
