/* Finds how far each direction of the fan is free, and takes the best. */
#include "mover/agent/avoidance_internal.h"

#include "mover/agent/driving/driving_pace.h"
#include "mover/agent/driving/ground_obstacles.h"
#include "mover/agent/driving/progress.h"
#include "mover/agent/driving/seen_box.h"
#include "mover/agent/driving/shunting.h"
#include "mover/agent/neighbour_lists.h"
#include "mover/agent/perception.h"
#include "mover/agent/room_around.h"
#include "mover/context/cruise_start.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/terrain/crater.h"
#include "world/terrain/fixed_index.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stddef.h>

#define LOW_FLIGHT_M 40.0 /* above this height no fixed object is an obstacle */
#define BRAKE_SHARE  0.8  /* share of the hardest braking that it relies on */
#define TURN_COST    0.25 /* of each radian of turning, in shares of the horizon */
#define CHANGE_COST  0.10 /* of each radian off the last dodge, against wavering */
#define SWEEP_COST   0.10 /* of a turn of 90 degrees off the present heading, at full speed */
#define LEFT_COST    0.03 /* of turning left, so that two vehicles that meet both turn right */
#define SHARP_SHARE  0.25 /* share of its speed in turns of 90 degrees and more */
#define ROLLS_MPS    2.0  /* a faster vehicle does not turn in place */
#define CREEP_M      0.5  /* it goes on so far while it turns past an obstacle beside it */
#define TOUCHES_M    0.1  /* a vehicle that reaches less into a wall only touches it */
#define NARROW_M     0.4  /* the gap to a wall beside its way, where there is no more */
#define STRAYS       0.05 /* how far bodies leave their course, as a share of the distance */
#define GIVEN_WAY_S  2.5  /* the other is expected to give way if they meet later */
#define CROSSING     0.94 /* cosine of 20 degrees: courses that differ by less do not cross */
#define DEEPER_M     0.2  /* than a step that it climbs, a crater is an obstacle */
#define BOWL_SHARE   1.15 /* of its radius, within which a crater's ground is too steep */
#define ROUNDED_MPS  1e-4 /* more than the index's rounding of velocities */

/* A patrol that finds no gentle way free for this share of the horizon goes over steep ground. */
#define STEEP_FREE 0.5

/* The fan: angles off the desired heading, with their sines and cosines. Direction PRESENT is the
 * present heading. */
#define FAN             13
#define FAN_BACK        7 /* backwards: as far as 35 degrees */
#define PRESENT         FAN
#define BOTH(value)     (value), (value)
#define OPPOSITE(value) (value), -(value)
/* clang-format off */
static const double fan_rad[FAN] = {
    0.0, OPPOSITE(10 * RAD_PER_DEG), OPPOSITE(20 * RAD_PER_DEG), OPPOSITE(35 * RAD_PER_DEG),
    OPPOSITE(55 * RAD_PER_DEG), OPPOSITE(80 * RAD_PER_DEG), OPPOSITE(115 * RAD_PER_DEG)};
static const double fan_sine[FAN] = {
    0.0, OPPOSITE(0.17364817766693033), OPPOSITE(0.3420201433256687), OPPOSITE(0.573576436351046),
    OPPOSITE(0.8191520442889918), OPPOSITE(0.984807753012208), OPPOSITE(0.9063077870366499)};
static const double fan_cosine[FAN] = {
    1.0, BOTH(0.984807753012208), BOTH(0.9396926207859084), BOTH(0.8191520442889918),
    BOTH(0.5735764363510461), BOTH(0.17364817766693041), BOTH(-0.42261826174069944)};
/* clang-format on */

struct look {
    const struct kind *kind;
    int step; /* 1: looks along all of the fan; PRESENT: only along directions 0 and PRESENT */
    double sine, cosine; /* of the desired heading */
    double sign;         /* 1; backwards -1 */
    double desired_mps, present_mps;
    double speed_mps; /* along the fan: the speed that it can reach within a second */
    double horizon_m;
    double half_width, half_length, gap;
    double strays;                 /* how far it leaves its course, as a share of the distance */
    double nose_m;                 /* how far it reaches ahead of its middle: its gun, too */
    double left_m, right_m;        /* and to the sides */
    double think_s;                /* until it decides again */
    bool passes_standing;          /* others that stand do not count */
    double ahead_s;                /* by which the index may hold others further on their way */
    double x[FAN + 1], z[FAN + 1]; /* the fan's directions, unit */
    double free_m[FAN + 1];        /* how far each is free; at most the horizon */
    double steep[FAN];             /* what steep ground there costs */
};

