/* The schema: its words are the world's, and docs/scenario.md is made of its rows. */
#include "config/syntax/schema.h"
#include "docs/keys/key_tables.h"
#include "world/entity/entity.h"
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
    const struct key *row = &table->keys[key_table_find(table, key)];

    for (const struct key_choice *choice = row->choices; choice->name != NULL; choice++) {
        if (choice->value != KEY_LATER)
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

static void test_document_is_made_of_the_schema(void **state)
{
    char *document = read_document(), *made = NULL, problem[256] = "";
    size_t bytes = 0;
    FILE *to = open_memstream(&made, &bytes);

    (void)state;
    assert_non_null(to);
    int result = key_tables_write(to, document, problem, sizeof(problem));
    assert_int_equal(fclose(to), 0);
    assert_string_equal(problem, "");
    assert_int_equal(result, 0);
    if (strcmp(made, document) != 0)
        fail_msg(DOCUMENT " does not say what the schema says; right would be: make docs");
    free(made);
    free(document);
}

/* Does the text give the key a value somewhere: "name = "? */
static bool has_example(const char *text, const char *name)
{
    for (const char *at = strstr(text, name); at != NULL; at = strstr(at + 1, name)) {
        const char *after = at + strlen(name);

        if ((at[-1] == ' ' || at[-1] == '`' || at[-1] == '{') &&
            strncmp(after + strspn(after, " "), "= ", 2) == 0)
            return true;
    }
    return false;
}

static void test_document_has_examples(void **state)
{
    static const struct key_table *const tables[] = {
        &schema_scenario, &schema_vehicle, &schema_object, &schema_script,
        &schema_step,     &schema_base,    &schema_fire,   &schema_kind};
    char *document = read_document();

    (void)state;
    for (size_t t = 0; t < COUNT(tables); t++) {
        for (uint32_t i = 0; i < tables[t]->count; i++) {
            const char *name = tables[t]->keys[i].name, *dot = strrchr(name, '.');

            if (!has_example(document, dot != NULL ? dot + 1 : name))
                fail_msg("%s has no example of %s", DOCUMENT, name);
        }
    }
    free(document);
}

static void assert_tables_refused(const char *document, const char *says)
{
    char problem[256] = "", *made = NULL;
    size_t bytes = 0;
    FILE *to = open_memstream(&made, &bytes);

    assert_non_null(to);
    assert_int_equal(key_tables_write(to, document, problem, sizeof(problem)), -1);
    assert_int_equal(fclose(to), 0);
    assert_string_equal(problem, says);
    free(made);
}

static void test_tables_of_a_document_are_refused(void **state)
{
    (void)state;
    assert_tables_refused("# Nothing\n", "world.name: is in no table");
    assert_tables_refused("<!-- keys of wrold -->\n<!-- end -->\n",
                          "wrold: is no group, list or kind");
    assert_tables_refused("<!-- keys of world -->\n| key |\n",
                          "world: has no \"<!-- end -->\" behind its table");
    assert_tables_refused("<!-- keys of world -->\n<!-- end -->\n"
                          "<!-- keys of world -->\n<!-- end -->\n",
                          "world.name: is in two tables");
    assert_tables_refused("<!-- words of world.hz -->\n<!-- end -->\n",
                          "world.hz: is no key with allowed words");
    assert_tables_refused("<!-- words of world.pace -->\n<!-- end -->\n",
                          "real: has no meaning in the schema");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_words_are_the_worlds),
        cmocka_unit_test(test_document_is_made_of_the_schema),
        cmocka_unit_test(test_document_has_examples),
        cmocka_unit_test(test_tables_of_a_document_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
