/* Words of events. */
#include "world/event_text.h"

#include "world/entity/entity.h"
#include "world/enum_names.h"

#include <stdio.h>

#define PARTY_MAX 48

/* "tank 12", "tree 40211", "ground" */
static const char *party_text(char text[PARTY_MAX], struct event_text_party party)
{
    if (party.id)
        (void)snprintf(text, PARTY_MAX, "%s %u", party.kind, party.id);
    else
        (void)snprintf(text, PARTY_MAX, "%s", party.kind);
    return text;
}

void event_text_collision(char text[EVENT_TEXT_MAX], struct event_text_party a,
                          struct event_text_party b, double closing_mps, enum response response)
{
    char first[PARTY_MAX], second[PARTY_MAX];
    (void)snprintf(text, EVENT_TEXT_MAX, "%s hit %s at %.1f m/s: %s", party_text(first, a),
                   party_text(second, b), closing_mps, response_name(response));
}

void event_text_fire(char text[EVENT_TEXT_MAX], struct event_text_party shooter,
                     struct event_text_party target, const char *munition)
{
    char by[PARTY_MAX], at[PARTY_MAX];
    const char *who = shooter.id ? party_text(by, shooter) : "the sky";
    if (target.id)
        (void)snprintf(text, EVENT_TEXT_MAX, "%s fired at %s", who, party_text(at, target));
    else
        (void)snprintf(text, EVENT_TEXT_MAX, "%s fired a %s", who, munition);
}

void event_text_detonation(char text[EVENT_TEXT_MAX], const char *munition,
                           struct event_text_party victim, enum struck struck, bool destroyed)
{
    char party[PARTY_MAX];
    (void)snprintf(text, EVENT_TEXT_MAX, "%s struck %s%s", munition,
                   victim.id ? party_text(party, victim) : struck_name(struck),
                   victim.id && destroyed ? ", destroyed" : "");
}

void event_text_crater(char text[EVENT_TEXT_MAX], double radius_m, double depth_m)
{
    (void)snprintf(text, EVENT_TEXT_MAX, "crater of %.1f m, %.1f m deep", radius_m, depth_m);
}

void event_text_agent(char text[EVENT_TEXT_MAX], struct event_text_party agent, uint32_t from,
                      uint32_t to, enum agent_reason because)
{
    char party[PARTY_MAX];
    (void)snprintf(text, EVENT_TEXT_MAX, "%s: %s to %s, %s", party_text(party, agent),
                   behaviour_name((enum behaviour)from), behaviour_name((enum behaviour)to),
                   agent_reason_name(because));
}

void event_text_command(char text[EVENT_TEXT_MAX], enum command_type type,
                        enum command_result result, uint32_t entity)
{
    char about[16] = "";
    if (entity)
        (void)snprintf(about, sizeof about, " %u", entity);
    (void)snprintf(text, EVENT_TEXT_MAX, "command %s%s: %s", command_type_name(type), about,
                   command_result_name(result));
}
