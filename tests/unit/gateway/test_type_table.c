/* The table of types: which row holds, the shipped file, and each refusal. */
#include "gateway/type_table.h"

#include "tests/support/fixture.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const struct kind kinds[] = {{.name = "tank", .domain = DOMAIN_LAND},
                                    {.name = "jet", .domain = DOMAIN_AIR},
                                    {.name = "shell", .domain = DOMAIN_MUNITION},
                                    {.name = "tree", .domain = DOMAIN_FIXED}};
static struct type_table table;
static struct error_text error;
static char path[64];

static int read_text(const char *text)
{
    snprintf(path, sizeof path, "/tmp/jolon-types.%d", (int)getpid());
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    int result = type_table_read(&table, path, kinds, 4, &error);
    unlink(path);
    return result;
}

static void assert_row(uint16_t kind, uint8_t force, unsigned country, bool nearest)
{
    const struct type_row *row = type_table_row(&table, kind, force);
    assert_int_equal(row->type.country, country);
    assert_int_equal(row->nearest, nearest);
}

#define DOMAIN_ROWS                                                                                \
    "<land> * 1.1.1.0.0.0.0\n<sea> * 1.3.2.0.0.0.0\n<munition> * 2.9.4.0.0.0.0 1 2\n"

static void test_the_nearest_row_holds(void **state)
{
    (void)state;
    assert_int_equal(read_text("# a comment\n\n" DOMAIN_ROWS "<air> * 1.2.3.0.0.0.0\n"
                               "<air>\tred 1.2.33.0.0.0.0 # of the red force\n"
                               "tank * 1.1.225.1.1.2.0\ntank red 1.1.222.1.2.1.0\n"
                               "unknown * 1.1.9.9.9.9.9\nshell * 2.2.225.2.13.1.0 5000 1000"),
                     0);
    assert_row(0, FORCE_BLUE, 225, false);
    assert_row(0, FORCE_NEUTRAL, 225, false);
    assert_row(0, FORCE_RED, 222, false);
    assert_row(1, FORCE_BLUE, 3, true);
    assert_row(1, FORCE_RED, 33, true);
    assert_int_equal(type_table_row(&table, 2, FORCE_RED)->warhead, 5000);
    assert_int_equal(type_table_row(&table, 2, FORCE_RED)->fuse, 1000);
    assert_row(3, FORCE_RED, 0, false); /* trees do not move */
    assert_row(KIND_NONE, FORCE_RED, 0, false);
    assert_row(0, 77, 0, false);
}

/* A row without a type of Cursor on Target has that of the next that would hold. */
static void test_types_of_cursor_on_target(void **state)
{
    (void)state;
    assert_int_equal(read_text("<land> * 1.1.1.0.0.0.0\n<sea> * 1.3.2.0.0.0.0\n"
                               "<munition> * 2.9.4.0.0.0.0 1 2 A-W\n<air> * 1.2.3.0.0.0.0 A\n"
                               "tank * 1.1.225.1.1.2.0 G-E-V-A-T\ntank red 1.1.222.1.2.1.0\n"
                               "shell * 2.2.225.2.13.1.0 5000 1000\n"),
                     0);
    assert_string_equal(type_table_row(&table, 0, FORCE_BLUE)->cot, "G-E-V-A-T");
    assert_string_equal(type_table_row(&table, 0, FORCE_RED)->cot, "G-E-V-A-T");
    assert_string_equal(type_table_row(&table, 1, FORCE_RED)->cot, "A");
    assert_string_equal(type_table_row(&table, 2, FORCE_RED)->cot, "A-W");
    assert_int_equal(type_table_row(&table, 2, FORCE_RED)->warhead, 5000);
    assert_int_equal(read_text(DOMAIN_ROWS "<air> * 1.2.3.0.0.0.0\n"), 0);
    assert_string_equal(type_table_row(&table, 0, FORCE_RED)->cot, "");
}

static void assert_refused(const char *text, const char *why)
{
    assert_int_equal(read_text(text), -1);
    if (!strstr(error.text, why) || !strstr(error.text, path))
        fail_msg("\"%s\" has no \"%s\"", error.text, why);
}

static void test_refusals(void **state)
{
    (void)state;
    assert_refused("tank *\n", ":1: tank: must be KIND FORCE TYPE");
    assert_refused("\ntank *\n", ":2: tank: must be KIND FORCE TYPE");
    assert_refused("tank * 1.1.1.1.1.1.1 5 6 G 8\n", "must be KIND FORCE TYPE");
    assert_refused("tank * 1.1.1.1.1.1.1 5\n", "Cursor on Target");
    assert_refused("tank * 1.1.1.1.1.1.1 5 6 g\n", "Cursor on Target");
    assert_refused("tank * 1.1.1.1.1.1.1 G--E\n", "Cursor on Target");
    assert_refused("tank * 1.1.1.1.1.1.1 G-E-\n", "Cursor on Target");
    assert_refused("tank * 1.1.1.1.1.1.1 G-<\n", "Cursor on Target");
    assert_refused("tank * 1.1.1.1.1.1.1 G-E-V-A-T-H-E-A-V-Y-X-Y-Z\n", "Cursor on Target");
    assert_refused("tank green 1.1.1.1.1.1.1\n", "blue, red, neutral or *");
    assert_refused("tank * 1.1.1.1.1.1\n", "seven numbers");
    assert_refused("tank in 1.1.1.1.1.1\n", "seven numbers");
    assert_refused("tank in 1.1.1.1.1.1.1 G-E\n", "KIND in TYPE");
    assert_refused("<land> in 1.1.1.1.1.1.1\n", "KIND in TYPE");
    assert_refused("tank * 1.1.1.1.1.1.1.1\n", "seven numbers");
    assert_refused("tank * 1.1.1.1.1.1.256\n", "seven numbers");
    assert_refused("tank * 1.1.65536.1.1.1.1\n", "seven numbers");
    assert_refused("shell * 1.1.1.1.1.1.1 65536 1\n", "warhead and fuse");
    assert_refused("tank * 1.1.1.1.1.1.1\ntank * 1.1.1.1.1.1.1\n", ":2: tank: has a row before");
    assert_refused(DOMAIN_ROWS, "has no row of jet or <air>");
    char line[400];
    memset(line, ' ', sizeof line);
    line[sizeof line - 1] = '\0';
    assert_refused(line, ":1: a line has at most");
    assert_int_equal(type_table_read(&table, "/nonexistent", kinds, 4, &error), -1);
}

