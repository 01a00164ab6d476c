/* Entity State PDUs: what is due, and what it says. */
#include "gateway/entity_output.h"

#include "gateway/cot_event.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "world/entity/disabled.h"
#include "world/entity/remote.h"
#include "world/maths/random.h"
#include "world/params.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Below these, a motion is uniform, or none at all. */
#define ACCELERATION_LEAST 0.5  /* [m/s^2] */
#define RATE_LEAST         0.03 /* [rad/s] */
#define SPEED_LEAST        0.02 /* [m/s] */

/* Rates that die away are taken as they will be so much later, because receivers extrapolate them
 * as constants: that saves 4 % of all PDUs. Rates that grow are taken as they are [s]. */
#define RATES_LEAD_S 0.15

#define ACCELERATION_MOST 60.0 /* [m/s^2] an impact is no acceleration that lasts */
#define RATE_MOST         6.0  /* [rad/s] */

/* A pass leads the time of the frames back to the clock by this share of the difference, and at
 * once when the difference is larger than any noise. */
#define OFFSET_SHARE  0.1
#define OFFSET_MOST_S 0.1

#define LAST_AT_ONCE 32u /* last states within a millisecond */

#define FLAMES_S         60.0 /* since the damage of a wreck last grew */
#define HEARTBEAT_SPREAD 0.1  /* of the heartbeat, which is so much longer at most */

/* What a pass knows of a row. */
struct row_view {
    uint32_t row, id;
    struct mat3 axes;     /* of the world at its place, in ECEF */
    struct vec3 velocity; /* [m/s] ECEF */
    struct vec3 position; /* [m] ECEF */
    struct mat3 matrix;   /* euler.h */
    uint32_t appearance;
    float turret, gun;
    bool has_gun;
    double off_m, off_rad; /* from where receivers have it */
};

bool entity_output_sends(const struct kind *kind)
{
    return kind->domain < DOMAIN_MUNITION ||
           (kind->domain == DOMAIN_MUNITION && kind->guidance == GUIDANCE_HOMING);
}

int entity_output_open(struct entity_output *entities, const struct view *view,
                       struct error_text *error)
{
    entities->capacity = view->header->capacity;
    entities->sent = calloc(entities->capacity, sizeof *entities->sent);
    entities->followed = calloc(entities->capacity, sizeof *entities->followed);
    if (!entities->sent || !entities->followed || snapshot_init(&entities->snapshot, view) != 0) {
        free(entities->sent);
        free(entities->followed);
        entities->sent = NULL;
        entities->followed = NULL;
        return error_text_set(error, "entities: no memory for %u: %s", entities->capacity,
                              strerror(errno));
    }
    return 0;
}

void entity_output_close(struct entity_output *entities)
{
    snapshot_free(&entities->snapshot);
    free(entities->sent);
    free(entities->followed);
    entities->sent = NULL;
    entities->followed = NULL;
}

uint32_t entity_output_row(const struct entity_output *entities, uint32_t id)
{
    const struct snapshot *snapshot = &entities->snapshot;
    return id == 0 ? SLOT_NONE : entities_find(&snapshot->entities, snapshot->head.used, id);
}

struct vec3 entity_output_velocity_before(const struct entity_output *entities, uint32_t row,
                                          uint64_t tick)
{
    const struct entities *e = &entities->snapshot.entities;
    const struct entity_sent *sent = &entities->sent[row];
    if (sent->seen_id != e->row[row].id && sent->id != e->row[row].id)
        return entities_velocity(e, row);
    if (sent->seen_tick < tick)
        return sent->seen_velocity;
    return sent->earlier_tick < tick ? sent->earlier_velocity : entities_velocity(e, row);
}

/* --- what a row looks like ---------------------------------------------------------------------*/

