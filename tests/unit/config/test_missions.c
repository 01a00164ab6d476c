/* Missions, phases, reactions and objectives: what is read, what is refused, and the example of
 * docs/scenario.md. */
#include "config/missions.h"

#include "config/loader.h"
#include "tests/support/quick_config.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/runtime/error_text.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static struct error_text error;

#define WORLD                                                                                      \
    "terrain = { source = \"flat\"; };\n"                                                          \
    "objectives = ( { name = \"hill\"; area = [100.0, 200.0, 300.0, 400.0]; force = \"red\"; } );" \
    "vehicles = ( { name = \"lead\"; kind = \"tank\"; count = 4; force = \"blue\"; },"             \
    "{ kind = \"jet\"; count = 2; group = \"air\"; force = \"blue\"; },"                           \
    "{ name = \"mixed\"; kind = \"jeep\"; force = \"blue\"; },"                                    \
    "{ name = \"mixed-red\"; kind = \"jeep\"; force = \"red\"; } );\n"
#define PHASES(list) WORLD "missions = ( { name = \"lead\"; phases = (\n" list " ); } );"
#define REACTIONS(list)                                                                            \
    WORLD "missions = ( { name = \"lead\"; phases = ( { name = \"a\"; order = \"hold\"; } ); "     \
          "reactions = (\n" list " ); } );"
#define AIR(list)                                                                                  \
    WORLD "missions = ( { name = \"m\"; vehicles = \"air\"; phases = (\n" list " ); } );"
#define P0 "missions[0].phases[0]."

