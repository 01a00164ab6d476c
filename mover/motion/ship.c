/* Moves ships. */
#include "mover/motion/ship.h"

#include "mover/context/ground_strike.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define KEEL_DRAG_MPS2 2.0 /* brakes a sideways slide */

/* A hull that runs ashore digs in: the friction is this share of its weight. The same hull rests on
 * the shore with a small share of its weight for each length that is ashore, and that much friction
 * holds it when it backs off. */
#define SHORE_DRAG    0.7
#define BORNE_SHARE   0.1
#define SHORE_HARM    1.0 /* of the energy that the shore takes */
#define HARMLESS_MPS  0.5
#define ASHORE_STEP_M 1.0

/* Of the rudder and of the heading that an agent wants [s]; of the speed [s]. */
#define RUDDER_S  4.0 /* from amidships to hard over, and until the ship turns so */
#define HEADING_S 6.0
#define SPEED_S   2.0

#define HEEL_RAD     0.07 /* 4 degrees, at top speed and full rudder */
#define ASTERN_SHARE 0.7  /* of full thrust, with the screws astern */
#define TURN_DRAG    1.8  /* of full rudder, in multiples of the drag: 39 % of the speed is lost */
#define STILL_DRAG   0.05 /* share of the drag that grows with the speed, not with its square */
#define STOPPED_MPS  1e-3

/* Heading and speeds along and across it. */
struct course {
    double sine, cosine;       /* of the heading */
    double forward, rightward; /* [m/s] */
};

/* --- the shore ---------------------------------------------------------------------------------*/

static bool is_land(const struct step_context *context, double x, double z)
{
    return world_holds(context->world, x, z) &&
           !cover_is_water(terrain_cover(&context->world->terrain, x, z));
}

/* What the ends of the hull are on. */
struct grounding {
    double bow_m, stern_m;   /* length of the hull that is ashore there */
    bool bow_out, stern_out; /* beyond the edge of the world */
};

/* Returns the length of the hull that is ashore at an end. sign: 1 for the bow, -1 for the stern.
 */
static double ashore(const struct step_context *context, const struct kind *kind,
                     const struct course *course, struct vec3 at, double sign)
{
    double length = 0.0;
    while (length < kind->length_m) {
        double way = sign * (0.5 * kind->length_m - length);
        if (!is_land(context, at.x + course->sine * way, at.z - course->cosine * way))
            break;
        length += ASHORE_STEP_M;
    }
    return maths_min(length, kind->length_m);
}

static struct grounding find_grounding(const struct step_context *context, const struct kind *kind,
                                       const struct course *course, struct vec3 at)
{
    double x = 0.5 * kind->length_m * course->sine, z = -0.5 * kind->length_m * course->cosine;
    return (struct grounding){
        .bow_m = ashore(context, kind, course, at, 1.0),
        .stern_m = ashore(context, kind, course, at, -1.0),
        .bow_out = !world_holds(context->world, at.x + x, at.z + z),
        .stern_out = !world_holds(context->world, at.x - x, at.z - z),
    };
}

/* Friction [m/s2] of the shore against a motion along the heading, ahead or astern. */
static double friction_of(const struct kind *kind, const struct grounding *grounding, bool ahead)
{
    double ashore_m = grounding->bow_m + grounding->stern_m;
    bool deeper = ahead ? grounding->bow_m > 0.0 || grounding->bow_out
                        : grounding->stern_m > 0.0 || grounding->stern_out;
    double share = deeper ? 1.0 : BORNE_SHARE * ashore_m / maths_max(kind->length_m, 1.0);
    return SHORE_DRAG * GRAVITY_MPS2 * share;
}