static uint32_t appearance_of(const struct world *world, const struct snapshot *snapshot,
                              uint32_t row)
{
    static const uint8_t levels[DAMAGE_COUNT] = {0, 1, 2, 2, 3};
    const struct entities *e = &snapshot->entities;
    const struct kind *kind = &world->kinds[e->row[row].kind];
    uint8_t damage = e->row[row].damage < DAMAGE_COUNT ? e->row[row].damage : DAMAGE_DESTROYED;
    bool wreck = e->row[row].state == ENTITY_WRECK;
    uint32_t appearance = PDU_APPEARANCE_DAMAGE(wreck ? 3 : levels[damage]);
    if (kind->domain == DOMAIN_LAND && !wreck) {
        appearance |= disabled_drive(kind, e, row) ? PDU_APPEARANCE_MOBILITY_KILL : 0;
        appearance |= disabled_gun(kind, e, row) ? PDU_APPEARANCE_FIRE_KILL : 0;
    }
    if (wreck) {
        double since_s =
            (double)((uint32_t)snapshot->head.tick - e->row[row].changed_tick) * world_dt_s(world);
        appearance |= PDU_APPEARANCE_MOBILITY_KILL | PDU_APPEARANCE_FIRE_KILL;
        appearance |= PDU_APPEARANCE_SMOKE | (since_s < FLAMES_S ? PDU_APPEARANCE_FLAMES : 0);
        if (kind->domain != DOMAIN_LAND)
            appearance &= ~(PDU_APPEARANCE_MOBILITY_KILL | PDU_APPEARANCE_FIRE_KILL);
    }
    return appearance | (snapshot->head.paused ? PDU_APPEARANCE_FROZEN : 0);
}

/* Returns the angular velocity that turns one attitude into another within dt_s [rad/s, body axes
 * of DIS]. */
static struct vec3 rates_between(const struct mat3 *from, const struct mat3 *to, double dt_s)
{
    /* The skew part of from^T to is the axis times the sine of the angle, which is small. */
    double d[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            d[i][j] = from->m[0][i] * to->m[0][j] + from->m[1][i] * to->m[1][j] +
                      from->m[2][i] * to->m[2][j];
    }
    struct vec3 body = {0.5 * (d[2][1] - d[1][2]), 0.5 * (d[0][2] - d[2][0]),
                        0.5 * (d[1][0] - d[0][1])};
    return vec3_scale(local_frame_body_to_dis(body), 1.0 / dt_s);
}

/* Returns the rates that a receiver should extrapolate of a row that now turns by these. */
static struct vec3 lasting_rates(struct vec3 rates, struct vec3 before, double past_s)
{
    double square = vec3_dot(rates, rates);
    double growth = vec3_dot(rates, vec3_sub(rates, before)); /* per past_s, times the square */
    if (!(square > 0.0) || growth >= 0.0)
        return rates;
    return vec3_scale(rates, maths_max(0.0, 1.0 + RATES_LEAD_S / past_s * growth / square));
}

/* Notes the velocity of a row in a new frame. */
static void note_velocity(struct entity_sent *sent, const struct snapshot *snapshot, uint32_t row)
{
    sent->earlier_tick = sent->seen_tick;
    sent->earlier_velocity = sent->seen_velocity;
    sent->seen_tick = snapshot->head.tick;
    sent->seen_velocity = entities_velocity(&snapshot->entities, row);
}

/* Updates the motion of a row by a new frame. Its acceleration and rates are those since the last
 * pass: smoothing them over 0.05 s costs 6 % more PDUs, over 0.07 s 9 %. */
static void observe(struct entity_sent *sent, const struct snapshot *snapshot, uint32_t row,
                    const struct mat3 *turn, double dt_s, bool follows)
{
    const struct entities *e = &snapshot->entities;
    struct vec3 velocity = entities_velocity(e, row);
    double past_s = (double)(snapshot->head.tick - sent->seen_tick) * dt_s;
    if (sent->seen_id != e->row[row].id || past_s > 1.0) {
        sent->acceleration = sent->rates = sent->seen_rates = (struct vec3){0};
    } else if (past_s > 0.0) {
        sent->acceleration = vec3_limited(
            vec3_scale(vec3_sub(velocity, sent->seen_velocity), 1.0 / past_s), ACCELERATION_MOST);
        struct vec3 rates = vec3_limited(rates_between(&sent->seen_turn, turn, past_s), RATE_MOST);
        sent->rates = lasting_rates(rates, sent->seen_rates, 0.5 * (past_s + sent->seen_s));
        if (!follows) {
            sent->seen_rates = rates;
            sent->seen_s = past_s;
        }
    } else {
        return;
    }
    if (follows)
        return; /* the next pass sees the motion since the last one */
    if (sent->seen_id != e->row[row].id && sent->id != e->row[row].id)
        sent->seen_velocity = velocity; /* it was somebody else's */
    note_velocity(sent, snapshot, row);
    sent->seen_id = e->row[row].id;
    sent->seen_turn = *turn;
}