static void assert_kind(struct pdu_entity_type type, bool munition, uint16_t kind, bool same)
{
    bool is_same;
    assert_int_equal(type_table_kind(&table, type, munition, &is_same), kind);
    assert_int_equal(is_same, same);
}

static void test_the_nearest_kind(void **state)
{
    (void)state;
    assert_int_equal(read_text(DOMAIN_ROWS "<air> * 1.2.3.0.0.0.0\ntank * 1.1.225.1.1.2.0\n"
                                           "tank red 1.1.222.1.2.1.0\njet * 1.2.225.1.3.3.0\n"
                                           "tank in 1.1.0.7.0.0.0\n"
                                           "shell * 2.2.225.2.13.1.0 1 2\n"),
                     0);
    assert_kind((struct pdu_entity_type){1, 1, 222, 1, 2, 1, 0}, false, 0, true);
    assert_kind((struct pdu_entity_type){1, 1, 222, 1, 2, 1, 5}, false, 0, false);
    assert_kind((struct pdu_entity_type){1, 2, 71, 9, 9, 9, 9}, false, 1, false);
    assert_kind((struct pdu_entity_type){1, 1, 0, 7, 0, 0, 0}, false, 0, true);
    assert_kind((struct pdu_entity_type){1, 3, 2, 0, 0, 0, 0}, false, KIND_NONE, false);
    assert_kind((struct pdu_entity_type){2, 2, 225, 2, 13, 1, 0}, true, 2, true);
    assert_kind((struct pdu_entity_type){2, 2, 225, 2, 13, 1, 0}, false, KIND_NONE, false);
    assert_kind((struct pdu_entity_type){3, 1, 225, 1, 1, 2, 0}, false, KIND_NONE, false);
}

/* Every kind that we ship has a row of its own. */
static void test_the_shipped_table(void **state)
{
    struct fixture fixture;
    char shipped[512];
    (void)state;
    fixture_open(&fixture, "");
    const struct world *world = &fixture.view.world;
    snprintf(shipped, sizeof shipped, "%s/dis/types.txt", fixture_shipped_dir());
    if (type_table_read(&table, shipped, world->kinds, world->counts.kinds, &error) != 0)
        fail_msg("%s", error.text);
    for (uint16_t kind = 0; kind < world->counts.kinds; kind++) {
        if (world->kinds[kind].domain == DOMAIN_FIXED)
            continue;
        for (uint8_t force = 0; force < FORCE_COUNT; force++) {
            const struct type_row *row = type_table_row(&table, kind, force);
            if (!row->given || row->nearest)
                fail_msg("%s has no row of its own", world->kinds[kind].name);
            if (world->kinds[kind].domain == DOMAIN_MUNITION)
                assert_true(row->warhead > 0 && row->fuse > 0);
        }
    }
    /* Types of categories that none of our kinds has, and what the numbers below would suggest. */
    static const struct {
        struct pdu_entity_type type;
        const char *kind;
    } shown[] = {
        {{1, 2, 225, 2, 4, 1, 0}, "jet"}, /* A-10A */
        {{1, 2, 225, 2, 4, 3, 0}, "jet"},         {{1, 2, 225, 4, 2, 1, 0}, "jet"},
        {{1, 2, 225, 40, 1, 1, 0}, "jet"},        {{1, 2, 222, 2, 1, 4, 0}, "jet"},
        {{1, 2, 225, 21, 2, 1, 0}, "helicopter"}, /* UH-60A */
        {{1, 2, 225, 21, 2, 3, 0}, "helicopter"}, {{1, 2, 78, 24, 1, 1, 0}, "helicopter"},
        {{1, 2, 225, 1, 3, 3, 0}, "jet"},         {{1, 2, 225, 20, 1, 1, 0}, "helicopter"},
        {{1, 1, 225, 3, 1, 1, 0}, "carrier"},     {{1, 1, 225, 80, 1, 1, 0}, "jeep"},
        {{1, 1, 78, 5, 0, 0, 0}, "howitzer"},     {{1, 1, 78, 44, 0, 0, 0}, "truck"},
        {{1, 1, 78, 1, 1, 1, 0}, "tank"},         {{1, 3, 78, 6, 1, 0, 0}, "ship"},
    };
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++) {
        bool same;
        uint16_t kind = type_table_kind(&table, shown[i].type, false, &same);
        if (kind == KIND_NONE || strcmp(world->kinds[kind].name, shown[i].kind) != 0)
            fail_msg("type %u of the list is no %s", (unsigned)i, shown[i].kind);
    }
    fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_nearest_row_holds),
        cmocka_unit_test(test_types_of_cursor_on_target),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_the_nearest_kind),
        cmocka_unit_test(test_the_shipped_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
