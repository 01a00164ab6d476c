/* A world's values as JSON. */
#include "ipc/json/world_json.h"

#include "ipc/process/log.h"
#include "world/entity/command.h"
#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/event_text.h"
#include "world/world.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void need(const void *made)
{
    if (!made)
        die_refused("out of memory while writing JSON");
}

/* cJSON copies the key, which may fail too and would leave the value out silently. */
static void put(cJSON *object, const char *key, cJSON *item)
{
    if (!item || !cJSON_AddItemToObject(object, key, item))
        need(NULL);
}

void json_text(cJSON *object, const char *key, const char *text)
{
    need(cJSON_AddStringToObject(object, key, text));
}

void json_number(cJSON *object, const char *key, double value)
{
    need(isfinite(value) ? cJSON_AddNumberToObject(object, key, value)
                         : cJSON_AddNullToObject(object, key));
}

void json_whole(cJSON *object, const char *key, uint64_t value)
{
    char text[24];
    snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    need(cJSON_AddRawToObject(object, key, text));
}

void json_bool(cJSON *object, const char *key, int value)
{
    need(cJSON_AddBoolToObject(object, key, value));
}

void json_hex(cJSON *object, const char *key, uint64_t value)
{
    char text[24];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)value);
    json_text(object, key, text);
}

static cJSON *single(float value)
{
    char text[32];
    snprintf(text, sizeof text, "%.9g", (double)value);
    return isfinite(value) ? cJSON_CreateRaw(text) : cJSON_CreateNull();
}

void json_single(cJSON *object, const char *key, float value)
{
    put(object, key, single(value));
}

void json_triple(cJSON *object, const char *key, double x, double y, double z)
{
    const double value[3] = {x, y, z};
    put(object, key, cJSON_CreateDoubleArray(value, 3));
}

void json_triple_single(cJSON *object, const char *key, const float value[3])
{
    cJSON *array = json_array(object, key);
    for (int i = 0; i < 3; i++) {
        cJSON *item = single(value[i]);
        need(item);
        cJSON_AddItemToArray(array, item);
    }
}

cJSON *json_object(cJSON *object, const char *key)
{
    cJSON *child = cJSON_AddObjectToObject(object, key);
    need(child);
    return child;
}

cJSON *json_array(cJSON *object, const char *key)
{
    cJSON *child = cJSON_AddArrayToObject(object, key);
    need(child);
    return child;
}

void json_print(cJSON *object)
{
    char *text = cJSON_PrintUnformatted(object);
    need(text);
    puts(text);
    cJSON_free(text);
    cJSON_Delete(object);
}

/* --- events ------------------------------------------------------------------------------------*/

static const char *kind_text(const struct world *world, const struct event_party *party)
{
    if (party->id == 0) /* the terrain, or none */
        return party->fixed ? "ground" : "none";
    return party->kind < world->counts.kinds ? world->kinds[party->kind].name : "?";
}

static void add_party(cJSON *object, const char *key, const struct event_party *party,
                      const char *kind)
{
    cJSON *child = json_object(object, key);
    json_whole(child, "id", party->id);
    json_text(child, "kind", kind);
    json_bool(child, "fixed", party->fixed);
}

static void add_collision(cJSON *object, const struct event_collision *collision,
                          const char *const *kind)
{
    add_party(object, "a", &collision->a, kind[EVENT_TEXT_FIRST]);
    add_party(object, "b", &collision->b, kind[EVENT_TEXT_SECOND]);
    json_triple(object, "point", collision->point[0], collision->point[1], collision->point[2]);
    json_triple_single(object, "normal", collision->normal);
    json_triple_single(object, "direction", collision->direction_a);
    json_number(object, "toi", collision->toi);
    json_single(object, "closing_mps", collision->closing_mps);
    json_single(object, "angle_deg", collision->angle_deg);
    json_single(object, "impulse_ns", collision->impulse_ns);
    json_text(object, "response", response_name((enum response)collision->response));
    if (collision->remote)
        json_bool(object, "remote", true);
    json_text(object, "damage_a", damage_name((enum damage)collision->a.damage));
    json_text(object, "damage_b", damage_name((enum damage)collision->b.damage));
    json_bool(object, "begins", collision->begins != 0);
}

static void add_fire(cJSON *object, const struct event_fire *fire, const char *const *kind)
{
    add_party(object, "shooter", &fire->shooter, kind[EVENT_TEXT_FIRST]);
    add_party(object, "target", &fire->target, kind[EVENT_TEXT_SECOND]);
    add_party(object, "munition", &fire->munition, kind[EVENT_TEXT_MUNITION]);
    json_triple(object, "point", fire->point[0], fire->point[1], fire->point[2]);
}

