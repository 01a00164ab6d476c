/* Chooses, takes, drives, fires with and releases vehicles. */
#include "clients/drive/session.h"

#include "clients/drive/vehicle_choice.h"
#include "ipc/process/clock.h"
#include "world/entity/command.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"
#include "world/runtime/utf8.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A smaller change of a control is not sent. */
#define CONTROL_STEP 0.004

/* Where targets are searched: angle to either side of the direction of view, and multiple of the
 * weapon's range. */
#define LOCK_CONE_RAD  1.05
#define LOCK_RANGE     1.5
#define LOCK_RANGE_MIN 1000.0 /* [m] */
#define LOOK_STEP_RAD  (PI / 12.0)

/* A gun that does not bear on its target is laid on it; for LAY_NS the shot is tried again. */
#define LAY_NS       (8 * (uint64_t)NS_PER_S)
#define LAY_RETRY_NS (100 * (uint64_t)NS_PER_MS)

/* The first data may be a second old (ipc/topics/dds_topics.c): a vehicle that is newer comes
 * later. */
#define MISSED_LIMIT_NS (1500 * (uint64_t)NS_PER_MS)

#define IDLE_NS      (20 * (uint64_t)NS_PER_MS)
#define FRAME_MIN_NS (2 * (uint64_t)NS_PER_MS)
#define RATE_MIN_HZ  1.0

void session_notify(struct session *session, uint64_t now_ns, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)utf8_format(session->notice, sizeof session->notice, format, arguments);
    va_end(arguments);
    session->notice_ns = now_ns;
    session->notices++;
}

void session_open(struct session *session, struct world_mirror *mirror,
                  struct command_client *client, const char *wanted, uint64_t now_ns)
{
    *session = (struct session){.mirror = mirror, .client = client, .wanted = wanted, .zoom = 2};
    control_shaping_reset(&session->shaping, now_ns);
}

const jolon_Entity *session_entity(const struct session *session)
{
    return world_mirror_entity(session->mirror, session->vehicle);
}

const char *session_label(const struct world_mirror *mirror, uint32_t id, char text[64])
{
    const jolon_Entity *entity = world_mirror_entity(mirror, id);
    const char *name = name_table_of(&mirror->names, id);
    const char *kind = entity ? world_mirror_kind_name(mirror, entity->kind) : "vehicle";
    if (id == 0)
        (void)snprintf(text, 64, "nothing");
    else if (name[0])
        (void)snprintf(text, 64, "%s (%s %u)", name, kind, id);
    else
        (void)snprintf(text, 64, "%s %u", kind, id);
    return text;
}

static double rate_hz(const struct world_mirror *mirror)
{
    double wanted = mirror->has_world ? mirror->world.hz : 0.0;
    if (mirror->frame_ns && mirror->frame.time_scale > 0.0)
        wanted *= mirror->frame.time_scale;
    if (mirror->has_world && !mirror->world.real_time && mirror->frame_ns)
        wanted = maths_max(wanted, mirror->frame.rate_hz);
    return maths_max(wanted, RATE_MIN_HZ);
}

/* The length of a frame [ns] at the world's rate and time scale. */
static uint64_t frame_length_ns(const struct world_mirror *mirror)
{
    uint64_t frame_ns = (uint64_t)(NS_PER_S / rate_hz(mirror));
    return frame_ns < FRAME_MIN_NS ? FRAME_MIN_NS : frame_ns;
}

/* The length of a lease in frames, as commands have it. */
static uint32_t lease_frames(const struct world_mirror *mirror)
{
    return (uint32_t)maths_clamp(rate_hz(mirror) * SESSION_LEASE_S, 1.0, COMMAND_LEASE_MAX);
}

static bool is_aircraft(const struct session *session)
{
    const jolon_Entity *entity = session_entity(session);
    const jolon_KindInfo *kind = entity ? world_mirror_kind(session->mirror, entity->kind) : NULL;
    return kind && kind->domain == jolon_DOMAIN_AIR;
}

static bool differs(const struct controls *a, const struct controls *b)
{
    const float x[] = {a->throttle, a->steer, a->climb, a->traverse, a->elevate, a->brake};
    const float y[] = {b->throttle, b->steer, b->climb, b->traverse, b->elevate, b->brake};
    for (size_t i = 0; i < sizeof x / sizeof x[0]; i++) {
        double change = fabs((double)x[i] - (double)y[i]);
        bool ends = fabs((double)x[i]) < 1e-9 || fabs((double)x[i]) >= 1.0;
        if (change > CONTROL_STEP || (ends && change > 0.0))
            return true;
    }
    return a->gear != b->gear;
}

