/* Events in words, for people: one set, whoever shows them. Pure. */
#ifndef JOLON_WORLD_EVENT_TEXT_H
#define JOLON_WORLD_EVENT_TEXT_H

#include "world/entity/command.h"
#include "world/entity/event.h"

#include <stdbool.h>
#include <stdint.h>

#define EVENT_TEXT_MAX 192u /* [byte] of any of them, with the NUL */

/* One side of an event. Id 0: kind alone says what it is. */
struct event_text_party {
    const char *kind;
    uint32_t id;
};

void event_text_collision(char text[EVENT_TEXT_MAX], struct event_text_party a,
                          struct event_text_party b, double closing_mps, enum response response);
void event_text_fire(char text[EVENT_TEXT_MAX], struct event_text_party shooter,
                     struct event_text_party target, const char *munition);
void event_text_detonation(char text[EVENT_TEXT_MAX], const char *munition,
                           struct event_text_party victim, enum struck struck, bool destroyed);
void event_text_crater(char text[EVENT_TEXT_MAX], double radius_m, double depth_m);
void event_text_agent(char text[EVENT_TEXT_MAX], struct event_text_party agent, uint32_t from,
                      uint32_t to, enum agent_reason because);
/* entity: that it made or changed, 0: none. */
void event_text_command(char text[EVENT_TEXT_MAX], enum command_type type,
                        enum command_result result, uint32_t entity);

#endif