/* --- the fan -----------------------------------------------------------------------------------*/

static void direct(struct look *look, int k)
{
    look->x[k] = look->sign * (look->sine * fan_cosine[k] + look->cosine * fan_sine[k]);
    look->z[k] = look->sign * (look->sine * fan_sine[k] - look->cosine * fan_cosine[k]);
    look->free_m[k] = look->horizon_m;
}

/* Sets how far it reaches ahead and to its sides, with its gun where it points. */
static void reach_out(struct look *look, const struct kind *kind, double gun_m, double turret_rad)
{
    double sine = 0.0, cosine = 1.0;
    if (kind->part_count > 0)
        maths_sincos(turret_rad, &sine, &cosine);
    look->nose_m = maths_max(look->half_length, look->sign * gun_m * cosine);
    look->right_m = maths_max(look->half_width, look->sign * gun_m * sine);
    look->left_m = maths_max(look->half_width, -look->sign * gun_m * sine);
}

/* How long ago the index may have been right about a vehicle, beyond half a second [s]. */
static double ahead_of(const struct step_context *context)
{
    return context->dt_s * (double)(context->cruise_frames - context->cruise_short);
}

double avoidance_ahead(const struct step_context *context)
{
    return context->avoidance->fastest_mps * ahead_of(context);
}

static void begin(struct look *look, const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double speed = fabs(desired->speed_mps), sine, cosine, forward, rightward;
    look->kind = kind;
    look->step = PRESENT;
    look->sign = desired->speed_mps < 0.0 ? -1.0 : 1.0;
    look->desired_mps = speed;
    look->half_width = 0.5 * kind->width_m;
    look->half_length = 0.5 * kind->length_m;
    reach_out(look, kind, context->avoidance->nose_m[m->row[i].kind], (double)m->row[i].turret);
    if (kind->domain != DOMAIN_AIR)
        look->think_s = context->dt_s * (double)cruise_start_think_frames(context, i);
    look->ahead_s = ahead_of(context);
    look->gap = avoidance_gap(kind);
    look->strays = STRAYS;
    look->horizon_m = avoidance_horizon(kind, speed);
    maths_sincos(desired->heading_rad, &look->sine, &look->cosine);
    direct(look, 0);
    maths_sincos(m->row[i].heading, &sine, &cosine);
    kinematics_along(m, i, sine, cosine, &forward, &rightward);
    look->x[PRESENT] = look->sign * sine;
    look->z[PRESENT] = -look->sign * cosine;
    look->present_mps = maths_max(1.0, look->sign * forward);
    look->speed_mps = maths_min(speed, look->present_mps + kind->acceleration_mps2);
    look->free_m[PRESENT] = look->horizon_m;
}

/* Extends the look to all of the fan. Mostly the desired direction is free and this is not needed.
 */
static void open_fan(struct look *look)
{
    look->step = 1;
    for (int k = 0; k < FAN; k++)
        direct(look, k), look->steep[k] = 0.0;
    look->free_m[PRESENT] = look->horizon_m;
}

/* Limits the directions by an obstacle of radius reach_m at (dx, dz), relative to the vehicle. */
static void limit_by_standing(struct look *look, double dx, double dz, double reach_m)
{
    double beside = reach_m + look->half_width + look->gap;
    double ahead = reach_m + look->nose_m + look->gap;
    for (int k = 0; k <= FAN; k += look->step) {
        double along = dx * look->x[k] + dz * look->z[k];
        double across = fabs(dx * look->z[k] - dz * look->x[k]);
        if (along > 0.0 && across < beside + STRAYS * along)
            look->free_m[k] = maths_min(look->free_m[k], maths_max(0.0, along - ahead));
    }
}

/* Returns true if the other vehicle must give way. As at sea, a vehicle gives way to one on its
 * right and to one that it overtakes. */
