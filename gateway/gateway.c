/* The gateway: what comes in and what goes out. */
#include "gateway/gateway.h"

#include "gateway/earth/geoid_grid.h"
#include "gateway/remote_notices.h"
#include "gateway/udp/udp_interface.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/role_notes.h"
#include "world/params.h"
#include "world/provenance.h"
#include "world/terrain/gridsquare.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define SLICE_NS (2 * (uint64_t)NS_PER_MS) /* from one look at a busy socket to the next */
#define TYPES    "dis/types.txt"           /* beneath the folder of data */

/* What a gateway leaves to the next one. Receivers may know us by the port from which we send. */
struct gateway_notes {
    struct management_notes requests;
    uint16_t sender_port; /* 0: none */
};
_Static_assert(sizeof(struct gateway_notes) <= ROLE_NOTES_BYTES, "the notes have room");

static struct gateway_notes *notes_of(const struct gateway *gateway)
{
    return role_notes(gateway->view.slot[ROLE_GATEWAY]);
}

static void tell_begin(const struct gateway *gateway)
{
    const struct gateway_params *params = &gateway->view.world.params->gateway;
    char at[UDP_ADDRESS_TEXT];
    log_info("sends DIS %u, exercise %u, to %s", params->version, params->exercise,
             udp_address_text(&gateway->output.udp.to, at, sizeof at));
    if (gateway->input.socket >= 0)
        log_info("receives at %s", udp_address_text(&gateway->input.at, at, sizeof at));
    if (!pdu_input_hears(&gateway->input, &gateway->output.udp.to))
        log_warn("gateway.listen = %s does not hear what others send to %s, where we send: listen "
                 "there%s",
                 params->listen, udp_address_text(&gateway->output.udp.to, at, sizeof at),
                 udp_address_multicast(&gateway->output.udp.to) ? "" : ", or at 0.0.0.0");
    if (gateway->entities.cot)
        log_info("sends events of Cursor on Target to %s",
                 udp_address_text(&gateway->cot.udp.to, at, sizeof at));
}

/* Settings that have no effect without another one. */
static void tell_idle_settings(const struct params *params)
{
    const struct gateway_params *gateway = &params->gateway;
    bool listens = strcmp(gateway->listen, GATEWAY_LISTS_NONE) != 0;
    if (!listens && params->remotes_max > 0)
        log_warn("world.remotes_max = %u has no effect: gateway.listen is none",
                 params->remotes_max);
    if (!listens && strcmp(gateway->control, GATEWAY_LISTS_NONE) != 0)
        log_warn("gateway.control = %s has no effect: gateway.listen is none", gateway->control);
    if (listens && (gateway->peers[0] == '\0' || strcmp(gateway->peers, GATEWAY_LISTS_NONE) == 0))
        log_warn("gateway.peers names nobody, so all that comes to gateway.listen = %s is refused",
                 gateway->listen);
}

/* A world may have fewer free rows than it allows entities of others. */
static void tell_room(const struct gateway *gateway)
{
    const struct params *params = gateway->view.world.params;
    struct state_head head;
    if (params->remotes_max > 0 && snapshot_head(&head, &gateway->view) == 0 &&
        head.vehicles > params->capacity - params->remotes_max)
        log_warn(
            "world.capacity = %u has %u vehicles now, so not all of world.remotes_max = %u fit: "
            "a capacity of %u and some for munitions would do",
            params->capacity, head.vehicles, params->remotes_max,
            head.vehicles + params->remotes_max);
}

/* Who may not be controlled needs no way to the intake. */
static int open_management(struct gateway *gateway, const char *world, struct error_text *error)
{
    const char *control = gateway->view.world.params->gateway.control;
    struct command_link link = {NULL, NULL};
    gateway->commands.fd = -1;
    if (strcmp(control, GATEWAY_LISTS_NONE) != 0)
        link = command_socket_open(&gateway->commands, world);
    return management_open(&gateway->management, &gateway->output, gateway->entities.ids, control,
                           link, &notes_of(gateway)->requests, error);
}

