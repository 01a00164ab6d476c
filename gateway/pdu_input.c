/* The gateway's ear. */
#include "gateway/pdu_input.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <inttypes.h>
#include <string.h>

#define MINUTE_NS (60 * (uint64_t)NS_PER_S)

int pdu_input_open(struct pdu_input *input, const char *listen, unsigned interface,
                   struct error_text *error)
{
    struct error_text reason;
    input->socket = -1;
    if (strcmp(listen, PDU_INPUT_NONE) == 0)
        return 0;
    if (udp_address_parse(&input->at, listen, PDU_PORT, &reason) != 0)
        return error_text_set(error, "gateway.listen = \"%s\": %s", listen, reason.text);
    input->socket = udp_socket_listener(&input->at, interface, &reason);
    return input->socket >= 0 ? 0 : error_text_set(error, "gateway.listen: %s", reason.text);
}

bool pdu_input_hears(const struct pdu_input *input, const struct udp_address *to)
{
    bool group = udp_address_multicast(to);
    if (input->socket < 0 || (!group && !udp_socket_broadcast(to)))
        return true;
    return udp_address_port(&input->at) == udp_address_port(to) &&
           (udp_address_same_host(&input->at, to) || (!group && udp_address_wildcard(&input->at)));
}

/* Returns the simulation that issued a PDU, {0} for a type that Jolon does not know. */
static struct pdu_id issuer_of(const struct pdu *pdu)
{
    switch ((enum pdu_type)pdu->header.type) {
    case PDU_ENTITY_STATE:
        return pdu->entity_state.id;
    case PDU_FIRE:
        return pdu->fire.firer;
    case PDU_DETONATION:
        return pdu->detonation.firer;
    case PDU_COLLISION:
        return pdu->collision.issuer;
    case PDU_COLLISION_ELASTIC:
        return pdu->collision_elastic.issuer;
    case PDU_CREATE:
    case PDU_REMOVE:
    case PDU_START_RESUME:
    case PDU_STOP_FREEZE:
    case PDU_ACKNOWLEDGE:
        return pdu->management.originator;
    }
    return (struct pdu_id){0, 0, 0};
}

/* The event of a Fire and of a Detonation is issued by who sends it; the firer of a shot from
 * nowhere is 0:0:0. */
static struct pdu_id event_of(const struct pdu *pdu)
{
    switch ((enum pdu_type)pdu->header.type) {
    case PDU_FIRE:
        return pdu->fire.event;
    case PDU_DETONATION:
        return pdu->detonation.event;
    default:
        return (struct pdu_id){0, 0, 0};
    }
}

static bool is_own(const struct entity_ids *own, struct pdu_id id)
{
    return id.site == own->site && id.application >= own->application &&
           id.application - own->application < own->applications;
}

/* Notes a PDU with our own numbers. One from another port is none of ours that comes back. */
static void note_echo(struct pdu_input *input, const struct udp_datagram *datagram)
{
    input->echoes++;
    if (input->sender_port == 0 || udp_address_port(&datagram->from) == input->sender_port)
        return;
    input->twins++;
    input->twin_from = datagram->from;
}

static void take(struct pdu_input *input, const struct pdu *pdu,
                 const struct udp_datagram *datagram, pdu_input_handler *handler, void *context,
                 uint64_t now_ns)
{
    if (pdu->header.exercise != input->exercise) {
        input->foreign++;
        input->foreign_from = datagram->from;
        input->foreign_exercise = pdu->header.exercise;
    } else if (is_own(&input->own, issuer_of(pdu)) || is_own(&input->own, event_of(pdu))) {
        note_echo(input, datagram);
    } else {
        handler(context, pdu, &datagram->from, now_ns);
    }
}

/* Returns true if datagrams are taken from this sender. */
static bool from_peer(struct pdu_input *input, const struct udp_datagram *datagram)
{
    struct internet_address address = udp_address_internet(&datagram->from);
    if (gateway_lists_has_peer(&input->peers, &address))
        return true;
    input->strangers++;
    input->stranger_from = datagram->from;
    return false;
}

static void read_datagram(struct pdu_input *input, const struct udp_datagram *datagram,
                          pdu_input_handler *handler, void *context, uint64_t now_ns)
{
    static struct pdu pdu;
    struct pdu_cursor cursor = {datagram->bytes, datagram->size, 0};
    enum pdu_result result;
    input->counts.datagrams++;
    input->counts.octets += datagram->size;
    while ((result = pdu_read(&cursor, &pdu)) != PDU_END) {
        pdu_read_count(&input->counts, result, &pdu);
        if (result == PDU_GOOD) {
            take(input, &pdu, datagram, handler, context, now_ns);
        } else if (result != PDU_SKIPPED) {
            input->bad++;
            input->bad_from = datagram->from;
        }
    }
}