static bool gives_way(const struct look *look, double dx, double dz, double vx, double vz)
{
    double ahead = dx * look->x[0] + dz * look->z[0];
    double to_right = dz * look->x[0] - dx * look->z[0];
    double same = vx * look->x[0] + vz * look->z[0];
    double speed = sqrt(vx * vx + vz * vz);
    if (speed < 1.0) /* it stands */
        return false;
    if (same > CROSSING * speed)
        return ahead < 0.0;
    return same > -CROSSING * speed && to_right < 0.0;
}

/* Returns false only if the obstacle, which moves at (vx, vz), cannot be met before the horizon
 * along direction k; this holds for the rounded values of the index too. It may be up to
 * look->ahead_s further back on its way than (dx, dz). Needs no division. */
static bool may_meet(const struct look *look, int k, double dx, double dz, double vx, double vz,
                     double reach_m)
{
    double speed = k == PRESENT ? look->present_mps : look->speed_mps;
    double ux = speed * look->x[k] - vx, uz = speed * look->z[k] - vz;
    double square = ux * ux + uz * uz, closing = sqrt(square);
    double rounded = ROUNDED_MPS * (fabs(dx) + fabs(dz));
    double along = dx * ux + dz * uz, across = dx * uz - dz * ux; /* times closing */
    double back_along = along - look->ahead_s * (vx * ux + vz * uz);
    double back_across = across - look->ahead_s * (vx * uz - vz * ux);
    double first = maths_min(along, back_along), last = maths_max(along, back_along);
    double off = across * back_across < 0.0 ? 0.0 : maths_min(fabs(across), fabs(back_across));
    double beside =
        reach_m + look->gap + AVOIDANCE_ROUNDED_M + maths_max(look->half_width, look->half_length);
    double ahead = reach_m + look->nose_m + look->gap + AVOIDANCE_ROUNDED_M;
    return last > -rounded && off < beside * closing + STRAYS * last + rounded &&
           speed * (first - ahead * closing - rounded) <
               look->horizon_m * (square + ROUNDED_MPS * (closing + 1.0));
}

/* Limits the directions by an obstacle that moves at (vx, vz): to the distance that the vehicle
 * goes until they meet. */
static void limit_by_moving(struct look *look, double dx, double dz, double vx, double vz,
                            double reach_m)
{
    double beside = reach_m + look->half_width + look->gap;
    double ahead = reach_m + look->nose_m + look->gap;
    bool other_gives_way = gives_way(look, dx, dz, vx, vz);
    for (int k = 0; k <= FAN; k += look->step) {
        double speed = k == PRESENT ? look->present_mps : look->speed_mps;
        double ux = speed * look->x[k] - vx, uz = speed * look->z[k] - vz;
        double closing = sqrt(ux * ux + uz * uz);
        if (closing < 0.1)
            continue;
        double along = (dx * ux + dz * uz) / closing;
        double across = fabs(dx * uz - dz * ux) / closing;
        double askew = fabs(ux * look->z[k] - uz * look->x[k]) / closing; /* 0: head on */
        double wide = beside + askew * (look->half_length - look->half_width);
        if (along > 0.0 && across < wide + STRAYS * along) {
            double meets_s = maths_max(0.0, along - ahead) / closing;
            if (!other_gives_way || meets_s < GIVEN_WAY_S)
                look->free_m[k] = maths_min(look->free_m[k], speed * meets_s);
        }
    }
}

/* --- obstacles ---------------------------------------------------------------------------------*/

/* Limits the directions by a rectangle about (dx, dz), relative to the vehicle: half its length in
 * the direction (ux, uz), half its width across. What counts is the part of it that is in the
 * vehicle's way, so that a street between two long houses stays free, also for one that is askew in
 * it. Of a wall that the vehicle is beside already it keeps no gap. */
