/* Which contacts of bodies that rest on each other are no impacts. Pure; any thread. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_CONTACT_RESTS_H
#define JOLON_COLLIDER_NARROW_PHASE_CONTACT_RESTS_H

#include "collider/narrow_phase/contact_queue.h"

#include <stdbool.h>

/* Returns true if the bodies of a contact close too slowly for an impact. */
bool contact_rests_on(const struct contact_input *input, const struct contact *contact);

/* Returns true if the bodies of a pair that rest on each other close too slowly for an impact at
 * all of their points. */
bool contact_rests_still(const struct contact_queue *contacts, const struct contact_input *input,
                         uint32_t index);

#endif