static const struct {
    const char *text;
    int line;
    const char *says; /* the beginning of the message after "file:line: " */
} refusals[] = {
    {PHASES("{ name = \"a\"; order = \"retreat\"; }"), 4,
     P0 "order = \"retreat\": unknown; allowed: hold, reserve, move, bound"},
    {PHASES("{ name = \"a\"; }"), 4, P0 "order: is missing"},
    {PHASES("{ order = \"hold\"; }"), 4, P0 "name: is missing"},
    {PHASES("{ name = \"a\"; order = \"hold\"; }, { name = \"b\"; order = \"hold\"; }"), 4,
     P0 "for_s: is missing, and so is any other condition; a phase needs one unless it is the "
        "last"},
    {PHASES(
         "{ name = \"a\"; order = \"hold\"; for_s = 1.0; }, { name = \"a\"; order = \"hold\"; }"),
     4, "missions[0].phases[1].name = \"a\": is also the name of another phase"},
    {PHASES("{ name = \"a\"; order = \"hold\"; when_below = 0.5; }"), 4,
     P0 "when_below = 0.5: is only for reactions; allowed: for_s, until_s"},
    {PHASES("{ name = \"a\"; order = \"hold\"; taken = \"hull\"; }"), 4,
     P0 "taken = \"hull\": is not the name of an objective; allowed: a name of objectives"},
    {PHASES("{ name = \"a\"; order = \"hold\"; after = \"lead\"; }"), 4,
     P0 "after = \"lead\": is no phase; allowed: \"mission.phase\""},
    {PHASES("{ name = \"a\"; order = \"hold\"; after = \"lead.b\"; }"), 4,
     P0 "after = \"lead.b\": is no phase; allowed: \"mission.phase\""},
    {PHASES("{ name = \"a\"; order = \"hold\"; after = \"lead.a\"; }, { name = \"b\"; order = "
            "\"hold\"; }"),
     4, P0 "after = \"lead.a\": is this phase, or one that comes after it, and so never ends"},
    {PHASES("{ name = \"a\"; order = \"hold\"; for_s = 1.0; after = \"lead.b\"; }, { name = \"b\"; "
            "order = \"hold\"; }"),
     4, P0 "after = \"lead.b\": is this phase, or one that comes after it, and so never ends"},
    {REACTIONS("{ name = \"b\"; order = \"hold\"; for_s = 5.0; when_after = \"lead.none\"; }"), 4,
     "missions[0].reactions[0].when_after = \"lead.none\": is no phase; allowed: "},
    {PHASES("{ name = \"a\"; order = \"hold\"; for_s = 1.0; not = \"for_s taken\"; }"), 4,
     P0 "not = \"for_s taken\": does not name conditions of this phase; allowed: the names"},
    {PHASES("{ name = \"a\"; order = \"hold\"; for_s = 1.0; not = \"for\"; }"), 4,
     P0 "not = \"for\": does not name conditions of this phase; allowed: the names"},
    {PHASES("{ name = \"a\"; order = \"hold\"; for_s = 1.0; when_all = true; }"), 4,
     P0 "when_all = true: is only for reactions; allowed: for_s, until_s"},
    {PHASES("{ name = \"a\"; order = \"hold\"; below = 1.5; }"), 4,
     P0 "below = 1.5: out of range; allowed: 0.01..1"},
    {PHASES("{ name = \"a\"; order = \"move\"; }"), 4,
     P0 "to: is missing; this order needs to, a route, an area or an objective"},
    {PHASES("{ name = \"a\"; order = \"attack\"; to = [1.0, 2.0]; }"), 4,
     P0 "area: is missing; this order needs an area or an objective"},
    {PHASES("{ name = \"a\"; order = \"hold\"; to = [1.0, 2.0]; }"), 4,
     P0 "to = [1, 2]: is not for this order; allowed: move, bound, attack"},
    {PHASES("{ name = \"a\"; order = \"move\"; to = [1.0, 2.0]; route = ( [1.0, 2.0], [3.0, 4.0] "
            "); }"),
     4, P0 "to = [1, 2]: stands beside route; allowed: one of the two"},
    {PHASES(
         "{ name = \"a\"; order = \"patrol\"; objective = \"hill\"; area = [1.0, 2.0, 3.0, 4.0]; "
         "}"),
     4, P0 "objective = \"hill\": stands beside area; allowed: one of the two"},
    {PHASES("{ name = \"a\"; order = \"move\"; to = [1.0, 2.0]; roads = true; }"), 4,
     P0 "roads = true: needs a route"},
    {PHASES("{ name = \"a\"; order = \"move\"; to = [1.0, 2.0]; bound_s = 20.0; }"), 4,
     P0 "bound_s = 20: is only for bound; allowed: none here"},
    {PHASES("{ name = \"a\"; order = \"hold\"; munition = \"artillery\"; }"), 4,
     P0 "munition = \"artillery\": is only for barrage; allowed: none here"},
    {PHASES("{ name = \"a\"; order = \"barrage\"; objective = \"hill\"; munition = \"tank\"; }"), 4,
     P0
     "munition = \"tank\": is not a kind for this list; allowed: anti-tank-missile, artillery, "},
    {PHASES(""), 3, "missions[0]: has no phases; right would be: phases = ("},
    {AIR("{ name = \"a\"; order = \"hold\"; }"), 4,
     P0 "order = \"hold\": is not for aircraft that cannot hover; right would be: patrol"},
    {REACTIONS("{ name = \"b\"; order = \"hold\"; for_s = 5.0; }"), 4,
     "missions[0].reactions[0].when_below: is missing, and so is any other condition; a reaction "
     "needs one of the keys that begin with when_"},
    {WORLD "missions = (\n{ name = \"a\"; vehicles = \"none\"; phases = ( { name = \"a\"; order = "
           "\"hold\"; } ); } );",
     4,
     "missions[0].vehicles = \"none\": is neither a group of vehicles nor the beginning of a "
     "name"},
    {WORLD "missions = (\n{ name = \"mixed\"; phases = ( { name = \"a\"; order = \"hold\"; } ); } "
           ");",
     4, "missions[0].vehicles: has vehicles of two forces; allowed: of one force"},
    {WORLD
     "missions = ( { name = \"lead\"; phases = ( { name = \"a\"; order = \"hold\"; } ); },\n{ "
     "name = \"b\"; vehicles = \"lead\"; phases = ( { name = \"a\"; order = \"hold\"; } ); } "
     ");",
     4,
     "missions[1].vehicles = \"lead\": has vehicles of the mission \"lead\"; allowed: each "
     "vehicle in one mission"},
    {WORLD "missions = (\n{ name = \"g\"; off_map = true; phases = ( { name = \"a\"; order = "
           "\"move\"; to = [1.0, 2.0]; } ); } );",
     4, "missions[0].phases[0].order = \"move\": needs vehicles, and the mission is off the map"},
    {WORLD "missions = (\n{ name = \"g\"; off_map = true; force = \"green\"; phases = ( { name = "
           "\"a\"; order = \"hold\"; } ); } );",
     4, "missions[0].force = \"green\": "},
    {"objectives = (\n{ name = \"a\"; area = [3.0, 2.0, 1.0, 4.0]; } );", 2,
     "objectives[0].area = "},
    {"objectives = ( { name = \"a\"; area = [1.0, 2.0, 3.0, 4.0]; },\n{ name = \"a\"; area = [1.0, "
     "2.0, 3.0, 4.0]; } );",
     2,
     "objectives[1].name = \"a\": is also the name of another objective; allowed: each name "
     "once"},
    {"battle = {\n end_s = 300.0;\n again_s = 200.0; };", 3,
     "battle.again_s = 200: is not after battle.end_s; allowed: 0, or above 300"},
};

static void test_mistakes_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(refusals); i++) {
        struct scenario scenario;
        char place[128];
        assert_int_equal(quick_config_load(&scenario, refusals[i].text, NULL, &error), -1);
        if (refusals[i].line > 0)
            snprintf(place, sizeof place, "%s:%d: ", quick_config.scenario_path, refusals[i].line);
        else
            snprintf(place, sizeof place, "%s: ", quick_config.scenario_path);
        const char *says = error.text + strlen(place);
        if (strncmp(error.text, place, strlen(place)) != 0 ||
            strncmp(says, refusals[i].says, strlen(refusals[i].says)) != 0)
            fail_msg("says \"%s\" instead of \"%s%s\"", error.text, place, refusals[i].says);
    }
}

