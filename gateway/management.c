/* Simulation management. */
#include "gateway/management.h"

#include "gateway/pdu/pdu_layout.h"
#include "gateway/pdu/timestamp.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <inttypes.h>
#include <string.h>

#define HOUR_S 3600.0

int management_open(struct management *management, struct pdu_output *output, struct entity_ids ids,
                    const char *control, struct command_link link, struct error_text *error)
{
    memset(management, 0, sizeof *management);
    management->output = output;
    management->ids = ids;
    if (gateway_lists_control(&management->control, control, error) != 0)
        return -1;
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

static void acknowledge(struct management *management, const struct management_request *request,
                        uint16_t response, uint64_t now_ns)
{
    static const uint16_t flags[] = {[PDU_CREATE] = PDU_ACKNOWLEDGE_CREATE,
                                     [PDU_REMOVE] = PDU_ACKNOWLEDGE_REMOVE,
                                     [PDU_START_RESUME] = PDU_ACKNOWLEDGE_START,
                                     [PDU_STOP_FREEZE] = PDU_ACKNOWLEDGE_STOP};
    static struct pdu pdu;
    if (!pdu_output_take(management->output, now_ns))
        return; /* its sender repeats the request */
    pdu.header.type = PDU_ACKNOWLEDGE;
    pdu.management = (struct pdu_management){.originator = request->as,
                                             .receiver = request->from,
                                             .acknowledge = flags[request->type],
                                             .response = response,
                                             .request = request->number};
    pdu_output_send(management->output, &pdu);
}

static void finish(struct management *management, struct management_request *request,
                   uint16_t response, const char *why, uint64_t now_ns)
{
    request->state = MANAGEMENT_DONE;
    request->response = response;
    for (; request->owed > 0; request->owed--)
        acknowledge(management, request, response, now_ns);
    if (log_due(&management->done_logged_ns, NS_PER_S))
        log_info("%s %" PRIu32 " of %u:%u:%u: %s", name_of(request->type), request->number,
                 request->from.site, request->from.application, request->from.entity, why);
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

static struct management_request *find(struct management *management, uint8_t type,
                                       const struct pdu_management *body)
{
    for (uint32_t i = 0; i < MANAGEMENT_REQUESTS; i++) {
        struct management_request *request = &management->request[i];
        const struct pdu_id *from = &body->originator;
        if (request->state != MANAGEMENT_FREE && request->type == type &&
            request->number == body->request && request->from.site == from->site &&
            request->from.application == from->application && request->from.entity == from->entity)
            return request;
    }
    return NULL;
}

/* Acknowledges a request that has come before, once for each time. */
static void repeated(struct management *management, struct management_request *request,
                     uint64_t now_ns)
{
    if (request->state == MANAGEMENT_SENT)
        request->owed++;
    else
        acknowledge(management, request,
                    request->state == MANAGEMENT_DONE ? request->response : PDU_RESPONSE_ABLE,
                    now_ns);
}

static struct management_request *new_request(struct management *management, uint8_t type,
                                              const struct pdu_management *body, struct pdu_id as)
{
    struct management_request *request = &management->request[management->next];
    management->next = (management->next + 1) % MANAGEMENT_REQUESTS;
    if (request->state == MANAGEMENT_SENT)
        command_client_forget(&management->client, request->sequence);
    *request = (struct management_request){.from = body->originator,
                                           .as = as,
                                           .number = body->request,
                                           .type = type,
                                           .owed = 1,
                                           .due_s = time_of(body)};
    return request;
}

static bool allowed(struct management *management, uint8_t type, struct pdu_id from)
{
    if (gateway_lists_has_control(&management->control, from.site, from.application))
        return true;
    management->refused++;
    if (log_due(&management->refused_logged_ns, NS_PER_S))
        log_warn("%s of %u:%u:%u is ignored: gateway.control does not name it (%" PRIu64 " so far)",
                 name_of(type), from.site, from.application, from.entity, management->refused);
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
    struct management_request *request = find(management, type, body);
    if (request) {
        repeated(management, request, now_ns);
        return;
    }
    request = new_request(management, type, body, as);
    if (type == PDU_CREATE || type == PDU_REMOVE)
        finish(management, request, PDU_RESPONSE_UNABLE, "Jolon makes its entities itself", now_ns);
    else if (body->receiver.entity != 0 && body->receiver.entity != PDU_ID_ALL)
        finish(management, request, PDU_RESPONSE_UNABLE,
               "one entity cannot start or stop, only the whole world", now_ns);
    else if (request->due_s > utc_s + MANAGEMENT_AHEAD_S)
        finish(management, request, PDU_RESPONSE_UNABLE,
               "its time is more than an hour ahead of this machine's clock", now_ns);
    else if (request->due_s > utc_s) {
        acknowledge(management, request, PDU_RESPONSE_ABLE, now_ns);
        request->owed = 0;
        request->state = MANAGEMENT_WAITS;
    } else
        carry_out(management, request, now_ns);
}
