/* The lists of contacts in dumps. */
#include "supervisor/worldctl/contact_chains.h"

#include "world/entity/persistent_contact.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct persistent_contact contacts[] = {
    {1, 2, 0, 1, 5, 9, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
    {1, 4, 0, 3, 6, 8, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
    {2, 4, 1, 3, 7, 7, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
    {2, PERSISTENT_CONTACT_FIXED | 6, 1, SLOT_NONE, 4, 9, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}},
};

static void check(const struct contact_chains *chains, uint32_t row, const char *text)
{
    cJSON *object = cJSON_CreateObject();
    contact_chains_json(object, chains, row);
    char *written = cJSON_PrintUnformatted(object);
    assert_string_equal(written, text);
    cJSON_free(written);
    cJSON_Delete(object);
}

static void test_each_entity_has_its_contacts(void **state)
{
    const struct snapshot snapshot = {.head = {.used = 4, .contact_count = 4},
                                      .contacts = contacts};
    struct contact_chains chains;
    (void)state;
    assert_int_equal(contact_chains_make(&chains, &snapshot), 0);
    check(&chains, 0,
          "{\"contacts\":[{\"id\":2,\"fixed\":false,\"begin_tick\":5,\"pressed_tick\":9},"
          "{\"id\":4,\"fixed\":false,\"begin_tick\":6,\"pressed_tick\":8}]}");
    check(&chains, 1,
          "{\"contacts\":[{\"id\":1,\"fixed\":false,\"begin_tick\":5,\"pressed_tick\":9},"
          "{\"id\":4,\"fixed\":false,\"begin_tick\":7,\"pressed_tick\":7},"
          "{\"id\":7,\"fixed\":true,\"begin_tick\":4,\"pressed_tick\":9}]}");
    check(&chains, 2, "{\"contacts\":[]}");
    check(&chains, 3,
          "{\"contacts\":[{\"id\":1,\"fixed\":false,\"begin_tick\":6,\"pressed_tick\":8},"
          "{\"id\":2,\"fixed\":false,\"begin_tick\":7,\"pressed_tick\":7}]}");
    contact_chains_free(&chains);
}

static void test_no_contacts_are_an_empty_list(void **state)
{
    const struct snapshot snapshot = {.head = {.used = 1}};
    struct contact_chains chains;
    (void)state;
    assert_int_equal(contact_chains_make(&chains, &snapshot), 0);
    check(&chains, 0, "{\"contacts\":[]}");
    contact_chains_free(&chains);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_entity_has_its_contacts),
        cmocka_unit_test(test_no_contacts_are_an_empty_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