/* Returns true if receivers have the row exactly where it is, because it stands where it stood when
 * it was sent. Most rows do, and need none of the mathematics then. */
static bool stands(struct entity_sent *sent, const struct world *world,
                   const struct snapshot *snapshot, uint32_t row, uint64_t now_ns)
{
    const struct entities *e = &snapshot->entities;
    if (sent->id != e->row[row].id || sent->state.model != DEAD_RECKONING_STATIC ||
        now_ns >= sent->heartbeat_ns || sent->before_ns != 0 || sent->place.x != e->row[row].x ||
        sent->place.y != e->row[row].y || sent->place.z != e->row[row].z ||
        sent->heading != e->row[row].heading || sent->pitch != e->row[row].pitch ||
        sent->roll != e->row[row].roll || sent->turret != e->row[row].turret ||
        sent->gun != e->row[row].gun || sent->appearance != appearance_of(world, snapshot, row))
        return false;
    if (sent->seen_tick != snapshot->head.tick)
        note_velocity(sent, snapshot, row); /* for observe(): it stood until now */
    sent->acceleration = sent->rates = sent->seen_rates = (struct vec3){0};
    return true;
}

static struct row_view look_at(struct entity_output *entities, const struct world *world,
                               uint32_t row, bool follows)
{
    const struct snapshot *snapshot = &entities->snapshot;
    const struct entities *e = &snapshot->entities;
    const struct kind *kind = &world->kinds[e->row[row].kind];
    struct mat3 turn =
        rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
    double scale = snapshot->head.paused ? 0.0 : snapshot->head.time_scale;
    struct mat3 axes = local_frame_axes(&entities->frame, entities_position(e, row));
    observe(&entities->sent[row], snapshot, row, &turn, world_dt_s(world), follows);
    return (struct row_view){
        .row = row,
        .id = e->row[row].id,
        .axes = axes,
        .velocity = vec3_scale(rotation_apply(&axes, entities_velocity(e, row)), scale),
        .position = local_frame_ecef(&entities->frame, entities_position(e, row)),
        .matrix = local_frame_ecef_turn(&axes, &turn),
        .appearance = appearance_of(world, snapshot, row),
        .turret = e->row[row].turret,
        .gun = e->row[row].gun,
        .has_gun = kind->part_count > 0 && kind->domain != DOMAIN_MUNITION};
}

/* --- what is due -------------------------------------------------------------------------------*/

static double turned(float a, float b)
{
    return fabs(maths_wrap_half((double)a - (double)b));
}

/* Returns where a receiver of an Entity State of the frame at sent_ns has the row now. */
static void receivers_have(const struct dead_reckoning *state, uint32_t appearance,
                           uint64_t sent_ns, uint64_t frame_ns, struct vec3 *position,
                           struct mat3 *matrix)
{
    double since_s = frame_ns > sent_ns ? (double)(frame_ns - sent_ns) / 1e9 : 0.0;
    dead_reckoning_at(state, appearance & PDU_APPEARANCE_FROZEN ? 0.0 : since_s, position, matrix);
}

/* Returns true if a receiver that has lost the last Entity State has the row too far off. */
static bool lost_is_off(const struct entity_sent *sent, const struct row_view *view,
                        uint64_t now_ns, uint64_t frame_ns)
{
    struct vec3 position;
    struct mat3 matrix;
    if (sent->before_ns == 0 || now_ns - sent->sent_ns < (uint64_t)(ENTITY_OUTPUT_AGAIN_S * 1e9))
        return false;
    receivers_have(&sent->before, sent->before_appearance, sent->before_ns, frame_ns, &position,
                   &matrix);
    return vec3_length(vec3_sub(position, view->position)) >
           ENTITY_OUTPUT_POSITION_M + ENTITY_OUTPUT_LOST_S * vec3_length(view->velocity);
}

/* Computes how far off receivers have the row. */
static void measure(const struct entity_sent *sent, struct row_view *view, uint64_t frame_ns)
{
    struct vec3 position;
    struct mat3 matrix;
    receivers_have(&sent->state, sent->appearance, sent->frame_ns, frame_ns, &position, &matrix);
    view->off_m = vec3_length(vec3_sub(position, view->position));
    view->off_rad = euler_angle_between(&matrix, &view->matrix);
    if (view->has_gun)
        view->off_rad = maths_max(view->off_rad, maths_max(turned(sent->turret, view->turret),
                                                           turned(sent->gun, view->gun)));
}

