/* Keeps and renews leases. */
#include "clients/harness/leases.h"

#include "ipc/process/clock.h"
#include "ipc/json/world_json.h"
#include "world/entity/command.h"
#include "world/enum_names.h"

#include <string.h>

/* Renewals leave room in the client for the program's commands. */
#define WAITING_MAX (COMMAND_CLIENT_WAITING_MAX / 2)

void leases_clear(struct leases *leases)
{
    leases->count = 0;
}

static struct lease *find(struct leases *leases, uint32_t vehicle)
{
    for (uint32_t i = 0; i < leases->count; i++) {
        if (leases->held[i].command.entity == vehicle)
            return &leases->held[i];
    }
    return NULL;
}

static void drop(struct leases *leases, struct lease *lease)
{
    *lease = leases->held[--leases->count];
}

/* The length of a lease in frames, at the greatest rate that the world may have now. */
static uint32_t lease_frames(const struct leases *leases)
{
    const jolon_FrameStatus *frame = &leases->mirror->frame;
    double rate_hz = leases->mirror->world.hz;
    if (rate_hz * frame->time_scale > rate_hz)
        rate_hz *= frame->time_scale;
    if (frame->rate_hz > rate_hz)
        rate_hz = frame->rate_hz;
    double frames = LEASES_S * rate_hz + 1.0;
    return frames < COMMAND_LEASE_MAX ? (uint32_t)frames : COMMAND_LEASE_MAX;
}

/* Returns the lease that a command changes, or NULL. */
static struct lease *lease_of(struct leases *leases, const struct command_text *order)
{
    jolon_CommandType type = order->command.type;
    bool has_lease = type == jolon_COMMAND_DRIVE || type == jolon_COMMAND_RELEASE ||
                     type == jolon_COMMAND_REMOVE;
    return has_lease ? find(leases, order->command.entity) : NULL;
}

void leases_begin(struct leases *leases, struct command_client *client, struct command_text *order)
{
    struct lease *lease = lease_of(leases, order);
    if (lease && lease->sequence) {
        command_client_forget(client, lease->sequence);
        lease->sequence = 0;
    }
    if (order->command.type == jolon_COMMAND_DRIVE && !command_text_needs_hz(order))
        order->command.lease_frames = lease_frames(leases);
}

void leases_hold_off(struct leases *leases, const struct command_text *order)
{
    struct lease *lease = lease_of(leases, order);
    if (lease)
        lease->command_pending = true;
}

void leases_answer(struct leases *leases, const struct command_text *order,
                   const jolon_CommandReply *reply, uint64_t now_ns)
{
    bool keeps = order->command.type == jolon_COMMAND_DRIVE && !command_text_needs_hz(order);
    struct lease *lease = lease_of(leases, order);
    if (reply->result != jolon_RESULT_DONE)
        return;
    if (lease && !keeps) /* released, or held by a lease that the program renews itself */
        drop(leases, lease);
    if (!keeps)
        return;
    if (!lease && leases->count < LEASES_MAX)
        lease = &leases->held[leases->count++];
    if (lease)
        *lease = (struct lease){.command = order->command,
                                .renew_ns = now_ns + LEASES_RENEW_NS,
                                .tick = leases->mirror->frame.tick};
}

static void write_lost(const struct leases *leases, uint32_t vehicle, jolon_CommandResult error)
{
    cJSON *object = cJSON_CreateObject();
    json_whole(object, "lost", vehicle);
    json_text(object, "because", command_result_name((enum command_result)error));
    output_object(leases->output, OUTPUT_ANSWER, object);
}

/* Returns true if the lease needs renewal. The leases of a paused world do not expire, and a
 * command would make it commit a frame. */
static bool runs(const struct leases *leases, const struct lease *lease)
{
    return !leases->mirror->frame.paused || leases->mirror->frame.tick != lease->tick;
}

void leases_turn(struct leases *leases, struct command_client *client, uint64_t now_ns)
{
    for (uint32_t i = 0; i < leases->count;) {
        struct lease *lease = &leases->held[i];
        jolon_CommandReply reply;
        if (lease->sequence && command_client_answered(client, lease->sequence, &reply)) {
            lease->sequence = 0;
            if (reply.result != jolon_RESULT_DONE) {
                write_lost(leases, lease->command.entity, reply.result);
                drop(leases, lease);
                continue;
            }
        }
        if (!lease->sequence && !lease->command_pending && now_ns >= lease->renew_ns) {
            lease->renew_ns = now_ns + LEASES_RENEW_NS;
            if (runs(leases, lease) && client->count < WAITING_MAX) {
                lease->command.lease_frames = lease_frames(leases);
                lease->sequence = command_client_send(client, &lease->command);
                lease->tick = leases->mirror->frame.tick;
            }
        }
        lease->command_pending = false;
        i++;
    }
}

uint64_t leases_due_ns(const struct leases *leases)
{
    uint64_t due_ns = UINT64_MAX;
    for (uint32_t i = 0; i < leases->count; i++) {
        if (!leases->held[i].sequence && leases->held[i].renew_ns < due_ns)
            due_ns = leases->held[i].renew_ns;
    }
    return due_ns;
}
