/* Compares the climb that the ground ahead needs with the climb that an aeroplane has. */
#include "mover/agent/flight/terrain_following.h"

#include "mover/context/cruise_start.h"
#include "mover/motion/aircraft.h"
#include "mover/motion/airframe.h"
#include "world/entity/climb_limits.h"
#include "world/terrain/climb_ahead.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/square_bounds.h"
#include "world/world.h"

#define LOOKS       16   /* places at which it looks at the ground */
#define NEAR_S      0.6  /* between the first of them */
#define FAR_SHARE   0.2  /* and between later ones, of the time that they are ahead */
#define ROLLS_S     0.5  /* until its bank turns it */
#define CLEAR_SHARE 0.5  /* of the height that it wants, over the ground ahead */
#define STEEP_SHARE 0.35 /* of its speed: so fast it climbs and loses no speed that it needs */
#define CLIMB_SHARE 0.8  /* and of its kind's rate of climb */
#define LEVEL_LOAD  1.5  /* [share of its lift] that it needs while it turns */
#define LATER_SHARE 0.6  /* of the climb that it has: if it needs no more, it may climb later */

/* An aeroplane before a decision. */
struct climb_look {
    const struct square_bounds *tops; /* of all that stands on the ground */
    double x, y, z, up_mps, speed_mps;
    double heading_rad; /* of its motion */
    double clear_m;     /* over all that is ahead */
    double pull_mps2;   /* the least that ends a descent */
    double turn_rps;    /* the most while it climbs */
    double late_s;      /* until a decision turns it */
};

static struct climb_look begin(const struct step_context *context, uint32_t i,
                               const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const double think_s = context->dt_s * (double)cruise_start_think_frames(context, i);
    double speed = sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz);
    double load = maths_max(climb_limits_lift(kind, speed) / LEVEL_LOAD, 1.0);
    double turn = GRAVITY_MPS2 * sqrt(load * load - 1.0) / maths_max(speed, 1.0);
    return (struct climb_look){
        .tops = &context->line_of_sight->skyline,
        .x = m->row[i].x,
        .y = m->row[i].y + think_s * maths_min(m->row[i].vy, 0.0),
        .z = m->row[i].z,
        .up_mps = m->row[i].vy,
        .speed_mps = speed,
        .heading_rad = maths_heading(m->row[i].vx, m->row[i].vz),
        .clear_m = CLEAR_SHARE * desired->altitude_m,
        .pull_mps2 = climb_limits_pull(kind, speed),
        .turn_rps = maths_min(turn, kind->turn_rate_rps),
        .late_s = think_s + ROLLS_S,
    };
}

/* Returns the height [m] of all that stands in the gridsquare of a point. */
static double top_at(const struct climb_look *look, double x, double z)
{
    uint16_t bound = square_bounds_of(look->tops, gridsquare_of(&look->tops->squares, x, z));
    return SQUARE_BOUNDS_LOWEST_M + SQUARE_BOUNDS_HEIGHT_M * bound;
}

/* Returns the rate of climb [m/s] that is needed on the way that turns by off_rad, at a rate of
 * turn_rps at most. */
static double needed_climb(const struct climb_look *look, double off_rad, double turn_rps)
{
    double rate = -INFINITY, x = look->x, z = look->z, t = 0.0, sine, cosine;
    for (int n = 0; n < LOOKS; n++) {
        double step = maths_max(NEAR_S, FAR_SHARE * t);
        double turn = turn_rps * maths_max(t + 0.5 * step - look->late_s, 0.0);
        turn = maths_min(turn, fabs(off_rad));
        maths_sincos(look->heading_rad + (off_rad < 0.0 ? -turn : turn), &sine, &cosine);
        x += sine * look->speed_mps * step;
        z -= cosine * look->speed_mps * step;
        t += step;
        double even = (top_at(look, x, z) + look->clear_m - look->y) / t;
        double change = climb_ahead_change(look->up_mps, even, look->pull_mps2, t);
        rate = maths_max(rate, look->up_mps + change);
    }
    return rate;
}

