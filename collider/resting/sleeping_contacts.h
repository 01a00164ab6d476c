/* Whether all contacts that last sleep, so that a frame leaves their table as it is. It is found by
 * one look at each of them, before anything is solved. Pure; one thread. */
#ifndef JOLON_COLLIDER_RESTING_SLEEPING_CONTACTS_H
#define JOLON_COLLIDER_RESTING_SLEEPING_CONTACTS_H

#include "collider/response/response_context.h"

#include <stdbool.h>

/* Returns true if no body of the committed table of contacts is awake, none of the contacts
 * overlaps or bears a load, and nothing that a body touches is gone. The frame's pairs have been
 * found, and no response has written a row. */
bool sleeping_contacts_all(const struct response_context *context);

/* Copies the committed table if all slept when the frame began, and nothing has changed since then
 * by which a contact could change. Returns false if it may have. */
bool sleeping_contacts_keep(const struct response_context *context);

#endif
