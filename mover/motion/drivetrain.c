/* Power-limited drive, brakes, engine braking, and the limits of steering. */
#include "mover/motion/drivetrain.h"

#include "mover/motion/kinematics.h"
#include "world/world.h"

#define GEARS_WHEELS 1.45
#define GEARS_TRACKS 1.16

#define REACTS_S     0.2  /* in which a difference of speed is made good, if forces allow */
#define LEAST_MPS    0.5  /* below it the drive force grows no more */
#define HARDEST      0.95 /* share of the grip that the brakes use */
#define ENGINE_BRAKE 0.5  /* share of the acceleration: slowing by a released throttle */
#define STANDS_MPS   0.3  /* a slower vehicle that is to stand is held by its brakes */
#define AIR_DRAG     0.48 /* [kg/m3] half the density of air times the drag of a box */
#define DRIVER_TURNS 1.5  /* [g] lateral acceleration at which a driver's wheel is fully turned */
#define STABLE       0.8  /* share of the overturning acceleration */
#define TURNS_MPS    1.0  /* slower wheels are steered as at this speed */

/* --- steering ----------------------------------------------------------------------------------*/

double drivetrain_lateral(const struct kind *kind, double friction)
{
    double overturns = 0.5 * kind->track_m / maths_max(kind->centre_height_m, 0.01);
    return GRAVITY_MPS2 * maths_min(friction, STABLE * overturns);
}

/* Turns to the right by this rate [rad/s], or along this curve [1/m], as far as the kind and the
 * lateral acceleration allow. */
static void turn_at(struct drivetrain *drivetrain, double rate_rps, double lateral_mps2,
                    double forward_mps)
{
    const struct kind *kind = drivetrain->kind;
    double speed = maths_max(fabs(forward_mps), TURNS_MPS);
    if (kind->tracked) {
        double most = lateral_mps2 / speed;
        drivetrain->yaw_rps = maths_clamp(rate_rps, -most, most);
        return;
    }
    double most =
        maths_min(1.0 / maths_max(kind->least_turn_m, 0.1), lateral_mps2 / (speed * speed));
    double curve = forward_mps < 0.0 ? -rate_rps / speed : rate_rps / speed;
    drivetrain->curve =
        drivetrain->driven ? drivetrain->wheel * most : maths_clamp(curve, -most, most);
}

void drivetrain_steer(struct drivetrain *drivetrain, double forward_mps, double friction,
                      double dt_s)
{
    const struct kind *kind = drivetrain->kind;
    if (!drivetrain->driven) {
        turn_at(drivetrain, drivetrain->asked_rps, drivetrain_lateral(kind, friction), forward_mps);
        return;
    }
    drivetrain->wheel =
        kinematics_approach(drivetrain->wheel, drivetrain->turn, DRIVETRAIN_WHEEL_PS * dt_s);
    turn_at(drivetrain, drivetrain->wheel * kind->turn_rate_rps, DRIVER_TURNS * GRAVITY_MPS2,
            forward_mps);
}

struct drivetrain drivetrain_of(const struct step_context *context, uint32_t i,
                                const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double most = kind->turn_rate_rps;
    double asked = desired->held
                       ? desired->turn * most
                       : maths_wrap_half(desired->heading_rad - m->row[i].heading) / context->dt_s;
    return (struct drivetrain){.kind = kind,
                               .wanted_mps = desired->speed_mps,
                               .slowing = desired->driven ? desired->brake : 1.0,
                               .hand_brake = desired->hand_brake,
                               .asked_rps = maths_clamp(asked, -most, most),
                               .turn = desired->turn,
                               .wheel = maths_clamp((double)m->row[i].dodge, -1.0, 1.0),
                               .driven = desired->driven,
                               .neutral = desired->gear == GEAR_NEUTRAL};
}

double drivetrain_gears(const struct kind *kind)
{
    return kind->tracked ? GEARS_TRACKS : GEARS_WHEELS;
}

double drivetrain_power(const struct kind *kind)
{
    return kind->power_w * (kind->tracked ? DRIVETRAIN_BY_TRACKS : DRIVETRAIN_BY_WHEELS);
}

/* --- forces ------------------------------------------------------------------------------------*/

/* Returns the drive force for a wanted speed that is higher; rise: of the way ahead. */
static double drive(const struct kind *kind, double speed, double wanted, double rise,
                    double rolling_n, double grip_n)
{
    double air = AIR_DRAG * kind->width_m * kind->height_m * speed * speed;
    double faster = maths_min((wanted - speed) / REACTS_S, kind->acceleration_mps2);
    double resists = kind->mass_kg * GRAVITY_MPS2 * rise + rolling_n + air;
    double power = drivetrain_power(kind) / maths_max(speed, LEAST_MPS);
    if (power > resists)
        power = resists + (power - resists) / drivetrain_gears(kind);
    return maths_clamp(kind->mass_kg * faster + resists, 0.0, maths_min(power, grip_n));
}

/* Returns how hard brakes and engine slow a vehicle that is faster than wanted [N]. The engine's
 * drag is a force of its own, which a steep slope may exceed. The rolling resistance adds to it. */
static double slow(const struct drivetrain *drivetrain, double speed, double wanted,
                   const struct drivetrain_ground *ground, double rise)
{
    const struct kind *kind = drivetrain->kind;
    double needed = kind->mass_kg * ((speed - wanted) / REACTS_S - GRAVITY_MPS2 * rise);
    double engine = ENGINE_BRAKE * kind->acceleration_mps2 * kind->mass_kg;
    double pedal = speed > kind->max_speed_mps ? 1.0 : drivetrain->slowing;
    double most = maths_min(engine, HARDEST * ground->grip_n);
    most += pedal * (HARDEST * ground->grip_n - most);
    return ground->rolling_n + maths_clamp(needed - ground->rolling_n, 0.0, most);
}

struct drivetrain_force drivetrain_force(const struct drivetrain *drivetrain, double forward_mps,
                                         const struct drivetrain_ground *ground)
{
    const struct kind *kind = drivetrain->kind;
    double rolling = ground->rolling_n, rise = ground->rise;
    double grip_n = ground->grip_n, wanted = drivetrain->wanted_mps;
    struct drivetrain_force force = {0.0, rolling};
    if (drivetrain->neutral) {
        force.brake_n = fabs(forward_mps) > kind->max_speed_mps
                            ? grip_n /* the driver does not let it roll faster */
                            : maths_min(grip_n, rolling + drivetrain->slowing * HARDEST * grip_n);
        return force;
    }
    double ahead = wanted != 0.0 ? (wanted < 0.0 ? -1.0 : 1.0) : (forward_mps < 0.0 ? -1.0 : 1.0);
    double speed = ahead * forward_mps;
    wanted *= ahead;
    if (speed < 0.0 || (wanted == 0.0 && speed < STANDS_MPS))
        force.brake_n = grip_n; /* it does not roll back */
    else if (wanted < speed)
        force.brake_n = maths_min(grip_n, slow(drivetrain, speed, wanted, ground, ahead * rise));
    if (wanted > speed && speed > -STANDS_MPS)
        force.drive_n =
            ahead * drive(kind, maths_max(speed, 0.0), wanted, ahead * rise, rolling, grip_n);
    return force;
}