/* Orders without an engagement of their own. */
static void test_orders_say_whom_to_fire_at(void **state)
{
    static const struct {
        const char *order;
        uint32_t engage;
    } orders[] = {{"hold", 0},
                  {"reserve", 0},
                  {"move", ENTITY_FLAG_FIRE_AT_WILL},
                  {"bound", ENTITY_FLAG_FIRE_AT_WILL},
                  {"attack", ENTITY_FLAG_FIRE_AT_WILL},
                  {"defend", ENTITY_FLAG_FIRE_AT_WILL},
                  {"withdraw", 0},
                  {"patrol", ENTITY_FLAG_FIRE_AT_WILL},
                  {"strike", ENTITY_FLAG_FIRE_AT_WILL},
                  {"barrage", 0},
                  {"resupply", 0}};
    (void)state;
    assert_int_equal(COUNT(orders), MISSION_ORDER_COUNT);
    for (uint32_t i = 0; i < COUNT(orders); i++) {
        const bool stays =
            strcmp(orders[i].order, "hold") == 0 || strcmp(orders[i].order, "reserve") == 0;
        struct scenario s;
        char text[2048];
        snprintf(text, sizeof text, PHASES("{ name = \"a\"; order = \"%s\"; %s }"), orders[i].order,
                 stays ? "" : "objective = \"hill\";");
        if (quick_config_load(&s, text, NULL, &error) != 0)
            fail_msg("%s", error.text);
        assert_int_equal(s.phases[0].phase.order, i);
        assert_int_equal(s.phases[0].phase.engage, orders[i].engage);
        assert_int_equal(s.phases[0].phase.area == MISSION_NONE, stays);
        scenario_free(&s);
    }
}

static void test_conditions_are_read(void **state)
{
    struct scenario s;
    (void)state;
    if (quick_config_load(
            &s,
            PHASES("{ name = \"a\"; order = \"hold\"; for_s = 1.0; until_s = 2.0; arrived = 0.5; "
                   "taken = \"hill\"; below = 0.25; at_least_s = 3.0; },"
                   "{ name = \"b\"; order = \"hold\"; lost = \"hill\"; enemy_in = \"hill\"; "
                   "after = \"lead.a\"; }"),
            NULL, &error) != 0)
        fail_msg("%s", error.text);
    const struct battle_phase *a = &s.phases[0].phase, *b = &s.phases[1].phase;
    assert_true(a->until.for_s == 1.0 && a->until.at_s == 2.0 && a->until.arrived == 0.5 &&
                a->until.below == 0.25 && a->at_least_s == 3.0);
    assert_int_equal(a->until.taken, 0);
    assert_int_equal(a->until.lost, MISSION_NONE);
    assert_int_equal(a->until.after_mission, MISSION_NONE);
    assert_true(b->until.for_s < 0.0 && b->until.at_s < 0.0);
    assert_int_equal(b->until.lost, 0);
    assert_int_equal(b->until.enemy_in, 0);
    assert_int_equal(b->until.after_mission, 0);
    assert_int_equal(b->until.after_phase, 0);
    assert_int_equal(s.missions[0].mission.force, FORCE_BLUE);
    scenario_free(&s);
}

/* --- the document ------------------------------------------------------------------------------*/

#define DOCUMENT_MAX 262144 /* [byte] */

static char *read_example(void)
{
    char *text = calloc(1, DOCUMENT_MAX);
    FILE *file = fopen("docs/scenario.md", "r");
    assert_non_null(text);
    assert_non_null(file);
    assert_true(fread(text, 1, DOCUMENT_MAX - 1, file) < DOCUMENT_MAX - 1);
    fclose(file);
    char *begin = strstr(text, "<!-- example of missions -->");
    assert_non_null(begin);
    begin = strchr(begin, '\n');
    char *end = strstr(begin, "<!-- end of example -->");
    assert_non_null(end);
    *end = '\0';
    char *example = strdup(begin);
    assert_non_null(example);
    free(text);
    return example;
}

static void test_the_example_of_the_document_is_a_scenario(void **state)
{
    char *example = read_example();
    struct scenario s;
    (void)state;
    if (quick_config_load(&s, example, NULL, &error) != 0)
        fail_msg("%s", error.text);
    assert_int_equal(s.mission_count, 3);
    assert_int_equal(s.objective_count, 1);
    assert_int_equal(s.phase_count, 15);
    scenario_free(&s);
    free(example);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mistakes_are_refused),
        cmocka_unit_test(test_orders_say_whom_to_fire_at),
        cmocka_unit_test(test_conditions_are_read),
        cmocka_unit_test(test_the_example_of_the_document_is_a_scenario),
    };
    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
