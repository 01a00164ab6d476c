/* Events as text for people, the same wherever they are shown. Pure; any thread. */
#ifndef JOLON_WORLD_EVENT_TEXT_H
#define JOLON_WORLD_EVENT_TEXT_H

#include "world/entity/event.h"

#define EVENT_TEXT_MAX 192u /* [byte] of any of them, with the NUL */

/* The parties of an event; a type of event does not have all of them. */
enum event_text_party {
    EVENT_TEXT_FIRST,  /* the body a, the shooter, the party struck, the agent */
    EVENT_TEXT_SECOND, /* the body b, the target */
    EVENT_TEXT_MUNITION,
    EVENT_TEXT_PARTIES
};

/* Points to the event's parties; NULL for those that its type does not have. */
void event_text_parties(const struct event *event,
                        const struct event_party *parties[EVENT_TEXT_PARTIES]);

/* Writes the event's text, "" for an unknown type. kind: for each party of the event the name of
 * its kind; a party without an id is named by that alone. */
void event_text(char text[EVENT_TEXT_MAX], const struct event *event,
                const char *const kind[EVENT_TEXT_PARTIES]);

/* The word of a type; "?" for an unknown type. */
const char *event_type_name(enum event_type type);

#endif