static void limit_by_box(struct look *look, double dx, double dz, double ux, double uz, double half,
                         double width)
{
    for (int k = 0; k <= FAN; k += look->step) {
        const double cosine = ux * look->x[k] + uz * look->z[k];
        const double sine = uz * look->x[k] - ux * look->z[k];
        const struct seen_box box = {.along = dx * look->x[k] + dz * look->z[k],
                                     .right = dz * look->x[k] - dx * look->z[k],
                                     .length_along = half * cosine,
                                     .length_right = half * sine,
                                     .width_along = width * -sine,
                                     .width_right = width * cosine};
        const double reach = fabs(box.length_along) + fabs(box.width_along);
        const double begins = maths_max(0.0, box.along - reach - look->nose_m);
        const double keeps[] = {-TOUCHES_M, NARROW_M, look->gap + look->strays * begins};
        double ahead = INFINITY;
        for (int n = 0; n < 3; n++) {
            const double nearest =
                seen_box_nearest(&box, -look->left_m - keeps[n], look->right_m + keeps[n]);
            if (n == 0 || nearest > look->nose_m)
                ahead = maths_min(ahead, nearest);
        }
        if (ahead < INFINITY)
            look->free_m[k] =
                maths_min(look->free_m[k], maths_max(0.0, ahead - look->nose_m - look->gap));
    }
}

/* Returns true if a fixed object reaches into a circle about the vehicle. */
static bool is_near(const struct fixed_object *object, double dx, double dz, double radius_m)
{
    const double most = radius_m + (double)object->radius_m;
    return dx * dx + dz * dz <= most * most;
}

static void see_square(const struct step_context *context, uint32_t i, struct look *look,
                       uint32_t square)
{
    const struct world *world = context->world;
    const struct entities *m = context->m;
    bool flies = look->kind->domain == DOMAIN_AIR;
    const uint32_t *objects;
    uint32_t count = world_reach(world, square, &objects);
    for (uint32_t n = 0; n < count; n++) {
        const struct fixed_object *object = &world->fixed[objects[n]];
        double dx = object->x - m->row[i].x, dz = object->z - m->row[i].z;
        if (!is_near(object, dx, dz, look->horizon_m) || !avoidance_harms(context, i, objects[n]))
            continue;
        if (flies &&
            (double)object->y + (double)object->height_m + 0.5 * look->kind->height_m < m->row[i].y)
            continue;
        const uint32_t boxes = flies ? 0 : avoidance_boxes(context, object);
        for (uint32_t b = 0; b < boxes; b++) {
            const struct avoidance_box_placed box = avoidance_box_of(context, object, b);
            limit_by_box(look, box.x - m->row[i].x, box.z - m->row[i].z, box.ux, box.uz, box.half_m,
                         box.half_width);
        }
        if (boxes == 0)
            limit_by_standing(look, dx, dz,
                              flies ? fixed_index_of_fixed(object, world->kinds)
                                    : avoidance_disc(context, object));
    }
}

static void see_fixed(const struct step_context *context, uint32_t i, struct look *look)
{
    const struct entities *m = context->m;
    double most = look->horizon_m;
    const struct gridsquares *squares = &context->world->terrain.squares;
    struct gridsquare_box box = gridsquare_box_of(squares, m->row[i].x - most, m->row[i].z - most,
                                                  m->row[i].x + most, m->row[i].z + most);
    for (int32_t row = box.z0; row <= box.z1; row++)
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t square = gridsquare_index(squares, column, row);
            if (context->avoidance->occupied[square / 64] >> square % 64 & 1u)
                see_square(context, i, look, square);
        }
}

bool avoidance_goes_around(const struct step_context *context, uint32_t i,
                           const struct crater *crater)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const double radius = (double)crater->radius_m;
    const double dx = crater->x - m->row[i].x, dz = crater->z - m->row[i].z;
    const double goal_x = crater->x - m->row[i].goal_x, goal_z = crater->z - m->row[i].goal_z;
    return (double)crater->depth_m > kind->step_m + DEEPER_M && !progress_stuck(context, i) &&
           dx * dx + dz * dz > radius * radius &&
           (m->row[i].behaviour != BEHAVIOUR_SCRIPT ||
            goal_x * goal_x + goal_z * goal_z > radius * radius);
}

/* Limits the directions by craters. */
static void see_craters(const struct step_context *context, uint32_t i, struct look *look)
{
    const struct entity *m = &context->m->row[i];
    const double most = look->horizon_m;
    const struct crater *crater;
    if (look->kind->domain != DOMAIN_LAND)
        return;
    struct crater_walk walk = crater_walk_begin(context->craters, m->x, m->z, most);
    while ((crater = crater_walk_next(&walk)) != NULL) {
        const double dx = crater->x - m->x, dz = crater->z - m->z;
        if (dx * dx + dz * dz < most * most && avoidance_goes_around(context, i, crater))
            limit_by_standing(look, dx, dz, BOWL_SHARE * (double)crater->radius_m);
    }
}

