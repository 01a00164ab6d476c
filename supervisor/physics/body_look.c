/* Copies of rows, and what explains their changes. */
#include "supervisor/physics/body_look.h"

#include "world/entity/cruise.h"
#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/remote.h"
#include "world/state.h"
#include "world/cruise_pose.h"
#include "world/world.h"

#include <stdlib.h>

/* An explosion of a kilogram may push bodies within this distance [m]. It grows with the cube root
 * of the charge. */
#define BLAST_REACH_M 20.0

int body_looks_make(struct body_looks *looks, uint32_t capacity)
{
    *looks = (struct body_looks){.body = calloc(capacity, sizeof *looks->body),
                                 .of_row = calloc(capacity, sizeof *looks->of_row),
                                 .memory = calloc(capacity, sizeof *looks->memory)};
    if (looks->body && looks->of_row && looks->memory)
        return 0;
    body_looks_free(looks);
    return -1;
}

void body_looks_free(struct body_looks *looks)
{
    free(looks->body);
    free(looks->of_row);
    free(looks->memory);
    *looks = (struct body_looks){0};
}

struct vec3 motion_look_centre(const struct motion_look *look, const struct kind *kind)
{
    return vec3_scale(look->pose.up, kind->domain == DOMAIN_LAND ? kind->centre_height_m : 0.0);
}

struct vec3 motion_look_centre_velocity(const struct motion_look *look, const struct kind *kind)
{
    return vec3_add(look->velocity, vec3_cross(look->spin, motion_look_centre(look, kind)));
}

struct vec3 motion_look_gyration(const struct kind *kind)
{
    double length = kind->length_m * kind->length_m, height = kind->height_m * kind->height_m;
    double width = kind->width_m * kind->width_m;
    return vec3_scale((struct vec3){height + width, length + width, length + height}, 1.0 / 12.0);
}

double motion_look_turning(const struct motion_look *look, const struct kind *kind)
{
    const struct vec3 gyration = motion_look_gyration(kind);
    const struct vec3 spin = rigid_pose_in(&look->pose, look->spin);
    return sqrt(gyration.x * spin.x * spin.x + gyration.y * spin.y * spin.y +
                gyration.z * spin.z * spin.z);
}

static bool all_finite(const struct motion_look *look)
{
    const struct vec3 *at = &look->pose.at, *v = &look->velocity, *w = &look->spin;
    /* The sum of finite numbers of this size is finite, and NaN and infinity stay in it. */
    double sum = at->x + at->y + at->z + v->x + v->y + v->z + w->x + w->y + w->z;
    return isfinite(sum + look->heading + look->pitch + look->roll + look->turret + look->gun);
}

static bool same_place(const struct motion_look *a, const struct motion_look *b)
{
    return a->pose.at.x == b->pose.at.x && a->pose.at.y == b->pose.at.y &&
           a->pose.at.z == b->pose.at.z;
}

static bool same_angles(const struct motion_look *a, const struct motion_look *b)
{
    return a->heading == b->heading && a->pitch == b->pitch && a->roll == b->roll &&
           a->turret == b->turret && a->gun == b->gun;
}

/* A wreck rests from the tick that until_tick says (docs/decisions/031-wrecks-on-the-ground.md). */
static bool is_at_rest(const struct motion_look *look, uint32_t until_tick, uint64_t tick)
{
    return look->wreck && until_tick != 0 && until_tick <= tick &&
           vec3_dot(look->velocity, look->velocity) == 0.0 &&
           vec3_dot(look->spin, look->spin) == 0.0;
}

static void read_motion(struct motion_look *look, const struct body_looks *looks,
                        const struct world *world, const struct state *state, uint32_t row)
{
    const struct entities *e = &state->entities;
    enum domain domain = (enum domain)world->kinds[e->row[row].kind].domain;
    struct cruise_pose pose = cruise_pose_of(world, looks->craters, e, row, state->head->tick);
    *look = (struct motion_look){
        .pose = {.at = pose.at},
        .heading = pose.heading_rad,
        .turret = (double)e->row[row].turret,
        .gun = (double)e->row[row].gun,
        .pitch = pose.pitch_rad,
        .roll = pose.roll_rad,
        .velocity = cruise_velocity(e, row, state->head->tick, world_dt_s(world)),
        .spin = {e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z},
        .wreck = e->row[row].state == ENTITY_WRECK};
    look->sprung =
        !look->wreck && domain == DOMAIN_LAND && (e->row[row].flags & ENTITY_FLAG_CHASSIS) != 0;
    look->courses = !look->wreck && !look->sprung && domain == DOMAIN_LAND &&
                    e->row[row].behaviour == BEHAVIOUR_HOLD;
    look->at_rest = is_at_rest(look, e->row[row].until_tick, state->head->tick);
}