/* Lets the shore slow the ship, and adds what its hull suffers to harm_j. */
static void scrape(const struct step_context *context, uint32_t i, struct course *course,
                   const struct grounding *grounding)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    double step = friction_of(kind, grounding, course->forward >= 0.0) * context->dt_s;
    double before = course->forward * course->forward + course->rightward * course->rightward;
    course->forward = kinematics_approach(course->forward, 0.0, step);
    if (grounding->bow_m + grounding->stern_m <= 0.0)
        return; /* the edge of the world does no harm */
    course->rightward =
        kinematics_approach(course->rightward, 0.0, SHORE_DRAG * GRAVITY_MPS2 * context->dt_s);
    double after = course->forward * course->forward + course->rightward * course->rightward;
    if (before > HARMLESS_MPS * HARMLESS_MPS)
        context->m->row[i].harm_j += 0.5 * SHORE_HARM * kind->mass_kg * (before - after);
}

/* Notes whether the shore holds the ship. Returns true if a field beside its motion has changed.
 */
static bool set_aground(const struct step_context *context, uint32_t i, bool aground)
{
    struct entities *m = context->m;
    bool was = (m->row[i].flags & ENTITY_FLAG_AGROUND) != 0;
    if (aground && !was) {
        m->row[i].flags |= ENTITY_FLAG_AGROUND;
        m->row[i].trigger = TRIGGER_AGROUND;
    } else if (!aground && was) {
        m->row[i].flags &= (uint8_t)~ENTITY_FLAG_AGROUND;
    }
    return aground || was;
}

/* Moves the ship by its course. The shore slows it meanwhile. */
static struct ship_moved advance(const struct step_context *context, uint32_t i,
                                 struct course *course)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    struct grounding grounding = find_grounding(context, kind, course, entities_position(m, i));
    bool aground = grounding.bow_m + grounding.stern_m > 0.0;
    if (aground || grounding.bow_out || grounding.stern_out)
        scrape(context, i, course, &grounding);
    m->row[i].vx = course->forward * course->sine + course->rightward * course->cosine;
    m->row[i].vz = -course->forward * course->cosine + course->rightward * course->sine;
    kinematics_advance(context, &m->row[i].x, &m->row[i].vx);
    kinematics_advance(context, &m->row[i].z, &m->row[i].vz);
    /* a post in water has the height of its surface */
    m->row[i].y = kinematics_ground(context, m->row[i].x, m->row[i].z);
    m->row[i].vy = 0.0;
    bool ahead = course->forward >= 0.0;
    return (struct ship_moved){
        .blocked = ahead ? grounding.bow_m > 0.0 || grounding.bow_out
                         : grounding.stern_m > 0.0 || grounding.stern_out,
        .touched = set_aground(context, i, aground),
    };
}

/* --- rudder and screws -------------------------------------------------------------------------*/

/* The effect of the rudder, 0..1: it grows with the speed. The screws turn a ship that lies. */
static double rudder_effect(const struct kind *kind, double forward)
{
    return maths_clamp(fabs(forward) / maths_max(kind->max_speed_mps, 1e-9), 0.15, 1.0);
}

/* The rudder, -1..1, right above 0, as the heel shows it. */
static double rudder_of(double roll, double effect)
{
    return maths_clamp(-roll / (HEEL_RAD * effect * effect), -1.0, 1.0);
}

/* The rudder that the helmsman wants. */
static double helm(const struct kind *kind, const struct desired_motion *desired, double heading,
                   double effect)
{
    if (desired->driven)
        return desired->turn;
    double rate = desired->held ? desired->turn * kind->turn_rate_rps
                                : maths_wrap_half(desired->heading_rad - heading) / HEADING_S;
    return maths_clamp(rate / maths_max(kind->turn_rate_rps * effect, 1e-9), -1.0, 1.0);
}

/* Moves the rudder and turns. The ship heels out of its turn. Returns the rudder. */
static double steer(const struct step_context *context, uint32_t i,
                    const struct desired_motion *desired, struct course *course)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double effect = rudder_effect(kind, course->forward);
    double wanted = helm(kind, desired, m->row[i].heading, effect);
    double rudder =
        kinematics_approach(rudder_of(m->row[i].roll, effect), wanted, context->dt_s / RUDDER_S);
    m->row[i].roll = -rudder * HEEL_RAD * effect * effect;
    if (rudder != 0.0 && !(m->row[i].flags & ENTITY_FLAG_AGROUND)) {
        double turned = rudder * effect * kind->turn_rate_rps * context->dt_s;
        m->row[i].heading = maths_wrap_turn(m->row[i].heading + turned);
        maths_sincos(m->row[i].heading, &course->sine, &course->cosine);
    }
    return rudder;
}

