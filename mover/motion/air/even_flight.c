/* Finds the even motion of a stretch, and whether it may be flown. */
#include "mover/motion/air/even_flight.h"

#include "mover/motion/aircraft.h"
#include "mover/motion/airframe.h"
#include "mover/motion/kinematics.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/square_bounds.h"
#include "world/world.h"

#define PIECE_S      0.5   /* between two looks at the ground */
#define AHEAD_S      3.0   /* it looks so far beyond the end, as agents do for others */
#define TURN_RAD     0.3   /* it turns by no more */
#define LEAN_RAD     0.2   /* its bank and its pitch change by no more */
#define GAIN_MPS2    5.0   /* it gains or loses speed no faster */
#define CLIMB_MPS2   3.0   /* its climb changes no faster */
#define CLIMB_SHARE  0.8   /* of its kind's rate of climb, on which it relies */
#define STEEP_SHARE  0.35  /* of its speed, the same of an aeroplane */
#define SLIP_MPS     0.01  /* it slips sideways no faster */
#define SAME_MPS     0.05  /* a gain so small waits while it turns */
#define SAME_RAD     0.005 /* and a turn so small while it gains speed */
#define WANTED_SHARE 0.75  /* of its height, that it keeps over all ground ahead if it can */
#define LEAST_SHARE  0.5   /* and if it cannot, the stretch is refused */
#define OVER_M       3.0   /* from the body to the ground, and more than the rim of any crater */
#define EDGE_M       200.0 /* near the edge of the world an aircraft is told so in each frame */
#define IDLE_SHARE   0.2   /* of the fuel at full speed: it burns no less */
#define BESIDE_M     8.0   /* between the bodies of two aircraft that do not come near */
#define SPREAD       0.15  /* how far courses stray, as a share of the way until they meet */
#define FAR_M        150.0 /* aircraft that are further above or below are in nobody's way */

/* An aircraft and its stretch. */
struct even_flight {
    const struct step_context *context;
    const struct kind *kind;
    double time_s;
    struct vec3 from;
    double heading_rad, speed_mps, up_mps; /* when it begins */
    double turned_rad, gain_mps2, climb_mps2;
};

static bool is_aeroplane(const struct kind *kind)
{
    return kind->min_speed_mps > 0.0;
}

/* Returns the radius of a sphere about its position that contains its body. */
static double body_m(const struct kind *kind)
{
    return maths_max(kind->bound_m, kind->radius_m);
}

/* Returns where it is after so many seconds. After the stretch it goes straight on. */
static struct vec3 place_at(const struct even_flight *f, double t)
{
    const double in_s = maths_min(t, f->time_s), beyond_s = t - in_s;
    const double arc_m = (f->speed_mps + 0.5 * f->gain_mps2 * in_s) * in_s;
    const double way_m = (f->speed_mps + f->gain_mps2 * f->time_s) * beyond_s;
    double sine, cosine;
    struct vec3 at = cruise_end(f->from, f->heading_rad, f->turned_rad * in_s / f->time_s, arc_m);
    maths_sincos(f->heading_rad + f->turned_rad, &sine, &cosine);
    at.x += way_m * sine;
    at.y += f->up_mps * t + f->climb_mps2 * in_s * (t - 0.5 * in_s);
    at.z -= way_m * cosine;
    return at;
}

/* The ground without its craters: so the slopes of the gridsquares hold. */
static double ground_at(const struct even_flight *f, struct vec3 at)
{
    return terrain_height(&f->context->world->terrain, NULL, at.x, at.z);
}

/* --- speed and turn ----------------------------------------------------------------------------*/

/* Returns how much speed [m/s2] its engine lets it gain when it begins. */
static double most_gain(const struct even_flight *f)
{
    const f64x4 none = SIMD_EVERY(0.0), one = SIMD_EVERY(1.0), speed = SIMD_EVERY(f->speed_mps);
    struct airframe airframe = {.stall_mps = SIMD_EVERY(f->kind->min_speed_mps),
                                .full_mps = SIMD_EVERY(f->kind->max_speed_mps),
                                .thrust_mps2 = SIMD_EVERY(f->kind->acceleration_mps2),
                                .climb_mps = SIMD_EVERY(f->kind->climb_rate_mps),
                                .forward_mps = speed,
                                .up_mps = SIMD_EVERY(f->up_mps),
                                .wanted_mps = SIMD_EVERY(INFINITY),
                                .weight_mps2 = SIMD_EVERY(GRAVITY_MPS2),
                                .spool = one,
                                .power = one};
    f64x4 low = none, high = airframe.thrust_mps2, through;
    if (is_aeroplane(f->kind)) {
        airframe_push(&airframe, &speed, f->time_s, &high);
        return high[0];
    }
    airframe_inflow(&airframe, &through);
    through = SIMD_EVERY(sqrt(through[0]));
    airframe_power(&airframe, &through);
    airframe_hasten(&airframe, &low, &high);
    return high[0];
}

