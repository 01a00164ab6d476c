/* Writes what never changes in a world, and places in all their forms. */
#include "clients/console/world_json.h"

#include "world/earth_location.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

#include <stdio.h>
#include <string.h>

#define NAMES_MAX       5000u
#define DEGREE_DECIMALS 7 /* 1 cm */

static void put_kinds(struct json_writer *json, const struct world_reader *reader)
{
    const struct world *world = &reader->view.world;
    uint32_t kinds = kind_of_files(world->kinds, world->counts.kinds);
    json_writer_key(json, "kinds");
    json_writer_begin(json, '[');
    for (uint32_t i = 0; i < kinds; i++) {
        const struct kind *kind = &world->kinds[i];
        json_writer_begin(json, '{');
        json_writer_key_word(json, "name", kind->name);
        json_writer_key_word(json, "domain", domain_name((enum domain)kind->domain));
        json_writer_key_number(json, "length_m", kind->length_m, 2);
        json_writer_key_bool(json, "turret", reader->turret[i]);
        json_writer_key_whole(json, "rounds", kind->rounds);
        json_writer_key_number(json, "fuel_l", kind->fuel_l, 1);
        json_writer_key_number(json, "max_speed_mps", kind->max_speed_mps, 1);
        json_writer_key_number(json, "min_speed_mps", kind->min_speed_mps, 1);
        json_writer_key_number(json, "range_m", kind->range_m, 0);
        json_writer_end(json, '}');
    }
    json_writer_end(json, ']');
}

static void put_names(struct json_writer *json, const struct world *world)
{
    uint32_t put = 0, left_out = 0;
    json_writer_key(json, "names");
    json_writer_begin(json, '{');
    for (uint32_t i = 0; i < world->counts.names; i++) {
        char id[16];
        if (!world->names[i].text[0])
            continue;
        if (put == NAMES_MAX) {
            left_out++;
            continue;
        }
        (void)snprintf(id, sizeof id, "%u", i + 1);
        json_writer_key_word(json, id, world->names[i].text);
        put++;
    }
    json_writer_end(json, '}');
    json_writer_key_whole(json, "names_left_out", left_out);
}

static void put_objectives(struct json_writer *json, const struct world *world)
{
    json_writer_key(json, "objectives");
    json_writer_begin(json, '[');
    for (uint32_t o = 0; o < world->counts.objectives; o++) {
        const struct objective *objective = &world->objectives[o];
        json_writer_begin(json, '{');
        json_writer_key_word(json, "name", objective->name);
        json_writer_key_number(json, "x0", objective->x0, 0);
        json_writer_key_number(json, "z0", objective->z0, 0);
        json_writer_key_number(json, "x1", objective->x1, 0);
        json_writer_key_number(json, "z1", objective->z1, 0);
        json_writer_end(json, '}');
    }
    json_writer_end(json, ']');
}

void world_json(const struct world_query *query, struct http_answer *answer)
{
    struct json_writer *json = &answer->json;
    if (!world_query_attached(query, answer))
        return;
    const struct view *view = &query->reader->view;
    const struct params *params = view->world.params;
    char run[24];
    (void)snprintf(run, sizeof run, "%016llx", (unsigned long long)view->header->made);
    json_writer_begin(json, '{');
    json_writer_key_word(json, "world", view->name);
    json_writer_key_word(json, "run", run);
    json_writer_key_word(json, "ground", params->name);
    const char *file = strrchr(params->scenario, '/');
    json_writer_key_word(json, "scenario", file ? file + 1 : params->scenario);
    json_writer_key_number(json, "side_m", view->world.terrain.squares.world_m, 0);
    json_writer_key_number(json, "hz", params->hz, 3);
    json_writer_key_bool(json, "real_time", params->pace == PACE_REAL);
    json_writer_key_whole(json, "capacity", params->capacity);
    json_writer_key_bool(json, "token_needed", true);
    put_kinds(json, query->reader);
    put_names(json, &view->world);
    put_objectives(json, &view->world);
    json_writer_key(json, "behaviours");
    json_writer_begin(json, '[');
    for (int i = 0; i < BEHAVIOUR_COUNT; i++)
        json_writer_word(json, behaviour_name((enum behaviour)i));
    json_writer_end(json, ']');
    json_writer_key(json, "forces");
    json_writer_begin(json, '[');
    for (int i = 0; i < FORCE_COUNT; i++)
        json_writer_word(json, force_name((enum force)i));
    json_writer_end(json, ']');
    json_writer_key(json, "damages");
    json_writer_begin(json, '[');
    for (int i = 0; i < DAMAGE_COUNT; i++)
        json_writer_word(json, damage_name((enum damage)i));
    json_writer_end(json, ']');
    json_writer_key(json, "gears");
    json_writer_begin(json, '[');
    for (int i = 0; i < GEAR_COUNT; i++)
        json_writer_word(json, gear_name((enum gearing)i));
    json_writer_end(json, ']');
    json_writer_end(json, '}');
}

void world_json_earth(struct json_writer *json, const struct world *world, double x, double z)
{
    struct location_frame frame;
    struct location_earth earth;
    earth_location_frame(&frame, world->params, world->terrain.squares.world_m);
    location_earth(&earth, &frame, x, z);
    json_writer_key_number(json, "latitude_deg", earth.latitude_deg, DEGREE_DECIMALS);
    json_writer_key_number(json, "longitude_deg", earth.longitude_deg, DEGREE_DECIMALS);
    json_writer_key_word(json, "degrees", earth.degrees);
    json_writer_key_word(json, "mgrs", earth.mgrs);
}

void world_json_place(const struct world_query *query, struct http_answer *answer)
{
    struct json_writer *json = &answer->json;
    struct location place;
    struct location_frame frame;
    struct error_text error;
    double x, z;
    if (!world_query_attached(query, answer))
        return;
    const struct world *world = &query->reader->view.world;
    earth_location_frame(&frame, world->params, world->terrain.squares.world_m);
    if (location_read(&place, query_text(&query->arguments, "at"), &error) != 0 ||
        location_world(&place, &frame, &x, &z, &error) != 0) {
        http_answer_error(answer, HTTP_ANSWER_BAD,
                          "ask as at=25000,24000, at=44.2705N,71.3033W or at=19TCK1617404497",
                          "at: %s", error.text);
        return;
    }
    json_writer_begin(json, '{');
    json_writer_key_number(json, "x", x, 2);
    json_writer_key_number(json, "z", z, 2);
    world_json_earth(json, world, x, z);
    json_writer_end(json, '}');
}