/* A world without the grid has one undulation, and says so. */
static void read_undulation(struct gateway *gateway)
{
    const struct gateway_params *params = &gateway->view.world.params->gateway;
    const char *folder = getenv("PROJ_DATA");
    char path[400];
    struct error_text error;
    if (!params->undulation_grid)
        return;
    (void)snprintf(path, sizeof path, "%s/" GEOID_GRID_NAME, folder ? folder : GEOID_GRID_FOLDER);
    if (local_frame_read_undulation(&gateway->entities.frame, path, params->undulation_m, &error) !=
        0)
        log_warn(
            "%s; all heights are by gateway.undulation_m = %.2f (Debian's package proj-data has "
            "the grid, and PROJ_DATA names its folder)",
            error.text, params->undulation_m);
    else
        log_info("takes the height of the sea at each place from %s", path);
}

static bool tell_types(void *subject, uint64_t now_ns)
{
    struct gateway *gateway = subject;
    (void)now_ns;
    return remote_notices_types(&gateway->remotes, gateway->view.world.kinds);
}

/* Says what the rate puts off, and what was lost because it waited too long. */
static bool tell_rate(void *subject, uint64_t now_ns)
{
    struct gateway *gateway = subject;
    const struct event_output *events = &gateway->events;
    uint64_t states = gateway->entities.postponed, total = states + events->postponed,
             gaps = events->cursor.gap;
    (void)now_ns;
    if (total == gateway->postponed_told && gaps == gateway->gaps_told)
        return false;
    log_warn("gateway.rate = %u PDUs a second is less than the world needs: it has put off Entity "
             "States in %" PRIu64 " and events in %" PRIu64 " of the gateway's passes, %" PRIu64
             " events wait, and %" PRIu64 " are lost",
             gateway->output.rate_ps, states, events->postponed, events->waiting, gaps);
    gateway->postponed_told = total;
    gateway->gaps_told = gaps;
    return true;
}

static void add_notices(struct gateway *gateway)
{
    struct notices *notices = &gateway->notices;
    notices_add(notices, management_tell_done, &gateway->management);
    notices_add(notices, management_tell_refused, &gateway->management);
    notices_add(notices, pdu_input_tell_twins, &gateway->input);
    notices_add(notices, pdu_input_tell_strangers, &gateway->input);
    notices_add(notices, pdu_input_tell_faults, &gateway->input);
    notices_add(notices, pdu_input_tell_foreign, &gateway->input);
    notices_add(notices, remote_notices_refusals, &gateway->remotes);
    notices_add(notices, remote_notices_world, &gateway->remotes);
    notices_add(notices, tell_types, gateway);
    notices_add(notices, udp_output_tell, &gateway->output.udp);
    notices_add(notices, udp_output_tell, &gateway->cot.udp);
    notices_add(notices, tell_rate, gateway);
}

/* Opens the way in, by settings that the way out has. */
static int open_receiving(struct gateway *gateway, const char *world, unsigned interface,
                          struct error_text *error)
{
    const struct gateway_params *params = &gateway->view.world.params->gateway;
    struct remote_input *remotes = &gateway->remotes;
    struct pdu_input *input = &gateway->input;
    remotes->types = &gateway->types;
    remotes->frame = &gateway->entities.frame;
    remotes->own = gateway->entities.ids;
    remotes->clamp = params->clamp != 0;
    remotes->timeout_ns = (uint64_t)(params->timeout_s * 1e9);
    if (remote_input_open(remotes, &gateway->view, clock_now_ns(), error) != 0)
        return -1;
    input->exercise = gateway->output.exercise;
    input->own = gateway->entities.ids;
    input->sender_port =
        udp_socket_port(gateway->output.udp.socket, notes_of(gateway)->sender_port);
    CRASH_POINT("note of the port");
    notes_of(gateway)->sender_port = input->sender_port;
    if (gateway_lists_peers(&input->peers, params->peers, error) != 0 ||
        pdu_input_open(input, params->listen, interface, error) != 0)
        return -1;
    return open_management(gateway, world, error);
}

