/* Writes the frame, its counters, the entities of an area and the requested vehicle. */
#include "clients/console/state_json.h"

#include "clients/console/world_json.h"
#include "world/entity/kind.h"
#include "world/entity/grounded.h"
#include "world/entity/remote.h"
#include "world/entity/spool.h"
#include "world/enum_names.h"
#include "world/params.h"
#include "world/pull_up.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <stdio.h>

#define ENTITIES     2000u  /* by default ... */
#define ENTITIES_MAX 20000u /* ... and at most */
#define MILLI_NS     1e6

static void put_times(struct json_writer *json, const char *key, const struct histogram *histogram)
{
    json_writer_key(json, key);
    json_writer_begin(json, '{');
    json_writer_key_number(json, "p50", (double)histogram_quantile(histogram, 0.50) / MILLI_NS, 3);
    json_writer_key_number(json, "p99", (double)histogram_quantile(histogram, 0.99) / MILLI_NS, 3);
    json_writer_key_number(json, "max", (double)histogram->max_ns / MILLI_NS, 3);
    json_writer_end(json, '}');
}

static void put_tally(struct json_writer *json, const struct state_head *head)
{
    const struct counters *tally = &head->tally;
    json_writer_key(json, "tally");
    json_writer_begin(json, '{');
    json_writer_key_whole(json, "collisions", tally->collisions);
    json_writer_key_whole(json, "fires", tally->fires);
    json_writer_key_whole(json, "detonations", tally->detonations);
    json_writer_key_whole(json, "craters", head->crater_count);
    json_writer_key_whole(json, "destroyed", tally->destroyed);
    json_writer_key_whole(json, "fixed_damaged", tally->fixed_damaged);
    json_writer_key_whole(json, "agent_changes", tally->agent_changes);
    json_writer_key_whole(json, "commands", tally->commands);
    json_writer_key_whole(json, "events_dropped", tally->events_dropped);
    json_writer_key_whole(json, "contacts", head->contact_count);
    json_writer_key_whole(json, "contacts_refused", tally->contacts_refused);
    json_writer_end(json, '}');
}

static void put_head(struct json_writer *json, const struct world_query *query)
{
    const struct world_reader *reader = query->reader;
    const struct view *view = &reader->view;
    const struct state_head *head = &reader->snapshot.head;
    json_writer_key_whole(json, "frame", head->frame);
    json_writer_key_number(json, "time_s", state_time_s(&view->world, head), 3);
    json_writer_key_word(json, "state", world_reader_state(reader, head));
    json_writer_key_bool(json, "paused", head->paused != 0);
    json_writer_key_number(json, "scale", head->time_scale, 3);
    json_writer_key_number(json, "rate_hz", world_reader_rate_hz(reader), 1);
    json_writer_key_whole(json, "late_frames", atomic_load(&view->slot[ROLE_MOVER]->late_frames));
    json_writer_key_whole(json, "vehicles", head->vehicles);
    json_writer_key_whole(json, "munitions", head->munitions);
    json_writer_key_whole(json, "events", head->event_end);
    put_tally(json, head);
    put_times(json, "frame_ms", &view->slot[ROLE_COLLIDER]->whole);
}

/* --- the entities -----------------------------------------------------------------------------*/

struct area_asked {
    double x0, z0, x1, z1;
    uint64_t most;          /* entities */
    bool motions;           /* since was given: */
    uint64_t since, stride; /* the frame and the stride of the client's last answer */
};

