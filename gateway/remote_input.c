/* From PDUs to records: Entity State, and what all have in common. */
#include "gateway/remote_input_internal.h"

#include "gateway/earth/euler.h"
#include "gateway/pdu/timestamp.h"
#include "gateway/remote_ring.h"
#include "ipc/process/clock.h"
#include "world/maths/dead_reckoning.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <string.h>

#define HEIGHT_MOST_M          50000.0
#define HEIGHT_LEAST_M         -1000.0 /* no ground and no submarine is deeper */
#define ACCELERATION_MOST_MPS2 1000.0
#define RATE_MOST_RPS          20.0

/* By simulated time, which the world takes at most. It takes no other velocity than above. */
#define SCALED_ACCELERATION_MOST_MPS2 10000.0
#define SCALED_RATE_MOST_RPS          100.0

#define DRY_M 1e7 /* no place on the earth is further from our square */

#define GONE_NS (2 * (uint64_t)NS_PER_S) /* told, and no row for so long: it was refused */

#define PLATFORM  1 /* kinds of types of DIS */
#define MUNITION  2
#define LIFE_FORM 3

/* --- opening -----------------------------------------------------------------------------------*/

/* A gateway that was killed has left its last shots in the ring. */
static void note_old_shot(struct remote_input *input, const struct remote_record *record,
                          uint64_t now_ns)
{
    struct told_event shot = event_memory_of(record, now_ns);
    shot.placed = record->type == REMOTE_FIRE || record->entity == 0; /* else it is in a body */
    shot.place = (struct vec3){record->position[0], record->position[1], record->position[2]};
    event_memory_note(&input->heard, &shot);
}

/* It has left who owns the entities, too. An entity without a row is forgotten soon. */
static void note_old_owner(struct remote_input *input, const struct remote_record *record,
                           uint64_t at, uint64_t now_ns)
{
    struct remote_entry *entry = remote_table_find(&input->table, record->remote);
    if (record->type == REMOTE_LOST) {
        if (entry)
            remote_table_remove(&input->table, entry);
        return;
    }
    if (!entry)
        entry = remote_table_add(&input->table, record->remote, now_ns);
    if (!entry)
        return;
    entry->owner = record->event;
    entry->told_at = at;
}

static void read_ring(struct remote_input *input, const struct view *view, uint64_t now_ns)
{
    const struct command_ring_words *words = view->commands[RING_GATEWAY];
    uint64_t slots = layout_ring_slots(view->header, RING_GATEWAY),
             end = segment_load(&words->head);
    for (uint64_t i = end > slots ? end - slots : 0; i < end; i++) {
        struct remote_record record = remote_record_of(&words->slot[i & (slots - 1)]);
        if (record.type == REMOTE_STRUCK || record.type == REMOTE_FIRE)
            note_old_shot(input, &record, now_ns);
        if (record.type == REMOTE_TRACK || record.type == REMOTE_OWNER ||
            record.type == REMOTE_LOST)
            note_old_owner(input, &record, i, now_ns);
    }
}

int remote_input_open(struct remote_input *input, const struct view *view, uint64_t now_ns,
                      struct error_text *error)
{
    if (remote_table_open(&input->table, view->world.params->remotes_max) != 0)
        return error_text_set(error, "remote entities: no memory for %u: %s",
                              view->world.params->remotes_max, strerror(errno));
    input->time_scale = 1.0; /* until the first snapshot */
    input->side_m = view->world.terrain.squares.world_m;
    input->world_capacity = view->header->capacity;
    input->grace_ns = now_ns + (uint64_t)(REMOTE_INPUT_GRACE_S * 1e9);
    read_ring(input, view, now_ns);
    return 0;
}

void remote_input_close(struct remote_input *input)
{
    remote_table_close(&input->table);
}

/* --- numbers -----------------------------------------------------------------------------------*/

static bool within(struct vec3 v, double most)
{
    return vec3_length(v) <= most; /* false for NaN */
}

static bool in_square(const struct remote_input *input, struct vec3 at)
{
    return at.x >= 0.0 && at.x <= input->side_m && at.z >= 0.0 && at.z <= input->side_m;
}

/* Returns true if a place is one of the world, and else counts why not. */
bool remote_input_in_world(struct remote_input *input, struct vec3 at)
{
    bool high = at.y >= HEIGHT_LEAST_M && at.y <= HEIGHT_MOST_M; /* false for NaN */
    if (!in_square(input, at))
        input->refused[REMOTE_INPUT_PLACE]++;
    else if (!high)
        input->refused[REMOTE_INPUT_HEIGHT]++;
    return in_square(input, at) && high;
}