static void send_drive(struct session *session, const struct controls *controls, uint64_t now_ns)
{
    jolon_Command command = {
        .type = jolon_COMMAND_DRIVE,
        .entity = session->vehicle,
        .throttle = controls->throttle,
        .steer = controls->steer,
        .climb = controls->climb,
        .traverse = controls->traverse,
        .elevate = controls->elevate,
        .brake = controls->brake,
        .gear = (jolon_Gear)controls->gear,
        .lease_frames = lease_frames(session->mirror),
    };
    session->drive = command_client_send(session->client, &command);
    session->sent = *controls;
    session->sent_ns = now_ns;
}

/* Drops a DRIVE that is still repeated, because it would take the vehicle again. */
static void send_release(struct session *session)
{
    jolon_Command command = {.type = jolon_COMMAND_RELEASE, .entity = session->vehicle};
    command_client_forget(session->client, session->drive);
    session->drive = 0;
    command_client_forget(session->client, session->release);
    session->release = command_client_send(session->client, &command);
}

static bool has_lease(const struct session *session)
{
    return session->state == SESSION_TAKING || session->state == SESSION_DRIVING;
}

/* The lever of an aircraft begins where it keeps its speed: a jet without throttle would fall. */
static double lever_of(const struct session *session)
{
    const jolon_Entity *self = session_entity(session);
    const jolon_KindInfo *kind = self ? world_mirror_kind(session->mirror, self->kind) : NULL;
    if (!kind || !is_aircraft(session))
        return 0.0;
    double speed = hypot((double)self->vx_mps, (double)self->vz_mps);
    return maths_clamp(speed / maths_max((double)kind->max_speed_mps, 1.0), 0.0, 1.0);
}

static void take_vehicle(struct session *session, uint32_t id, uint64_t now_ns)
{
    char label[64];
    if (id == 0) {
        session_notify(session, now_ns, "there is no such vehicle that is free");
        return;
    }
    if (has_lease(session) && session->vehicle != id)
        send_release(session);
    session->vehicle = id;
    session->seen = session->loss_told = false;
    session->target = session->last_target = 0;
    session->lay_until_ns = 0;
    session->look_rad = 0.0;
    session->state = SESSION_TAKING;
    control_shaping_reset(&session->shaping, now_ns);
    session->shaping.lever = lever_of(session);
    struct controls controls = control_shaping_controls(&session->shaping, false);
    send_drive(session, &controls, now_ns);
    session_notify(session, now_ns, "taking %s", session_label(session->mirror, id, label));
}

static struct vehicle_choice any_vehicle(const struct session *session)
{
    return (struct vehicle_choice){
        .source = session->client->source, .from = session->vehicle, .force = -1, .kind = -1};
}

static void take_nearest(struct session *session, int force, int kind, uint64_t now_ns)
{
    struct vehicle_choice choice = any_vehicle(session);
    choice.force = force;
    choice.kind = kind;
    take_vehicle(session, vehicle_choice_nearest(session->mirror, &choice), now_ns);
}

static void release(struct session *session, uint64_t now_ns)
{
    char label[64];
    if (!has_lease(session))
        return;
    send_release(session);
    session->state = SESSION_WATCHING;
    session_notify(session, now_ns, "%s goes back to its agent; enter takes it again",
                   session_label(session->mirror, session->vehicle, label));
}

static void lock(struct session *session, uint64_t now_ns)
{
    char label[64];
    const jolon_Entity *self = session_entity(session);
    const jolon_KindInfo *kind = self ? world_mirror_kind(session->mirror, self->kind) : NULL;
    if (!kind)
        return;
    double range_m = maths_max((double)kind->range_m * LOCK_RANGE, LOCK_RANGE_MIN);
    double bearing = (double)self->heading_rad + session->look_rad;
    uint32_t found = vehicle_choice_target(session->mirror, self, session->target, bearing,
                                           LOCK_CONE_RAD, range_m);
    if (found)
        session_notify(session, now_ns, "target: %s", session_label(session->mirror, found, label));
    else
        session_notify(session, now_ns, "no enemy within %.0f m and 60 degrees of where you look",
                       range_m);
    session->target = found;
    session->last_target = found ? found : session->last_target;
}

