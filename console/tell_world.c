/* What of a world never changes. */
#include "console/tell.h"

#include "world/square.h"

#include <stdio.h>
#include <string.h>

bool tell_there(const struct tell *tell, struct answer *answer)
{
    if (tell->watch->there)
        return true;
    answer_error(answer, ANSWER_AWAY,
                 "this page goes on by itself when it is there; jolon start makes one, jolon "
                 "worlds lists those there are",
                 "%s", tell->watch->why.text);
    return false;
}

bool tell_copied(const struct tell *tell, struct answer *answer)
{
    if (!tell_there(tell, answer))
        return false;
    if (watch_copy(tell->watch, tell->now_ns) == 0)
        return true;
    answer_error(answer, ANSWER_AWAY, "jolon world check tells what is wrong with it", "%s",
                 tell->watch->why.text);
    return false;
}

static void put_kinds(struct text *text, const struct watch *watch)
{
    const struct world *world = &watch->view.world;
    text_key(text, "kinds");
    text_begin(text, '[');
    for (uint32_t i = 0; i < world->counts.kinds; i++) {
        const struct kind *kind = &world->kinds[i];
        text_begin(text, '{');
        text_key_word(text, "name", kind->name);
        text_key_word(text, "domain", domain_name((enum domain)kind->domain));
        text_key_number(text, "length_m", kind->length_m, 2);
        text_key_bool(text, "turret", watch->turret[i]);
        text_key_whole(text, "rounds", kind->rounds);
        text_key_number(text, "fuel_l", kind->fuel_l, 1);
        text_key_number(text, "max_speed_mps", kind->max_speed_mps, 1);
        text_key_number(text, "range_m", kind->range_m, 0);
        text_end(text, '}');
    }
    text_end(text, ']');
}

static void put_names(struct text *text, const struct world *world)
{
    uint32_t put = 0, left_out = 0;
    text_key(text, "names");
    text_begin(text, '{');
    for (uint32_t i = 0; i < world->counts.names; i++) {
        char id[16];
        if (!world->names[i].text[0])
            continue;
        if (put == TELL_NAMES_MAX) {
            left_out++;
            continue;
        }
        (void)snprintf(id, sizeof id, "%u", i + 1);
        text_key_word(text, id, world->names[i].text);
        put++;
    }
    text_end(text, '}');
    text_key_whole(text, "names_left_out", left_out);
}

void tell_world(const struct tell *tell, struct answer *answer)
{
    struct text *text = &answer->text;
    if (!tell_there(tell, answer))
        return;
    const struct view *view = &tell->watch->view;
    const struct params *params = view->world.params;
    char run[24];
    (void)snprintf(run, sizeof run, "%016llx", (unsigned long long)view->header->made);
    text_begin(text, '{');
    text_key_word(text, "world", view->name);
    text_key_word(text, "run", run);
    text_key_word(text, "ground", params->name);
    const char *file = strrchr(params->scenario, '/');
    text_key_word(text, "scenario", file ? file + 1 : params->scenario);
    text_key_number(text, "side_m", WORLD_SIDE_M, 0);
    text_key_number(text, "hz", params->hz, 3);
    text_key_bool(text, "real_time", params->pace == PACE_REAL);
    text_key_whole(text, "capacity", params->capacity);
    text_key_bool(text, "token_needed", true);
    put_kinds(text, tell->watch);
    put_names(text, &view->world);
    text_key(text, "behaviours");
    text_begin(text, '[');
    for (int i = 0; i < BEHAVIOUR_COUNT; i++)
        text_word(text, behaviour_name((enum behaviour)i));
    text_end(text, ']');
    text_key(text, "forces");
    text_begin(text, '[');
    for (int i = 0; i < FORCE_COUNT; i++)
        text_word(text, force_name((enum force)i));
    text_end(text, ']');
    text_key(text, "damages");
    text_begin(text, '[');
    for (int i = 0; i < DAMAGE_COUNT; i++)
        text_word(text, damage_name((enum damage)i));
    text_end(text, ']');
    text_key(text, "gears");
    text_begin(text, '[');
    for (int i = 0; i < GEAR_COUNT; i++)
        text_word(text, gear_name((enum gearing)i));
    text_end(text, ']');
    text_end(text, '}');
}
