/* The schema: its words are the world's, and docs/scenario.md says of every key what it does. */
#include "config/schema.h"
#include "world/entity.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#define DOCUMENT "docs/scenario.md"

/* The schema's words are the world's own. */
static void check_words(const struct key_table *table, const char *key,
                        const char *(*name_of)(uint32_t))
{
    const struct key *row = &table->keys[keys_find(table, key)];

    for (const struct key_choice *choice = row->choices; choice->name != NULL; choice++) {
        if (choice->built)
            assert_string_equal(choice->name, name_of(choice->value));
    }
}

static const char *force_word(uint32_t v)
{
    return force_name((enum force)v);
}
static const char *behaviour_word(uint32_t v)
{
    return behaviour_name((enum behaviour)v);
}
static const char *domain_word(uint32_t v)
{
    return domain_name((enum domain)v);
}
static const char *class_word(uint32_t v)
{
    return object_class_name((enum object_class)v);
}
static const char *method_word(uint32_t v)
{
    return method_name((enum method)v);
}
static const char *shape_word(uint32_t v)
{
    return shape_name((enum shape)v);
}
static const char *response_word(uint32_t v)
{
    return response_model_name((enum response_model)v);
}
static const char *view_word(uint32_t v)
{
    uint32_t view = 0;
    if (v == (1u << VIEW_CHASE | 1u << VIEW_MAP))
        return "both";
    while (v != 1u << view)
        assert_true(++view < VIEW_COUNT);
    return view_mode_name((enum view_mode)view);
}
static const char *back_end_word(uint32_t v)
{
    return back_end_name((enum back_end)v);
}

static void test_words_are_the_worlds(void **state)
{
    (void)state;
    check_words(&schema_vehicle, "force", force_word);
    check_words(&schema_vehicle, "behaviour", behaviour_word);
    check_words(&schema_kind, "domain", domain_word);
    check_words(&schema_kind, "class", class_word);
    check_words(&schema_scenario, "collision.method", method_word);
    check_words(&schema_scenario, "collision.shape", shape_word);
    check_words(&schema_scenario, "collision.response", response_word);
    check_words(&schema_scenario, "renderer.view", view_word);
    check_words(&schema_scenario, "renderer.backend", back_end_word);
}

/* --- the document ------------------------------------------------------------------------------
 */

static char *read_document(void)
{
    FILE *file = fopen(DOCUMENT, "r");
    char *text = calloc(1, 65536);

    assert_non_null(file);
    assert_non_null(text);
    size_t bytes = fread(text, 1, 65535, file);
    assert_true(bytes > 0 && bytes < 65535);
    fclose(file);
    return text;
}

/* Copies cell number column of a table's row, without blanks around it and backticks in it. */
static void copy_cell(const char *row, int column, char *cell, size_t bytes)
{
    size_t used = 0;

    for (int i = 0; i <= column && row != NULL; i++)
        row = strchr(row + (i > 0), '|');
    cell[0] = '\0';
    if (row == NULL)
        return;
    for (row++; *row != '|' && *row != '\n' && *row != '\0' && used + 1 < bytes; row++) {
        if (*row != '`' && (used > 0 || *row != ' '))
            cell[used++] = *row;
    }
    while (used > 0 && cell[used - 1] == ' ')
        used--;
    cell[used] = '\0';
}

static void check_documented(const char *document, const char *prefix, const struct key *key)
{
    char begin[160], cell[256], allowed[256];

    snprintf(begin, sizeof(begin), "\n| `%s%s` |", prefix, key->name);
    const char *row = strstr(document, begin);
    if (row == NULL)
        fail_msg("%s says nothing of %s%s", DOCUMENT, prefix, key->name);
    copy_cell(row + 1, 1, cell, sizeof(cell));
    assert_string_equal(cell, key_type_name(key->type));
    copy_cell(row + 1, 2, cell, sizeof(cell));
    keys_allowed(key, allowed, sizeof(allowed));
    assert_string_equal(cell, allowed);
    copy_cell(row + 1, 3, cell, sizeof(cell));
    if (key->fallback != NULL)
        assert_string_equal(cell, key->fallback);
    else if (key->required)
        assert_string_equal(cell, "required");
    else
        assert_true(cell[0] != '\0');
    copy_cell(row + 1, 4, cell, sizeof(cell));
    assert_true(cell[0] != '\0');
    /* And some example gives it a value. */
    const char *last = strrchr(key->name, '.');
    const char *name = last != NULL ? last + 1 : key->name;
    bool shown = false;
    for (const char *at = strstr(document, name); at != NULL && !shown; at = strstr(at + 1, name)) {
        const char *after = at + strlen(name);

        shown = (at[-1] == ' ' || at[-1] == '`' || at[-1] == '{') &&
                strncmp(after + strspn(after, " "), "= ", 2) == 0;
    }
    if (!shown)
        fail_msg("%s has no example of %s%s", DOCUMENT, prefix, key->name);
}

static const struct {
    const struct key_table *table;
    const char *prefix;
} documented[] = {
    {&schema_scenario, ""},         {&schema_vehicle, "vehicles[]."},
    {&schema_object, "objects[]."}, {&schema_script, "scripts[]."},
    {&schema_step, "steps[]."},     {&schema_base, "bases[]."},
    {&schema_fire, "fires[]."},     {&schema_kind, ""},
};

static void test_document_has_every_key(void **state)
{
    char *document = read_document();

    (void)state;
    for (size_t t = 0; t < COUNT(documented); t++) {
        for (uint32_t i = 0; i < documented[t].table->count; i++)
            check_documented(document, documented[t].prefix, &documented[t].table->keys[i]);
    }
    free(document);
}

static void test_document_has_no_other_key(void **state)
{
    char *document = read_document();

    (void)state;
    for (const char *row = strstr(document, "\n| `"); row != NULL; row = strstr(row + 1, "\n| `")) {
        char name[128], type[64];
        bool known = false, typed = false;

        copy_cell(row + 1, 0, name, sizeof(name));
        copy_cell(row + 1, 1, type, sizeof(type));
        for (int i = 0; i < KEY_TYPE_COUNT; i++)
            typed |= strcmp(type, key_type_name((enum key_type)i)) == 0;
        if (!typed) /* a row of another table, such as that of behaviours */
            continue;
        for (size_t t = 0; t < COUNT(documented); t++) {
            size_t length = strlen(documented[t].prefix);

            known |= strncmp(name, documented[t].prefix, length) == 0 &&
                     keys_find(documented[t].table, name + length) >= 0;
        }
        if (!known)
            fail_msg("%s describes %s, which is no key", DOCUMENT, name);
    }
    free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_words_are_the_worlds),
        cmocka_unit_test(test_document_has_every_key),
        cmocka_unit_test(test_document_has_no_other_key),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