/* Returns how far it turns [rad] to the first heading that needs no more than most_mps, or to the
 * one that needs least. *needed: of the desired one, off_rad; then of that. */
static double find_way(const struct climb_look *look, double off_rad, double most_mps,
                       double *needed)
{
    static const double turns[] = {0.0, 0.5, -0.5, 1.0, -1.0, 1.6, -1.6, 2.4, -2.4, PI};
    double best = off_rad;
    for (int n = 0; n < 10 && *needed > most_mps; n++) {
        double off = maths_wrap_half(off_rad + turns[n]);
        double rate = needed_climb(look, off, look->turn_rps);
        if (rate < *needed) {
            *needed = rate;
            best = off;
        }
    }
    return best;
}

/* An agent comes down no steeper than straight to over the next height, so that it need not climb
 * hard again, and has time to keep from others. A script's jet comes down to the height that its
 * author gives as soon as it can, and is too low to climb later. */
void terrain_following_steer(const struct step_context *context, uint32_t i, double highest_m,
                             struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const struct climb_look look = begin(context, i, desired);
    double most = maths_min(STEEP_SHARE * look.speed_mps, CLIMB_SHARE * kind->climb_rate_mps);
    double off = maths_wrap_half(desired->heading_rad - m->row[i].heading);
    double needed = needed_climb(&look, off, look.turn_rps), climb = needed;
    if (needed > most && !aircraft_turns_back(context, i)) {
        desired->heading_rad = m->row[i].heading + find_way(&look, off, most, &needed);
        climb = kind->climb_rate_mps;
    }
    bool low = m->row[i].behaviour == BEHAVIOUR_SCRIPT;
    if (low && climb <= 0.0)
        return;
    climb = maths_min(climb, kind->climb_rate_mps);
    double height = m->row[i].y - aircraft_ground(context, i) + climb / AIRCRAFT_FOLLOW_PS;
    if (!low && needed < LATER_SHARE * most)
        height = maths_min(height, highest_m);
    desired->altitude_m = maths_max(desired->altitude_m, height);
}

/* --- helicopters -------------------------------------------------------------------------------*/

#define HOVER_LATE_S 0.7  /* until its lean slows it down */
#define HOVER_BANK   0.8  /* slope of its steepest bank in a turn, which leaves it power to climb */
#define LEAST_BANK   0.2  /* and of the steepest where it is near the ground */
#define HOVER_M      40.0 /* it looks so far ahead even at rest */
#define HOVER_S      3.0  /* and in seconds, beyond the way in which it stops */
#define HOVER_LEAN   0.5  /* sine of the steepest lean */
#define HOVER_CLEAR  0.5  /* of the height that it wants, over the ground ahead */
#define HOVER_LEAST  0.25 /* the same, which it must have */
#define HOVER_SHARE  0.8  /* of its size, which it must have where it flies lower */
#define STANDS_MPS   1.0  /* so slowly it turns in place */
#define TURNS_SHARE  0.7  /* it turns when it can fly so much of its speed on the way of the turn */
#define TURN_RAD     0.1  /* a smaller turn leads over the same ground */

/* Returns the slope of the bank that the height over the ground leaves room for at its sides. */
static double bank_room(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double east, south, half = 0.5 * kind->width_m;
    double ground =
        terrain_base_plane(&context->world->terrain, m->row[i].x, m->row[i].z, &east, &south);
    double room = m->row[i].y + kind->low_m - ground - half * sqrt(east * east + south * south);
    return maths_clamp(room / half, LEAST_BANK, HOVER_BANK);
}

static struct climb_objects objects_of(const struct step_context *context)
{
    const struct world *world = context->world;
    return (struct climb_objects){
        .fixed = world->fixed,
        .reach_start = world->reach_start,
        .reach = world->reach,
        .kinds = world->kinds,
        .damage = context->committed->fixed_damage,
    };
}