uint32_t pdu_input_receive(struct pdu_input *input, pdu_input_handler *handler, void *context,
                           uint64_t now_ns)
{
    static uint8_t bytes[UDP_SOCKET_AT_ONCE][UDP_SOCKET_BYTES_MAX];
    static struct udp_datagram datagrams[UDP_SOCKET_AT_ONCE];
    uint32_t total = 0, count = UDP_SOCKET_AT_ONCE;
    if (input->socket < 0)
        return 0;
    for (uint32_t i = 0; i < UDP_SOCKET_AT_ONCE; i++) {
        datagrams[i].bytes = bytes[i];
        datagrams[i].room = sizeof bytes[i];
    }
    while (count == UDP_SOCKET_AT_ONCE && total < PDU_INPUT_DATAGRAMS) {
        count = udp_socket_receive_many(input->socket, datagrams, UDP_SOCKET_AT_ONCE);
        for (uint32_t i = 0; i < count; i++) {
            if (from_peer(input, &datagrams[i]))
                read_datagram(input, &datagrams[i], handler, context, now_ns);
        }
        total += count;
    }
    return total;
}

/* --- the log -----------------------------------------------------------------------------------*/

bool pdu_input_tell_strangers(void *subject, uint64_t now_ns)
{
    struct pdu_input *input = subject;
    char from[UDP_ADDRESS_TEXT];
    (void)now_ns;
    if (input->strangers == input->strangers_told)
        return false;
    log_warn("%" PRIu64 " more datagrams of strangers were refused, the last from %s: "
             "gateway.peers does not name it",
             input->strangers - input->strangers_told,
             udp_address_text(&input->stranger_from, from, sizeof from));
    input->strangers_told = input->strangers;
    return true;
}

/* Says how many faults there were since the last time, and by the example of the last sender. */
bool pdu_input_tell_faults(void *subject, uint64_t now_ns)
{
    struct pdu_input *input = subject;
    char from[UDP_ADDRESS_TEXT];
    enum pdu_result most = PDU_BAD_HEADER;
    (void)now_ns;
    if (input->bad == input->bad_told)
        return false;
    for (int i = PDU_BAD_HEADER; i < PDU_RESULTS; i++) {
        if (input->counts.result[i] > input->counts.result[most])
            most = (enum pdu_result)i;
    }
    log_warn("%" PRIu64 " more PDUs with faults were dropped, the last of a datagram from %s; most "
             "of all have %s",
             input->bad - input->bad_told, udp_address_text(&input->bad_from, from, sizeof from),
             pdu_result_text(most));
    input->bad_told = input->bad;
    return true;
}

/* Returns true if a count has grown and was not told for a minute. */
static bool minute_over(uint64_t count, uint64_t *told, uint64_t *told_ns, uint64_t now_ns)
{
    if (count == *told || (*told_ns != 0 && now_ns - *told_ns < MINUTE_NS))
        return false;
    *told = count;
    *told_ns = now_ns;
    return true;
}

bool pdu_input_tell_foreign(void *subject, uint64_t now_ns)
{
    struct pdu_input *input = subject;
    char from[UDP_ADDRESS_TEXT];
    if (!minute_over(input->foreign, &input->foreign_told, &input->foreign_told_ns, now_ns))
        return false;
    log_info("%s sends PDUs of exercise %u, which are left out: ours is %u (%" PRIu64
             " so far of all other exercises)",
             udp_address_text(&input->foreign_from, from, sizeof from), input->foreign_exercise,
             input->exercise, input->foreign);
    return true;
}

bool pdu_input_tell_twins(void *subject, uint64_t now_ns)
{
    struct pdu_input *input = subject;
    char from[UDP_ADDRESS_TEXT];
    if (!minute_over(input->twins, &input->twins_told, &input->twins_told_ns, now_ns))
        return false;
    log_warn("%s sends PDUs with our own numbers, gateway.site = %u and gateway.application = %u "
             "to %u, which are left out as ours that come back (%" PRIu64
             " so far): if it is another simulator, give one of the two another gateway.site",
             udp_address_text(&input->twin_from, from, sizeof from), input->own.site,
             input->own.application, input->own.application + input->own.applications - 1u,
             input->twins);
    return true;
}