static bool read_area(const struct world_query *query, struct area_asked *area,
                      struct http_answer *answer)
{
    const struct query *arguments = &query->arguments;
    const char *given = query_text(arguments, "area");
    const double side_m = query->reader->view.world.terrain.squares.world_m;
    *area =
        (struct area_asked){.x1 = side_m, .z1 = side_m, .motions = *query_text(arguments, "since")};
    int used = 0;
    if (*given && (sscanf(given, "%lf,%lf,%lf,%lf%n", &area->x0, &area->z0, &area->x1, &area->z1,
                          &used) != 4 ||
                   given[used] || !(area->x0 <= area->x1) || !(area->z0 <= area->z1))) {
        http_answer_error(answer, HTTP_ANSWER_BAD, "ask as area=X0,Z0,X1,Z1 in metres",
                          "area=%.60s: not four numbers, the lower ones first", given);
        return false;
    }
    return query_whole(arguments, "most", 0, ENTITIES_MAX, ENTITIES, &area->most, answer) &&
           query_whole(arguments, "since", 0, INT64_MAX, 0, &area->since, answer) &&
           query_whole(arguments, "stride", 0, UINT32_MAX, 0, &area->stride, answer);
}

static bool is_within(const struct area_asked *area, double x, double z)
{
    return x >= area->x0 && x <= area->x1 && z >= area->z0 && z <= area->z1;
}

static bool within(const struct area_asked *area, const struct entities *e, uint32_t row)
{
    return e->row[row].state != ENTITY_FREE && is_within(area, e->row[row].x, e->row[row].z);
}

/* What is written of a row: where and how fast it is. */
struct place {
    double x, z, heading_rad, speed_mps;
};

/* Begins an entity's array, with the members that each has. */
static void begin_entity(struct json_writer *json, const struct world_query *query, uint32_t row,
                         const struct place *place)
{
    const struct entities *e = &query->reader->snapshot.entities;
    json_writer_begin(json, '[');
    json_writer_whole(json, e->row[row].id);
    json_writer_whole(json, e->row[row].kind);
    json_writer_whole(json, e->row[row].force);
    json_writer_whole(json, e->row[row].behaviour);
    json_writer_whole(json, e->row[row].state);
    json_writer_whole(json, e->row[row].damage);
    json_writer_number(json, place->x, 1);
    json_writer_number(json, place->z, 1);
    json_writer_number(json, place->heading_rad, 3);
    json_writer_number(json, place->speed_mps, 1);
    json_writer_number(json, (double)e->row[row].turret, 3);
    json_writer_whole(json, world_query_driver(query, row));
}

static void put_entity(struct json_writer *json, const struct world_query *query, uint32_t row)
{
    const struct entities *e = &query->reader->snapshot.entities;
    const struct place place = {e->row[row].x, e->row[row].z, e->row[row].heading,
                                vec3_length(entities_velocity(e, row))};
    begin_entity(json, query, row, &place);
    json_writer_end(json, ']');
}

/* Writes a row as it was told last. Members at the end that are zero are left out. */
static void put_motion(struct json_writer *json, const struct world_query *query, uint32_t row)
{
    const struct motion_told *told = &query->reader->motions.told[row];
    const struct told_motion *motion = &told->motion;
    const struct place place = {motion->at.x, motion->at.z, motion->heading_rad,
                                vec3_length(motion->velocity)};
    begin_entity(json, query, row, &place);
    json_writer_whole(json, row);
    json_writer_number(json, (double)told->tick * world_dt_s(&query->reader->view.world), 3);
    if (motion->lasts_s > 0.0F || vec3_dot(motion->velocity, motion->velocity) > 0.0) {
        json_writer_number(json, motion->velocity.x, 2);
        json_writer_number(json, motion->velocity.z, 2);
    }
    if (motion->lasts_s > 0.0F) {
        json_writer_number(json, (double)motion->turn_rps, 4);
        json_writer_number(json, (double)motion->gain_mps2, 3);
        json_writer_number(json, (double)motion->lasts_s, 3);
    }
    json_writer_end(json, ']');
}

/* Returns true if the client has to be told a row of the area: it does not go on as it was told, or
 * it was not in the area. */
