/* The choice of the followed vehicle. */
#include "renderer/scene/camera/follow.h"

#include "world/entity/kind.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <string.h>

#define CELLS          200   /* a side, in which neighbours are counted: of 250 m in 50 km */
#define AHEAD_M        160.0 /* neighbours count where the camera looks */
#define NEIGHBOURS_MAX 10
#define FIRES          16.0 /* its round is in the air */
#define SMALL_MM       50.0 /* rounds that penetrate less than this ... */
#define SMALL_SHARE    0.5  /* ... count so much less */
#define FIRED_AT       14.0 /* a round is in the air that was fired at it */
#define FIGHTS         5.0
#define NO_ENEMY       4.0   /* less for vehicles of no force while others fight */
#define BETTER         4.0   /* so much livelier is the vehicle to which the camera changes */
#define ACTION         10.0  /* what an effect counts beside the vehicle, less ... */
#define ACTION_NEAR_M  450.0 /* ... further away, nothing from here on */
#define ACTION_MAX     30.0
#define TARGET_NEAR_M  1200.0 /* a target so near counts ... */
#define TARGET_NEAR    8.0    /* ... up to so much */
#define NEIGHBOUR      0.6    /* what each of the neighbours counts */
#define WATCH_M        900.0  /* effects so near are watched ... */
#define WATCH_LEAST    0.2    /* ... if they are together so strong */
#define OBJECTS_MAX    10     /* most fixed objects nearby that count */

static int32_t cell_axis(const struct world *world, double metres)
{
    const double cell_m = world->terrain.squares.world_m / CELLS;
    int32_t cell = (int32_t)(world_clamp(world, metres) / cell_m);
    return cell < CELLS ? cell : CELLS - 1;
}

static bool is_vehicle(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    return e->row[slot].state == ENTITY_ACTIVE &&
           e->row[slot].kind < frame_view->world->counts.kinds &&
           frame_view->world->kinds[e->row[slot].kind].domain != DOMAIN_MUNITION;
}

/* Returns how much there is of an effect to be seen: 1 for an explosion that has just happened, 0
 * for what is over. Muzzles flash for a moment, and wrecks burn. */
static double seen(const struct effect *effect, double now_s)
{
    static const double share[EFFECT_TYPE_COUNT] = {
        [EFFECT_FLASH] = 0.2, [EFFECT_EXPLOSION] = 1.0, [EFFECT_BURST] = 1.0, [EFFECT_SPLASH] = 0.7,
        [EFFECT_HIT] = 0.2,   [EFFECT_CRASH] = 0.5,     [EFFECT_DECOY] = 0.7, [EFFECT_WRECK] = 2.5};
    enum effect_type type = (enum effect_type)effect->type;
    return share[type] * maths_max(0.0, 1.0 - (now_s - effect->time_s) / effects_life_s(type));
}

static double action_near(const struct effects *effects, struct vec3 position, double now_s)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < effects->count; i++) {
        double off = vec3_length(vec3_sub(effects->effect[i].point, position));
        if (off < ACTION_NEAR_M)
            sum += ACTION * seen(&effects->effect[i], now_s) * (1.0 - off / ACTION_NEAR_M);
    }
    return maths_min(sum, ACTION_MAX);
}

/* Returns the vector from a vehicle to its target, or a zero vector if it has none. */
static struct vec3 to_target(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    enum behaviour behaviour = (enum behaviour)e->row[slot].behaviour;
    uint32_t target = e->row[slot].target_slot;
    bool fights = behaviour == BEHAVIOUR_ATTACK || behaviour == BEHAVIOUR_REPOSITION ||
                  behaviour == BEHAVIOUR_FLEE;
    if (!fights || e->row[slot].target_id == 0 ||
        !entities_alive(e, target, e->row[slot].target_id))
        return (struct vec3){0.0, 0.0, 0.0};
    return vec3_sub(entities_position(e, target), entities_position(e, slot));
}

static double level(struct vec3 way)
{
    return sqrt(way.x * way.x + way.z * way.z);
}

/* Returns the middle of the directions of the effects, and their mean distance, counting old and
 * far ones less. far_m is 0 if there is too little to be seen. */
