/* The gateway's way to the network. */
#include "gateway/pdu_output.h"

#include "gateway/pdu/pdu_write.h"
#include "gateway/pdu/timestamp.h"
#include "gateway/udp/udp_socket.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <errno.h>
#include <string.h>
#include <time.h>

#define STATUS_CONSTRUCTIVE 6u /* version 7: live, virtual or constructive: 3 in bits 1 and 2 */

/* PDUs at once, as a share of a second's. */
#define BURST_SHARE 4u

int pdu_output_open(struct pdu_output *output, const char *address, uint16_t port, uint32_t rate_ps,
                    struct error_text *error)
{
    struct error_text reason;
    output->rate_ps = rate_ps;
    if (udp_address_parse(&output->to, address, port, &reason) != 0)
        return error_text_set(error, "gateway.address = \"%s\": %s", address, reason.text);
    output->socket = udp_socket_sender(&output->to, NULL, error);
    return output->socket < 0 ? -1 : 0;
}

bool pdu_output_take(struct pdu_output *output, uint64_t now_ns)
{
    return rate_take(&output->rate, output->rate_ps, output->rate_ps / BURST_SHARE + 1, now_ns);
}

void pdu_output_send(struct pdu_output *output, struct pdu *pdu)
{
    uint8_t bytes[PDU_WRITE_BYTES_MAX];
    struct timespec utc;
    clock_gettime(CLOCK_REALTIME, &utc);
    pdu->header.version = output->version;
    pdu->header.exercise = output->exercise;
    pdu->header.status = STATUS_CONSTRUCTIVE;
    pdu->header.timestamp =
        timestamp_of((double)(utc.tv_sec % 3600) + (double)utc.tv_nsec / 1e9, true);
    size_t size = pdu_write(pdu, bytes, sizeof bytes);
    if (size > 0 && udp_socket_send(output->socket, &output->to, bytes, size) == 0) {
        output->sent++;
        output->octets += size;
        return;
    }
    int cause = errno;
    output->failed++;
    if (log_due(&output->failure_logged_ns, NS_PER_S))
        log_warn("%llu PDUs could not be sent: %s", (unsigned long long)output->failed,
                 size > 0 ? strerror(cause) : "too long");
}