/* Returns true if the way of a part of the stretch is part of its way, and it turns little. */
static bool turn_and_gain(struct even_flight *f, const struct desired_motion *desired)
{
    const double full = f->kind->max_speed_mps;
    const double least = maths_min(AIRFRAME_SAFE * f->kind->min_speed_mps, full);
    const double off = maths_clamp(desired->speed_mps, least, full) - f->speed_mps;
    f->turned_rad = desired->turn * f->kind->turn_rate_rps * f->time_s;
    f->gain_mps2 = maths_clamp(off / maths_max(f->time_s, AIRFRAME_HOVER_S), -GAIN_MPS2,
                               maths_min(GAIN_MPS2, most_gain(f)));
    if (cruise_off(f->turned_rad / f->time_s, f->gain_mps2, f->time_s) > CRUISE_OFF_M) {
        if (fabs(f->gain_mps2) * f->time_s < SAME_MPS)
            f->gain_mps2 = 0.0;
        else if (fabs(f->turned_rad) < SAME_RAD)
            f->turned_rad = 0.0;
        else
            return false;
    }
    return fabs(f->turned_rad) <= TURN_RAD;
}

/* --- climb -------------------------------------------------------------------------------------*/

/* Returns the least change of climb [m/s2] with which it is so high over all ground ahead. */
static double change_over(const struct even_flight *f, double height_m)
{
    const uint32_t looks = (uint32_t)((f->time_s + AHEAD_S) / PIECE_S + 0.5);
    double least = -INFINITY;
    for (uint32_t n = 1; n <= looks; n++) {
        const double t = PIECE_S * n, in_s = maths_min(t, f->time_s);
        const double level_m = f->from.y + f->up_mps * t;
        const double ground = ground_at(f, place_at(f, t));
        least = maths_max(least, (ground + height_m - level_m) / (in_s * (t - 0.5 * in_s)));
    }
    return least;
}

/* Returns the change [m/s2] to the climb that the motion of a frame would want at the end, where it
 * is higher or lower by the change. */
static double change_to_height(const struct even_flight *f, double height_m)
{
    const double follow_s = 1.0 / AIRCRAFT_FOLLOW_PS, time_s = f->time_s;
    const double ground =
        maths_max(ground_at(f, place_at(f, time_s)), ground_at(f, place_at(f, time_s + AHEAD_S)));
    const double off_m = ground + height_m - f->from.y - f->up_mps * time_s;
    return (off_m - f->up_mps * follow_s) / (time_s * (0.5 * time_s + follow_s));
}

/* Returns the change [m/s2] to the climb that the motion of a frame wants now. */
static double change_asked(const struct even_flight *f, uint32_t i, double height_m)
{
    const double off_m = aircraft_ground(f->context, i) + height_m - f->from.y;
    const double most = f->kind->climb_rate_mps;
    return (maths_clamp(off_m * AIRCRAFT_FOLLOW_PS, -most, most) - f->up_mps) / f->time_s;
}

/* Chooses the climb. An agent that wants another height than usual keeps from others by it, or
 * climbs over what is further ahead: it has its climb, or the stretch is refused. */
static bool climb(struct even_flight *f, uint32_t i, const struct desired_motion *desired)
{
    const double height = desired->altitude_m, way = (double)f->context->m->row[i].climb;
    const double over = maths_min(height, f->kind->cruise_altitude_m);
    const double rate = f->kind->climb_rate_mps;
    double most = CLIMB_SHARE * rate;
    if (is_aeroplane(f->kind))
        most = maths_min(most, STEEP_SHARE * f->speed_mps);
    const double low = maths_max((-rate - f->up_mps) / f->time_s, -CLIMB_MPS2);
    const double high = maths_max(maths_min((most - f->up_mps) / f->time_s, CLIMB_MPS2), low);
    const double asked = way != 0.0 ? change_asked(f, i, height) : 0.0;
    double change = maths_max(change_to_height(f, height), change_over(f, WANTED_SHARE * over));
    if (way > 0.0)
        change = maths_max(change, asked);
    f->climb_mps2 = maths_clamp(change, low, high);
    return (way <= 0.0 || asked <= high) && (way >= 0.0 || asked >= low) &&
           change_over(f, LEAST_SHARE * over) <= high;
}

/* --- room --------------------------------------------------------------------------------------*/

