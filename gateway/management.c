/* Simulation management. */
#include "gateway/management.h"

#include "gateway/pdu/pdu_layout.h"
#include "gateway/pdu/timestamp.h"
#include "ipc/process/log.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define HOUR_S 3600.0

/* Takes over the requests that wait, as far as they are still allowed. */
static void take_over(struct management *management)
{
    struct management_note note;
    uint32_t count = 0;
    for (uint32_t i = 0; i < MANAGEMENT_NOTES; i++) {
        if (!management_notes_get(management->notes, i, &note) ||
            !gateway_lists_has_control(&management->control, note.from.site, note.from.application))
            continue;
        management->request[i] = (struct management_request){.from = note.from,
                                                             .as = note.as,
                                                             .number = note.number,
                                                             .type = (uint8_t)note.type,
                                                             .state = MANAGEMENT_WAITS,
                                                             .due_s = note.due_s};
        count++;
    }
    if (count > 0)
        log_info("takes over requests that wait for their time: %u", count);
}

int management_open(struct management *management, struct pdu_output *output, struct entity_ids ids,
                    const char *control, struct command_link link, struct management_notes *notes,
                    struct error_text *error)
{
    memset(management, 0, sizeof *management);
    management->output = output;
    management->ids = ids;
    management->notes = notes;
    if (gateway_lists_control(&management->control, control, error) != 0)
        return -1;
    take_over(management);
    return command_client_open(&management->client, link, error);
}

/* --- what a request says -----------------------------------------------------------------------*/

static const char *name_of(uint8_t type)
{
    const struct pdu_layout *layout = pdu_layout_of(type);
    return layout ? layout->name : "?";
}

/* Returns true if a number of an identifier means this one of ours. */
static bool means(uint16_t number, uint16_t first, uint16_t count)
{
    return number == PDU_ID_ALL || (number >= first && number - first < count);
}

/* Returns true if a request is for us, with the identifier that acknowledges it. */
static bool for_us(const struct management *management, struct pdu_id receiver, struct pdu_id *as)
{
    const struct entity_ids *ids = &management->ids;
    bool one = receiver.application != PDU_ID_ALL;
    *as = (struct pdu_id){ids->site, one ? receiver.application : ids->application, 0};
    return means(receiver.site, ids->site, 1) &&
           means(receiver.application, ids->application, ids->applications);
}

/* Returns the time at which a request is to be carried out, 0 for at once. */
static double time_of(const struct pdu_management *body)
{
    return HOUR_S * body->real_time.hours + timestamp_seconds(body->real_time.past_hour);
}

/* --- acknowledging -----------------------------------------------------------------------------*/

static uint32_t place_of(const struct management *management,
                         const struct management_request *request)
{
    return (uint32_t)(request - management->request);
}

/* Sends the acknowledgements that are owed. What the rate puts off stays owed. */
static void acknowledge(struct management *management, struct management_request *request,
                        uint16_t response, uint64_t now_ns)
{
    static const uint16_t flags[] = {[PDU_CREATE] = PDU_ACKNOWLEDGE_CREATE,
                                     [PDU_REMOVE] = PDU_ACKNOWLEDGE_REMOVE,
                                     [PDU_START_RESUME] = PDU_ACKNOWLEDGE_START,
                                     [PDU_STOP_FREEZE] = PDU_ACKNOWLEDGE_STOP};
    static struct pdu pdu;
    for (; request->owed > 0; request->owed--) {
        if (!pdu_output_take(management->output, PDU_OUTPUT_ANSWER, now_ns))
            return;
        pdu.header.type = PDU_ACKNOWLEDGE;
        pdu.management = (struct pdu_management){.originator = request->as,
                                                 .receiver = request->from,
                                                 .acknowledge = flags[request->type],
                                                 .response = response,
                                                 .request = request->number};
        pdu_output_send(management->output, &pdu, 0.0);
    }
}

static void finish(struct management *management, struct management_request *request,
                   uint16_t response, const char *why, uint64_t now_ns)
{
    request->state = MANAGEMENT_DONE;
    request->response = response;
    management_notes_drop(management->notes, place_of(management, request));
    acknowledge(management, request, response, now_ns);
    management->done++;
    management->done_last = *request;
    management->done_why = why;
}

bool management_tell_done(void *subject, uint64_t now_ns)
{
    struct management *management = subject;
    const struct management_request *last = &management->done_last;
    char others[64] = "";
    (void)now_ns;
    if (management->done == management->done_told)
        return false;
    if (management->done - management->done_told > 1)
        (void)snprintf(others, sizeof others, " (and %" PRIu64 " others before it)",
                       management->done - management->done_told - 1);
    log_info("%s %" PRIu32 " of %u:%u:%u: %s%s", name_of(last->type), last->number, last->from.site,
             last->from.application, last->from.entity, management->done_why, others);
    management->done_told = management->done;
    return true;
}