static void add_detonation(cJSON *object, const struct event_detonation *detonation,
                           const char *const *kind)
{
    add_party(object, "munition", &detonation->munition, kind[EVENT_TEXT_MUNITION]);
    json_triple(object, "point", detonation->point[0], detonation->point[1], detonation->point[2]);
    json_text(object, "struck", struck_name((enum struck)detonation->struck));
    json_whole(object, "id", detonation->struck_party.id);
    json_text(object, "kind", kind[EVENT_TEXT_FIRST]);
    json_text(object, "damage", damage_name((enum damage)detonation->struck_party.damage));
    json_single(object, "explosive_kg", detonation->explosive_kg);
    if (detonation->remote)
        json_bool(object, "remote", true);
}

static void add_crater(cJSON *object, const struct event_crater *crater, const char *const *kind)
{
    (void)kind;
    json_triple(object, "point", crater->point[0], crater->point[1], crater->point[2]);
    json_single(object, "radius_m", crater->radius_m);
    json_single(object, "depth_m", crater->depth_m);
}

static void add_agent(cJSON *object, const struct event_agent *agent, const char *const *kind)
{
    json_whole(object, "id", agent->agent.id);
    json_text(object, "kind", kind[EVENT_TEXT_FIRST]);
    json_text(object, "from", behaviour_name((enum behaviour)agent->from));
    json_text(object, "to", behaviour_name((enum behaviour)agent->to));
    json_text(object, "because", agent_reason_name((enum agent_reason)agent->because));
}

static void add_contact_end(cJSON *object, const struct event_contact_end *end,
                            const char *const *kind)
{
    add_party(object, "a", &end->a, kind[EVENT_TEXT_FIRST]);
    add_party(object, "b", &end->b, kind[EVENT_TEXT_SECOND]);
    json_number(object, "lasted_s", end->lasted_s);
    json_whole(object, "impacts", end->impacts);
    json_single(object, "impulse_ns", end->impulse_ns);
    json_text(object, "because", contact_end_reason_name((enum contact_end_reason)end->because));
}

static void add_command(cJSON *object, const struct event_command *command, const char *const *kind)
{
    (void)kind;
    json_hex(object, "source", command->source);
    json_whole(object, "command_sequence", command->sequence);
    json_text(object, "command", command_type_name((enum command_type)command->type));
    json_text(object, "result", command_result_name((enum command_result)command->result));
    json_whole(object, "id", command->entity);
}

static void add_mission(cJSON *object, const struct event_mission *mission, const char *const *kind)
{
    (void)kind;
    json_text(object, "news", mission_news_name((enum mission_news)mission->news));
    json_whole(object, "battle", mission->round);
    json_text(object, "name", mission->name);
    json_text(object, "phase", mission->phase);
    json_text(object, "force", force_name((enum force)mission->force));
    if (mission->news == MISSION_NEWS_OBJECTIVE)
        json_text(object, "from", force_name((enum force)mission->from));
    if (mission->news != MISSION_NEWS_RESULT)
        return;
    for (int force = FORCE_BLUE; force < FORCE_COUNT; force++) {
        cJSON *side = json_object(object, force_name((enum force)force));
        json_whole(side, "held", mission->held[force]);
        json_whole(side, "lost", mission->lost[force]);
    }
}

static void add_input(cJSON *object, const struct event_input *input, const char *const *kind)
{
    (void)kind;
    json_text(object, "ring", command_ring_name((enum command_ring)input->ring));
    json_whole(object, "first", input->first);
    json_whole(object, "count", input->count);
    json_hex(object, "hash", input->hash);
    json_whole(object, "refused", input->refused);
    if (input->refused == 0)
        return;
    json_hex(object, "remote", input->remote);
    json_text(object, "because", remote_refusal_name((enum remote_refusal)input->because));
}

void json_event_members(cJSON *object, const struct event *event,
                        const char *const kind[EVENT_TEXT_PARTIES])
{
    json_text(object, "type", event_type_name((enum event_type)event->type));
    switch ((enum event_type)event->type) {
#define X(tag, word)                                                                               \
    case EVENT_##tag:                                                                              \
        add_##word(object, &event->word, kind);                                                    \
        break;
        EVENT_TYPES(X)
#undef X
    default:
        break;
    }
}

cJSON *json_event(const struct world *world, const struct event *event)
{
    const struct event_party *parties[EVENT_TEXT_PARTIES];
    const char *kind[EVENT_TEXT_PARTIES];
    cJSON *object = cJSON_CreateObject();
    need(object);
    json_whole(object, "frame", event->frame);
    json_whole(object, "index", event->index);
    json_number(object, "time_s", (double)event->tick * world_dt_s(world));
    event_text_parties(event, parties);
    for (int i = 0; i < EVENT_TEXT_PARTIES; i++)
        kind[i] = parties[i] ? kind_text(world, parties[i]) : NULL;
    json_event_members(object, event, kind);
    return object;
}
