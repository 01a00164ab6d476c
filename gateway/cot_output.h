/* Events of Cursor on Target for the entities that the gateway sends: another way out beside the
 * PDUs. An event goes with each Entity State, so thresholds, heartbeat and rate are the same. */
#ifndef JOLON_GATEWAY_COT_OUTPUT_H
#define JOLON_GATEWAY_COT_OUTPUT_H

#include "gateway/earth/euler.h"
#include "gateway/type_table.h"
#include "gateway/udp_output.h"

#define COT_OUTPUT_NONE "none" /* of gateway.cot */
#define COT_OUTPUT_PORT 6969   /* of ATAK's and WinTAK's group */

/* An event is out of date when two heartbeats have not come, as an entity of DIS is [s]. */
#define COT_OUTPUT_STALE_S 12

struct cot_output {
    struct udp_output udp;
    uint8_t exercise; /* in the identifiers */
};

/* What an event says of an entity. */
struct cot_output_entity {
    struct pdu_id id;
    const struct type_row *type;
    uint8_t force; /* enum force */
    const char *callsign;
    struct vec3 position;      /* [m] ECEF */
    struct vec3 velocity;      /* [m/s] ECEF */
    const struct mat3 *matrix; /* euler.h; gives the course of what stands */
};

/* Opens the way out to gateway.cot, by an interface (udp_interface.h). Returns 0, or -1 with the
 * reason. */
int cot_output_open(struct cot_output *cot, const char *address, unsigned interface,
                    uint8_t exercise, struct error_text *error);

/* Sends where the entity is; gone: that it is not there any more. The time is the clock's. A type
 * without a row for Cursor on Target is not sent. */
void cot_output_send(struct cot_output *cot, const struct cot_output_entity *entity, bool gone);

#endif