/* Returns true if a new Entity State is due for a row that was sent before. */
static bool due(const struct entity_sent *sent, const struct row_view *view, uint64_t now_ns,
                uint64_t frame_ns)
{
    return sent->appearance != view->appearance || now_ns >= sent->heartbeat_ns ||
           view->off_m > ENTITY_OUTPUT_POSITION_M || view->off_rad > ENTITY_OUTPUT_ANGLE_RAD ||
           lost_is_off(sent, view, now_ns, frame_ns);
}

/* Returns true if a row may pass a threshold before the next pass. */
static bool to_follow(const struct entity_sent *sent, const struct row_view *view)
{
    return vec3_length(sent->seen_rates) > ENTITY_OUTPUT_FOLLOW_RPS ||
           view->off_m > ENTITY_OUTPUT_FOLLOW_SHARE * ENTITY_OUTPUT_POSITION_M ||
           view->off_rad > ENTITY_OUTPUT_FOLLOW_SHARE * ENTITY_OUTPUT_ANGLE_RAD;
}

/* The heartbeats of entities that were sent together spread over the time. */
static uint64_t heartbeat_after(uint32_t id, uint64_t now_ns)
{
    double share = (double)(random_mix(id ^ now_ns) >> 11) * 0x1.0p-53;
    double wait_s = ENTITY_OUTPUT_HEARTBEAT_S * (1.0 + HEARTBEAT_SPREAD * share);
    return now_ns + (uint64_t)(wait_s * 1e9);
}

/* --- what it says ------------------------------------------------------------------------------*/

/* Selects the model of dead reckoning by the row's motion, and fills the motion. */
static void set_motion(struct pdu_entity_state *state, const struct entity_output *entities,
                       const struct row_view *view, const struct entity_sent *sent)
{
    const struct state_head *head = &entities->snapshot.head;
    double scale = head->paused ? 0.0 : head->time_scale;
    struct vec3 acceleration =
        vec3_scale(rotation_apply(&view->axes, sent->acceleration), scale * scale);
    struct vec3 rates = vec3_scale(sent->rates, scale);
    bool turns = vec3_length(rates) > RATE_LEAST;
    bool speeds = vec3_length(acceleration) > ACCELERATION_LEAST;
    if (!turns && !speeds && vec3_length(view->velocity) < SPEED_LEAST) {
        state->dead_reckoning = DEAD_RECKONING_STATIC;
        return;
    }
    vec3_to_floats(state->velocity, view->velocity);
    state->dead_reckoning = turns    ? DEAD_RECKONING_RVW
                            : speeds ? DEAD_RECKONING_FVW
                                     : DEAD_RECKONING_FPW;
    if (turns || speeds)
        vec3_to_floats(state->acceleration, acceleration);
    if (turns)
        vec3_to_floats(state->angular_velocity, rates);
}

/* Writes the name of an entity for people: the scenario's, or kind and id. */
static void set_label(char label[COT_EVENT_TEXT], const struct world *world,
                      const struct kind *kind, uint32_t id)
{
    const char *name = world_entity_name(world, id);
    if (name[0] != '\0')
        (void)snprintf(label, COT_EVENT_TEXT, "%s", name);
    else
        (void)snprintf(label, COT_EVENT_TEXT, "%s %u", kind->name, id);
}