static void read_body(struct body_looks *looks, const struct world *world,
                      const struct state *state, uint32_t row)
{
    const struct entities *e = &state->entities;
    struct body_look *body = &looks->body[looks->count];
    const struct row_memory *memory = &looks->memory[row];
    *body = (struct body_look){.row = row, .kind = &world->kinds[e->row[row].kind]};
    read_motion(&body->now, looks, world, state, row);
    body->named =
        (struct measured_body){e->row[row].id, false, e->row[row].kind, body->now.pose.at};
    body->finite = all_finite(&body->now);
    body->foreign = remote_is(e, row);
    looks->foreign += body->foreign;
    body->known = memory->id == e->row[row].id && body->finite;
    if (body->known) {
        body->was = &memory->look;
        body->touched = memory->touched;
        body->parted = memory->parted;
        body->thrown = memory->thrown;
        body->spun = memory->spun;
        body->buried_s = memory->buried_s;
    }
    if (body->known && same_angles(&body->now, body->was)) {
        body->now.pose = body->was->pose;
        body->now.pose.at = body->named.at;
        body->still = same_place(&body->now, body->was);
    } else if (body->finite) {
        body->now.pose =
            rigid_pose_of(body->named.at, body->now.heading, body->now.pitch, body->now.roll);
    }
    looks->of_row[row] = looks->count++;
}

void body_looks_begin(struct body_looks *looks, const struct world *world,
                      const struct state *state)
{
    const struct entities *e = &state->entities;
    looks->count = looks->foreign = 0;
    looks->rows = state->head->used;
    for (uint32_t row = 0; row < state->head->used; row++) {
        looks->of_row[row] = NO_LOOK;
        if (e->row[row].state == ENTITY_FREE ||
            world->kinds[e->row[row].kind].domain == DOMAIN_MUNITION)
            looks->memory[row].id = 0;
        else
            read_body(looks, world, state, row);
    }
}

void body_looks_end(struct body_looks *looks)
{
    for (uint32_t i = 0; i < looks->count; i++) {
        const struct body_look *body = &looks->body[i];
        struct row_memory *memory = &looks->memory[body->row];
        memory->id = body->finite ? body->named.id : 0;
        memory->touched = body->touches;
        memory->parted = body->parts;
        memory->thrown = body->thrown;
        memory->spun = body->spun;
        memory->buried_s = body->buried_s;
        memory->look = body->now;
    }
}

uint32_t body_looks_find(const struct body_looks *looks, uint32_t id)
{
    /* The bodies of the scenario have their row's number + 1. */
    uint32_t first = id > 0 && id <= looks->rows ? looks->of_row[id - 1] : NO_LOOK;
    if (first != NO_LOOK && looks->body[first].named.id == id)
        return first;
    for (uint32_t i = 0; i < looks->count && id != 0; i++) {
        if (looks->body[i].named.id == id)
            return i;
    }
    return NO_LOOK;
}

static struct body_look *party(struct body_looks *looks, const struct event_party *party)
{
    uint32_t index = party->fixed ? NO_LOOK : body_looks_find(looks, party->id);
    return index == NO_LOOK ? NULL : &looks->body[index];
}

/* struck: the body that a round has hit, or NULL. */
static void blast(struct body_looks *looks, const struct body_look *struck, struct vec3 point,
                  double explosive_kg)
{
    double reach = BLAST_REACH_M * maths_cbrt(explosive_kg);
    for (uint32_t i = 0; i < looks->count; i++) {
        struct body_look *body = &looks->body[i];
        struct vec3 apart = vec3_sub(body->named.at, point);
        body->blasts += body == struck || vec3_length(apart) <= reach + body->kind->bound_m;
    }
}

void body_looks_hits(struct body_looks *looks, const struct state *state,
                     const struct persistent_contact *before, uint32_t count)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < state->head->contact_count; i++) {
        const struct persistent_contact *now = &state->contacts[i];
        uint64_t key = persistent_contact_key(now);
        while (next < count && persistent_contact_key(&before[next]) < key)
            next++;
        bool known = next < count && persistent_contact_key(&before[next]) == key;
        uint32_t hits = now->impacts - (known ? before[next].impacts : 0u);
        uint32_t presses = now->pressed_tick == (uint32_t)state->head->tick;
        const uint32_t side[2] = {body_looks_find(looks, now->a_id),
                                  body_looks_find(looks, now->b_id)};
        for (int n = 0; n < 2; n++) {
            if (side[n] == NO_LOOK)
                continue;
            looks->body[side[n]].hits += hits;
            looks->body[side[n]].presses += presses;
        }
    }
}

void body_looks_wrecked(struct body_looks *looks)
{
    for (uint32_t i = 0; i < looks->count; i++) {
        const struct body_look *body = &looks->body[i];
        if (body->known && body->now.wreck && !body->was->wreck && body->kind->explosive_kg > 0.0)
            blast(looks, NULL, body->named.at, body->kind->explosive_kg);
    }
}

void body_looks_explain(struct body_looks *looks, const struct event *event)
{
    struct body_look *a = NULL, *b = NULL;
    if (event->type == EVENT_COLLISION) {
        a = party(looks, &event->collision.a);
        b = party(looks, &event->collision.b);
        if (a)
            a->struck++;
        if (b)
            b->struck++;
    } else if (event->type == EVENT_DETONATION) {
        const double *point = event->detonation.point;
        a = party(looks, &event->detonation.struck_party);
        blast(looks, a, (struct vec3){point[0], point[1], point[2]},
              (double)event->detonation.explosive_kg);
    } else if (event->type == EVENT_COMMAND) {
        uint32_t index = body_looks_find(looks, event->command.entity);
        if (index != NO_LOOK)
            looks->body[index].commanded = true;
    }
}
