/* Identifiers of DIS for our entities, without a memory: the application and the number are a
 * division of our id, so a restarted gateway says the same. Our ids have 32 bits and are never used
 * again; DIS has 16 bits in each application. Pure; any thread. */
#ifndef JOLON_GATEWAY_ENTITY_IDS_H
#define JOLON_GATEWAY_ENTITY_IDS_H

#include "gateway/pdu/pdu.h"

#include <stdbool.h>

/* The numbers of an application: 1 to FFFD. 0, FFFE and FFFF are reserved. */
#define ENTITY_IDS_PER_APPLICATION 65533u

struct entity_ids {
    uint16_t site;
    uint16_t application;  /* the first of the range */
    uint16_t applications; /* their number */
};

/* Writes the identifier of an entity, or of the event that has our id. Returns false, and writes
 * 0:0:0 (no entity), for id 0 and for an id beyond the range of applications. */
bool entity_ids_of(const struct entity_ids *ids, uint32_t id, struct pdu_id *to);

/* The inverse. Returns 0 for an identifier that is none of ours. */
uint32_t entity_ids_back(const struct entity_ids *ids, struct pdu_id from);

#endif