static struct follow_sight to_effects(const struct effects *effects, struct vec3 position,
                                      double now_s)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    double all = 0.0, far_m = 0.0;
    for (uint32_t i = 0; i < effects->count; i++) {
        struct vec3 off = vec3_sub(effects->effect[i].point, position);
        double way_m = level(off);
        if (way_m > WATCH_M || way_m < 1.0)
            continue;
        double counts = seen(&effects->effect[i], now_s) * (1.0 - way_m / WATCH_M);
        sum = vec3_add(sum, vec3_scale(off, counts / way_m));
        all += counts;
        far_m += counts * way_m;
    }
    if (level(sum) < WATCH_LEAST)
        return (struct follow_sight){0.0, 0.0};
    return (struct follow_sight){maths_heading(sum.x, sum.z), far_m / all};
}

struct follow_sight follow_look(const struct frame_view *frame_view, const struct effects *effects,
                                uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    struct vec3 way = to_target(frame_view, slot);
    if (level(way) > 0.0)
        return (struct follow_sight){maths_heading(way.x, way.z), level(way)};
    struct follow_sight sight = to_effects(effects, entities_position(e, slot),
                                           state_time_s(frame_view->world, frame_view->head));
    return sight.far_m > 0.0 ? sight : (struct follow_sight){e->row[slot].heading, 0.0};
}

/* Returns true if the row is a round in the air that a living vehicle fired. A howitzer's shell
 * does not count: it comes down far from the gun. */
static bool is_round(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    return e->row[slot].state == ENTITY_ACTIVE && e->row[slot].behaviour == BEHAVIOUR_FLIGHT &&
           frame_view->world->kinds[e->row[slot].kind].delivery != DELIVERY_ARC &&
           entities_alive(e, e->row[slot].owner_slot, e->row[slot].owner_id);
}

static bool is_owner(const struct entities *e, uint32_t round, uint32_t slot)
{
    return e->row[round].owner_slot == slot && e->row[round].owner_id == e->row[slot].id;
}

static bool is_target(const struct entities *e, uint32_t round, uint32_t slot)
{
    return e->row[round].target_slot == slot && e->row[round].target_id == e->row[slot].id;
}

/* What one round in the air adds to a vehicle. The fire of machine guns is hardly to be seen. */
static double fire_of(const struct frame_view *frame_view, uint32_t round, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    double mm = frame_view->world->kinds[e->row[round].kind].penetration_mm;
    double share = mm > 0.0 && mm < SMALL_MM ? SMALL_SHARE : 1.0;
    return share * (is_owner(e, round, slot) ? FIRES : is_target(e, round, slot) ? FIRED_AT : 0.0);
}

/* The most that a round in the air adds to a vehicle. */
static double fire_near(const struct frame_view *frame_view, uint32_t slot)
{
    double most = 0.0;
    for (uint32_t i = 0; i < frame_view->head->used; i++) {
        if (is_round(frame_view, i))
            most = maths_max(most, fire_of(frame_view, i, slot));
    }
    return most;
}

/* Returns true if the kind fires along an arc: what it does is to be seen elsewhere. */
static bool is_howitzer(const struct frame_view *frame_view, const struct kind *kind)
{
    return kind->munition != KIND_NONE &&
           frame_view->world->kinds[kind->munition].delivery == DELIVERY_ARC;
}

static double liveliness(const struct frame_view *frame_view, const struct effects *effects,
                         uint32_t slot, uint32_t neighbours)
{
    const struct entities *e = frame_view->entities;
    const struct kind *kind = &frame_view->world->kinds[e->row[slot].kind];
    struct vec3 position = entities_position(e, slot);
    double speed = vec3_length(entities_velocity(e, slot));
    double score = NEIGHBOUR * (neighbours < NEIGHBOURS_MAX ? neighbours : NEIGHBOURS_MAX);
    score += is_howitzer(frame_view, kind) ? 0.0
             : kind->domain == DOMAIN_LAND ? 5.0
             : kind->domain == DOMAIN_AIR  ? 0.5
                                           : 0.0;
    score += speed > 3.0 ? 5.0 : 0.0;
    score -= e->row[slot].force == FORCE_NEUTRAL ? NO_ENEMY : 0.0;
    score -= e->row[slot].damage;
    const uint32_t *around;
    uint32_t objects = world_reach(
        frame_view->world,
        gridsquare_of(&frame_view->world->terrain.squares, position.x, position.z), &around);
    score += 0.25 * (objects < OBJECTS_MAX ? objects : OBJECTS_MAX);
    score += e->row[slot].behaviour == BEHAVIOUR_ATTACK ? FIGHTS : 0.0;
    double way = vec3_length(to_target(frame_view, slot));
    score += way > 0.0 ? TARGET_NEAR * maths_max(0.0, 1.0 - way / TARGET_NEAR_M) : 0.0;
    return score +
           action_near(effects, position, state_time_s(frame_view->world, frame_view->head));
}