bool management_tell_refused(void *subject, uint64_t now_ns)
{
    struct management *management = subject;
    const struct management_request *last = &management->refused_last;
    (void)now_ns;
    if (management->refused == management->refused_told)
        return false;
    log_warn("%s of %u:%u:%u is ignored: gateway.control does not name it (%" PRIu64 " so far)",
             name_of(last->type), last->from.site, last->from.application, last->from.entity,
             management->refused);
    management->refused_told = management->refused;
    return true;
}

/* --- carrying out ------------------------------------------------------------------------------*/

static void carry_out(struct management *management, struct management_request *request,
                      uint64_t now_ns)
{
    jolon_Command command;
    memset(&command, 0, sizeof command);
    command.type = request->type == PDU_STOP_FREEZE ? jolon_COMMAND_PAUSE : jolon_COMMAND_RESUME;
    request->sequence = command_client_send(&management->client, &command);
    request->state = MANAGEMENT_SENT;
    request->late_ns = now_ns + MANAGEMENT_ANSWER_NS;
    if (request->sequence == 0)
        finish(management, request, PDU_RESPONSE_UNABLE, "too many commands wait", now_ns);
}

static void poll_request(struct management *management, struct management_request *request,
                         uint64_t now_ns, double utc_s)
{
    jolon_CommandReply reply;
    if (request->state == MANAGEMENT_WAITS)
        acknowledge(management, request, PDU_RESPONSE_ABLE, now_ns);
    if (request->state == MANAGEMENT_DONE)
        acknowledge(management, request, request->response, now_ns);
    if (request->state == MANAGEMENT_WAITS && utc_s >= request->due_s)
        carry_out(management, request, now_ns);
    if (request->state != MANAGEMENT_SENT)
        return;
    if (command_client_answered(&management->client, request->sequence, &reply)) {
        bool done = reply.result == jolon_RESULT_DONE;
        const char *why = !done                              ? "the world has refused it"
                          : request->type == PDU_STOP_FREEZE ? "the world is paused"
                                                             : "the world runs";
        finish(management, request, done ? PDU_RESPONSE_ABLE : PDU_RESPONSE_UNABLE, why, now_ns);
    } else if (now_ns >= request->late_ns) {
        command_client_forget(&management->client, request->sequence);
        finish(management, request, PDU_RESPONSE_UNABLE, "the world has not answered", now_ns);
    }
}

void management_poll(struct management *management, uint64_t now_ns, double utc_s)
{
    if (management->control.count == 0)
        return;
    command_client_poll(&management->client);
    for (uint32_t i = 0; i < MANAGEMENT_REQUESTS; i++)
        poll_request(management, &management->request[i], now_ns, utc_s);
}

/* --- taking ------------------------------------------------------------------------------------*/

static bool same_sender(const struct management_request *request, struct pdu_id from)
{
    return request->state != MANAGEMENT_FREE && request->from.site == from.site &&
           request->from.application == from.application && request->from.entity == from.entity;
}

/* Returns true if a request came so short a time ago that the network may still have PDUs from
 * before it. */
static bool is_recent(const struct management_request *request, uint64_t now_ns)
{
    return request->heard_ns != 0 &&
           now_ns - request->heard_ns < (uint64_t)(MANAGEMENT_NETWORK_S * 1e9);
}

/* Returns the request that a PDU repeats, NULL for a new one: a request that is not carried out
 * yet, or one of which the network has made two. */
static struct management_request *find(struct management *management, const struct pdu *pdu,
                                       uint64_t now_ns)
{
    const struct pdu_management *body = &pdu->management;
    for (uint32_t i = 0; i < MANAGEMENT_REQUESTS; i++) {
        struct management_request *request = &management->request[i];
        if (!same_sender(request, body->originator) || request->type != pdu->header.type ||
            request->number != body->request || request->due_s != time_of(body))
            continue;
        if (request->state != MANAGEMENT_DONE ||
            (request->stamp == pdu->header.timestamp && is_recent(request, now_ns)))
            return request;
    }
    return NULL;
}

/* Returns true if the sender has sent the contrary later than this and the network has it
 * overtaken. */
