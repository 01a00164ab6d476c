/* The text of each type of event. */
#include "world/event_text.h"

#include "world/entity/command.h"
#include "world/entity/entity.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void check(struct event event, const char *first, const char *second, const char *munition,
                  const char *text)
{
    const char *const kind[EVENT_TEXT_PARTIES] = {first, second, munition};
    char written[EVENT_TEXT_MAX];
    event_text(written, &event, kind);
    assert_string_equal(written, text);
}

static void test_each_type_has_its_text(void **state)
{
    (void)state;
    check((struct event){.type = EVENT_NONE}, NULL, NULL, NULL, "");
    check((struct event){.type = EVENT_TYPE_COUNT}, NULL, NULL, NULL, "");
    check((struct event){.type = EVENT_COLLISION,
                         .collision = {.a.id = 12,
                                       .b = {.id = 40211, .fixed = 1},
                                       .closing_mps = 7.25f,
                                       .response = RESPONSE_BOUNCE}},
          "tank", "tree", NULL, "tank 12 hit tree 40211 at 7.2 m/s: bounce");
    check((struct event){.type = EVENT_COLLISION, .collision = {.a.id = 12, .b.fixed = 1}}, "tank",
          "ground", NULL, "tank 12 hit ground at 0.0 m/s: none");
    check((struct event){.type = EVENT_FIRE, .fire = {.shooter.id = 1, .target.id = 2}}, "tank",
          "truck", "shell", "tank 1 fired at truck 2");
    check((struct event){.type = EVENT_FIRE}, "none", "none", "bomb", "the sky fired a bomb");
    check((struct event){.type = EVENT_DETONATION,
                         .detonation = {.struck_party = {.id = 2, .damage = DAMAGE_DESTROYED}}},
          "truck", NULL, "shell", "shell struck truck 2, destroyed");
    check((struct event){.type = EVENT_DETONATION, .detonation.struck = STRUCK_WATER}, "none", NULL,
          "shell", "shell struck water");
    check((struct event){.type = EVENT_CRATER, .crater = {.radius_m = 2.0f, .depth_m = 0.5f}}, NULL,
          NULL, NULL, "crater of 2.0 m, 0.5 m deep");
    check((struct event){.type = EVENT_AGENT,
                         .agent = {.agent.id = 3,
                                   .from = BEHAVIOUR_PATROL,
                                   .to = BEHAVIOUR_FLEE,
                                   .because = REASON_HURT}},
          "jeep", NULL, NULL, "jeep 3: patrol to flee, hurt");
    check((struct event){.type = EVENT_CONTACT_END,
                         .contact_end = {.a.id = 12, .b.id = 14, .lasted_s = 3.25}},
          "tank", "jeep", NULL, "tank 12 and jeep 14 parted after 3.2 s");
    check((struct event){.type = EVENT_CONTACT_END,
                         .contact_end = {.a.id = 12, .b = {.id = 40211, .fixed = 1}}},
          "tank", "tree", NULL, "tank 12 and tree 40211 parted after 0.0 s");
    check((struct event){.type = EVENT_CONTACT_END,
                         .contact_end = {.a.id = 12, .b.id = 14, .because = CONTACT_END_NO_ROOM}},
          "tank", "jeep", NULL, "tank 12 and jeep 14: no room for their contact");
    check((struct event){.type = EVENT_COMMAND,
                         .command = {.type = COMMAND_SPAWN, .entity = 7, .result = COMMAND_DONE}},
          NULL, NULL, NULL, "command spawn 7: done");
    check((struct event){.type = EVENT_COMMAND, .command.type = COMMAND_PAUSE}, NULL, NULL, NULL,
          "command pause: done");
    check((struct event){.type = EVENT_MISSION, .mission = {.name = "lead", .phase = "attack"}},
          NULL, NULL, NULL, "lead: attack");
    check((struct event){.type = EVENT_MISSION,
                         .mission = {.news = MISSION_NEWS_OBJECTIVE,
                                     .name = "hill",
                                     .force = FORCE_BLUE,
                                     .from = FORCE_RED}},
          NULL, NULL, NULL, "blue takes hill from red");
    check((struct event){.type = EVENT_MISSION,
                         .mission = {.news = MISSION_NEWS_RESULT,
                                     .round = 1,
                                     .force = FORCE_RED,
                                     .held = {0, 1, 2},
                                     .lost = {0, 30, 4}}},
          NULL, NULL, NULL,
          "battle 1 ends: red wins; blue holds 1 and lost 30, red holds 2 and lost 4");
    check(
        (struct event){.type = EVENT_MISSION, .mission = {.news = MISSION_NEWS_AGAIN, .round = 2}},
        NULL, NULL, NULL, "battle 2 begins");
}

static void test_parties_are_those_of_the_type(void **state)
{
    const struct event fire = {.type = EVENT_FIRE}, crater = {.type = EVENT_CRATER};
    const struct event end = {.type = EVENT_CONTACT_END};
    const struct event_party *parties[EVENT_TEXT_PARTIES];
    (void)state;
    event_text_parties(&fire, parties);
    assert_ptr_equal(parties[EVENT_TEXT_FIRST], &fire.fire.shooter);
    assert_ptr_equal(parties[EVENT_TEXT_SECOND], &fire.fire.target);
    assert_ptr_equal(parties[EVENT_TEXT_MUNITION], &fire.fire.munition);
    event_text_parties(&end, parties);
    assert_ptr_equal(parties[EVENT_TEXT_FIRST], &end.contact_end.a);
    assert_ptr_equal(parties[EVENT_TEXT_SECOND], &end.contact_end.b);
    assert_null(parties[EVENT_TEXT_MUNITION]);
    event_text_parties(&crater, parties);
    for (int i = 0; i < EVENT_TEXT_PARTIES; i++)
        assert_null(parties[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_type_has_its_text),
        cmocka_unit_test(test_parties_are_those_of_the_type),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
