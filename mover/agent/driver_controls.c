/* From the controls of a driven vehicle to its desired motion. */
#include "mover/agent/driver_controls.h"

#include "world/world.h"

#define REVERSE_SHARE 0.4  /* of full speed, backwards */
#define LOW_SHARE     0.35 /* of full speed, in low gear */
#define ASTERN_SHARE  0.5  /* of full speed, ships backwards */
#define STALL_SHARE   0.3  /* of the stalling speed that the air brake takes */
#define FULL_THRUST   0.25 /* throttle from which an aeroplane's engine may give all its thrust */
#define HOVER_BACK    0.25 /* of full speed, helicopters backwards */

/* The speed [m/s] for a throttle. full: the kind's top speed; back: the share of it backwards. */
static double geared(enum gearing gear, double throttle, double full, double back)
{
    switch (gear) {
    case GEAR_REVERSE: /* a negative throttle has no effect */
        return -back * full * maths_max(throttle, 0.0);
    case GEAR_NEUTRAL:
        return 0.0;
    case GEAR_LOW:
        full *= LOW_SHARE;
        break;
    default:
        break;
    }
    return full * (throttle < 0.0 ? back * throttle : throttle);
}

/* The throttle of a helicopter is its speed, forwards or backwards. That of a jet is its speed
 * above that at which it stalls. Below FULL_THRUST it also limits the thrust, and at 0 there is
 * none: the jet glides. With the air brake it stalls. */
static double airspeed(const struct kind *kind, double throttle, double brake)
{
    throttle *= 1.0 - brake;
    if (kind->min_speed_mps > 0.0)
        return kind->min_speed_mps * (1.0 - STALL_SHARE * brake) +
               maths_max(throttle, 0.0) * (kind->max_speed_mps - kind->min_speed_mps);
    return kind->max_speed_mps * (throttle < 0.0 ? HOVER_BACK * throttle : throttle);
}

void driver_controls_motion(const struct step_context *context, uint32_t i,
                            struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double throttle = (double)m->row[i].throttle, brake = (double)m->row[i].brake;
    enum gearing gear = entity_gear(m->row[i].flags);
    *desired = (struct desired_motion){
        .heading_rad = m->row[i].heading,
        .driven = true,
        .gear = kind->domain == DOMAIN_AIR ? GEAR_AUTOMATIC : gear,
        .turn = (double)m->row[i].steer,
        .climb_mps = (double)m->row[i].climb * kind->climb_rate_mps,
        .brake = brake,
        .hand_brake = kind->domain == DOMAIN_LAND ? maths_max(0.0, (double)m->row[i].climb) : 0.0,
    };
    /* The brake overrides the throttle. */
    if (kind->domain == DOMAIN_AIR) {
        desired->speed_mps = airspeed(kind, throttle, brake);
        desired->power = maths_clamp(throttle * (1.0 - brake) / FULL_THRUST, 0.0, 1.0);
    } else {
        desired->speed_mps = geared(gear, throttle * (1.0 - brake), kind->max_speed_mps,
                                    kind->domain == DOMAIN_SEA ? ASTERN_SHARE : REVERSE_SHARE);
    }
}

void driver_controls_release(const struct entities *m, uint32_t i)
{
    m->row[i].throttle = m->row[i].steer = m->row[i].climb = 0.0f;
    m->row[i].traverse = m->row[i].elevate = m->row[i].brake = 0.0f;
    m->row[i].dodge = 0.0f; /* the front wheels, or the engine */
    m->row[i].flags &= (uint8_t)~ENTITY_GEAR_MASK;
    m->row[i].driver = 0;
}