/* Returns the steepest slope of the ground in the squares of the box; INFINITY if one has none. */
static double slope_within(const struct even_flight *f, struct gridsquare_box box)
{
    const struct square_bounds *slopes = f->context->slopes;
    uint16_t most = 0;
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint16_t bound =
                square_bounds_of(slopes, gridsquare_index(&slopes->squares, column, row));
            most = bound > most ? bound : most;
        }
    }
    return most == SQUARE_BOUNDS_NONE ? INFINITY : SQUARE_BOUNDS_SLOPE_STEP * most;
}

/* Returns true if the body stays OVER_M over the ground on a piece of its way: of the ground
 * between two points no more is over their middle than the steepest slope makes of half the way. Or
 * it is over all that stands in these squares. */
static bool is_over(const struct even_flight *f, struct vec3 a, struct vec3 b)
{
    const double bound_m = body_m(f->kind), dx = b.x - a.x, dz = b.z - a.z;
    const struct gridsquare_box box =
        gridsquare_box_of(&f->context->world->terrain.squares, maths_min(a.x, b.x) - bound_m,
                          maths_min(a.z, b.z) - bound_m, maths_max(a.x, b.x) + bound_m,
                          maths_max(a.z, b.z) + bound_m);
    const double slope = slope_within(f, box),
                 sag_m = PIECE_S * PIECE_S * fabs(f->climb_mps2) / 8.0;
    const double low_m = maths_min(a.y, b.y) - sag_m - OVER_M;
    const double way_m = slope * sqrt(dx * dx + dz * dz);
    if (low_m - bound_m * sqrt(1.0 + slope * slope) >
        0.5 * (ground_at(f, a) + ground_at(f, b) + way_m))
        return true;
    return square_bounds_within(&f->context->line_of_sight->skyline, box,
                                square_bounds_below_height(low_m - bound_m));
}

static bool stays_over_ground(const struct even_flight *f)
{
    struct vec3 before = f->from;
    for (uint32_t n = 1; PIECE_S * (n - 1) < f->time_s; n++) {
        const struct vec3 at = place_at(f, maths_min(PIECE_S * n, f->time_s));
        if (!is_over(f, before, at))
            return false;
        before = at;
    }
    return true;
}

/* Returns how far a place is from the nearest edge of the world [m]. */
static double inside_m(const struct even_flight *f, struct vec3 at)
{
    const double side_m = f->context->world->terrain.squares.world_m;
    return maths_min(maths_min(at.x, at.z), side_m - maths_max(at.x, at.z));
}

/* Returns true if it does not end near an edge of the world, or flies away from the edge. */
static bool keeps_inside(const struct even_flight *f, struct vec3 end)
{
    return inside_m(f, end) >= EDGE_M || inside_m(f, end) > inside_m(f, f->from);
}

/* --- the row -----------------------------------------------------------------------------------*/

/* Returns the fuel that it burns [l]. */
static double burnt(const struct even_flight *f, const struct desired_motion *desired)
{
    double share = fabs(desired->speed_mps) / maths_max(f->kind->max_speed_mps, 1e-9);
    return f->kind->fuel_l > 0.0
               ? f->kind->fuel_lps * maths_clamp(share, IDLE_SHARE, 1.0) * f->time_s
               : 0.0;
}

/* Finds what bank and pitch change by. A helicopter leans to gain speed and against its drag. */
static void find_lean(const struct even_flight *f, uint32_t i, struct cruise_changes *changes)
{
    const struct entities *m = f->context->m;
    const double speed = f->speed_mps + f->gain_mps2 * f->time_s;
    const double share = speed / maths_max(f->kind->max_speed_mps, 1.0);
    const double path = (f->up_mps + changes->climbed_mps) / maths_max(speed, 1.0);
    const double tilt = AIRFRAME_DRAG_SLOPE * share * fabs(share) + f->gain_mps2 / GRAVITY_MPS2;
    changes->pitched_rad = maths_atan2(is_aeroplane(f->kind) ? path : -tilt, 1.0) - m->row[i].pitch;
    changes->rolled_rad =
        maths_atan2(f->turned_rad / f->time_s * speed, GRAVITY_MPS2) - m->row[i].roll;
}

static void write_row(const struct even_flight *f, uint32_t i, const struct cruise_changes *changes)
{
    struct entities *m = f->context->m;
    const double speed = f->speed_mps + f->gain_mps2 * f->time_s;
    double sine, cosine;
    kinematics_cruise(f->context, i, changes);
    entities_set_position(m, i, place_at(f, f->time_s));
    m->row[i].heading = maths_wrap_turn(m->row[i].heading + f->turned_rad);
    maths_sincos(m->row[i].heading, &sine, &cosine);
    entities_set_velocity(
        m, i, (struct vec3){speed * sine, f->up_mps + changes->climbed_mps, -speed * cosine});
    m->row[i].pitch += changes->pitched_rad;
    m->row[i].roll += changes->rolled_rad;
}

