/* A way out to the network. */
#include "gateway/udp_output.h"

#include "gateway/udp/udp_socket.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

int udp_output_open(struct udp_output *output, const char *key, const char *address, uint16_t port,
                    const char *what, struct error_text *error)
{
    struct error_text reason;
    *output = (struct udp_output){.socket = -1, .what = what};
    if (udp_address_parse(&output->to, address, port, &reason) != 0)
        return error_text_set(error, "%s = \"%s\": %s", key, address, reason.text);
    output->socket = udp_socket_sender(&output->to, NULL, error);
    return output->socket < 0 ? -1 : 0;
}

void udp_output_send(struct udp_output *output, const void *bytes, size_t size)
{
    if (size > 0 && udp_socket_send(output->socket, &output->to, bytes, size) == 0) {
        output->sent++;
        output->octets += size;
        return;
    }
    int cause = errno;
    output->failed++;
    if (log_due(&output->failure_logged_ns, NS_PER_S))
        log_warn("%" PRIu64 " %s could not be sent: %s", output->failed, output->what,
                 size > 0 ? strerror(cause) : "too long");
}