int gateway_open(struct gateway *gateway, const char *world, struct error_text *error)
{
    const struct view *view = &gateway->view;
    const struct gateway_params *params = &view->world.params->gateway;
    char folder[400], path[sizeof folder + sizeof TYPES + 1];
    struct pdu_output *output = &gateway->output;
    struct entity_output *entities = &gateway->entities;
    unsigned interface;
    struct error_text reason;
    if (udp_interface_find(&interface, params->interface, &reason) != 0)
        return error_text_set(error, "gateway.interface = \"%s\": %s", params->interface,
                              reason.text);
    if (process_data_dir(folder, sizeof folder) != 0)
        return error_text_set(error, "the folder of data is missing; set JOLON_DATA to it");
    (void)snprintf(path, sizeof path, "%s/%s", folder, TYPES);
    output->version = (uint8_t)params->version;
    output->exercise = (uint8_t)params->exercise;
    entities->output = gateway->events.output = output;
    entities->types = &gateway->types;
    entities->ids = (struct entity_ids){(uint16_t)params->site, (uint16_t)params->application,
                                        (uint16_t)params->applications};
    gateway->events.entities = entities;
    gateway->events.remotes = &gateway->remotes;
    if (provenance_find(view->world.recipe, view->world.counts.recipe, "ground"))
        local_frame_project(&entities->frame, params->latitude_deg, params->longitude_deg,
                            params->undulation_m, 0.5 * view->world.terrain.squares.world_m);
    else
        local_frame_make(&entities->frame, params->latitude_deg, params->longitude_deg,
                         params->undulation_m, 0.5 * view->world.terrain.squares.world_m,
                         0.5 * view->world.terrain.squares.world_m);
    read_undulation(gateway);
    if (type_table_read(&gateway->types, path, view->world.kinds, view->world.counts.kinds,
                        error) != 0 ||
        pdu_output_open(output, params->address, (uint16_t)params->port, interface, params->rate_ps,
                        error) != 0 ||
        entity_output_open(entities, view, error) != 0)
        return -1;
    if (open_receiving(gateway, world, interface, error) != 0)
        return -1;
    if (strcmp(params->cot, COT_OUTPUT_NONE) != 0) {
        if (cot_output_open(&gateway->cot, params->cot, interface, output->exercise, error) != 0)
            return -1;
        entities->cot = &gateway->cot;
    }
    const struct role_slot *slot = view->slot[ROLE_GATEWAY];
    event_output_open(&gateway->events, view,
                      atomic_load_explicit(&slot->frame, memory_order_relaxed));
    add_notices(gateway);
    tell_begin(gateway);
    tell_room(gateway);
    tell_idle_settings(gateway->view.world.params);
    return 0;
}

static double utc_s(void)
{
    struct timespec utc;
    clock_gettime(CLOCK_REALTIME, &utc);
    return (double)utc.tv_sec + (double)utc.tv_nsec / 1e9;
}

/* Acts on a PDU that is for us, by its type. */
static void take_pdu(void *context, const struct pdu *pdu, const struct udp_address *from,
                     uint64_t now_ns)
{
    struct gateway *gateway = context;
    switch ((enum pdu_type)pdu->header.type) {
    case PDU_CREATE:
    case PDU_REMOVE:
    case PDU_START_RESUME:
    case PDU_STOP_FREEZE:
        management_receive(&gateway->management, pdu, now_ns, utc_s());
        break;
    default:
        if (!remote_input_take(&gateway->remotes, &gateway->view, pdu, from, now_ns))
            gateway->without_effect++;
        break;
    }
}

/* A busy socket is looked at each SLICE_NS, before its buffer in the system is full, and not for
 * each datagram. */
void gateway_receive(struct gateway *gateway, uint64_t due_ns)
{
    uint64_t now_ns = clock_now_ns();
    management_poll(&gateway->management, now_ns, utc_s());
    while (now_ns < due_ns && !process_stopping()) {
        if (gateway->input.socket < 0) {
            clock_sleep_until_ns(due_ns);
        } else if (udp_socket_wait(gateway->input.socket, due_ns - now_ns)) {
            now_ns = clock_now_ns();
            (void)pdu_input_receive(&gateway->input, take_pdu, gateway, now_ns);
            remote_input_tell(&gateway->remotes, &gateway->view, now_ns);
            clock_sleep_until_ns(now_ns + SLICE_NS < due_ns ? now_ns + SLICE_NS : due_ns);
        }
        frame_protocol_beat(&gateway->view);
        now_ns = clock_now_ns();
        notices_tell(&gateway->notices, now_ns);
    }
}