static void send_fire(struct session *session)
{
    jolon_Command command = {
        .type = jolon_COMMAND_FIRE, .entity = session->vehicle, .target = session->target};
    session->fire = command_client_send(session->client, &command);
}

/* Says that its vehicle is lost, and what to do. self: NULL: it was removed. */
static void tell_loss(struct session *session, const jolon_Entity *self, uint64_t now_ns)
{
    char label[64];
    session_notify(
        session, now_ns, "your %s is %s; n takes the next vehicle, o the nearest of its force",
        session_label(session->mirror, session->vehicle, label), self ? "destroyed" : "gone");
}

static void fire(struct session *session, uint64_t now_ns)
{
    session->lay_until_ns = 0;
    if (!has_lease(session) && session->loss_told)
        tell_loss(session, session_entity(session), now_ns);
    else if (!has_lease(session))
        session_notify(session, now_ns, "you drive nothing that could fire; enter takes it");
    else if (session->fire == 0) /* one shot at a time: the gun reloads anyway */
        send_fire(session);
}

static void look(struct session *session, int by)
{
    session->look_rad = by == 0 ? 0.0 : maths_wrap_half(session->look_rad + by * LOOK_STEP_RAD);
}

static void change_vehicle(struct session *session, enum input_action action, uint64_t now_ns)
{
    const jolon_Entity *self = session_entity(session);
    struct vehicle_choice choice = any_vehicle(session);
    switch (action) {
    case ACTION_NEXT:
    case ACTION_PREVIOUS:
        take_vehicle(session,
                     vehicle_choice_next(session->mirror, &choice, action == ACTION_NEXT ? 1 : -1),
                     now_ns);
        break;
    case ACTION_NEAREST_KIND:
        take_nearest(session, -1, self ? (int)self->kind : -1, now_ns);
        break;
    case ACTION_NEAREST_FORCE:
        take_nearest(session, self ? (int)self->force : -1, -1, now_ns);
        break;
    case ACTION_NEAREST_BLUE:
        take_nearest(session, FORCE_BLUE, -1, now_ns);
        break;
    case ACTION_NEAREST_RED:
        take_nearest(session, FORCE_RED, -1, now_ns);
        break;
    case ACTION_NEAREST_NEUTRAL:
        take_nearest(session, FORCE_NEUTRAL, -1, now_ns);
        break;
    default:
        if (session->vehicle && !has_lease(session))
            take_vehicle(session, session->vehicle, now_ns);
        break;
    }
}

static void act(struct session *session, enum input_action action, uint64_t now_ns)
{
    switch (action) {
    case ACTION_FIRE:
        fire(session, now_ns);
        break;
    case ACTION_LOCK:
        lock(session, now_ns);
        break;
    case ACTION_UNLOCK:
        session->target = 0;
        session->lay_until_ns = 0;
        break;
    case ACTION_STOP:
        control_shaping_stop(&session->shaping);
        break;
    case ACTION_GEAR_UP:
    case ACTION_GEAR_DOWN:
        control_shaping_gear(&session->shaping, action == ACTION_GEAR_UP ? 1 : -1);
        break;
    case ACTION_RELEASE:
        release(session, now_ns);
        break;
    case ACTION_LOOK_LEFT:
    case ACTION_LOOK_RIGHT:
    case ACTION_LOOK_AHEAD:
        look(session, action == ACTION_LOOK_AHEAD ? 0 : action == ACTION_LOOK_LEFT ? -1 : 1);
        break;
    case ACTION_ZOOM_IN:
        session->zoom -= session->zoom > 0;
        break;
    case ACTION_ZOOM_OUT:
        session->zoom += session->zoom + 1 < SESSION_ZOOMS;
        break;
    case ACTION_HELP:
        session->help = !session->help;
        break;
    case ACTION_QUIT:
        session->ended = true;
        break;
    default:
        if (session->state != SESSION_WAITING)
            change_vehicle(session, action, now_ns);
        break;
    }
}

void session_apply(struct session *session, const struct intent *intent, uint64_t now_ns)
{
    if (intent->type == INTENT_ACT)
        act(session, intent->action, now_ns);
    else
        control_shaping_apply(&session->shaping, intent, now_ns);
}