/* Returns how far a vehicle may be above or below, from middle to middle, and still be in the way.
 */
static double apart_of(const struct look *look, const struct kind *other)
{
    if (look->kind->domain == DOMAIN_LAND && other->domain == DOMAIN_LAND)
        return INFINITY; /* a road down a slope leads to one that is far below */
    return 0.5 * (look->kind->height_m + other->height_m) + look->gap;
}

/* Returns false if a vehicle is certainly in nobody's way, by what the index knows of it. */
static bool concerns(const struct step_context *context, uint32_t i, const struct look *look,
                     const struct neighbour_index_entry *at)
{
    const struct entity *row = &context->m->row[i];
    double reach = context->avoidance->reach_m[at->kind];
    double dx = (double)at->x - row->x, dz = (double)at->z - row->z;
    double vx = (double)at->vx, vz = (double)at->vz;
    double apart = apart_of(look, &context->world->kinds[at->kind]);
    if (at->row == i || fabs((double)at->y - row->y) > apart + AVOIDANCE_ROUNDED_M)
        return false;
    return look->step != PRESENT || may_meet(look, 0, dx, dz, vx, vz, reach) ||
           may_meet(look, PRESENT, dx, dz, vx, vz, reach);
}

/* Limits the directions by a vehicle that may be in the way. */
static void see_vehicle(const struct step_context *context, uint32_t i, struct look *look,
                        const struct neighbour_index_entry *at)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    struct vec3 off = vec3_sub(step_context_position(context, w, at->row), entities_position(m, i));
    struct vec3 velocity = step_context_velocity(context, w, at->row);
    const double square = velocity.x * velocity.x + velocity.z * velocity.z;
    if (look->passes_standing && square < ROOM_AROUND_STANDS_MPS * ROOM_AROUND_STANDS_MPS)
        return;
    if (fabs(off.y) <= apart_of(look, &context->world->kinds[at->kind]))
        limit_by_moving(look, off.x, off.z, velocity.x, velocity.z,
                        context->avoidance->reach_m[at->kind]);
}

#define SEEN_TOGETHER 16u

/* Vehicles whose rows have been asked for, and are seen together when they have come. */
struct seen {
    const struct neighbour_index_entry *entry[SEEN_TOGETHER];
    uint32_t count;
};

static void see_all(const struct step_context *context, uint32_t i, struct look *look,
                    struct seen *seen)
{
    for (uint32_t n = 0; n < seen->count; n++)
        see_vehicle(context, i, look, seen->entry[n]);
    seen->count = 0;
}

static void take(const struct step_context *context, uint32_t i, struct look *look,
                 struct seen *seen, const struct neighbour_index_entry *entry)
{
    if (!concerns(context, i, look, entry))
        return;
    entity_prefetch_pose(&context->committed->entities.row[entry->row]);
    seen->entry[seen->count++] = entry;
    if (seen->count == SEEN_TOGETHER)
        see_all(context, i, look, seen);
}

/* Sees those of a list that are within a distance. */
static void see_listed(const struct step_context *context, uint32_t i, struct look *look,
                       const struct neighbour_list *list, double most)
{
    const struct neighbour_index_entry *entry = &context->neighbour_lists->entries[list->first];
    const struct entity *row = &context->m->row[i];
    struct seen seen = {.count = 0};
    for (const struct neighbour_index_entry *end = entry + list->count; entry < end; entry++) {
        if (neighbour_index_within(entry, row->x, row->z, most * most))
            take(context, i, look, &seen, entry);
    }
    see_all(context, i, look, &seen);
}

