/* Sockets of UDP. */
#include "gateway/udp/udp_socket.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define RECEIVE_BUFFER                                                                             \
    (4 * 1024 * 1024) /* a burst of some thousand PDUs; the system may give less */

static int refused(int socket, const struct udp_address *address, const char *what,
                   struct error_text *error)
{
    char text[UDP_ADDRESS_TEXT];
    int cause = errno;
    if (socket >= 0)
        close(socket);
    return error_text_set(
        error, "%s: cannot %s: %s", udp_address_text(address, text, sizeof text), what,
        cause == EADDRINUSE ? "another program does (ss -lunp lists them); what is sent to an "
                              "address of this machine has one receiver, so take another port, "
                              "or a group of multicast"
                            : strerror(cause));
}

static int set(int socket, int level, int name, int value)
{
    return setsockopt(socket, level, name, &value, sizeof value);
}

/* An address of a link without its interface means nothing. */
static int unscoped(const struct udp_address *address, struct error_text *error)
{
    char text[UDP_ADDRESS_TEXT];
    return error_text_set(error,
                          "%s: is an address of one link, and needs an interface: set "
                          "gateway.interface, or --interface of jolon dis, to its name",
                          udp_address_text(address, text, sizeof text));
}

/* Selects the interface by which multicast leaves. */
static int leave_by(int out, const struct udp_address *to, unsigned interface)
{
    struct ip_mreqn by = {.imr_ifindex = (int)interface};
    if (interface == 0 || !udp_address_multicast(to))
        return 0;
    if (to->any.sa_family == AF_INET6)
        return set(out, IPPROTO_IPV6, IPV6_MULTICAST_IF, (int)interface);
    return setsockopt(out, IPPROTO_IP, IP_MULTICAST_IF, &by, sizeof by);
}

int udp_socket_sender(const struct udp_address *to, unsigned interface, struct error_text *error)
{
    char text[UDP_ADDRESS_TEXT];
    if (udp_address_wildcard(to)) /* the system would send to this machine */
        return error_text_set(error,
                              "%s: is no address to send to; right would be that of a machine, of "
                              "a broadcast such as 10.0.0.255, or of a group such as 239.1.2.3",
                              udp_address_text(to, text, sizeof text));
    if (udp_address_link_local(to) && !udp_address_multicast(to) && interface == 0)
        return unscoped(to, error);
    int out = socket(to->any.sa_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (out < 0)
        return refused(out, to, "make a socket", error);
    if (to->any.sa_family == AF_INET && set(out, SOL_SOCKET, SO_BROADCAST, 1) != 0)
        return refused(out, to, "broadcast", error);
    if (leave_by(out, to, interface) != 0)
        return refused(out, to, "send by this interface", error);
    return out;
}

bool udp_socket_broadcast(const struct udp_address *address)
{
    if (address->any.sa_family != AF_INET)
        return false;
    int out = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (out < 0)
        return false;
    /* The system refuses a broadcast to a socket without SO_BROADCAST, and knows its networks. */
    bool is = connect(out, &address->any, udp_address_bytes(address)) != 0 && errno == EACCES;
    close(out);
    return is;
}

uint16_t udp_socket_port(int socket, uint16_t wanted)
{
    struct udp_address own = {0};
    socklen_t length = sizeof own;
    if (getsockname(socket, &own.any, &length) != 0)
        return 0;
    if (own.any.sa_family == AF_INET6)
        own.v6.sin6_port = htons(wanted);
    else
        own.v4.sin_port = htons(wanted);
    if (bind(socket, &own.any, length) != 0)
        return wanted != 0 ? udp_socket_port(socket, 0) : 0;
    return getsockname(socket, &own.any, &length) == 0 ? udp_address_port(&own) : 0;
}

static int join(int in, const struct udp_address *at, unsigned interface)
{
    if (at->any.sa_family == AF_INET6) {
        struct ipv6_mreq group = {.ipv6mr_multiaddr = at->v6.sin6_addr,
                                  .ipv6mr_interface = interface};
        return setsockopt(in, IPPROTO_IPV6, IPV6_ADD_MEMBERSHIP, &group, sizeof group);
    }
    struct ip_mreqn group = {.imr_multiaddr = at->v4.sin_addr, .imr_ifindex = (int)interface};
    return setsockopt(in, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
}

int udp_socket_listener(const struct udp_address *at, unsigned interface, struct error_text *error)
{
    struct udp_address scoped = *at;
    bool group = udp_address_multicast(at);
    udp_address_scope(&scoped, interface);
    if (udp_address_link_local(at) && interface == 0)
        return unscoped(at, error);
    int in = socket(at->any.sa_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (in < 0)
        return refused(in, at, "make a socket", error);
    (void)set(in, SOL_SOCKET, SO_RCVBUF, RECEIVE_BUFFER);
    if ((group || udp_socket_broadcast(at)) && set(in, SOL_SOCKET, SO_REUSEADDR, 1) != 0)
        return refused(in, at, "share the address", error);
    if (bind(in, &scoped.any, udp_address_bytes(at)) != 0)
        return refused(in, at, "receive there", error);
    if (group && join(in, at, interface) != 0)
        return refused(in, at, "join the group", error);
    return in;
}

int udp_socket_send(int socket, const struct udp_address *to, const void *bytes, size_t size)
{
    ssize_t sent;
    do {
        sent = sendto(socket, bytes, size, MSG_NOSIGNAL, &to->any, udp_address_bytes(to));
    } while (sent < 0 && errno == EINTR);
    /* The kernel reports that an earlier datagram reached no receiver, and has not sent this one.
     */
    if (sent < 0 && errno == ECONNREFUSED)
        sent = sendto(socket, bytes, size, MSG_NOSIGNAL, &to->any, udp_address_bytes(to));
    return sent >= 0 || errno == ECONNREFUSED ? 0 : -1;
}

int udp_socket_receive(int socket, void *bytes, size_t size, struct udp_address *from)
{
    socklen_t length = sizeof *from;
    memset(from, 0, sizeof *from);
    ssize_t got = recvfrom(socket, bytes, size, 0, &from->any, &length);
    return got < 0 ? -1 : (int)got;
}

uint32_t udp_socket_receive_many(int socket, struct udp_datagram *datagrams, uint32_t count)
{
    struct mmsghdr message[UDP_SOCKET_AT_ONCE];
    struct iovec place[UDP_SOCKET_AT_ONCE];
    count = count < UDP_SOCKET_AT_ONCE ? count : UDP_SOCKET_AT_ONCE;
    memset(message, 0, sizeof message);
    for (uint32_t i = 0; i < count; i++) {
        memset(&datagrams[i].from, 0, sizeof datagrams[i].from);
        place[i] = (struct iovec){datagrams[i].bytes, datagrams[i].room};
        message[i].msg_hdr = (struct msghdr){.msg_name = &datagrams[i].from.any,
                                             .msg_namelen = sizeof datagrams[i].from,
                                             .msg_iov = &place[i],
                                             .msg_iovlen = 1};
    }
    int got = recvmmsg(socket, message, count, MSG_DONTWAIT, NULL);
    for (int i = 0; i < got; i++)
        datagrams[i].size = message[i].msg_len;
    return got < 0 ? 0 : (uint32_t)got;
}

bool udp_socket_wait(int socket, uint64_t wait_ns)
{
    struct pollfd ready = {.fd = socket, .events = POLLIN};
    struct timespec wait = {(time_t)(wait_ns / 1000000000u), (long)(wait_ns % 1000000000u)};
    return ppoll(&ready, 1, &wait, NULL) > 0;
}