static bool is_overtaken(const struct management *management, const struct pdu *pdu,
                         uint64_t now_ns)
{
    for (uint32_t i = 0; i < MANAGEMENT_REQUESTS; i++) {
        const struct management_request *request = &management->request[i];
        if (!same_sender(request, pdu->management.originator) ||
            request->type == pdu->header.type || !is_recent(request, now_ns) ||
            timestamp_absolute(request->stamp) != timestamp_absolute(pdu->header.timestamp))
            continue;
        double older_s = timestamp_between(pdu->header.timestamp, request->stamp);
        if (older_s > 0.0 && older_s <= MANAGEMENT_NETWORK_S)
            return true;
    }
    return false;
}

/* Acknowledges a request that has come before, once for each time. */
static void repeated(struct management *management, struct management_request *request,
                     uint64_t now_ns)
{
    request->owed++;
    if (request->state != MANAGEMENT_SENT)
        acknowledge(management, request,
                    request->state == MANAGEMENT_DONE ? request->response : PDU_RESPONSE_ABLE,
                    now_ns);
}

/* Returns a place for a request: a free one, or that of the oldest that is done. NULL when all are
 * of requests that are not. */
static struct management_request *free_place(struct management *management)
{
    for (uint32_t i = 0; i < MANAGEMENT_REQUESTS; i++) {
        uint32_t place = (management->next + i) % MANAGEMENT_REQUESTS;
        uint8_t state = management->request[place].state;
        if (state != MANAGEMENT_FREE && state != MANAGEMENT_DONE)
            continue;
        management->next = (place + 1) % MANAGEMENT_REQUESTS;
        return &management->request[place];
    }
    return NULL;
}

static struct management_request request_of(const struct pdu *pdu, struct pdu_id as,
                                            uint64_t now_ns)
{
    return (struct management_request){.from = pdu->management.originator,
                                       .as = as,
                                       .number = pdu->management.request,
                                       .type = pdu->header.type,
                                       .owed = 1,
                                       .stamp = pdu->header.timestamp,
                                       .heard_ns = now_ns,
                                       .due_s = time_of(&pdu->management)};
}

/* Lets a request wait for its time. The note is written before the acknowledgement promises it. */
static void await_time(struct management *management, struct management_request *request,
                       uint64_t now_ns)
{
    request->state = MANAGEMENT_WAITS;
    management_notes_put(management->notes, place_of(management, request),
                         &(struct management_note){.due_s = request->due_s,
                                                   .from = request->from,
                                                   .as = request->as,
                                                   .number = request->number,
                                                   .type = request->type});
    acknowledge(management, request, PDU_RESPONSE_ABLE, now_ns);
}

static bool allowed(struct management *management, uint8_t type, struct pdu_id from)
{
    if (gateway_lists_has_control(&management->control, from.site, from.application))
        return true;
    management->refused++;
    management->refused_last = (struct management_request){.from = from, .type = type};
    return false;
}

void management_receive(struct management *management, const struct pdu *pdu, uint64_t now_ns,
                        double utc_s)
{
    uint8_t type = pdu->header.type;
    const struct pdu_management *body = &pdu->management;
    struct pdu_id as;
    if ((type != PDU_CREATE && type != PDU_REMOVE && type != PDU_START_RESUME &&
         type != PDU_STOP_FREEZE) ||
        !for_us(management, body->receiver, &as) || !allowed(management, type, body->originator))
        return;
    struct management_request *request = find(management, pdu, now_ns);
    if (request) {
        repeated(management, request, now_ns);
        return;
    }
    request = free_place(management);
    if (!request) {
        struct management_request one = request_of(pdu, as, now_ns);
        management->full++;
        management->done++;
        management->done_last = one;
        management->done_why = "too many requests wait, for their time or for the world";
        acknowledge(management, &one, PDU_RESPONSE_UNABLE, now_ns);
        return;
    }
    bool overtaken = is_overtaken(management, pdu, now_ns);
    *request = request_of(pdu, as, now_ns);
    if (type == PDU_CREATE || type == PDU_REMOVE)
        finish(management, request, PDU_RESPONSE_UNABLE, "Jolon makes its entities itself", now_ns);
    else if (body->receiver.entity != 0 && body->receiver.entity != PDU_ID_ALL)
        finish(management, request, PDU_RESPONSE_UNABLE,
               "one entity cannot start or stop, only the whole world", now_ns);
    else if (request->due_s > utc_s + MANAGEMENT_AHEAD_S)
        finish(management, request, PDU_RESPONSE_UNABLE,
               "its time is more than an hour ahead of this machine's clock", now_ns);
    else if (overtaken)
        finish(management, request, PDU_RESPONSE_UNABLE,
               "a later request of the same sender has overtaken it", now_ns);
    else if (request->due_s > utc_s)
        await_time(management, request, now_ns);
    else
        carry_out(management, request, now_ns);
}
