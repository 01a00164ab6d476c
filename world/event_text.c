/* The types of events: a word and a text each. */
#include "world/event_text.h"

#include "world/entity/command.h"
#include "world/entity/entity.h"
#include "world/enum_names.h"

#include <stddef.h>
#include <stdio.h>

#define PARTY_MAX 48

/* "tank 12", "tree 40211", "ground" */
static const char *party_text(char text[PARTY_MAX], const char *kind, struct event_party party)
{
    if (party.id)
        (void)snprintf(text, PARTY_MAX, "%s %u", kind, party.id);
    else
        (void)snprintf(text, PARTY_MAX, "%s", kind);
    return text;
}

static void collision_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_collision *collision = &event->collision;
    char a[PARTY_MAX], b[PARTY_MAX];
    (void)snprintf(text, EVENT_TEXT_MAX, "%s hit %s at %.1f m/s: %s",
                   party_text(a, kind[EVENT_TEXT_FIRST], collision->a),
                   party_text(b, kind[EVENT_TEXT_SECOND], collision->b),
                   (double)collision->closing_mps,
                   response_name((enum response)collision->response));
}

static void fire_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_fire *fire = &event->fire;
    char by[PARTY_MAX], at[PARTY_MAX];
    const char *shooter =
        fire->shooter.id ? party_text(by, kind[EVENT_TEXT_FIRST], fire->shooter) : "the sky";
    if (fire->target.id)
        (void)snprintf(text, EVENT_TEXT_MAX, "%s fired at %s", shooter,
                       party_text(at, kind[EVENT_TEXT_SECOND], fire->target));
    else
        (void)snprintf(text, EVENT_TEXT_MAX, "%s fired a %s", shooter, kind[EVENT_TEXT_MUNITION]);
}

static void detonation_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_detonation *detonation = &event->detonation;
    struct event_party victim = detonation->struck_party;
    char party[PARTY_MAX];
    (void)snprintf(text, EVENT_TEXT_MAX, "%s struck %s%s", kind[EVENT_TEXT_MUNITION],
                   victim.id ? party_text(party, kind[EVENT_TEXT_FIRST], victim)
                             : struck_name((enum struck)detonation->struck),
                   victim.id && victim.damage == DAMAGE_DESTROYED ? ", destroyed" : "");
}

static void crater_text(char *text, const struct event *event, const char *const *kind)
{
    (void)kind;
    (void)snprintf(text, EVENT_TEXT_MAX, "crater of %.1f m, %.1f m deep",
                   (double)event->crater.radius_m, (double)event->crater.depth_m);
}

static void agent_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_agent *agent = &event->agent;
    char party[PARTY_MAX];
    (void)snprintf(text, EVENT_TEXT_MAX, "%s: %s to %s, %s",
                   party_text(party, kind[EVENT_TEXT_FIRST], agent->agent),
                   behaviour_name((enum behaviour)agent->from),
                   behaviour_name((enum behaviour)agent->to),
                   agent_reason_name((enum agent_reason)agent->because));
}

static void contact_end_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_contact_end *end = &event->contact_end;
    char a[PARTY_MAX], b[PARTY_MAX];
    const char *first = party_text(a, kind[EVENT_TEXT_FIRST], end->a);
    const char *second = party_text(b, kind[EVENT_TEXT_SECOND], end->b);
    if (end->because == CONTACT_END_NO_ROOM)
        (void)snprintf(text, EVENT_TEXT_MAX, "%s and %s: no room for their contact", first, second);
    else
        (void)snprintf(text, EVENT_TEXT_MAX, "%s and %s parted after %.1f s", first, second,
                       end->lasted_s);
}

static void command_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_command *command = &event->command;
    char about[16] = "";
    (void)kind;
    if (command->entity)
        (void)snprintf(about, sizeof about, " %u", command->entity);
    (void)snprintf(text, EVENT_TEXT_MAX, "command %s%s: %s",
                   command_type_name((enum command_type)command->type), about,
                   command_result_name((enum command_result)command->result));
}