/* Drag [m/s2] along the heading: full thrust at top speed; a turn adds to it. */
static double drag_of(const struct kind *kind, double forward, double rudder)
{
    double share = forward / maths_max(kind->max_speed_mps, 1e-9);
    double turning = 1.0 + TURN_DRAG * rudder * rudder;
    return kind->acceleration_mps2 *
           (STILL_DRAG * share + (1.0 - STILL_DRAG) * turning * share * fabs(share));
}

/* Returns the acceleration of the screws. A driver who takes the throttle back lets the ship run;
 * it slows by drag alone unless he brakes, with the screws astern. */
static double screws(const struct kind *kind, const struct desired_motion *desired, double wanted,
                     double forward, double drag)
{
    double full = kind->acceleration_mps2, back = ASTERN_SHARE * full;
    double need = (wanted - forward) / SPEED_S + drag;
    bool runs = desired->driven && wanted * forward >= 0.0 && fabs(wanted) < fabs(forward);
    double against = runs ? desired->brake * back : back;
    if (forward < 0.0)
        return maths_clamp(need, -back, runs ? desired->brake * full : full);
    return maths_clamp(need, -against, full);
}

static void sail(const struct step_context *context, uint32_t i,
                 const struct desired_motion *desired, struct course *course)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    double full = kind->max_speed_mps;
    double rudder = steer(context, i, desired, course);
    double drag = drag_of(kind, course->forward, rudder);
    double wanted = maths_clamp(desired->speed_mps, -0.5 * full, full), thrust = 0.0;
    if (kinematics_burn(context, i, fabs(wanted) / maths_max(full, 1e-9)))
        thrust = screws(kind, desired, wanted, course->forward, drag);
    course->forward += (thrust - drag) * context->dt_s;
    if (fabs(course->forward - wanted) < STOPPED_MPS)
        course->forward = wanted;
    course->rightward = kinematics_approach(course->rightward, 0.0, KEEL_DRAG_MPS2 * context->dt_s);
}

static struct course course_of(const struct step_context *context, uint32_t i)
{
    struct course course;
    maths_sincos(context->m->row[i].heading, &course.sine, &course.cosine);
    kinematics_along(context->m, i, course.sine, course.cosine, &course.forward, &course.rightward);
    return course;
}

struct ship_moved ship_move(const struct step_context *context, uint32_t i,
                            const struct desired_motion *desired)
{
    struct course course = course_of(context, i);
    sail(context, i, desired, &course);
    context->m->row[i].pitch = 0.0;
    return advance(context, i, &course);
}

/* --- stretches ---------------------------------------------------------------------------------*/

/* A stretch is refused whose motion is not that of many frames: its end shows how even it is. */
#define STRETCH_TURN_RAD 0.3  /* it turns by no more */
#define STRETCH_GAIN_MPS 1.5  /* and gains or loses no more speed */
#define STRETCH_HEEL_RAD 0.03 /* its heel changes by no more, at once */
#define STRETCH_RISE_M   0.01 /* and the water's height */
#define STRETCH_SLIP_MPS 0.01 /* it slips sideways no faster */

/* What a stretch changes and a refusal gives back. */
struct ship_row {
    double x, y, z, vx, vy, vz, heading, pitch, roll, fuel_l, harm_j;
    uint8_t flags, trigger;
};

static struct ship_row row_of(const struct entities *m, uint32_t i)
{
    return (struct ship_row){m->row[i].x,      m->row[i].y,      m->row[i].z,       m->row[i].vx,
                             m->row[i].vy,     m->row[i].vz,     m->row[i].heading, m->row[i].pitch,
                             m->row[i].roll,   m->row[i].fuel_l, m->row[i].harm_j,  m->row[i].flags,
                             m->row[i].trigger};
}