bool even_flight_begin(const struct step_context *context, uint32_t i,
                       const struct desired_motion *desired, uint32_t frames)
{
    struct entities *m = context->m;
    struct even_flight f = {.context = context,
                            .kind = &context->world->kinds[m->row[i].kind],
                            .time_s = context->dt_s * (double)frames,
                            .from = entities_position(m, i),
                            .heading_rad = m->row[i].heading,
                            .up_mps = m->row[i].vy};
    double sine, cosine, rightward;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    kinematics_along(m, i, sine, cosine, &f.speed_mps, &rightward);
    const double fuel = burnt(&f, desired);
    if (fabs(rightward) > SLIP_MPS || (fuel > 0.0 && m->row[i].fuel_l <= fuel) ||
        aircraft_turns_back(context, i) || !turn_and_gain(&f, desired) || !climb(&f, i, desired))
        return false;
    struct cruise_changes changes = {.frames = frames,
                                     .turned_rad = f.turned_rad,
                                     .gain_mps2 = f.gain_mps2,
                                     .climbed_mps = f.climb_mps2 * f.time_s};
    find_lean(&f, i, &changes);
    if (fabs(changes.pitched_rad) > LEAN_RAD || fabs(changes.rolled_rad) > LEAN_RAD ||
        !keeps_inside(&f, place_at(&f, f.time_s)) || !stays_over_ground(&f))
        return false;
    m->row[i].fuel_l -= fuel;
    write_row(&f, i, &changes);
    return true;
}

/* --- other aircraft ----------------------------------------------------------------------------*/

/* Returns the time [s], at most most_s, until row i may come near another aircraft if both go
 * straight on. */
static double free_of(const struct step_context *context, uint32_t i, uint32_t other, double most_s)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    const struct kind *kinds = context->world->kinds;
    const struct vec3 off =
        vec3_sub(step_context_position(context, w, other), entities_position(m, i));
    const struct vec3 nears =
        vec3_sub(step_context_velocity(context, w, other), entities_velocity(m, i));
    const double beside =
        body_m(&kinds[m->row[i].kind]) + body_m(&kinds[w->row[other].kind]) + BESIDE_M;
    const double spread = SPREAD * sqrt(nears.x * nears.x + nears.z * nears.z);
    if (fabs(off.y) > FAR_M)
        return most_s;
    for (uint32_t n = 0; PIECE_S * n < most_s; n++) {
        const double t = PIECE_S * n;
        double x = off.x + nears.x * t, z = off.z + nears.z * t;
        double near_m = beside + spread * maths_max(t, PIECE_S);
        if (x * x + z * z < near_m * near_m)
            return maths_max(t - PIECE_S, 0.0);
    }
    return most_s;
}

#define FOUND_TOGETHER 16u

/* Aircraft whose rows have been asked for, and are read together when they have come. */
struct found {
    uint32_t row[FOUND_TOGETHER], count;
};

static double free_of_all(const struct step_context *context, uint32_t i, struct found *found,
                          double free_s, double most_s)
{
    for (uint32_t n = 0; n < found->count; n++)
        free_s = maths_min(free_s, free_of(context, i, found->row[n], most_s));
    found->count = 0;
    return free_s;
}

/* The index holds another one where its stretch ends. */
uint32_t even_flight_frames(const struct step_context *context, uint32_t i, uint32_t frames)
{
    const struct entities *m = context->m;
    const double most_s = context->dt_s * (double)frames + AHEAD_S;
    const double ends_s = context->dt_s * (double)context->cruise_frames;
    const double fastest_mps = context->world->kinds[m->row[i].kind].max_speed_mps;
    const struct neighbour_index_entry *at;
    struct found found = {.count = 0};
    double free_s = most_s;
    if (frames <= context->cruise_short || frames <= context->think_frames)
        return frames;
    struct neighbour_query query =
        neighbour_query_begin(context->neighbours, NEIGHBOUR_INDEX_LIVING, m->row[i].x, m->row[i].z,
                              (2.0 * most_s + ends_s) * fastest_mps);
    while ((at = neighbour_query_next(&query)) != NULL) {
        if (at->row == i || context->world->kinds[at->kind].domain != DOMAIN_AIR)
            continue;
        entity_prefetch_pose(&context->committed->entities.row[at->row]);
        found.row[found.count++] = at->row;
        if (found.count == FOUND_TOGETHER)
            free_s = free_of_all(context, i, &found, free_s, most_s);
    }
    free_s = free_of_all(context, i, &found, free_s, most_s);
    const uint32_t least = context->think_frames > context->cruise_short ? context->think_frames
                                                                         : context->cruise_short;
    const double left = (free_s - AHEAD_S) / context->dt_s;
    if (free_s >= most_s)
        return frames;
    return left > (double)least ? (uint32_t)left : least;
}