static void result_text(char *text, const struct event_mission *mission)
{
    const char *winner =
        mission->force == FORCE_NEUTRAL ? "nobody" : force_name((enum force)mission->force);
    (void)snprintf(text, EVENT_TEXT_MAX,
                   "battle %u ends: %s wins; blue holds %u and lost %u, red holds %u and lost %u",
                   mission->round, winner, mission->held[FORCE_BLUE], mission->lost[FORCE_BLUE],
                   mission->held[FORCE_RED], mission->lost[FORCE_RED]);
}

static void mission_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_mission *mission = &event->mission;
    (void)kind;
    switch ((enum mission_news)mission->news) {
    case MISSION_NEWS_OBJECTIVE:
        (void)snprintf(text, EVENT_TEXT_MAX, "%s takes %.23s from %s",
                       force_name((enum force)mission->force), mission->name,
                       force_name((enum force)mission->from));
        break;
    case MISSION_NEWS_RESULT:
        result_text(text, mission);
        break;
    case MISSION_NEWS_AGAIN:
        (void)snprintf(text, EVENT_TEXT_MAX, "battle %u begins", mission->round);
        break;
    default:
        (void)snprintf(text, EVENT_TEXT_MAX, "%.23s: %.23s", mission->name, mission->phase);
        break;
    }
}

static void input_text(char *text, const struct event *event, const char *const *kind)
{
    const struct event_input *input = &event->input;
    char id[REMOTE_ID_TEXT];
    (void)kind;
    if (input->refused == 0)
        (void)snprintf(text, EVENT_TEXT_MAX, "%u records of other simulators", input->count);
    else
        (void)snprintf(text, EVENT_TEXT_MAX,
                       "%u records of other simulators, %u refused: of %s, %s", input->count,
                       input->refused, remote_id_text(input->remote, id),
                       remote_refusal_name((enum remote_refusal)input->because));
}

static const struct event_row {
    const char *word;
    void (*text)(char *text, const struct event *event, const char *const *kind);
} rows[] = {[EVENT_NONE] = {"none", NULL},
#define X(tag, word) [EVENT_##tag] = {#word, word##_text},
            EVENT_TYPES(X)
#undef X
};

void event_text_parties(const struct event *event,
                        const struct event_party *parties[EVENT_TEXT_PARTIES])
{
    parties[EVENT_TEXT_FIRST] = parties[EVENT_TEXT_SECOND] = parties[EVENT_TEXT_MUNITION] = NULL;
    switch ((enum event_type)event->type) {
    case EVENT_COLLISION:
        parties[EVENT_TEXT_FIRST] = &event->collision.a;
        parties[EVENT_TEXT_SECOND] = &event->collision.b;
        break;
    case EVENT_FIRE:
        parties[EVENT_TEXT_FIRST] = &event->fire.shooter;
        parties[EVENT_TEXT_SECOND] = &event->fire.target;
        parties[EVENT_TEXT_MUNITION] = &event->fire.munition;
        break;
    case EVENT_DETONATION:
        parties[EVENT_TEXT_FIRST] = &event->detonation.struck_party;
        parties[EVENT_TEXT_MUNITION] = &event->detonation.munition;
        break;
    case EVENT_AGENT:
        parties[EVENT_TEXT_FIRST] = &event->agent.agent;
        break;
    case EVENT_CONTACT_END:
        parties[EVENT_TEXT_FIRST] = &event->contact_end.a;
        parties[EVENT_TEXT_SECOND] = &event->contact_end.b;
        break;
    case EVENT_NONE:
    case EVENT_CRATER:
    case EVENT_COMMAND:
    case EVENT_MISSION:
    case EVENT_INPUT:
    case EVENT_TYPE_COUNT:
        break;
    }
}

void event_text(char text[EVENT_TEXT_MAX], const struct event *event,
                const char *const kind[EVENT_TEXT_PARTIES])
{
    text[0] = '\0';
    if (event->type < EVENT_TYPE_COUNT && rows[event->type].text)
        rows[event->type].text(text, event, kind);
}

const char *event_type_name(enum event_type type)
{
    return (size_t)type < EVENT_TYPE_COUNT ? rows[type].word : "?";
}