static void see_vehicles(const struct step_context *context, uint32_t i, struct look *look)
{
    const struct entities *m = context->m;
    const struct neighbour_index_entry *entry;
    const double ahead_m = avoidance_ahead(context);
    double most = avoidance_around(look->horizon_m) + ahead_m;
    const struct neighbour_list *list = &context->neighbour_lists->list[i];
    bool listed = step_context_thinks(context, i) && list->count != NEIGHBOUR_LISTS_NONE;
    if (listed && most <= context->avoidance->around_m[m->row[i].kind] + ahead_m) {
        see_listed(context, i, look, list, most);
        return;
    }
    struct neighbour_query query = neighbour_query_begin(context->neighbours, NEIGHBOUR_INDEX_ALL,
                                                         m->row[i].x, m->row[i].z, most);
    struct seen seen = {.count = 0};
    while ((entry = neighbour_query_next(&query)) != NULL)
        take(context, i, look, &seen, entry);
    see_all(context, i, look, &seen);
}

/* Returns the way in direction k, with the room that the vehicle needs. */
static struct ground_way way_of(const struct step_context *context, uint32_t i,
                                const struct look *look, int k)
{
    return (struct ground_way){.ux = look->x[k],
                               .uz = look->z[k],
                               .length_m = look->horizon_m,
                               .beside_m = look->half_width + look->gap,
                               .ahead_m = look->half_length + look->gap,
                               .slope = context->avoidance->slope[context->m->row[i].kind]};
}

/* --- the choice --------------------------------------------------------------------------------*/

/* The way to a direction on the other side may lead through what it is to go around, so that
 * turning far costs more the faster it is. A way back leads around no steep ground, and costs as
 * much as that ahead. heeds_steep: 1; 0: it goes over steep ground. */
static int best(const struct look *look, double dodge_rad, double heeds_steep)
{
    int found = 0;
    double most = -INFINITY;
    double sweep = SWEEP_COST * maths_min(1.0, look->present_mps / look->desired_mps);
    for (int k = 0; k < (look->sign < 0.0 ? FAN_BACK : FAN); k++) {
        double cosine = look->x[k] * look->x[PRESENT] + look->z[k] * look->z[PRESENT];
        double score = look->free_m[k] / look->horizon_m - TURN_COST * fabs(fan_rad[k]) -
                       CHANGE_COST * fabs(fan_rad[k] - dodge_rad) - sweep * (1.0 - cosine) -
                       (fan_rad[k] < 0.0 ? LEFT_COST : 0.0) -
                       heeds_steep * look->steep[fan_cosine[k] < 0.0 ? 0 : k];
        if (score > most) {
            most = score;
            found = k;
        }
    }
    return found;
}

/* How far the directions are free through which it turns from its present heading to a direction.
 */
static double turn_free(const struct look *look, int direction)
{
    double x = look->x[PRESENT], z = look->z[PRESENT], least = look->horizon_m;
    double across = x * look->z[direction] - z * look->x[direction];
    double along = x * look->x[direction] + z * look->z[direction];
    for (int k = 0; k < FAN; k += look->step) {
        bool between = (x * look->z[k] - z * look->x[k]) * across > 0.0 &&
                       x * look->x[k] + z * look->z[k] > along;
        if (between)
            least = maths_min(least, look->free_m[k]);
    }
    return least;
}

/* How far it goes on when it brakes now. */
static double stopping_way(const struct look *look)
{
    return look->present_mps * look->present_mps /
           (2.0 * BRAKE_SHARE * BRAKES * look->kind->acceleration_mps2);
}

/* The speed from which it can stop within free_m, when it brakes after its next decision. */
static double stopping_speed(const struct look *look, double free_m)
{
    double brake = BRAKE_SHARE * BRAKES * look->kind->acceleration_mps2, late_s = look->think_s;
    return brake * (sqrt(late_s * late_s + 2.0 * free_m / brake) - late_s);
}

/* The greatest speed that the ground ahead allows. Aircraft look at it by themselves
 * (flight/terrain_following.h). */
static double ground_speed(const struct step_context *context, uint32_t i, const struct look *look,
                           const struct desired_motion *desired)
{
    if (look->kind->domain == DOMAIN_LAND && look->sign > 0.0)
        return driving_pace(context, i, desired->heading_rad);
    return INFINITY;
}

/* --- the look ----------------------------------------------------------------------------------*/

static void see(const struct step_context *context, uint32_t i, struct look *look, bool low)
{
    see_vehicles(context, i, look);
    see_craters(context, i, look);
    if (low)
        see_fixed(context, i, look);
}

