/* Datagrams of other simulators through the gateway's intake into a world. The input is a series of
 * datagrams, each with the time since the one before, who sends it, and where an Entity State, a
 * Fire or a Detonation is, because random octets are never a place of the square. After each pass
 * mover and collider make a frame of the records. What the gateway tells the world must be
 * possible: the mover must refuse none for its values, and every row must be a good one. */
#include "tests/fuzz/support.h"

#include "collider/step.h"
#include "gateway/management.h"
#include "gateway/pdu/pdu_read.h"
#include "gateway/remote_input.h"
#include "gateway/remote_notices.h"
#include "mover/step.h"
#include "world/entity/event.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/runtime/check.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DATAGRAMS_MAX  64
#define DATAGRAM_BYTES 8 /* in front of each: see take_datagram() */
#define BEGIN_NS       1000000000000u
#define UTC_S          1795838582.0

static const char scenario_text[] =
    "world = { seed = 1; capacity = 64; remotes_max = 16; hz = 20.0; };\n"
    "terrain = { source = \"flat\"; height_m = 100.0; };\nobjects = { source = \"none\"; };\n"
    "vehicles = ();\n";
static const char types_text[] = "tank * 1.1.225.1.1.2.0\nship * 1.3.225.7.0.0.0\n"
                                 "jet * 1.2.225.1.3.3.0\nshell * 2.2.225.2.13.1.0 1000 1000\n"
                                 "<munition> * 2.9.225.2.14.2.0 1000 1000\n";

static struct view view;
static struct mover mover;
static struct collider collider;
static struct type_table types;
static struct local_frame frame;
static struct remote_input input;
static struct management management;
static struct management_notes notes;
static struct pdu_output output;
static uint64_t now_ns, frames;

/* --- commands ----------------------------------------------------------------------------------*/

static void take_command(void *self, const jolon_Command *command)
{
    (void)self;
    CHECK(command->type == jolon_COMMAND_PAUSE || command->type == jolon_COMMAND_RESUME);
}

static bool give_reply(void *self, jolon_CommandReply *to)
{
    (void)self;
    (void)to;
    return false;
}

static bool reachable(void *self)
{
    (void)self;
    return true;
}

static int descriptor(void *self)
{
    (void)self;
    return -1;
}

static const struct command_transport transport = {take_command, give_reply, reachable, descriptor};

/* --- the world ---------------------------------------------------------------------------------*/

static void open_world(void)
{
    struct error_text error;
    support_world_of(&view, support_file(scenario_text, sizeof scenario_text - 1));
    CHECK(mover_init(&mover, &view.world, view.w[0].craters, NULL) == 0);
    CHECK(type_table_read(&types, support_file(types_text, sizeof types_text - 1), view.world.kinds,
                          view.world.counts.kinds, &error) == 0);
    local_frame_make(&frame, 35.95, -121.25, -33.7, 0.5 * WORLD_SIDE_DEFAULT_M,
                     0.5 * WORLD_SIDE_DEFAULT_M);
    CHECK(collider_init(&collider, &view.world, view.w[0].craters, NULL) == 0);
}

/* Our vehicle, which others fire at and collide with. */
static void put_tank(void)
{
    const struct entities *e = &view.w[0].entities;
    struct state_head *head = view.w[0].head;
    while (view.world.kinds[e->row[0].kind].domain != DOMAIN_LAND)
        e->row[0].kind++;
    entities_set_position(e, 0, (struct vec3){25000.0, 100.0, 25000.0});
    e->row[0].id = head->next_id++;
    e->row[0].state = ENTITY_ACTIVE;
    e->row[0].behaviour = e->row[0].order = BEHAVIOUR_IDLE;
    e->row[0].fuel_l = view.world.kinds[e->row[0].kind].fuel_l;
    head->used = head->alloc_next = head->vehicles = 1;
}

/* Resets the world to frame 0 and opens the intake. No earlier input has an effect. */
static void begin_input(void)
{
    struct error_text error;
    for (uint32_t row = 0; row < view.header->capacity; row++)
        entities_clear(&view.w[0].entities, row);
    memset(view.w[0].head, 0, sizeof *view.w[0].head);
    view.w[0].head->next_id = 1;
    view.w[0].head->time_scale = 1.0;
    put_tank();
    atomic_store(&view.commands[RING_GATEWAY]->head, 0);
    mover.left = collider.left[0] = collider.left[1] = 0;
    collider.fixed_hash_frame = UINT64_MAX;
    collider.lists = (struct list_hashes){0};
    frames = 0;
    now_ns = BEGIN_NS;
    memset(&input, 0, sizeof input);
    input.types = &types;
    input.frame = &frame;
    input.own = (struct entity_ids){1991, 10, 2};
    input.clamp = true;
    input.timeout_ns = 12000000000u;
    CHECK(remote_input_open(&input, &view, now_ns, &error) == 0);
    memset(&notes, 0, sizeof notes);
    output = (struct pdu_output){.udp.socket = -1, .version = 7, .exercise = 1, .rate_ps = 1000};
    CHECK(management_open(&management, &output, input.own, "7:1, 8:*",
                          (struct command_link){&transport, NULL}, &notes, &error) == 0);
}

/* --- a pass ------------------------------------------------------------------------------------*/