/* Returns a place of the world. One that is nowhere near is outside the square. */
struct vec3 remote_input_place(const struct remote_input *input, const double location[3])
{
    struct vec3 ecef = {location[0], location[1], location[2]};
    if (!within(vec3_sub(ecef, input->frame->origin), DRY_M))
        return (struct vec3){-1.0, 0.0, -1.0};
    return local_frame_world(input->frame, ecef);
}

/* Returns an angle as it is in a record, at most so far from 0. An absurd one is 0. */
static int16_t angle_units(double angle_rad, double most_rad)
{
    double angle = fabs(angle_rad) < 1e6 ? maths_wrap_half(angle_rad) : 0.0;
    return (int16_t)lrint(maths_clamp(angle, -most_rad, most_rad) / PI * 32767.0);
}

/* --- time --------------------------------------------------------------------------------------*/

static void scale_floats(float value[3], double scale, double most)
{
    vec3_to_floats(value, vec3_limited(vec3_scale(vec3_of(value), scale), most));
}

/* Writes a record into the ring. Velocities of other simulators are by the clock, and those in the
 * ring by simulated time. */
int remote_input_append(struct remote_input *input, struct view *view, struct remote_record record)
{
    double scale = 1.0 / input->time_scale;
    if (input->time_scale != 1.0 && (record.type == REMOTE_TRACK || record.type == REMOTE_STRUCK))
        scale_floats(record.velocity, scale, REMOTE_INPUT_SPEED_MPS);
    if (input->time_scale != 1.0 && record.type == REMOTE_TRACK) {
        scale_floats(record.acceleration, scale * scale, SCALED_ACCELERATION_MOST_MPS2);
        scale_floats(record.rates, scale, SCALED_RATE_MOST_RPS);
    }
    return remote_ring_append(&input->table, view, &record, input->taken);
}

/* --- types -------------------------------------------------------------------------------------*/

uint16_t remote_input_kind(struct remote_input *input, struct pdu_entity_type type, bool munition)
{
    bool same;
    uint16_t kind = type_table_kind(input->types, type, munition, &same);
    if (!same)
        type_notices_note(&input->unknown, type, kind);
    return kind;
}

/* --- Entity State ------------------------------------------------------------------------------*/

static uint8_t force_of(uint8_t force)
{
    unsigned side = force > PDU_FORCE_LAST ? PDU_FORCE_OTHER : force % 3u;
    return side == PDU_FORCE_FRIENDLY   ? FORCE_BLUE
           : side == PDU_FORCE_OPPOSING ? FORCE_RED
                                        : FORCE_NEUTRAL;
}

static uint8_t damage_of(uint32_t appearance)
{
    static const uint8_t levels[4] = {DAMAGE_NONE, DAMAGE_LOW, DAMAGE_HIGH, DAMAGE_DESTROYED};
    return levels[appearance >> 3 & 3];
}

/* Fills the motion: all of it in the axes of the world. */
static void set_motion(struct remote_record *track, const struct mat3 *axes,
                       const struct pdu_entity_state *state)
{
    const struct euler angles = {(double)state->orientation[0], (double)state->orientation[1],
                                 (double)state->orientation[2]};
    bool sane = fabs(angles.psi) < 1e3 && fabs(angles.theta) < 1e3 && fabs(angles.phi) < 1e3;
    struct mat3 matrix = euler_matrix(sane ? angles : (struct euler){0.0, 0.0, 0.0});
    struct mat3 turn = local_frame_world_turn(axes, &matrix);
    double heading, pitch, roll;
    local_frame_angles(&turn, &heading, &pitch, &roll);
    vec3_to_floats(track->attitude, (struct vec3){heading, pitch, roll});
    uint8_t model = state->dead_reckoning;
    if (model < DEAD_RECKONING_STATIC || model > DEAD_RECKONING_FVB ||
        state->appearance & PDU_APPEARANCE_FROZEN)
        model = DEAD_RECKONING_STATIC;
    track->model = model;
    struct vec3 velocity = vec3_limited(vec3_of(state->velocity), REMOTE_INPUT_SPEED_MPS);
    struct vec3 acceleration = vec3_limited(vec3_of(state->acceleration), ACCELERATION_MOST_MPS2);
    struct vec3 rates = vec3_limited(vec3_of(state->angular_velocity), RATE_MOST_RPS);
    if (model >= DEAD_RECKONING_FPB) {
        velocity = rotation_apply(&matrix, velocity);
        acceleration = rotation_apply(&matrix, acceleration);
    }
    rates = rotation_apply(&matrix, rates);
    vec3_to_floats(track->velocity, rotation_back(axes, velocity));
    vec3_to_floats(track->acceleration, rotation_back(axes, acceleration));
    vec3_to_floats(track->rates, rotation_back(axes, rates));
}

