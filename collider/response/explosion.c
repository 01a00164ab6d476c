/* Detonations: their damage to bodies nearby and the push that they give them, craters in the
 * ground, and the chain of further explosions. */
#include "collider/response/explosion.h"

#include "collider/narrow_phase/cruise_rows.h"
#include "collider/response/body_push.h"
#include "collider/response/damage.h"
#include "collider/response/explosion_impulse.h"
#include "collider/response/path_change.h"
#include "collider/response/response.h"
#include "world/entity/armour.h"
#include "world/entity/kind.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/state.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

#include <errno.h>

#define TNT_J_PER_KG 4.184e6
#define EXPLOSION_RADIUS_M                                                                         \
    8.0 /* radius of one kilogram; grows with the cube root (Hopkinson scaling) */
#define EXPLOSION_COUPLING 0.02 /* share of a close charge's energy that a body absorbs */
#define SUPPRESSION_REACH  3.0  /* times that radius: crews so near a burst take cover */
#define CRATER_RADIUS_M    1.1  /* crater of one kilogram on soil; grows with the cube root */
#define CRATER_DEPTH       0.4  /* over the radius */

/* A charge with a delay fuze explodes inside a fixed object, where more of its energy does harm, or
 * below the ground: it throws out more soil, and less of its blast remains. */
#define INSIDE        2.0
#define BURIED_CRATER 3.0 /* the charge on the ground that makes as large a crater */
#define BURIED_BLAST  0.3 /* and the one whose blast is as strong, over that of this charge */

/* Tyres and tracks stop a slower push on the ground within a millimetre [m/s]. */
#define PUSH_LEAST_MPS 0.05

int charges_init(struct charges *charges, const struct world *world)
{
    /* Each row explodes at most once in a frame: as a round, or destroyed by an explosion. */
    *charges = (struct charges){.capacity = world->params->capacity};
    charges->charge = reserve_take(charges->capacity, sizeof *charges->charge);
    charges->pushed = reserve_take(charges->capacity, sizeof *charges->pushed);
    charges->is_pushed = reserve_take(charges->capacity / 64 + 1, sizeof *charges->is_pushed);
    if (charges->charge && charges->pushed && charges->is_pushed &&
        pair_list_init(&charges->near, broad_phase_found_most(world)) == 0)
        return 0;
    charges_free(charges);
    errno = ENOMEM;
    return -1;
}

void charges_free(struct charges *charges)
{
    reserve_free(charges->charge);
    reserve_free(charges->pushed);
    reserve_free(charges->is_pushed);
    pair_list_free(&charges->near);
    *charges = (struct charges){0};
}

void explosion_charge(struct response_context *context, const struct charge *charge)
{
    struct charges *charges = context->charges;
    CHECK(charges->count < charges->capacity);
    charges->charge[charges->count++] = *charge;
}

/* Energy that a body absorbs whose surface is at this distance: all of it at 0, nothing at the
 * radius. */
static double explosion_energy(double explosive_kg, double radius_m, double distance_m)
{
    double left = 1.0 - distance_m / radius_m;
    if (left <= 0.0)
        return 0.0;
    double share = distance_m <= 0.0 ? 1.0 : EXPLOSION_COUPLING * left * left;
    return TNT_J_PER_KG * explosive_kg * share;
}

static double distance_to(struct vec3 from, struct vec3 centre, double radius_m)
{
    return maths_max(0.0, vec3_length(vec3_sub(centre, from)) - radius_m);
}

/* Returns true if the impulse throws the land vehicle over. impulse_ns: at its centre of mass. */
static bool overturns(const struct response_context *context, uint32_t row, const struct mat3 *turn,
                      struct vec3 impulse_ns)
{
    const struct entities *e = &context->next->entities;
    struct vec3 own = rotation_back(turn, (struct vec3){impulse_ns.x, 0.0, impulse_ns.z});
    return e->row[row].state == ENTITY_ACTIVE &&
           explosion_impulse_overturns(&context->world->kinds[e->row[row].kind], own.x, own.z);
}