static struct climb_ahead look_ahead(const struct step_context *context, uint32_t i,
                                     const struct desired_motion *desired, double bank)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const double think_s = context->dt_s * (double)cruise_start_think_frames(context, i);
    double speed = sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz);
    double tight = speed / maths_max(kind->turn_rate_rps, 0.01), brake = climb_limits_brake(kind);
    double body = maths_min(0.5 * HOVER_LEAN * kind->length_m - kind->low_m, desired->altitude_m);
    bool astern = desired->speed_mps < 0.0;
    return (struct climb_ahead){
        .tops = &context->line_of_sight->skyline,
        .at = entities_position(m, i),
        .up_mps = m->row[i].vy,
        .speed_mps = speed,
        .half_length_m = 0.5 * kind->length_m,
        .half_width_m = 0.5 * kind->width_m,
        .climb_mps = CLIMB_SHARE * kind->climb_rate_mps,
        .pull_mps2 = climb_limits_pull(kind, speed),
        .brake_mps2 = brake,
        .late_s = HOVER_LATE_S + think_s,
        .heading_rad = speed > STANDS_MPS ? maths_heading(m->row[i].vx, m->row[i].vz)
                                          : m->row[i].heading + (astern ? PI : 0.0),
        .radius_m = maths_max(maths_max(speed * speed / (bank * GRAVITY_MPS2), tight), 1.0),
        .length_m = speed * speed / (2.0 * brake) + HOVER_S * speed + HOVER_M,
        .clear_m = maths_max(HOVER_CLEAR * desired->altitude_m, body),
        .least_m = maths_max(HOVER_LEAST * desired->altitude_m, HOVER_SHARE * body),
    };
}

/* It rises over what is ahead, trees and buildings too, on the way that it has and on the one that
 * it turns to, and is no faster than it can. Where the turn leads over ground that is too high for
 * its speed it holds its heading and slows down first: the slower it is, the less way the turn
 * needs. */
void terrain_following_hover(const struct step_context *context, uint32_t i,
                             struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const struct terrain *terrain = &context->world->terrain;
    if (!(desired->altitude_m > 0.0)) /* it sets down */
        return;
    const double bank = bank_room(context, i);
    const struct climb_objects objects = objects_of(context);
    struct climb_ahead ahead = look_ahead(context, i, desired, bank);
    ahead.objects = &objects;
    double astern = desired->speed_mps < 0.0 ? PI : 0.0;
    struct climb_need need = climb_ahead_need(terrain, &ahead);
    ahead.off_rad = maths_wrap_half(desired->heading_rad + astern - ahead.heading_rad);
    if (fabs(ahead.off_rad) > TURN_RAD && desired->speed_mps != 0.0) {
        struct climb_need turned = climb_ahead_need(terrain, &ahead);
        need.climb_mps = maths_max(need.climb_mps, turned.climb_mps);
        need.speed_mps = maths_min(need.speed_mps, turned.speed_mps);
        if (turned.speed_mps < TURNS_SHARE * ahead.speed_mps && ahead.speed_mps > STANDS_MPS)
            desired->heading_rad = m->row[i].heading;
    }
    double turn = maths_wrap_half(desired->heading_rad - m->row[i].heading);
    double most = bank * GRAVITY_MPS2 * AIRFRAME_TURN_S / maths_max(ahead.speed_mps, STANDS_MPS);
    desired->heading_rad = m->row[i].heading + maths_clamp(turn, -most, most);
    desired->speed_mps = maths_clamp(desired->speed_mps, -need.speed_mps, need.speed_mps);
    if (need.climb_mps == -INFINITY) /* nothing is near */
        return;
    double climb = maths_min(need.climb_mps, kind->climb_rate_mps);
    double height = m->row[i].y - aircraft_ground(context, i) + climb / AIRCRAFT_FOLLOW_PS;
    desired->altitude_m = maths_max(desired->altitude_m, height);
}