static void set_parts(struct remote_record *track, const struct pdu *pdu)
{
    for (uint32_t i = 0; i < pdu->parts; i++) {
        const struct pdu_part *part = &pdu->part[i];
        if (part->kind != PDU_PART_ARTICULATED)
            continue;
        if (part->type == PDU_TURRET_AZIMUTH)
            track->turret = angle_units((double)part->value, PI);
        if (part->type == PDU_GUN_ELEVATION)
            track->gun = angle_units((double)part->value, 0.5 * PI);
    }
}

void remote_input_lose(struct remote_input *input, struct view *view, struct remote_entry *entry)
{
    struct remote_record record = {
        .remote = entry->remote, .type = REMOTE_LOST, .slot = entry->track.slot};
    if (remote_input_append(input, view, record) != 0) {
        input->refused[REMOTE_INPUT_RING]++; /* its row is seen again, and lost later */
        return;
    }
    input->lost++;
    remote_table_remove(&input->table, entry);
}

/* Who comes first with an identifier is its owner. An address may have several simulators, one a
 * port. One that starts anew there, on another port, gets the entities that its predecessor no
 * longer sends. */
bool remote_input_owns(const struct remote_input *input, const struct remote_entry *entry,
                       const struct udp_address *from, uint64_t now_ns)
{
    uint64_t sender = remote_table_owner(from);
    bool same_host = (entry->owner ^ sender) >> REMOTE_TABLE_PORT_BITS == 0;
    bool silent = now_ns - entry->heard_ns > input->timeout_ns / 2;
    return entry->owner == 0 || entry->owner == sender || (same_host && silent);
}

/* Returns true if a sender can be the owner of an entity that has a row, and whose owner nobody
 * knows. */
static bool continues(const struct remote_input *input, const struct remote_entry *entry,
                      struct vec3 place, uint64_t now_ns)
{
    return entry->owner != 0 || !entry->placed || now_ns >= input->grace_ns ||
           vec3_length(vec3_sub(place, entry->place)) <= REMOTE_INPUT_GRACE_M;
}

/* Returns the entry that may be told of this place, or NULL and counts why not. */
static struct remote_entry *admit(struct remote_input *input, uint64_t remote, struct vec3 place,
                                  const struct udp_address *from, uint64_t now_ns)
{
    struct remote_entry *entry = remote_table_find(&input->table, remote);
    if (!remote_input_in_world(input, place))
        return NULL;
    if (!entry && !(entry = remote_table_add(&input->table, remote, now_ns))) {
        input->refused[REMOTE_INPUT_FULL]++;
        return NULL;
    }
    if (!remote_input_owns(input, entry, from, now_ns) || !continues(input, entry, place, now_ns)) {
        input->refused[REMOTE_INPUT_TWIN]++;
        input->twin = remote;
        input->twin_from = *from;
        return NULL;
    }
    if (entry->placed && vec3_length(vec3_sub(place, entry->place)) > 0.9 * REMOTE_JUMP_M) {
        input->refused[REMOTE_INPUT_JUMP]++;
        return NULL;
    }
    entry->owner = remote_table_owner(from);
    return entry;
}

/* Returns how much older a PDU is than what came at heard_ns with a time stamp [s], below 0 when it
 * is younger. 0 when the stamps or the time that has passed say nothing about the order. */
static double older_by(uint32_t stamp, uint64_t heard_ns, const struct pdu *pdu, uint64_t now_ns)
{
    double older_s = timestamp_between(pdu->header.timestamp, stamp);
    bool recent = now_ns - heard_ns < (uint64_t)(REMOTE_INPUT_LATE_S * 1e9);
    bool comparable = timestamp_absolute(stamp) == timestamp_absolute(pdu->header.timestamp);
    return recent && comparable && fabs(older_s) <= REMOTE_INPUT_LATE_S ? older_s : 0.0;
}