static void note_pushed(struct charges *charges, uint32_t row)
{
    uint64_t *word = &charges->is_pushed[row / 64], bit = (uint64_t)1 << row % 64;
    if (*word & bit)
        return;
    *word |= bit;
    charges->pushed[charges->pushed_count++] = row;
}

/* Finds the contacts of the new paths of the rows that explosions of this time have pushed. */
static void sweep_pushed(struct response_context *context, double time)
{
    struct charges *charges = context->charges;
    if (charges->pushed_count > 0)
        path_change_swept(context, charges->pushed, charges->pushed_count, time);
    for (uint32_t n = 0; n < charges->pushed_count; n++)
        charges->is_pushed[charges->pushed[n] / 64] = 0;
    charges->pushed_count = 0;
}

/* Pushes the row at this time, under the responses that know momentum. */
static void push(struct response_context *context, const struct charge *charge, uint32_t row,
                 double time)
{
    struct charges *charges = context->charges;
    const struct kind *kind = &context->world->kinds[context->next->entities.row[row].kind];
    struct explosion_impulse_target target = {.kind = kind};
    if (!context->functions->joint || row == charge->row)
        return;
    target.centre = body_push_centre(context, row, time, &target.turn);
    const struct explosion_impulse on_body =
        explosion_impulse_on(&target, charge->point, charge->explosive_kg);
    double speed = vec3_length(on_body.impulse_ns) / kind->mass_kg;
    if (!(speed > (path_change_grounded(context, row) ? PUSH_LEAST_MPS : 0.0)))
        return;
    if (overturns(context, row, &target.turn, on_body.impulse_ns))
        damage_overturn(context, row);
    body_push(context, row, time, on_body.point, on_body.impulse_ns);
    note_pushed(charges, row);
}

/* Damages the row, if it is no wreck. */
static void hurt(struct response_context *context, const struct charge *charge, double radius,
                 uint32_t row, double distance)
{
    const struct entities *e = &context->next->entities;
    if (e->row[row].state != ENTITY_ACTIVE)
        return;
    /* The effect of a direct hit has been applied already; here that body is treated like any
     * other. */
    double joules = explosion_energy(charge->explosive_kg, radius, maths_max(distance, 1e-3));
    /* A stray round of one's own side is no attack. */
    uint32_t owner = charge->owner_slot;
    bool known = entities_alive(e, owner, charge->owner_id);
    bool friend =
        known && e->row[owner].force != FORCE_NEUTRAL && e->row[owner].force == e->row[row].force;
    if (joules > 0.0 && known && owner != row && !friend)
        table_set_threat(&context->writer, row, owner, charge->owner_id);
    damage_row(context, row, joules, charge->time);
}

static void explosion_row(struct response_context *context, const struct charge *charge,
                          double radius, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    const struct path *path = &context->path[row];
    if (e->row[row].state == ENTITY_FREE || e->row[row].behaviour == BEHAVIOUR_FLIGHT)
        return;
    body_motion_require(context->motion, row);
    double time = maths_max(charge->time, path->since);
    double distance = distance_to(charge->point, path_at(path, time),
                                  context->world->kinds[e->row[row].kind].radius_m);
    hurt(context, charge, radius, row, distance);
    if (distance < radius)
        push(context, charge, row, time);
}

static void explosion_fixed(struct response_context *context, const struct charge *charge,
                            double radius, uint32_t index)
{
    const struct fixed_object *object = &context->world->fixed[index];
    struct vec3 at = fixed_position(object);
    double distance = distance_to(charge->point, at, (double)object->radius_m);
    damage_fell_object(context, index, explosion_energy(charge->explosive_kg, radius, distance),
                       vec3_sub(at, charge->point));
}

static bool listed(const struct pair_list *list, uint32_t row)
{
    for (uint32_t i = 0; i < list->count; i++) {
        if (list->pair[i].a == row)
            return true;
    }
    return false;
}