static bool is_news(const struct world_query *query, const struct area_asked *area, uint32_t row)
{
    const struct motion_table *motions = &query->reader->motions;
    const struct motion_told *told = &motions->told[row];
    if (motion_table_told(motions, row, area->since + 1))
        return true;
    const uint64_t frames = motions->frame - area->since;
    const uint64_t tick = motions->tick > frames ? motions->tick - frames : 0; /* unless paused */
    const double after_s =
        tick > told->tick ? (double)(tick - told->tick) * world_dt_s(&query->reader->view.world)
                          : 0.0;
    const struct told_motion then = told_motion_at(&told->motion, after_s);
    return !is_within(area, then.at.x, then.at.z);
}

/* Writes the rows from which entities have left since. */
static void put_gone(struct json_writer *json, const struct motion_table *motions, uint64_t since)
{
    json_writer_key(json, "gone");
    json_writer_begin(json, '[');
    for (uint32_t row = 0; row < motions->used; row++) {
        if (motion_table_told(motions, row, since + 1) &&
            motions->told[row].marks.state == ENTITY_FREE)
            json_writer_whole(json, row);
    }
    json_writer_end(json, ']');
}

/* If the area has more entities than are requested, only the multiples of an id stride are written,
 * so that the next answer has the same ones. */
static uint64_t stride_of(uint64_t count, uint64_t most)
{
    uint64_t stride = most > 0 ? (count + most - 1) / most : 0;
    return stride > 0 ? stride : 1;
}

/* Writes the entities of the area: all of them, or for a client that computes where they are those
 * that do not go on as it was told (ipc/frame/motion_table.h). */
static void put_entities(struct json_writer *json, const struct world_query *query,
                         const struct area_asked *area)
{
    const struct snapshot *snapshot = &query->reader->snapshot;
    const struct motion_table *motions = &query->reader->motions;
    const struct entities *e = &snapshot->entities;
    uint64_t count = 0, shown = 0;
    for (uint32_t row = 0; row < snapshot->head.used; row++)
        count += within(area, e, row);
    const uint64_t stride = stride_of(count, area->most);
    const bool whole = !area->motions || area->stride != stride ||
                       area->since < motions->from_frame || area->since > motions->frame;
    json_writer_key(json, "entities");
    json_writer_begin(json, '[');
    for (uint32_t row = 0; row < snapshot->head.used && shown < area->most; row++) {
        if (!within(area, e, row) || e->row[row].id % stride != 0)
            continue;
        shown++;
        if (!area->motions)
            put_entity(json, query, row);
        else if (whole || is_news(query, area, row))
            put_motion(json, query, row);
    }
    json_writer_end(json, ']');
    json_writer_key_whole(json, "left_out", count - shown);
    if (!area->motions)
        return;
    json_writer_key_bool(json, "whole", whole);
    json_writer_key_whole(json, "stride", stride);
    if (!whole)
        put_gone(json, motions, area->since);
}

/* --- the rest ---------------------------------------------------------------------------------*/

/* In a world with missions: who holds what, and the phases. */
static void put_battle(struct json_writer *json, const struct world *world,
                       const struct state_head *head)
{
    const struct battle_state *battle = &head->battle;
    double time_s = (double)((uint32_t)head->tick - battle->round_tick) * world_dt_s(world);
    if (world->counts.missions == 0)
        return;
    json_writer_key(json, "battle");
    json_writer_begin(json, '{');
    json_writer_key_whole(json, "round", battle->round);
    json_writer_key_number(json, "time_s", time_s, 1);
    json_writer_key_bool(json, "ended", battle->ended_tick != 0);
    json_writer_key_word(json, "winner", force_name((enum force)battle->winner));
    json_writer_key(json, "objectives");
    json_writer_begin(json, '{');
    for (uint32_t o = 0; o < world->counts.objectives; o++)
        json_writer_key_word(json, world->objectives[o].name,
                             force_name((enum force)battle->objective[o].owner));
    json_writer_end(json, '}');
    json_writer_key(json, "phases");
    json_writer_begin(json, '{');
    for (uint32_t i = 0; i < world->counts.missions; i++) {
        const struct mission *mission = &world->missions[i];
        const uint32_t phase = mission->first_phase + battle->mission[i].phase;
        json_writer_key_word(json, mission->name, world->mission_phases[phase].name);
    }
    json_writer_end(json, '}');
    json_writer_end(json, '}');
}