/* Returns true if the PDU is of an entity that has left since it was sent. */
static bool is_gone(const struct remote_input *input, uint64_t remote, const struct pdu *pdu,
                    uint64_t now_ns)
{
    uint32_t count = input->gone_count < REMOTE_INPUT_GONE ? input->gone_count : REMOTE_INPUT_GONE;
    for (uint32_t i = 0; i < count; i++) {
        if (input->gone[i].remote == remote &&
            older_by(input->gone[i].stamp, input->gone[i].heard_ns, pdu, now_ns) > 0.0)
            return true;
    }
    return false;
}

static void take_last(struct remote_input *input, struct view *view, const struct pdu *pdu,
                      const struct udp_address *from, uint64_t now_ns)
{
    uint64_t remote = id_of(pdu->entity_state.id);
    struct remote_entry *entry = remote_table_find(&input->table, remote);
    if (!entry || !remote_input_owns(input, entry, from, now_ns))
        return;
    uint32_t at = input->gone_count++ % REMOTE_INPUT_GONE;
    input->gone[at].remote = remote;
    input->gone[at].heard_ns = now_ns;
    input->gone[at].stamp = pdu->header.timestamp;
    remote_input_lose(input, view, entry);
}

/* Returns true if two records say the same, byte by byte. Records have no padding. */
static bool says_the_same(const struct remote_record *a, const struct remote_record *b)
{
    return memcmp((const unsigned char *)a, (const unsigned char *)b, sizeof *a) == 0;
}

/* Returns true if the entry has come this far already: by an Entity State that was sent later, or
 * by the same one. track: what the PDU says. */
static bool is_late(struct remote_input *input, struct remote_entry *entry,
                    const struct remote_record *track, const struct pdu *pdu, uint64_t now_ns)
{
    if (entry->track.remote == 0)
        return false; /* the first that comes */
    double older_s = older_by(entry->stamp, entry->heard_ns, pdu, now_ns);
    bool copy = entry->stamp == pdu->header.timestamp && says_the_same(&entry->track, track);
    if (copy) /* what stands may say the same for ever, by a clock that stands */
        entry->heard_ns = now_ns;
    input->late += copy || older_s > 0.0;
    return copy || older_s > 0.0;
}

/* Returns true if the world has the entity at rest as the track says, so that it need not be told.
 */
static bool stands(const struct remote_entry *entry, const struct remote_record *track)
{
    return !entry->waits && track->slot != SLOT_NONE && track->model == DEAD_RECKONING_STATIC &&
           says_the_same(&entry->track, track);
}

static void take_state(struct remote_input *input, struct view *view, const struct pdu *pdu,
                       const struct udp_address *from, uint64_t now_ns)
{
    const struct pdu_entity_state *state = &pdu->entity_state;
    uint64_t remote = id_of(state->id);
    struct remote_entry *entry = remote_table_find(&input->table, remote);
    if (state->appearance & PDU_APPEARANCE_DEACTIVATED) {
        take_last(input, view, pdu, from, now_ns);
        return;
    }
    bool flies = state->type.kind == MUNITION;
    bool shown = flies || state->type.kind == PLATFORM || state->type.kind == LIFE_FORM;
    uint16_t kind = shown ? remote_input_kind(input, state->type, flies) : KIND_NONE;
    if (kind == KIND_NONE) {
        input->refused[REMOTE_INPUT_TYPE]++;
        return;
    }
    struct vec3 place = remote_input_place(input, state->location);
    if ((!entry && is_gone(input, remote, pdu, now_ns)) ||
        !(entry = admit(input, remote, place, from, now_ns)))
        return;
    struct remote_record track = {.remote = remote,
                                  .type = REMOTE_TRACK,
                                  .slot = entry->track.slot,
                                  .event = entry->owner,
                                  .damage = damage_of(state->appearance),
                                  .flags = input->clamp ? REMOTE_FLAG_CLAMPED : 0,
                                  .kind = kind,
                                  .force = force_of(state->force),
                                  .position = {place.x, place.y, place.z}};
    const struct mat3 axes = local_frame_axes(input->frame, place);
    set_motion(&track, &axes, state);
    set_parts(&track, pdu);
    memcpy(track.marking, state->marking, PDU_MARKING_MAX);
    if (is_late(input, entry, &track, pdu, now_ns))
        return;
    bool same = stands(entry, &track);
    entry->track = track;
    entry->stamp = pdu->header.timestamp;
    entry->place = place;
    entry->placed = true;
    entry->heard_ns = now_ns;
    if (same)
        return;
    remote_table_wait(&input->table, entry);
}