void gateway_send(struct gateway *gateway)
{
    struct role_slot *slot = gateway->view.slot[ROLE_GATEWAY];
    uint64_t begun_ns = clock_now_ns();
    frame_protocol_beat(&gateway->view);
    /* The snapshot first, so that it has the entities that the events name; then the events, which
     * no crowd of entities delays. */
    bool seen = entity_output_look(&gateway->entities, &gateway->view, begun_ns);
    event_output_send(&gateway->events, &gateway->view, begun_ns);
    if (seen)
        entity_output_send(&gateway->entities, &gateway->view, begun_ns);
    remote_input_see(&gateway->remotes, &gateway->view, &gateway->entities.snapshot, begun_ns);
    remote_input_tell(&gateway->remotes, &gateway->view, begun_ns);
    log_frame(gateway->events.frame);
    atomic_store_explicit(&slot->gaps, gateway->events.cursor.gap, memory_order_relaxed);
    frame_protocol_stage_done(&gateway->view, gateway->events.frame, clock_now_ns() - begun_ns);
}

void gateway_follow(struct gateway *gateway)
{
    entity_output_follow(&gateway->entities, &gateway->view, clock_now_ns());
}

static void tell_received(const struct gateway *gateway)
{
    const struct pdu_input *input = &gateway->input;
    if (input->socket < 0)
        return;
    log_info("received %" PRIu64 " PDUs in %" PRIu64 " datagrams; %" PRIu64
             " datagrams of strangers, %" PRIu64 " PDUs of unknown types, "
             "%" PRIu64 " with faults, %" PRIu64 " of other exercises, %" PRIu64
             " of our own, %" PRIu64 " without effect",
             input->counts.result[PDU_GOOD], input->counts.datagrams, input->strangers,
             input->counts.result[PDU_SKIPPED], input->bad, input->foreign, input->echoes,
             gateway->without_effect);
    const struct remote_input *remotes = &gateway->remotes;
    char refused[700];
    log_info("told the world %" PRIu64 " tracks, %" PRIu64 " losses, %" PRIu64 " shots and %" PRIu64
             " detonations and collisions of other simulators; %" PRIu64
             " collisions were known, %" PRIu64
             " Entity States came late or twice; %u entities are known",
             remotes->tracks, remotes->lost, remotes->fires, remotes->struck, remotes->collisions,
             remotes->late, remotes->table.count);
    if (remote_notices_text(remotes, refused, sizeof refused))
        log_info("refused in all: %s; %u types of other simulators are not in the table of types",
                 refused, remotes->unknown.count);
}

static void tell_sent(const struct gateway *gateway)
{
    const struct udp_output *udp = &gateway->output.udp, *cot = &gateway->cot.udp;
    log_info("sent %" PRIu64 " PDUs of %" PRIu64 " octets; %" PRIu64 " failed, %" PRIu64
             " were put off by the rate, %" PRIu64 " events were lost",
             udp->sent, udp->octets, udp->failed,
             gateway->entities.postponed + gateway->events.postponed, gateway->events.cursor.gap);
    if (gateway->entities.cot)
        log_info("sent %" PRIu64 " events of Cursor on Target of %" PRIu64 " octets; %" PRIu64
                 " failed",
                 cot->sent, cot->octets, cot->failed);
}

void gateway_close(struct gateway *gateway)
{
    if (process_stopped_by_parent()) /* else the next gateway goes on with the same entities */
        entity_output_deactivate(&gateway->entities, &gateway->view, clock_now_ns());
    tell_sent(gateway);
    tell_received(gateway);
    remote_input_close(&gateway->remotes);
    entity_output_close(&gateway->entities);
    command_socket_close(&gateway->commands);
}