/* Finds the rows that may be within the radius: from the broad phase, and those that have left
 * their boxes. */
static void find_rows(const struct response_context *context, const struct path_box *box)
{
    const struct contact_queue *contacts = context->contacts;
    struct pair_list *near = &context->charges->near;
    cruise_rows_query(&context->input, box, near);
    for (uint32_t i = 0; i < contacts->stray_count; i++) {
        uint32_t row = contacts->strayed[i];
        if (pair_filter_boxes_meet(box, &context->broad->box[row]) && !listed(near, row))
            pair_list_add(near, row, 0);
    }
}

/* Marks the active vehicles within reach_m: their crews take cover (mover/agent). */
static void alarm(struct response_context *context, const struct charge *charge, double reach_m)
{
    const struct entities *e = &context->next->entities;
    const struct path still = {.at = charge->point};
    struct path_box box = pair_filter_path_box(&still, reach_m);
    struct pair_list *near = &context->charges->near;
    near->count = 0;
    cruise_rows_query(&context->input, &box, near);
    for (uint32_t n = 0; n < near->count; n++) {
        uint32_t row = near->pair[n].a;
        struct vec3 off = vec3_sub(entities_position(e, row), charge->point);
        if (e->row[row].state == ENTITY_ACTIVE && e->row[row].behaviour != BEHAVIOUR_FLIGHT &&
            e->row[row].behaviour != BEHAVIOUR_HOLD && e->row[row].id != charge->owner_id &&
            !(e->row[row].flags & ENTITY_FLAG_BURST) && vec3_dot(off, off) < reach_m * reach_m)
            table_set_flags(&context->writer, row, e->row[row].flags | ENTITY_FLAG_BURST);
    }
    near->count = 0;
}

static void explosion_one(struct response_context *context, const struct charge *charge)
{
    double radius = EXPLOSION_RADIUS_M * maths_cbrt(charge->explosive_kg);
    const struct path still = {.at = charge->point};
    struct path_box box = pair_filter_path_box(&still, radius + pair_filter_slack(context->world));
    struct pair_list *near = &context->charges->near;
    near->count = 0;
    find_rows(context, &box);
    for (uint32_t i = 0; i < near->count; i++)
        explosion_row(context, charge, radius, near->pair[i].a);
    alarm(context, charge, SUPPRESSION_REACH * radius);
    near->count = 0;
    broad_phase_query_fixed(context->broad, &context->input.detect, &box, near);
    for (uint32_t i = 0; i < near->count; i++)
        explosion_fixed(context, charge, radius, near->pair[i].b & ~PAIR_FIXED);
}

void explosion_all(struct response_context *context)
{
    struct charges *charges = context->charges;
    /* Explosions may add charges. Each body explodes once, so this ends. What a chain of them at
     * one time pushes is swept once, from there. */
    for (uint32_t i = 0; i < charges->count; i++) {
        struct charge charge = charges->charge[i];
        explosion_one(context, &charge);
        if (i + 1 == charges->count || charges->charge[i + 1].time != charge.time)
            sweep_pushed(context, charge.time);
        work_done();
    }
    charges->count = 0;
}

/* Wakes the wrecks over a new crater: the ground that bears them may be gone. */
static void undermine(struct response_context *context, const struct crater *crater)
{
    const struct entities *e = &context->next->entities;
    const struct path centre = {.at = {crater->x, 0.0, crater->z}};
    double reach = (double)crater->radius_m * CRATER_RIM + pair_filter_slack(context->world);
    struct path_box box = pair_filter_path_box(&centre, reach);
    struct pair_list *near = &context->charges->near;
    box.min_y = -INFINITY;
    box.max_y = INFINITY;
    near->count = 0;
    find_rows(context, &box);
    for (uint32_t i = 0; i < near->count; i++) {
        if (e->row[near->pair[i].a].state == ENTITY_WRECK)
            table_set_until_tick(&context->writer, near->pair[i].a, 0);
    }
}