static void set_marking(char marking[PDU_MARKING_MAX + 1], const struct world *world,
                        const struct kind *kind, uint32_t id)
{
    char text[64];
    const char *name = world_entity_name(world, id);
    if (name[0] != '\0')
        (void)snprintf(text, sizeof text, "%s", name);
    else if (id < 100000)
        (void)snprintf(text, sizeof text, "%.*s %u", id < 1000 ? 7 : 5, kind->name, id);
    else
        (void)snprintf(text, sizeof text, "%u", id);
    text[PDU_MARKING_MAX] = '\0';
    memset(marking, 0, PDU_MARKING_MAX + 1);
    for (size_t i = 0; text[i] != '\0'; i++)
        marking[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
}

/* Counts the values of parts that differ from those that were sent before. A gateway that starts
 * anew does not know the last count, so it begins at a number that differs from one time to the
 * next. */
static void count_changes(struct entity_sent *sent, const struct row_view *view, uint64_t tick)
{
    if (sent->id != view->id) {
        sent->turret_changes = sent->gun_changes = (uint8_t)tick;
        return;
    }
    if (sent->turret != view->turret)
        sent->turret_changes++;
    if (sent->gun != view->gun)
        sent->gun_changes++;
}

static void set_parts(struct pdu *pdu, const struct row_view *view, const struct entity_sent *sent)
{
    pdu->parts = view->has_gun ? 2 : 0;
    pdu->part[0] = (struct pdu_part){.kind = PDU_PART_ARTICULATED,
                                     .change = sent->turret_changes,
                                     .type = PDU_TURRET_AZIMUTH,
                                     .value = view->turret};
    pdu->part[1] = (struct pdu_part){.kind = PDU_PART_ARTICULATED,
                                     .change = sent->gun_changes,
                                     .attached_to = 1,
                                     .type = PDU_GUN_ELEVATION,
                                     .value = view->gun};
}

static uint8_t dis_force(uint8_t force)
{
    return force == FORCE_BLUE  ? PDU_FORCE_FRIENDLY
           : force == FORCE_RED ? PDU_FORCE_OPPOSING
                                : PDU_FORCE_NEUTRAL;
}

/* A vehicle that is destroyed is taken off the map of Cursor on Target, for its wreck is none. */
static bool on_map(const struct entity_sent *sent)
{
    return (sent->appearance & PDU_APPEARANCE_DAMAGE(3)) != PDU_APPEARANCE_DAMAGE(3);
}

static void send_cot(struct entity_output *entities, const struct world *world,
                     const struct entity_sent *sent, struct cot_output_entity *entity, bool gone)
{
    char label[COT_EVENT_TEXT];
    set_label(label, world, &world->kinds[sent->kind], sent->id);
    (void)entity_ids_of(&entities->ids, sent->id, &entity->id);
    entity->type = type_table_row(entities->types, sent->kind, sent->force);
    entity->force = sent->force;
    entity->callsign = label;
    cot_output_send(entities->cot, entity, gone);
}

/* Returns true if two Entity States have the row at rest at the same place. */
static bool rests(const struct dead_reckoning *before, const struct dead_reckoning *state)
{
    return before->model == DEAD_RECKONING_STATIC && state->model == DEAD_RECKONING_STATIC &&
           vec3_length(vec3_sub(state->position, before->position)) < ENTITY_OUTPUT_POSITION_M;
}

/* Remembers what the receivers have: the numbers as the PDU rounds them; and what those have that
 * lose it, unless that is the same. */
static void remember(struct entity_sent *sent, uint32_t id, const struct pdu_entity_state *state,
                     uint64_t now_ns)
{
    sent->before = sent->state;
    sent->before_appearance = sent->appearance;
    const float *v = state->velocity, *a = state->acceleration, *w = state->angular_velocity;
    sent->state = (struct dead_reckoning){
        .model = state->dead_reckoning,
        .position = {state->location[0], state->location[1], state->location[2]},
        .velocity = {(double)v[0], (double)v[1], (double)v[2]},
        .acceleration = {(double)a[0], (double)a[1], (double)a[2]},
        .rates = {(double)w[0], (double)w[1], (double)w[2]},
        .matrix = euler_matrix((struct euler){(double)state->orientation[0],
                                              (double)state->orientation[1],
                                              (double)state->orientation[2]})};
    sent->before_ns = sent->id == id && !rests(&sent->before, &sent->state) ? sent->frame_ns : 0;
    sent->appearance = state->appearance;
    sent->sent_ns = now_ns;
}

/* Returns how old the snapshot's frame is, by the clock [s]. */
static double frame_age_s(const struct entity_output *entities, uint64_t now_ns)
{
    double age_s = ((double)now_ns - (double)entities->frame_ns) / 1e9;
    return maths_clamp(age_s, 0.0, OFFSET_MOST_S);
}

static void send_state(struct entity_output *entities, const struct world *world,
                       const struct row_view *view, struct pdu_id id, uint64_t now_ns)
{
    static struct pdu pdu;
    const struct entities *e = &entities->snapshot.entities;
    struct entity_sent *sent = &entities->sent[view->row];
    uint16_t kind = e->row[view->row].kind;
    uint8_t force = e->row[view->row].force;
    const struct type_row *type = type_table_row(entities->types, kind, force);
    struct euler angles = euler_of(&view->matrix);
    pdu.header.type = PDU_ENTITY_STATE;
    pdu.entity_state = (struct pdu_entity_state){
        .id = id,
        .force = dis_force(force),
        .type = type->type,
        .alternative_type = type->type,
        .location = {view->position.x, view->position.y, view->position.z},
        .appearance = view->appearance,
        .character_set = 1};
    vec3_to_floats(pdu.entity_state.orientation,
                   (struct vec3){angles.psi, angles.theta, angles.phi});
    set_motion(&pdu.entity_state, entities, view, sent);
    set_marking(pdu.entity_state.marking, world, &world->kinds[kind], view->id);
    count_changes(sent, view, entities->snapshot.head.tick);
    set_parts(&pdu, view, sent);
    pdu_output_send(entities->output, &pdu, frame_age_s(entities, now_ns));
    bool was_on_map = sent->id != view->id || on_map(sent);
    remember(sent, view->id, &pdu.entity_state, now_ns);
    sent->id = view->id;
    sent->kind = kind;
    sent->force = force;
    sent->place = entities_position(e, view->row);
    sent->heading = e->row[view->row].heading;
    sent->pitch = e->row[view->row].pitch;
    sent->roll = e->row[view->row].roll;
    sent->turret = view->turret;
    sent->gun = view->gun;
    sent->frame_ns = entities->frame_ns;
    sent->heartbeat_ns = heartbeat_after(view->id, now_ns);
    if (entities->cot && was_on_map)
        send_cot(entities, world, sent,
                 &(struct cot_output_entity){.position = view->position,
                                             .velocity = view->velocity,
                                             .matrix = &view->matrix},
                 !on_map(sent));
    if (type->nearest && !entities->told_kind[kind]) {
        entities->told_kind[kind] = true;
        log_info("%s has no DIS type of its own and is sent as that of its domain",
                 world->kinds[kind].name);
    }
}

/* Sends the last state of what was in a row, where its dead reckoning has it. */
static void send_last(struct entity_output *entities, const struct world *world,
                      struct entity_sent *sent, uint64_t now_ns)
{
    static struct pdu pdu;
    struct vec3 position;
    struct mat3 matrix;
    dead_reckoning_at(&sent->state, (double)(now_ns - sent->sent_ns) / 1e9, &position, &matrix);
    struct euler angles = euler_of(&matrix);
    const struct type_row *type = type_table_row(entities->types, sent->kind, sent->force);
    pdu.header.type = PDU_ENTITY_STATE;
    pdu.entity_state =
        (struct pdu_entity_state){.force = dis_force(sent->force),
                                  .type = type->type,
                                  .alternative_type = type->type,
                                  .location = {position.x, position.y, position.z},
                                  .appearance = sent->appearance | PDU_APPEARANCE_DEACTIVATED,
                                  .dead_reckoning = DEAD_RECKONING_STATIC,
                                  .character_set = 1};
    (void)entity_ids_of(&entities->ids, sent->id, &pdu.entity_state.id);
    set_marking(pdu.entity_state.marking, world, &world->kinds[sent->kind], sent->id);
    vec3_to_floats(pdu.entity_state.orientation,
                   (struct vec3){angles.psi, angles.theta, angles.phi});
    pdu_output_send(entities->output, &pdu, 0.0);
    if (entities->cot && on_map(sent))
        send_cot(entities, world, sent,
                 &(struct cot_output_entity){.position = position, .matrix = &matrix}, true);
    sent->id = 0;
}

/* --- the time of a frame -----------------------------------------------------------------------*/

/* Returns the frames' own time, by the clock at the present scale [s]. */
static double frame_s(const struct snapshot *snapshot, const struct world *world)
{
    const struct state_head *head = &snapshot->head;
    return (double)head->tick * world_dt_s(world) /
           (head->time_scale > 0.0 ? head->time_scale : 1.0);
}

/* Returns the time of the clock to which the snapshot's frame belongs. A pass finds a frame that is
 * up to a whole frame old, in which a jet flies 4 m. The frames' own time has no such noise. It is
 * led back to the clock, so that a world that falls behind is seen to do so. */
static uint64_t frame_time_ns(struct entity_output *entities, const struct world *world,
                              uint64_t now_ns)
{
    double at_s = frame_s(&entities->snapshot, world);
    double late_s = (double)now_ns / 1e9 - at_s - entities->offset_s;
    entities->offset_s += fabs(late_s) > OFFSET_MOST_S ? late_s : OFFSET_SHARE * late_s;
    return (uint64_t)((at_s + entities->offset_s) * 1e9);
}

/* --- a pass ------------------------------------------------------------------------------------*/

/* Sends what is due of a row. Returns false when the rate is used up. */
static bool send_row(struct entity_output *entities, const struct world *world, uint32_t row,
                     uint64_t now_ns, bool follows)
{
    const struct snapshot *snapshot = &entities->snapshot;
    const struct entities *e = &snapshot->entities;
    struct entity_sent *sent = &entities->sent[row];
    bool here = row < snapshot->head.used && e->row[row].state != ENTITY_FREE &&
                entity_output_sends(&world->kinds[e->row[row].kind]) && !remote_is(e, row);
    if (sent->id != 0 && (!here || sent->id != e->row[row].id)) {
        if (!pdu_output_take(entities->output, PDU_OUTPUT_STATE, now_ns)) {
            entities->postponed++;
            return false;
        }
        send_last(entities, world, sent, now_ns);
    }
    struct pdu_id id;
    if (!here)
        return true;
    if (!entity_ids_of(&entities->ids, e->row[row].id, &id)) {
        entities->refused++;
        if (!entities->told_refused)
            log_warn("entity %u is not sent: gateway.applications = %u has room for %u ids",
                     e->row[row].id, entities->ids.applications,
                     entities->ids.applications * ENTITY_IDS_PER_APPLICATION);
        entities->told_refused = true;
        return true;
    }
    if (stands(sent, world, snapshot, row, now_ns))
        return true;
    struct row_view view = look_at(entities, world, row, follows);
    if (sent->id != 0)
        measure(sent, &view, entities->frame_ns);
    if (!follows && to_follow(sent, &view))
        entities->followed[entities->followed_count++] = row;
    if (sent->id != 0 && !due(sent, &view, now_ns, entities->frame_ns))
        return true;
    if (!pdu_output_take(entities->output, PDU_OUTPUT_STATE, now_ns)) {
        entities->postponed++;
        return false;
    }
    send_state(entities, world, &view, id, now_ns);
    return true;
}

bool entity_output_look(struct entity_output *entities, const struct view *view, uint64_t now_ns)
{
    if (snapshot_take_poses(&entities->snapshot, view) != 0)
        return false; /* the next pass sees a later frame */
    entities->frame_ns = frame_time_ns(entities, &view->world, now_ns);
    return true;
}

void entity_output_send(struct entity_output *entities, const struct view *view, uint64_t now_ns)
{
    uint32_t used = entities->snapshot.head.used;
    uint32_t rows = used > entities->known ? used : entities->known;
    entities->followed_count = 0;
    for (uint32_t i = 0; i < rows; i++) {
        uint32_t row = (entities->next_row + i) % rows;
        if (!send_row(entities, &view->world, row, now_ns, false)) {
            entities->next_row = row;
            entities->known = rows;
            entities->cut_short = true;
            return;
        }
    }
    entities->next_row = 0;
    entities->known = used;
    entities->cut_short = false;
}

void entity_output_follow(struct entity_output *entities, const struct view *view, uint64_t now_ns)
{
    const struct snapshot *snapshot = &entities->snapshot;
    const struct entities *e = &snapshot->entities;
    double scale = snapshot->head.time_scale;
    /* Where the rate does not suffice, each waits for its turn. */
    if (entities->cut_short || entities->followed_count == 0 ||
        !snapshot_take_row_poses(&entities->snapshot, view, entities->followed,
                                 entities->followed_count) ||
        snapshot->head.paused || snapshot->head.time_scale != scale)
        return; /* the next pass sees it */
    entities->frame_ns = (uint64_t)((frame_s(snapshot, &view->world) + entities->offset_s) * 1e9);
    for (uint32_t k = 0; k < entities->followed_count; k++) {
        uint32_t row = entities->followed[k];
        if (entities->sent[row].id == e->row[row].id &&
            !send_row(entities, &view->world, row, now_ns, true))
            return;
    }
}

void entity_output_deactivate(struct entity_output *entities, const struct view *view,
                              uint64_t now_ns)
{
    uint32_t sent = 0;
    for (uint32_t row = 0; row < entities->known; row++) {
        if (entities->sent[row].id == 0)
            continue;
        send_last(entities, &view->world, &entities->sent[row], now_ns);
        if (++sent % LAST_AT_ONCE == 0) /* receivers have small buffers, and no second chance */
            clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
}
