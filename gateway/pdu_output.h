/* Sends the gateway's PDUs: fills in the header, keeps the rate, counts. */
#ifndef JOLON_GATEWAY_PDU_OUTPUT_H
#define JOLON_GATEWAY_PDU_OUTPUT_H

#include "gateway/pdu/pdu.h"
#include "gateway/udp_output.h"
#include "ipc/process/rate.h"

#include <stdbool.h>

/* What is sent when the rate does not allow all, the last first. Each keeps something back for
 * those behind it, so that a crowd of entities does not delay what happens, and nothing delays
 * answers.
 */
enum pdu_output_weight { PDU_OUTPUT_STATE, PDU_OUTPUT_EVENT, PDU_OUTPUT_ANSWER };

struct pdu_output {
    struct udp_output udp;
    uint8_t version, exercise;
    uint32_t rate_ps; /* PDUs a second */
    struct rate rate;
};

/* Opens the socket. interface: by which multicast leaves (udp_interface.h). Returns 0, or -1 with
 * the reason. */
int pdu_output_open(struct pdu_output *output, const char *address, uint16_t port,
                    unsigned interface, uint32_t rate_ps, struct error_text *error);

/* Returns true if the rate allows one more PDU of this weight now, and takes it from the rate. */
bool pdu_output_take(struct pdu_output *output, enum pdu_output_weight weight, uint64_t now_ns);

/* Sends a PDU whose type and body are set, with the time stamp of when it was as the PDU says:
 * age_s ago, in UTC [s]. */
void pdu_output_send(struct pdu_output *output, struct pdu *pdu, double age_s);

#endif