static uint16_t *cell_of(const struct world *world, uint16_t *cells, double x, double z)
{
    return &cells[cell_axis(world, z) * CELLS + cell_axis(world, x)];
}

static double score_of(const struct frame_view *frame_view, const struct effects *effects,
                       uint16_t *neighbours, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    double looks_rad = follow_look(frame_view, effects, slot).heading_rad;
    double ahead_x = e->row[slot].x + AHEAD_M * maths_sin(looks_rad);
    double ahead_z = e->row[slot].z - AHEAD_M * maths_cos(looks_rad);
    return liveliness(frame_view, effects, slot,
                      *cell_of(frame_view->world, neighbours, ahead_x, ahead_z));
}

/* The best vehicle so far. */
struct choice {
    uint32_t slot; /* SLOT_NONE: none yet */
    double score;
};

static void offer(struct choice *choice, const struct frame_view *frame_view, uint32_t slot,
                  double score)
{
    if (slot < frame_view->head->used && is_vehicle(frame_view, slot) && score > choice->score)
        *choice = (struct choice){slot, score};
}

/* Offers the shooters and the targets of the rounds in the air. */
static void offer_fighters(struct choice *choice, const struct frame_view *frame_view,
                           const struct effects *effects, uint16_t *neighbours)
{
    const struct entities *e = frame_view->entities;
    for (uint32_t i = 0; i < frame_view->head->used; i++) {
        uint32_t of[2] = {e->row[i].owner_slot, e->row[i].target_slot};
        for (int n = 0; n < 2 && is_round(frame_view, i); n++) {
            if (of[n] < frame_view->head->used)
                offer(choice, frame_view, of[n],
                      score_of(frame_view, effects, neighbours, of[n]) +
                          fire_of(frame_view, i, of[n]));
        }
    }
}

/* Returns the liveliest vehicle, or `now` (SLOT_NONE: none) if no other one is much livelier. */
static uint32_t liveliest(const struct frame_view *frame_view, const struct effects *effects,
                          uint32_t now)
{
    uint16_t neighbours[CELLS * CELLS];
    const struct entities *e = frame_view->entities;
    struct choice choice = {SLOT_NONE, -INFINITY};
    memset(neighbours, 0, sizeof neighbours);
    for (uint32_t i = 0; i < frame_view->head->used; i++)
        if (is_vehicle(frame_view, i)) {
            uint16_t *here = cell_of(frame_view->world, neighbours, e->row[i].x, e->row[i].z);
            *here = (uint16_t)(*here + (*here < UINT16_MAX));
        }
    if (now != SLOT_NONE && is_vehicle(frame_view, now))
        offer(&choice, frame_view, now,
              score_of(frame_view, effects, neighbours, now) + fire_near(frame_view, now) + BETTER);
    for (uint32_t i = 0; i < frame_view->head->used; i++) {
        if (is_vehicle(frame_view, i))
            offer(&choice, frame_view, i, score_of(frame_view, effects, neighbours, i));
    }
    offer_fighters(&choice, frame_view, effects, neighbours);
    return choice.slot;
}

/* Returns true if the vehicle is active, or was destroyed only recently. */
static bool worth_following(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    double dead_s = (double)(frame_view->head->tick - e->row[slot].changed_tick) *
                    world_dt_s(frame_view->world);
    return e->row[slot].state == ENTITY_ACTIVE || dead_s < FOLLOW_WRECK_S;
}

uint32_t follow_choose(struct follow *follow, const struct frame_view *frame_view,
                       const struct effects *effects, uint32_t first_id, bool only)
{
    const struct entities *e = frame_view->entities;
    uint32_t used = frame_view->head->used;
    double now = state_time_s(frame_view->world, frame_view->head);
    uint32_t first = first_id != 0 ? entities_find(e, used, first_id) : SLOT_NONE;
    if (first != SLOT_NONE && (only || worth_following(frame_view, first))) {
        *follow = (struct follow){.id = first_id, .since_s = now};
        return first;
    }
    uint32_t slot = follow->id != 0 ? entities_find(e, used, follow->id) : SLOT_NONE;
    if (slot != SLOT_NONE && worth_following(frame_view, slot) &&
        (e->row[slot].state == ENTITY_WRECK || now - follow->since_s < FOLLOW_KEEP_S))
        return slot;
    uint32_t next = liveliest(frame_view, effects, slot);
    if (next == SLOT_NONE)
        return slot;
    *follow = (struct follow){.id = e->row[next].id, .since_s = now};
    return next;
}
