/* Shots: a new munition, its dispersion, and the alarm of its target. */
#ifndef JOLON_MOVER_WEAPON_FIRE_H
#define JOLON_MOVER_WEAPON_FIRE_H

#include "mover/context/serial_context.h"
#include "mover/weapon/firing_arc.h"
#include "world/maths/random.h"

/* Standard error of a howitzer's round along its range, as a share of the range: a probable error
 * of 0.4 %. Across the range it is the munition's dispersion. */
#define FIRE_RANGE_ERROR 0.0059

#define FIRE_AFAR_M 10000.0 /* distance of a battery that is off the map */

/* By how much a shell errs. */
struct fire_error {
    double range; /* as a share of the range */
    double azimuth_rad;
};

/* A shell of a howitzer. */
struct fire_shell {
    const struct firing_arc_solution *solution;
    struct fire_error mean; /* of all rounds of the mission */
    uint16_t munition;
    uint8_t fuze; /* enum fuze */
};

/* A shell of a battery that is off the map. */
struct fire_afar {
    struct vec3 point;
    double bearing_rad;     /* from the point to the battery */
    double left_s;          /* from now to the impact */
    struct fire_error mean; /* of all rounds of the mission */
    bool errs;              /* false: the shell flies exactly to the point */
    bool high;              /* along the higher arc */
    uint16_t munition;
    uint8_t fuze, force;
};

/* Row shooter fires at row target, or straight ahead for SLOT_NONE. munition KIND_NONE: its kind's
 * own. False, with nothing changed, when it has no munition or the frame has no room for an entity
 * or an event. */
bool fire_shoot(struct serial_context *context, uint32_t shooter, uint32_t target,
                uint16_t munition);

/* The same at a point on the ground. An aircraft releases what is dropped at once, wherever the
 * point is. A howitzer's shell flies along the lower arc; false also when the point is out of its
 * range. */
bool fire_shoot_at(struct serial_context *context, uint32_t shooter, double x, double z,
                   uint16_t munition);

/* Returns a random number with standard deviation 1, of an entity in this frame. */
double fire_normal(const struct serial_context *context, uint32_t entity,
                   enum random_purpose purpose);

/* Finds the firing data for a point. Returns false if it is out of range. */
bool fire_solve(const struct step_context *step, struct vec3 muzzle, uint16_t munition,
                struct vec3 point, bool high, struct firing_arc_solution *solution);

/* Row shooter fires a shell along its solution. error: out, by how much it errs. False as above. */
bool fire_shell(struct serial_context *context, uint32_t shooter, const struct fire_shell *shell,
                struct fire_error *error);

/* The same for a single shell at a point [m, world]. False also when it is out of range. */
bool fire_shell_at(struct serial_context *context, uint32_t shooter, struct vec3 point,
                   uint16_t munition, bool high, uint8_t fuze);

/* A shell from off the map appears on its arc. False as above. */
bool fire_from_afar(struct serial_context *context, const struct fire_afar *afar,
                    struct fire_error *error);

/* A munition of this kind falls from the sky onto (x, z). */
bool fire_drop_bomb(struct serial_context *context, uint16_t munition, double x, double z);

#endif