/* --- PDUs --------------------------------------------------------------------------------------*/

bool remote_input_take(struct remote_input *input, struct view *view, const struct pdu *pdu,
                       const struct udp_address *from, uint64_t now_ns)
{
    if (input->table.capacity == 0)
        return false;
    switch ((enum pdu_type)pdu->header.type) {
    case PDU_ENTITY_STATE:
        take_state(input, view, pdu, from, now_ns);
        break;
    case PDU_FIRE:
        remote_input_fire(input, view, pdu, now_ns);
        break;
    case PDU_DETONATION:
        remote_input_detonation(input, view, pdu, from, now_ns);
        break;
    case PDU_COLLISION:
    case PDU_COLLISION_ELASTIC:
        remote_input_collision(input, pdu, now_ns);
        break;
    default:
        return false;
    }
    return true;
}

void remote_input_world_refused(struct remote_input *input, uint64_t remote, uint32_t count,
                                uint32_t because)
{
    input->world_refused[because < REMOTE_REFUSAL_COUNT ? because : REMOTE_UNKNOWN] += count;
    input->world_refused_remote = remote;
}

/* --- passes ------------------------------------------------------------------------------------*/

/* Tells the track of an entry if it is time. Returns false if the entry still waits. */
static bool tell_entry(struct remote_input *input, struct view *view, struct remote_entry *entry,
                       uint64_t now_ns)
{
    if (!entry->waits)
        return true;
    if (now_ns - entry->told_ns < (uint64_t)(REMOTE_INPUT_LEAST_S * 1e9))
        return false;
    if (remote_input_append(input, view, entry->track) != 0) {
        input->refused[REMOTE_INPUT_RING]++;
        return false;
    }
    entry->waits = false;
    entry->told_ns = now_ns;
    entry->told_at = segment_load(&view->commands[RING_GATEWAY]->head) - 1;
    input->tracks++;
    return true;
}

void remote_input_tell(struct remote_input *input, struct view *view, uint64_t now_ns)
{
    struct remote_table *table = &input->table;
    uint32_t kept = 0;
    remote_input_tell_bodies(input, view, now_ns);
    for (uint32_t i = 0; i < table->waiting_count; i++) {
        uint32_t index = table->waiting[i];
        struct remote_entry *entry = &table->entry[index];
        if (tell_entry(input, view, entry, now_ns))
            entry->listed = false;
        else
            table->waiting[kept++] = index;
    }
    table->waiting_count = kept;
}

/* Tells again what the world had not taken by the last snapshot: it may have taken that after it
 * had changed its scale, and it was by the old one. */
static void tell_anew(struct remote_input *input)
{
    struct remote_table *table = &input->table;
    for (uint32_t i = 0; i < table->used; i++) {
        struct remote_entry *entry = &table->entry[i];
        if (entry->remote != 0 && entry->track.remote != 0 && entry->told_at >= input->taken &&
            entry->track.model != DEAD_RECKONING_STATIC)
            remote_table_wait(table, entry);
    }
}

/* A world that pauses goes on at its scale. The world itself leads what it knows to another one. */
static void set_time_scale(struct remote_input *input, const struct state_head *head)
{
    if (!(head->time_scale > 0.0) || head->time_scale == input->time_scale)
        return;
    input->time_scale = head->time_scale;
    tell_anew(input);
}

void remote_input_see(struct remote_input *input, struct view *view,
                      const struct snapshot *snapshot, uint64_t now_ns)
{
    struct remote_table *table = &input->table;
    if (table->capacity == 0)
        return;
    set_time_scale(input, &snapshot->head);
    input->taken = snapshot->head.command_cursor[RING_GATEWAY];
    remote_table_see(table, snapshot, now_ns);
    for (uint32_t i = 0; i < table->used; i++) {
        struct remote_entry *entry = &table->entry[i];
        if (entry->remote == 0)
            continue;
        bool here = entry->seen_ns == now_ns;
        if (!here)
            entry->track.slot = SLOT_NONE;
        if (here && now_ns - entry->heard_ns > input->timeout_ns)
            remote_input_lose(input, view, entry);
        else if (!here && now_ns - entry->seen_ns > GONE_NS)
            remote_table_remove(table, entry); /* it has left the world, or was refused */
    }
}