static void give_back(struct entities *m, uint32_t i, const struct ship_row *row)
{
    entities_set_position(m, i, (struct vec3){row->x, row->y, row->z});
    entities_set_velocity(m, i, (struct vec3){row->vx, row->vy, row->vz});
    m->row[i].heading = row->heading;
    m->row[i].pitch = row->pitch;
    m->row[i].roll = row->roll;
    m->row[i].fuel_l = row->fuel_l;
    m->row[i].harm_j = row->harm_j;
    m->row[i].flags = row->flags;
    m->row[i].trigger = row->trigger;
}

/* Replaces the position by that at the end of an arc on which the speed changes evenly, and notes
 * the stretch. Returns true if the way is even and on the water. */
static bool end_arc(const struct step_context *context, uint32_t i, const struct ship_row *row,
                    const struct course *before, uint32_t frames)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const struct course after = course_of(context, i);
    double turned = maths_wrap_half(m->row[i].heading - row->heading);
    double gain_mps = after.forward - before->forward, time_s = context->dt_s * frames;
    const struct vec3 from = {row->x, m->row[i].y, row->z};
    entities_set_position(
        m, i, cruise_end(from, row->heading, turned, (before->forward + 0.5 * gain_mps) * time_s));
    kinematics_cruise(context, i,
                      &(struct cruise_changes){
                          .frames = frames, .turned_rad = turned, .gain_mps2 = gain_mps / time_s});
    struct grounding end = find_grounding(context, kind, &after, entities_position(m, i));
    return fabs(turned) <= STRETCH_TURN_RAD && fabs(gain_mps) <= STRETCH_GAIN_MPS &&
           fabs(m->row[i].roll - row->roll) <= STRETCH_HEEL_RAD &&
           fabs(m->row[i].y - row->y) <= STRETCH_RISE_M &&
           fabs(before->rightward) <= STRETCH_SLIP_MPS && !end.bow_out && !end.stern_out &&
           end.bow_m + end.stern_m <= 0.0;
}

bool ship_stretch(const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired, uint32_t frames)
{
    struct step_context longer = *context; /* one frame as long as the stretch */
    struct entities *m = context->m;
    const struct ship_row row = row_of(m, i);
    const struct course before = course_of(context, i);
    longer.dt_s = context->dt_s * frames;
    struct ship_moved moved = ship_move(&longer, i, desired);
    if (!moved.blocked && !moved.touched && end_arc(context, i, &row, &before, frames))
        return true;
    give_back(m, i, &row);
    m->row[i].cruise_tick = 0;
    return false;
}

bool ship_hold(const struct step_context *context, uint32_t i)
{
    struct course course = course_of(context, i);
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    struct grounding grounding =
        find_grounding(context, kind, &course, entities_position(context->m, i));
    bool aground = grounding.bow_m + grounding.stern_m > 0.0;
    if (aground) {
        scrape(context, i, &course, &grounding);
        context->m->row[i].vx = course.forward * course.sine + course.rightward * course.cosine;
        context->m->row[i].vz = -course.forward * course.cosine + course.rightward * course.sine;
    }
    return set_aground(context, i, aground);
}

void ship_tell_aground(struct serial_context *context, uint32_t i)
{
    const struct step_context *step = context->step;
    const struct entities *m = step->m;
    struct vec3 before = entities_velocity(&step->committed->entities, i);
    double sine, cosine, speed = vec3_length(before);
    maths_sincos(m->row[i].heading, &sine, &cosine);
    double end = before.x * sine - before.z * cosine < 0.0 ? -0.5 : 0.5;
    end *= step->world->kinds[m->row[i].kind].length_m;
    struct vec3 at = {m->row[i].x + end * sine, m->row[i].y, m->row[i].z - end * cosine};
    struct vec3 ahead = speed > 0.0 ? vec3_scale(before, 1.0 / speed) : (struct vec3){0};
    (void)ground_strike_tell(context, i, at, ahead, RESPONSE_STOP);
}