/* Looks at the ground in the direction that is best until no other one is better. */
static int choose_ground(const struct step_context *context, uint32_t i, struct look *look,
                         double heeds_steep)
{
    double dodge = shunting_dodge(context->m, i);
    int direction = best(look, dodge, heeds_steep);
    for (int tries = 0; tries < FAN && look->kind->domain != DOMAIN_AIR; tries++) {
        const struct ground_way way = way_of(context, i, look, direction);
        double free_m = ground_obstacles_free(context, i, &way);
        bool leads_on = free_m >= STEEP_FREE * look->horizon_m;
        double steep = leads_on ? ground_obstacles_cost(context, i, &way) : 0.0;
        if (free_m >= look->free_m[direction] && steep <= look->steep[direction])
            break;
        look->free_m[direction] = maths_min(free_m, look->free_m[direction]);
        look->steep[direction] = steep;
        direction = best(look, dodge, heeds_steep);
    }
    return direction;
}

/* Chooses a direction when the desired one is not free, or steep. */
static int choose(const struct step_context *context, uint32_t i, struct look *look, bool low)
{
    open_fan(look);
    see(context, i, look, low);
    int direction = choose_ground(context, i, look, 1.0);
    return look->free_m[direction] < STEEP_FREE * look->horizon_m
               ? choose_ground(context, i, look, 0.0)
               : direction;
}

/* Returns true if the ground in the desired direction is not free, or steep. */
static bool ground_hinders(const struct step_context *context, uint32_t i, const struct look *look)
{
    const struct ground_way way = way_of(context, i, look, 0);
    return ground_obstacles_free(context, i, &way) < look->horizon_m ||
           ground_obstacles_cost(context, i, &way) > 0.0;
}

/* Return how far the ground, or earthworks alone, allow it to go on as it heads. */
static double ground_free(const struct step_context *context, uint32_t i, const struct look *look)
{
    const struct ground_way way = way_of(context, i, look, PRESENT);
    return ground_obstacles_free(context, i, &way);
}

static double works_free(const struct step_context *context, uint32_t i, const struct look *look)
{
    const struct ground_way way = way_of(context, i, look, PRESENT);
    return ground_obstacles_works(context, i, &way);
}

/* Sets the speed so that it can stop within free_m. */
static void ease_to(const struct step_context *context, uint32_t i, const struct look *look,
                    double ease, double free_m)
{
    if (free_m < look->horizon_m)
        ease = maths_max(ease, 1.0 - stopping_speed(look, free_m) / look->desired_mps);
    context->m->row[i].ease = (float)maths_clamp(ease, 0.0, 1.0);
}

/* Looks along the desired direction first: when it is free no other is better. Returns the
 * direction, and how far it is free in look->free_m. */
static int look_along(const struct step_context *context, uint32_t i, struct look *look)
{
    const struct entities *m = context->m;
    bool flies = look->kind->domain == DOMAIN_AIR;
    bool low =
        !flies || m->row[i].y - kinematics_ground(context, m->row[i].x, m->row[i].z) < LOW_FLIGHT_M;
    see(context, i, look, low);
    return look->free_m[0] < look->horizon_m || (!flies && ground_hinders(context, i, look))
               ? choose(context, i, look, low)
               : 0;
}

/* Turns to a direction no sooner than the way there is free. */
static void turn_to(const struct step_context *context, uint32_t i, struct look *look,
                    int direction, double ease, const struct desired_motion *desired)
{
    struct entities *m = context->m;
    const bool flies = look->kind->domain == DOMAIN_AIR;
    double free_m = look->free_m[direction], off = 0.0;
    if (direction != 0)
        look->free_m[PRESENT] = maths_min(look->free_m[PRESENT], works_free(context, i, look));
    if (look->x[direction] * look->x[PRESENT] + look->z[direction] * look->z[PRESENT] <
        fan_cosine[1]) {
        double turn_m = flies ? look->horizon_m : turn_free(look, direction);
        if (turn_m < stopping_way(look) && turn_m < look->free_m[PRESENT]) {
            direction = PRESENT; /* it slows down before it turns */
            off = maths_wrap_half(m->row[i].heading - desired->heading_rad);
        }
        free_m = maths_min(free_m, maths_min(maths_max(turn_m, CREEP_M), look->free_m[PRESENT]));
    }
    m->row[i].dodge = (float)(direction < FAN ? fan_rad[direction] : off);
    ease_to(context, i, look, ease, free_m);
}