static void read_drive_reply(struct session *session, uint64_t now_ns)
{
    char label[64];
    jolon_CommandReply reply;
    if (!session->drive || !command_client_answered(session->client, session->drive, &reply))
        return;
    session->drive = 0;
    (void)session_label(session->mirror, session->vehicle, label);
    if (reply.result == jolon_RESULT_DONE) {
        if (session->state == SESSION_TAKING)
            session_notify(session, now_ns,
                           "you drive %s; hold w to go, h shows the keys (frame %llu)", label,
                           (unsigned long long)reply.frame);
        session->state = SESSION_DRIVING;
        return;
    }
    session->state = SESSION_WATCHING;
    if (reply.result == jolon_RESULT_TAKEN)
        session_notify(
            session, now_ns,
            "%s: another client drives it; n takes the next, o the nearest of its force, "
            "enter tries again",
            label);
    else if (reply.result == jolon_RESULT_CANNOT || reply.result == jolon_RESULT_NO_SUCH_ENTITY)
        session_notify(session, now_ns, "%s is destroyed or gone; n takes the next vehicle", label);
    else
        session_notify(session, now_ns, "%s: %s; n takes the next vehicle", label,
                       command_result_name((enum command_result)reply.result));
}

/* Called when a vehicle that can fire did not: its gun does not bear on the target. The refused
 * command has made the mover begin to lay the gun. */
static void lay(struct session *session, uint64_t now_ns)
{
    char label[64];
    (void)session_label(session->mirror, session->target, label);
    if (session->lay_until_ns == 0) {
        session->lay_until_ns = now_ns + LAY_NS;
        session_notify(session, now_ns, "the gun is being laid on %s: it fires when it bears",
                       label);
    } else if (now_ns >= session->lay_until_ns) {
        session->lay_until_ns = 0;
        session_notify(session, now_ns,
                       "the gun does not bear on %s; turn towards it, or come nearer", label);
        return;
    }
    session->lay_next_ns = now_ns + LAY_RETRY_NS;
}

static void misfire(struct session *session, const jolon_CommandReply *reply, uint64_t now_ns)
{
    const jolon_Entity *self = session_entity(session);
    const jolon_KindInfo *kind = self ? world_mirror_kind(session->mirror, self->kind) : NULL;
    bool able = kind && kind->rounds > 0 && self->rounds > 0 && !(self->reload_s > 0.0f);
    if (reply->result == jolon_RESULT_CANNOT && able && session->target) {
        lay(session, now_ns);
        return;
    }
    session->lay_until_ns = 0;
    if (reply->result == jolon_RESULT_NO_SUCH_ENTITY) {
        session->target = 0;
        session_notify(session, now_ns, "the target is gone; t locks another");
    } else if (reply->result != jolon_RESULT_CANNOT || !kind) {
        session_notify(session, now_ns, "did not fire: %s",
                       command_result_name((enum command_result)reply->result));
    } else if (kind->rounds == 0) {
        session_notify(session, now_ns, "a %s has nothing to fire", kind->name);
    } else if (self->rounds == 0) {
        session_notify(session, now_ns, "out of rounds");
    } else {
        session_notify(session, now_ns, "still reloading: %.1f s", (double)self->reload_s);
    }
}

static void read_fire_reply(struct session *session, uint64_t now_ns)
{
    char label[64];
    jolon_CommandReply reply;
    if (!session->fire || !command_client_answered(session->client, session->fire, &reply))
        return;
    session->fire = 0;
    if (reply.result != jolon_RESULT_DONE) {
        misfire(session, &reply, now_ns);
        return;
    }
    session->lay_until_ns = 0;
    if (session->target)
        session_notify(session, now_ns, "fired at %s in frame %llu",
                       session_label(session->mirror, session->target, label),
                       (unsigned long long)reply.frame);
    else
        session_notify(session, now_ns, "fired in frame %llu", (unsigned long long)reply.frame);
}

/* Notices that the vehicle or the target was destroyed or removed. */
static void check_losses(struct session *session, uint64_t now_ns)
{
    char label[64];
    const struct world_mirror *mirror = session->mirror;
    const jolon_Entity *self = session_entity(session);
    const jolon_Entity *target = world_mirror_entity(mirror, session->target);
    if (session->target && (!target || target->state != jolon_ENTITY_ACTIVE)) {
        session_notify(session, now_ns, "the target, %s, is destroyed or gone; t locks another",
                       session_label(mirror, session->target, label));
        session->target = 0;
    }
    if (self)
        session->seen = true;
    if (session->loss_told || !session->seen || (self && self->state == jolon_ENTITY_ACTIVE))
        return;
    session->loss_told = true;
    session->state = SESSION_WATCHING;
    command_client_forget(session->client, session->drive);
    session->drive = 0;
    tell_loss(session, self, now_ns);
}

