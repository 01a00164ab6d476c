/* The gateway's way to the network. */
#include "gateway/pdu_output.h"

#include "gateway/pdu/pdu_write.h"
#include "gateway/pdu/timestamp.h"

#include <time.h>

#define STATUS_CONSTRUCTIVE 6u /* version 7: live, virtual or constructive: 3 in bits 1 and 2 */

/* Events and Entity States at once, as a share of a second's, and what of these is kept for events.
 * As much is added for answers. */
#define BURST_SHARE 4u
#define KEPT_SHARE  4u

int pdu_output_open(struct pdu_output *output, const char *address, uint16_t port,
                    unsigned interface, uint32_t rate_ps, struct error_text *error)
{
    output->rate_ps = rate_ps;
    return udp_output_open(&output->udp, "gateway.address", address, port, interface, "PDUs",
                           error);
}

bool pdu_output_take(struct pdu_output *output, enum pdu_output_weight weight, uint64_t now_ns)
{
    uint32_t events = output->rate_ps / BURST_SHARE + 1, kept = events / KEPT_SHARE + 1;
    uint32_t burst = weight == PDU_OUTPUT_ANSWER  ? events + kept
                     : weight == PDU_OUTPUT_EVENT ? events
                     : events > kept              ? events - kept
                                                  : 1;
    return rate_take(&output->rate, output->rate_ps, burst, now_ns);
}

void pdu_output_send(struct pdu_output *output, struct pdu *pdu, double age_s)
{
    uint8_t bytes[PDU_WRITE_BYTES_MAX];
    struct timespec utc;
    clock_gettime(CLOCK_REALTIME, &utc);
    pdu->header.version = output->version;
    pdu->header.exercise = output->exercise;
    pdu->header.status = STATUS_CONSTRUCTIVE;
    pdu->header.timestamp =
        timestamp_of((double)(utc.tv_sec % 3600) + (double)utc.tv_nsec / 1e9 - age_s, true);
    udp_output_send(&output->udp, bytes, pdu_write(pdu, bytes, sizeof bytes));
}