/* --- to and fro --------------------------------------------------------------------------------*/

/* Backs out: looks behind it as it looks ahead, and goes where that is free. */
static void back_out(const struct step_context *context, uint32_t i, struct shunting_way *way,
                     struct desired_motion *desired)
{
    struct look look = {0};
    struct desired_motion back = *desired;
    shunting_take(context, i, way, &back);
    back.heading_rad = way->heading_rad;
    begin(&look, context, i, &back);
    look.gap = NARROW_M;
    look.strays = 0.0; /* it drives at a walk */
    int direction = look_along(context, i, &look);
    way->heading_rad += fan_rad[direction];
    shunting_take(context, i, way, desired);
    ease_to(context, i, &look, 0.0, maths_min(look.free_m[direction], look.free_m[PRESENT]));
}

/* Takes a stroke, no faster than what moves and the ground in its direction allow. */
static void take_stroke(const struct step_context *context, uint32_t i,
                        const struct shunting_way *way, struct desired_motion *desired)
{
    struct look look = {.passes_standing = true};
    shunting_take(context, i, way, desired);
    begin(&look, context, i, desired);
    see_vehicles(context, i, &look);
    ease_to(
        context, i, &look, 0.0,
        maths_min(way->free_m, maths_min(look.free_m[PRESENT], ground_free(context, i, &look))));
}

/* Drives to and fro to a heading. Returns false if it need not, or cannot on its way. */
static bool shunt(const struct step_context *context, uint32_t i, double heading_rad,
                  struct desired_motion *desired)
{
    struct shunting_way way;
    if (!shunting_looks(context, i, heading_rad, desired))
        return false;
    const struct shunting_room room = room_around(context, i);
    if (!shunting_begins(context, i, &room, heading_rad, desired))
        return false;
    if (!shunting_choose(context, i, &room, heading_rad, desired, &way)) {
        if (!desired->shunts)
            return false;
        context->m->row[i].ease = 1.0f;
    } else if (way.backs_out) {
        back_out(context, i, &way, desired);
    } else {
        take_stroke(context, i, &way, desired);
    }
    return true;
}

static void look_ahead(const struct step_context *context, uint32_t i,
                       struct desired_motion *desired)
{
    struct look look = {0};
    if (desired->shunts) {
        (void)shunt(context, i, desired->heading_rad, desired);
        return;
    }
    begin(&look, context, i, desired);
    const double ease = 1.0 - ground_speed(context, i, &look, desired) / look.desired_mps;
    const int direction = look_along(context, i, &look);
    if (!shunt(context, i, desired->heading_rad + fan_rad[direction], desired))
        turn_to(context, i, &look, direction, ease, desired);
}

static bool rolls(const struct entities *m, uint32_t i)
{
    return m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz > ROLLS_MPS * ROLLS_MPS;
}

void avoidance_steer(const struct step_context *context, uint32_t i, struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (desired->driven) { /* dodge is the driver's wheel (mover/motion/chassis.h) */
        m->row[i].ease = 0.0f;
        return;
    }
    if (!(fabs(desired->speed_mps) > 0.0)) {
        m->row[i].dodge = m->row[i].ease = 0.0f;
        if (kind->domain == DOMAIN_LAND && rolls(m, i))
            desired->heading_rad = m->row[i].heading; /* it stops before it turns in place */
        return;
    }
    if (perception_looks_out(context, i))
        look_ahead(context, i, desired);
    else
        shunting_keep(context, i, desired);
    desired->heading_rad = maths_wrap_turn(desired->heading_rad + (double)m->row[i].dodge);
    desired->speed_mps *= 1.0 - (double)m->row[i].ease;
    if (desired->speed_mps > 0.0 && !desired->shunts && kind->domain != DOMAIN_SEA &&
        kind->min_speed_mps <= 0.0) {
        double off = maths_cos(desired->heading_rad - m->row[i].heading);
        desired->speed_mps *= maths_clamp(off, SHARP_SHARE, 1.0);
    }
}