/* In a world with room for remote entities: the markings of those in the area, by their ids. */
static void put_markings(struct json_writer *json, const struct world_query *query,
                         const struct area_asked *area)
{
    const struct snapshot *snapshot = &query->reader->snapshot;
    const struct entities *e = &snapshot->entities;
    uint64_t put = 0;
    if (query->reader->view.world.params->remotes_max == 0)
        return;
    json_writer_key(json, "markings");
    json_writer_begin(json, '{');
    for (uint32_t row = 0; row < snapshot->head.used && put < area->most; row++) {
        char marking[REMOTE_MARKING_MAX + 1], id[16];
        if (!within(area, e, row) || !remote_is(e, row))
            continue;
        (void)snprintf(id, sizeof id, "%u", e->row[row].id);
        remote_marking(e, row, marking);
        json_writer_key_word(json, id, marking);
        put++;
    }
    json_writer_end(json, '}');
}

static void put_where(struct json_writer *json, const struct world_query *query, uint32_t row)
{
    const struct entities *e = &query->reader->snapshot.entities;
    const struct world *world = &query->reader->view.world;
    json_writer_key_number(json, "x", e->row[row].x, 2);
    json_writer_key_number(json, "y", e->row[row].y, 2);
    json_writer_key_number(json, "z", e->row[row].z, 2);
    world_json_earth(json, world, e->row[row].x, e->row[row].z);
    json_writer_key_number(json, "speed_mps", vec3_length(entities_velocity(e, row)), 2);
    json_writer_key_number(json, "heading_deg", e->row[row].heading / RAD_PER_DEG, 1);
    json_writer_key_number(json, "pitch_deg", e->row[row].pitch / RAD_PER_DEG, 1);
    json_writer_key_number(json, "roll_deg", e->row[row].roll / RAD_PER_DEG, 1);
    json_writer_key_number(
        json, "altitude_m",
        e->row[row].y - terrain_base_height(&world->terrain, e->row[row].x, e->row[row].z), 1);
    json_writer_key_number(json, "turret_deg", (double)e->row[row].turret / RAD_PER_DEG, 1);
    json_writer_key_number(json, "gun_deg", (double)e->row[row].gun / RAD_PER_DEG, 1);
}

static void put_me(struct json_writer *json, const struct world_query *query, uint32_t row)
{
    static const char *const drivers[] = {"", "another", "you"};
    const struct world_reader *reader = query->reader;
    const struct entities *e = &reader->snapshot.entities;
    const struct world *world = &reader->view.world;
    const struct kind *kind = &world->kinds[e->row[row].kind];
    char marking[REMOTE_MARKING_MAX + 1];
    double reload_s =
        ((double)e->row[row].reload_tick - (double)reader->snapshot.head.tick) * world_dt_s(world);
    json_writer_key(json, "me");
    json_writer_begin(json, '{');
    json_writer_key_whole(json, "id", e->row[row].id);
    json_writer_key_word(json, "name", world_row_name(world, e, row, marking));
    json_writer_key_word(json, "kind", kind->name);
    json_writer_key_word(json, "force", force_name((enum force)e->row[row].force));
    json_writer_key_word(json, "behaviour", behaviour_name((enum behaviour)e->row[row].behaviour));
    json_writer_key_word(json, "state", entity_state_name((enum entity_state)e->row[row].state));
    json_writer_key_word(json, "damage", damage_name((enum damage)e->row[row].damage));
    put_where(json, query, row);
    json_writer_key_whole(json, "rounds", e->row[row].rounds);
    json_writer_key_whole(json, "rounds_full", kind->rounds);
    json_writer_key_number(json, "fuel_l", e->row[row].fuel_l, 1);
    json_writer_key_number(json, "fuel_full_l", kind->fuel_l, 1);
    json_writer_key_number(json, "reload_s", fmax(reload_s, 0.0), 2);
    json_writer_key_word(json, "gear", gear_name(entity_gear(e->row[row].flags)));
    json_writer_key_number(json, "throttle", (double)e->row[row].throttle, 2);
    json_writer_key_number(json, "spool", spool_of(e, kind, row), 2);
    json_writer_key_bool(json, "grounded", grounded_of(e, kind, row));
    json_writer_key_bool(json, "pull_up", pull_up_of(world, e, row));
    json_writer_key_whole(json, "target",
                          entities_alive(e, e->row[row].target_slot, e->row[row].target_id)
                              ? e->row[row].target_id
                              : 0);
    json_writer_key_word(json, "driver", drivers[world_query_driver(query, row)]);
    json_writer_end(json, '}');
}