static void dig(struct response_context *context, struct vec3 point, double explosive_kg)
{
    struct state_head *head = context->next->head;
    double radius = CRATER_RADIUS_M * maths_cbrt(explosive_kg);
    if (head->crater_count >= context->world->params->crater_slots) {
        head->tally.craters_refused++;
        return;
    }
    struct crater *crater = &context->next->craters[head->crater_count++];
    *crater = (struct crater){point.x, point.z, (float)radius, (float)(radius * CRATER_DEPTH),
                              head->frame};
    undermine(context, crater);
    struct event *event = event_writer_event(&context->events, EVENT_CRATER);
    if (event) {
        event->crater.point[0] = point.x;
        event->crater.point[1] = point.y;
        event->crater.point[2] = point.z;
        event->crater.radius_m = crater->radius_m;
        event->crater.depth_m = crater->depth_m;
    }
}

static enum struck struck_of(const struct response_context *context, uint32_t struck,
                             struct vec3 point)
{
    if (struck == CONTACT_AIR)
        return STRUCK_AIR;
    if (struck == CONTACT_GROUND)
        return cover_is_water(terrain_cover(&context->world->terrain, point.x, point.z))
                   ? STRUCK_WATER
                   : STRUCK_GROUND;
    return struck & PAIR_FIXED ? STRUCK_FIXED : STRUCK_VEHICLE;
}

/* The energy of a round and its charge at this velocity. */
static double energy_of(const struct kind *kind, struct vec3 velocity)
{
    return TNT_J_PER_KG * kind->explosive_kg + 0.5 * kind->mass_kg * vec3_dot(velocity, velocity);
}

static double luck_of(const struct response_context *context, uint32_t round,
                      enum random_purpose purpose)
{
    return random_unit(context->world->params->seed, context->next->head->tick,
                       context->next->entities.row[round].id, purpose);
}

/* The way that a round has flown, by its time and the mean of its speeds at the muzzle and now. */
static double flown_of(const struct response_context *context, uint32_t round, double speed_mps,
                       double time)
{
    const struct entities *e = &context->next->entities;
    uint32_t since = (uint32_t)context->next->head->tick - e->row[round].born_tick;
    double frames = (double)since - 1.0 + time;
    double first = context->world->kinds[e->row[round].kind].max_speed_mps;
    return maths_max(frames, 0.0) * context->world->params->dt_s * 0.5 * (first + speed_mps);
}

/* A round gets through. Returns the harm [J]. An undamaged vehicle may lose its gun alone, and then
 * still drives (world/entity/disabled.h). */
static double penetrate(struct response_context *context, uint32_t round, uint32_t struck,
                        double joules)
{
    const struct entities *e = &context->next->entities;
    const struct kind *vehicle = &context->world->kinds[e->row[struck].kind];
    double luck = luck_of(context, round, RANDOM_PENETRATED);
    if (armour_loss_of(luck) == ARMOUR_LOSS_FIRE && armour_disables(vehicle, joules) &&
        e->row[struck].state == ENTITY_ACTIVE && e->row[struck].damage < DAMAGE_MED)
        table_set_flags(&context->writer, struck, e->row[struck].flags | ENTITY_FLAG_DISARMED);
    return armour_harm(vehicle, joules, luck);
}

/* A hit on a vehicle by a round that may penetrate its armour. Returns true if the round glances
 * off. normal: from the round to the vehicle. */
