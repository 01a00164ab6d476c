/* What of a world never changes. */
#include "clients/console/world_json.h"

#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

#include <stdio.h>
#include <string.h>

#define NAMES_MAX 5000u

static void put_kinds(struct json_writer *text, const struct world_reader *reader)
{
    const struct world *world = &reader->view.world;
    json_writer_key(text, "kinds");
    json_writer_begin(text, '[');
    for (uint32_t i = 0; i < world->counts.kinds; i++) {
        const struct kind *kind = &world->kinds[i];
        json_writer_begin(text, '{');
        json_writer_key_word(text, "name", kind->name);
        json_writer_key_word(text, "domain", domain_name((enum domain)kind->domain));
        json_writer_key_number(text, "length_m", kind->length_m, 2);
        json_writer_key_bool(text, "turret", reader->turret[i]);
        json_writer_key_whole(text, "rounds", kind->rounds);
        json_writer_key_number(text, "fuel_l", kind->fuel_l, 1);
        json_writer_key_number(text, "max_speed_mps", kind->max_speed_mps, 1);
        json_writer_key_number(text, "range_m", kind->range_m, 0);
        json_writer_end(text, '}');
    }
    json_writer_end(text, ']');
}

static void put_names(struct json_writer *text, const struct world *world)
{
    uint32_t put = 0, left_out = 0;
    json_writer_key(text, "names");
    json_writer_begin(text, '{');
    for (uint32_t i = 0; i < world->counts.names; i++) {
        char id[16];
        if (!world->names[i].text[0])
            continue;
        if (put == NAMES_MAX) {
            left_out++;
            continue;
        }
        (void)snprintf(id, sizeof id, "%u", i + 1);
        json_writer_key_word(text, id, world->names[i].text);
        put++;
    }
    json_writer_end(text, '}');
    json_writer_key_whole(text, "names_left_out", left_out);
}

void world_json(const struct world_query *query, struct http_answer *answer)
{
    struct json_writer *text = &answer->text;
    if (!world_query_attached(query, answer))
        return;
    const struct view *view = &query->reader->view;
    const struct params *params = view->world.params;
    char run[24];
    (void)snprintf(run, sizeof run, "%016llx", (unsigned long long)view->header->made);
    json_writer_begin(text, '{');
    json_writer_key_word(text, "world", view->name);
    json_writer_key_word(text, "run", run);
    json_writer_key_word(text, "ground", params->name);
    const char *file = strrchr(params->scenario, '/');
    json_writer_key_word(text, "scenario", file ? file + 1 : params->scenario);
    json_writer_key_number(text, "side_m", WORLD_SIDE_M, 0);
    json_writer_key_number(text, "hz", params->hz, 3);
    json_writer_key_bool(text, "real_time", params->pace == PACE_REAL);
    json_writer_key_whole(text, "capacity", params->capacity);
    json_writer_key_bool(text, "token_needed", true);
    put_kinds(text, query->reader);
    put_names(text, &view->world);
    json_writer_key(text, "behaviours");
    json_writer_begin(text, '[');
    for (int i = 0; i < BEHAVIOUR_COUNT; i++)
        json_writer_word(text, behaviour_name((enum behaviour)i));
    json_writer_end(text, ']');
    json_writer_key(text, "forces");
    json_writer_begin(text, '[');
    for (int i = 0; i < FORCE_COUNT; i++)
        json_writer_word(text, force_name((enum force)i));
    json_writer_end(text, ']');
    json_writer_key(text, "damages");
    json_writer_begin(text, '[');
    for (int i = 0; i < DAMAGE_COUNT; i++)
        json_writer_word(text, damage_name((enum damage)i));
    json_writer_end(text, ']');
    json_writer_key(text, "gears");
    json_writer_begin(text, '[');
    for (int i = 0; i < GEAR_COUNT; i++)
        json_writer_word(text, gear_name((enum gearing)i));
    json_writer_end(text, ']');
    json_writer_end(text, '}');
}
