/* A way out to the network. */
#include "gateway/udp_output.h"

#include "gateway/udp/udp_socket.h"
#include "ipc/process/log.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

int udp_output_open(struct udp_output *output, const char *key, const char *address, uint16_t port,
                    unsigned interface, const char *what, struct error_text *error)
{
    struct error_text reason;
    *output = (struct udp_output){.socket = -1, .what = what};
    if (udp_address_parse(&output->to, address, port, &reason) != 0)
        return error_text_set(error, "%s = \"%s\": %s", key, address, reason.text);
    udp_address_scope(&output->to, interface);
    output->socket = udp_socket_sender(&output->to, interface, &reason);
    return output->socket >= 0 ? 0 : error_text_set(error, "%s: %s", key, reason.text);
}

void udp_output_send(struct udp_output *output, const void *bytes, size_t size)
{
    if (size > 0 && udp_socket_send(output->socket, &output->to, bytes, size) == 0) {
        output->sent++;
        output->octets += size;
        return;
    }
    output->cause = size > 0 ? errno : 0;
    output->failed++;
}

bool udp_output_tell(void *subject, uint64_t now_ns)
{
    struct udp_output *output = subject;
    (void)now_ns;
    if (output->failed == output->failed_told)
        return false;
    log_warn("%" PRIu64 " %s could not be sent: %s", output->failed, output->what,
             output->cause != 0 ? strerror(output->cause) : "too long");
    output->failed_told = output->failed;
    return true;
}
