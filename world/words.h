/* Events in words, for people: one set, whoever shows them. Pure. */
#ifndef JOLON_WORLD_WORDS_H
#define JOLON_WORLD_WORDS_H

#include "world/command.h"
#include "world/event.h"

#include <stdbool.h>
#include <stdint.h>

#define WORDS_MAX 192u /* [byte] of any of them, with the NUL */

/* One side of an event. Id 0: kind alone says what it is. */
struct words_party {
    const char *kind;
    uint32_t id;
};

void words_collision(char text[WORDS_MAX], struct words_party a, struct words_party b,
                     double closing_mps, enum response response);
void words_fire(char text[WORDS_MAX], struct words_party shooter, struct words_party target,
                const char *munition);
void words_detonation(char text[WORDS_MAX], const char *munition, struct words_party victim,
                      enum struck struck, bool destroyed);
void words_crater(char text[WORDS_MAX], double radius_m, double depth_m);
void words_agent(char text[WORDS_MAX], struct words_party agent, uint32_t from, uint32_t to,
                 enum agent_reason because);
/* entity: that it made or changed, 0: none. */
void words_command(char text[WORDS_MAX], enum command_type type, enum command_result result,
                   uint32_t entity);

#endif