/* Waits for the wanted vehicle, which is not in the world's data, or ends with the reason. */
static void miss_wanted(struct session *session, const char *reason, uint64_t now_ns)
{
    if (!session->missed_ns)
        session->missed_ns = now_ns;
    if (now_ns - session->missed_ns < MISSED_LIMIT_NS) {
        session->state = SESSION_WAITING;
        return;
    }
    session_notify(session, now_ns, "%s", reason);
    session->refused = session->ended = true;
}

/* Takes the first vehicle of this world: the wanted one, or any. */
static void take_first(struct session *session, uint64_t now_ns)
{
    struct error_text error;
    const struct world_mirror *mirror = session->mirror;
    struct vehicle_choice choice = any_vehicle(session);
    if (!mirror->has_world || !mirror->has_batch || !mirror->frame_ns || !mirror->names.known ||
        mirror->batch.run != mirror->world.run || !command_client_reachable(session->client))
        return;
    session->run = mirror->world.run;
    session->state = SESSION_WATCHING;
    choice.from = 0;
    uint32_t id = session->wanted ? vehicle_choice_by_text(mirror, &choice, session->wanted, &error)
                                  : vehicle_choice_next(mirror, &choice, 1);
    if (id)
        take_vehicle(session, id, now_ns);
    else if (session->wanted)
        miss_wanted(session, error.text, now_ns);
    else
        session_notify(session, now_ns, "no vehicle is free in world \"%s\"; n tries again",
                       mirror->name);
}

uint64_t session_turn(struct session *session, uint64_t now_ns)
{
    const struct world_mirror *mirror = session->mirror;
    uint64_t frame_ns = frame_length_ns(mirror);
    bool moves = control_shaping_step(&session->shaping, now_ns);
    struct controls controls = control_shaping_controls(&session->shaping, is_aircraft(session));
    if (has_lease(session)) {
        uint64_t since_ns = now_ns - session->sent_ns;
        bool paused = mirror->frame_ns && mirror->frame.paused; /* leases do not expire then */
        if ((since_ns >= SESSION_RENEW_NS && !paused) ||
            (since_ns >= frame_ns && differs(&controls, &session->sent)))
            send_drive(session, &controls, now_ns);
    }
    command_client_poll(session->client);
    read_drive_reply(session, now_ns);
    read_fire_reply(session, now_ns);
    if (session->lay_until_ns &&
        (!has_lease(session) || !session->target || control_shaping_aims(&session->shaping)))
        session->lay_until_ns = 0; /* aiming by hand ends the laying */
    if (session->lay_until_ns && session->fire == 0 && now_ns >= session->lay_next_ns)
        send_fire(session);
    if (mirror->has_world && session->run && mirror->world.run != session->run) {
        session->state = SESSION_WAITING;
        session->vehicle = session->target = 0;
        session->run = session->missed_ns = 0;
        session_notify(session, now_ns, "another world has begun under this name");
    }
    if (session->state == SESSION_WAITING)
        take_first(session, now_ns);
    else if (mirror->has_batch && session->vehicle)
        check_losses(session, now_ns);
    uint64_t due_ns = now_ns + (moves && frame_ns < IDLE_NS ? frame_ns : IDLE_NS);
    uint64_t next_ns = session->sent_ns + frame_ns; /* when a changed control may be sent */
    if (has_lease(session) && differs(&controls, &session->sent) && next_ns < due_ns)
        due_ns = next_ns;
    return due_ns;
}

void session_leave(struct session *session, uint64_t until_ns)
{
    jolon_CommandReply reply;
    if (has_lease(session))
        send_release(session);
    while (session->release &&
           !command_client_answered(session->client, session->release, &reply)) {
        uint64_t now_ns = clock_now_ns();
        if (now_ns >= until_ns)
            return;
        command_client_wait(session->client,
                            until_ns - now_ns < IDLE_NS ? until_ns : now_ns + IDLE_NS);
        command_client_poll(session->client);
    }
}