static void check_rows(const struct state *state)
{
    const struct entities *e = &state->entities;
    for (uint32_t i = 0; i < state->head->used; i++) {
        if (e->row[i].state == ENTITY_FREE)
            continue;
        CHECK(isfinite(e->row[i].x) && isfinite(e->row[i].y) && isfinite(e->row[i].z));
        CHECK(isfinite(e->row[i].vx) && isfinite(e->row[i].vy) && isfinite(e->row[i].vz));
        CHECK(isfinite(e->row[i].heading) && isfinite(e->row[i].pitch) && isfinite(e->row[i].roll));
        CHECK(isfinite(e->row[i].spin_x) && isfinite(e->row[i].spin_y) &&
              isfinite(e->row[i].spin_z));
        CHECK(e->row[i].kind < view.world.counts.kinds && e->row[i].damage <= DAMAGE_DESTROYED);
    }
}

/* What the mover refuses of the records, it refuses because of the world, not of their values. */
static void check_refusals(void)
{
    for (uint32_t i = 0; i < view.m.head->intent_count; i++) {
        const struct event *event = &view.m.intents[i];
        CHECK(event->type != EVENT_INPUT ||
              (event->input.because != REMOTE_UNKNOWN && event->input.because != REMOTE_NO_KIND));
    }
}

/* Makes a frame with the records. */
static void pass(void)
{
    const struct event_ring ring = {view.events, view.header->event_slots};
    struct command_source sources[COMMAND_RING_COUNT];
    const struct state *now = &view.w[frames & 1];
    struct state *next = &view.w[(frames + 1) & 1];
    remote_input_tell(&input, &view, now_ns);
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        sources[i].slot = view.commands[i]->slot;
        sources[i].slots = layout_ring_slots(view.header, i);
        sources[i].end = atomic_load(&view.commands[i]->head);
    }
    mover_step(&mover, now, &view.m, sources);
    check_refusals();
    collider_step(&collider, now, &view.m, next, &ring);
    check_rows(next);
    frames++;
    struct snapshot seen = {.head = *next->head, .entities = next->entities};
    remote_input_see(&input, &view, &seen, now_ns);
}

/* --- datagrams ---------------------------------------------------------------------------------*/

static void put_place(double location[3], const uint8_t *at)
{
    struct vec3 place = {24900.0 + (at[0] < 250 ? at[0] : 200.0 * at[0]), 100.0 + 4.0 * at[1],
                         24900.0 + at[2]};
    struct vec3 ecef = local_frame_ecef(&frame, place);
    location[0] = ecef.x;
    location[1] = ecef.y;
    location[2] = ecef.z;
}

static void take_pdu(struct pdu *pdu, const uint8_t *before, const struct udp_address *from)
{
    bool placed = (before[1] & 0x80) != 0;
    if (placed && pdu->header.type == PDU_ENTITY_STATE)
        put_place(pdu->entity_state.location, before + 2);
    if (placed && pdu->header.type == PDU_FIRE)
        put_place(pdu->fire.location, before + 2);
    if (placed && pdu->header.type == PDU_DETONATION)
        put_place(pdu->detonation.location, before + 2);
    if (!remote_input_take(&input, &view, pdu, from, now_ns))
        management_receive(&management, pdu, now_ns, UTC_S + (double)(now_ns - BEGIN_NS) / 1e9);
}

/* Octets before a datagram: 0 the time since the one before it [20 ms], 1 whether the world has a
 * frame before it (64), who sends it (0 to 3), and whether its places are those of octets 2 to 4
 * (128), 6 and 7 its length. Returns how many octets it has taken. */
static size_t take_datagram(const uint8_t *data, size_t size)
{
    static struct pdu pdu;
    struct udp_address from;
    struct error_text error;
    char sender[] = "10.0.0.1:3000";
    size_t length = (size_t)(data[6] << 8 | data[7]);
    length = length < size - DATAGRAM_BYTES ? length : size - DATAGRAM_BYTES;
    now_ns += 20000000u * data[0];
    sender[7] = (char)('1' + (data[1] & 1));
    sender[12] = (char)('0' + (data[1] >> 1 & 1));
    CHECK(udp_address_parse(&from, sender, 0, &error) == 0);
    if (data[1] & 64)
        pass();
    struct pdu_cursor cursor = {data + DATAGRAM_BYTES, length, 0};
    enum pdu_result result;
    while ((result = pdu_read(&cursor, &pdu)) != PDU_END) {
        if (result == PDU_GOOD)
            take_pdu(&pdu, data, &from);
    }
    management_poll(&management, now_ns, UTC_S + (double)(now_ns - BEGIN_NS) / 1e9);
    return DATAGRAM_BYTES + length;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char text[900];
    if (!view.base)
        open_world();
    begin_input();
    for (int i = 0; i < DATAGRAMS_MAX && size > DATAGRAM_BYTES; i++) {
        size_t used = take_datagram(data, size);
        data += used;
        size -= used;
    }
    pass();
    (void)remote_notices_text(&input, text, sizeof text);
    (void)type_notices_text(&input.unknown, view.world.kinds, text, sizeof text);
    CHECK(input.table.count <= 16);
    remote_input_close(&input);
    return 0;
}