static bool hit_armour(struct response_context *context, uint32_t round, uint32_t struck,
                       struct vec3 velocity, struct vec3 normal, double time)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[round].kind];
    const struct kind *vehicle = &context->world->kinds[e->row[struck].kind];
    struct mat3 turn = rotation_matrix(body_motion_orientation(context->motion, struck, time));
    double speed = vec3_length(velocity), joules = energy_of(kind, velocity);
    struct vec3 flight = vec3_scale(velocity, 1.0 / maths_max(speed, 1e-9));
    double penetration = armour_penetration(kind, flown_of(context, round, speed, time));
    struct armour_hit hit = armour_hit_of(vehicle, penetration, rotation_back(&turn, flight),
                                          rotation_back(&turn, vec3_scale(normal, -1.0)));
    switch (armour_effect_of(vehicle, kind, &hit, luck_of(context, round, RANDOM_PENETRATION))) {
    case ARMOUR_DEFLECTS:
        return true;
    case ARMOUR_HOLDS:
        damage_row(context, struck, ARMOUR_OUTSIDE * joules, time);
        return false;
    case ARMOUR_PENETRATED:
        joules = penetrate(context, round, struck, joules);
        break;
    default:
        break;
    }
    damage_row(context, struck, joules, time);
    return false;
}

/* A direct hit. Returns true if the round glances off. */
static bool hit(struct response_context *context, uint32_t round, uint32_t struck, enum struck what,
                struct vec3 normal, double time)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[round].kind];
    struct vec3 velocity = entities_velocity(e, round);
    if (what == STRUCK_VEHICLE)
        return hit_armour(context, round, struck, vec3_sub(velocity, entities_velocity(e, struck)),
                          normal, time);
    double inside = e->row[round].flags == FUZE_DELAY ? INSIDE : 1.0;
    if (what == STRUCK_FIXED)
        damage_fell_object(context, struck & ~PAIR_FIXED, inside * energy_of(kind, velocity),
                           velocity);
    return false;
}

static struct event_party party_struck(const struct response_context *context, uint32_t struck,
                                       enum struck what)
{
    const struct entities *e = &context->next->entities;
    if (what == STRUCK_VEHICLE)
        return (struct event_party){e->row[struck].id, e->row[struck].kind, 0,
                                    e->row[struck].damage};
    if (what == STRUCK_FIXED) {
        uint32_t object = struck & ~PAIR_FIXED;
        return (struct event_party){object + 1, context->world->fixed[object].kind, 1,
                                    (uint8_t)fallen_damage(context->next->fixed_damage[object])};
    }
    return (struct event_party){0, KIND_NONE, 0, DAMAGE_NONE};
}

void explosion_munition(struct response_context *context, uint32_t row, uint32_t struck,
                        struct vec3 normal, double time)
{
    const struct entities *e = &context->next->entities;
    struct state_head *head = context->next->head;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    struct vec3 point = path_at(&context->path[row], time);
    enum struck what = struck_of(context, struck, point);
    struct charge charge = {.point = point,
                            .time = time,
                            .explosive_kg = kind->explosive_kg,
                            .owner_slot = e->row[row].owner_slot,
                            .owner_id = e->row[row].owner_id,
                            .row = SLOT_NONE};
    struct event *event = event_writer_event(&context->events, EVENT_DETONATION);
    struct event_party munition = {e->row[row].id, e->row[row].kind, 0, DAMAGE_DESTROYED};

    head->tally.detonations++;
    if (hit(context, row, struck, what, normal, time))
        charge.explosive_kg = 0.0; /* a round that glances off breaks up */
    if (event) {
        event->detonation.munition = munition;
        event->detonation.struck_party = party_struck(context, struck, what);
        event->detonation.point[0] = point.x;
        event->detonation.point[1] = point.y;
        event->detonation.point[2] = point.z;
        event->detonation.explosive_kg = (float)charge.explosive_kg;
        event->detonation.struck = what;
        event->detonation.remote = e->row[row].order == BEHAVIOUR_REMOTE;
    }
    bool buried = what == STRUCK_GROUND && e->row[row].flags == FUZE_DELAY;
    if (what == STRUCK_GROUND && kind->craters)
        dig(context, point, kind->explosive_kg * (buried ? BURIED_CRATER : 1.0));
    charge.explosive_kg *= buried ? BURIED_BLAST : 1.0;
    table_clear_row(&context->writer, row);
    head->munitions--;
    contact_queue_drop(context->contacts, row);
    if (charge.explosive_kg > 0.0)
        explosion_charge(context, &charge);
}
