/* The schema: its choices have words, and docs/scenario.md is made of its rows. */
#include "config/syntax/schema.h"
#include "docs/keys/key_tables.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/param_values.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#define DOCUMENT     "docs/scenario.md"
#define DOCUMENT_MAX 262144 /* [byte] */

static const struct key_table *const tables[] = {
    &schema_scenario, &schema_vehicle, &schema_object,    &schema_script,
    &schema_step,     &schema_base,    &schema_objective, &schema_mission,
    &schema_phase,    &schema_fire,    &schema_kind,      &schema_earthwork};

/* Every choice has a word of its own. */
static void test_choices_have_words(void **state)
{
    (void)state;
    for (size_t t = 0; t < COUNT(tables); t++) {
        for (uint32_t i = 0; i < tables[t]->count; i++) {
            const struct key *key = &tables[t]->keys[i];

            for (uint32_t n = 0; n < key->choice_count; n++) {
                assert_string_not_equal(key_table_choice(key, n).name, "?");
                for (uint32_t m = 0; m < n; m++)
                    assert_string_not_equal(key_table_choice(key, m).name,
                                            key_table_choice(key, n).name);
            }
        }
    }
}

/* --- the document ------------------------------------------------------------------------------*/

static char *read_document(void)
{
    FILE *file = fopen(DOCUMENT, "r");
    char *text = calloc(1, DOCUMENT_MAX);

    assert_non_null(file);
    assert_non_null(text);
    size_t bytes = fread(text, 1, DOCUMENT_MAX - 1, file);
    assert_true(bytes > 0 && bytes < DOCUMENT_MAX - 1);
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

/* Returns true if the text sets the key somewhere: "name = ". */
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
        cmocka_unit_test(test_choices_have_words),
        cmocka_unit_test(test_document_is_made_of_the_schema),
        cmocka_unit_test(test_document_has_examples),
        cmocka_unit_test(test_tables_of_a_document_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
