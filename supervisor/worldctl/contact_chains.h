/* The persistent contacts of each entity, for dumps. */
#ifndef JOLON_SUPERVISOR_WORLDCTL_CONTACT_CHAINS_H
#define JOLON_SUPERVISOR_WORLDCTL_CONTACT_CHAINS_H

#include "ipc/frame/snapshot.h"
#include "ipc/json/world_json.h"

#include <stdint.h>

/* The contacts of each row as a chain. Side 2 * n belongs to a of contact n, 2 * n + 1 to b. */
struct contact_chains {
    const struct persistent_contact *contacts; /* the snapshot's */
    uint32_t *first;                           /* [used] the row's first side + 1, 0: none */
    uint32_t *next;                            /* [2 * contact_count] the next side + 1, 0: none */
};

/* Chains the contacts of a snapshot that passed its checks. Returns 0, or -1 with errno ENOMEM. */
int contact_chains_make(struct contact_chains *chains, const struct snapshot *snapshot);
void contact_chains_free(struct contact_chains *chains);

/* Adds the list "contacts" of a row: of each the other body's id (a fixed object's number, from 1,
 * when "fixed" is true), "begin_tick" and "pressed_tick". Ends the process when out of memory. */
void contact_chains_json(cJSON *object, const struct contact_chains *chains, uint32_t row);

#endif
