/* The options --listen and --interface. */
#include "gateway/tool/listener.h"

#include "gateway/pdu/pdu.h"
#include "gateway/udp/udp_address.h"
#include "gateway/udp/udp_interface.h"
#include "gateway/udp/udp_socket.h"
#include "ipc/process/log.h"
#include "world/runtime/error_text.h"

#include <stddef.h>

unsigned listener_interface(const char *interface)
{
    struct error_text error;
    unsigned number = 0;
    if (interface && udp_interface_find(&number, interface, &error) != 0)
        die_usage("--interface %s: %s", interface, error.text);
    return number;
}

int listener_open(const char *listen, const char *interface, struct udp_address *at)
{
    struct error_text error;
    if (udp_address_parse(at, listen, PDU_PORT, &error) != 0)
        die_usage("--listen %s: %s", listen, error.text);
    int socket = udp_socket_listener(at, listener_interface(interface), &error);
    if (socket < 0)
        die_refused("%s", error.text);
    return socket;
}