static void put_players(struct json_writer *json, const struct world_query *query)
{
    json_writer_key(json, "players");
    json_writer_begin(json, '[');
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        const struct player *player = &query->players->player[i];
        if (!player->number)
            continue;
        json_writer_begin(json, '{');
        json_writer_key_whole(json, "player", player->number);
        json_writer_key_word(json, "name", player->name);
        json_writer_key_whole(json, "vehicle", player->vehicle);
        json_writer_key_bool(json, "you", player == query->player);
        json_writer_end(json, '}');
    }
    json_writer_end(json, ']');
    if (query->player) {
        json_writer_key(json, "you");
        json_writer_begin(json, '{');
        json_writer_key_whole(json, "player", query->player->number);
        json_writer_key_whole(json, "vehicle", query->player->vehicle);
        json_writer_key_word(json, "lost", query->player->lost);
        json_writer_end(json, '}');
    }
}

static void put_missions(struct json_writer *json, const struct command_queue *queue)
{
    json_writer_key(json, "missions");
    json_writer_begin(json, '[');
    for (uint32_t i = 0; i < COMMAND_QUEUE_MISSIONS; i++) {
        const struct command_series *mission = &queue->mission[i].series;
        const struct command_text *order = &mission->order;
        if (!queue->mission[i].number)
            continue;
        json_writer_begin(json, '{');
        json_writer_key_whole(json, "mission", queue->mission[i].number);
        json_writer_key_word(json, "munition", order->command.kind);
        json_writer_key_number(json, "x", order->command.x_m, 1);
        json_writer_key_number(json, "z", order->command.z_m, 1);
        json_writer_key_number(json, "radius_m", order->radius_m, 1);
        json_writer_key_whole(json, "rounds", order->rounds);
        json_writer_key_whole(json, "fired", mission->done);
        json_writer_key_whole(json, "refused", mission->answered - mission->done);
        json_writer_end(json, '}');
    }
    json_writer_end(json, ']');
}

void state_json(const struct world_query *query, struct http_answer *answer)
{
    struct json_writer *json = &answer->json;
    struct area_asked area;
    uint64_t me = 0;
    if (!read_area(query, &area, answer) ||
        !query_whole(&query->arguments, "me", 0, UINT32_MAX, 0, &me, answer) ||
        !(area.motions ? world_query_told : world_query_copied)(query, answer))
        return;
    uint32_t row = world_reader_row(query->reader, (uint32_t)me);
    json_writer_begin(json, '{');
    put_head(json, query);
    put_battle(json, &query->reader->view.world, &query->reader->snapshot.head);
    put_entities(json, query, &area);
    put_markings(json, query, &area);
    put_players(json, query);
    put_missions(json, query->queue);
    if (row != SLOT_NONE)
        put_me(json, query, row);
    json_writer_end(json, '}');
}
