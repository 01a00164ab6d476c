/* The shell of a land vehicle on its springs: the points that the ground may touch besides the
 * wheels. Pure; any thread.
 *
 * A point is swept along its path within a sub-step. It touches where it comes through the ground,
 * by the normal there, so that neither a wall nor the rim of a crater gets into the shell at speed.
 * A wall is ground that rises more than the suspension's reach_m before a wheel: wheels do not
 * climb it (mover/motion/suspension.h), and the shell stands against it. */
#ifndef JOLON_MOVER_MOTION_CHASSIS_SHELL_H
#define JOLON_MOVER_MOTION_CHASSIS_SHELL_H

#include "mover/motion/ground_contacts.h"
#include "mover/motion/suspension.h"
#include "world/vehicle_shell.h"

/* Those of every shell (world/vehicle_shell.h), and on wheels four before the outer wheels, which
 * rise with them. */
#define CHASSIS_SHELL_POINTS 24u

struct chassis_shell {
    struct vec3 point[CHASSIS_SHELL_POINTS]; /* [m] body axes */
    uint32_t count;
};

/* What the ground does to a shell in a sub-step. */
struct chassis_shell_push {
    struct vec3 velocity_mps, spin_rps; /* pseudo-velocity out of the ground */
    double impulse_ns;                  /* along the normals; 0: no point bears anything */
    bool acts;                          /* a point bears something, or is deep in the ground */
    double hard_j;                      /* energy of the impact, if it is a hard one */
    double strike_j;                    /* the part of it that upright ground took */
};

/* Returns the tangent by which the slopes of the ground under a vehicle of this kind must differ
 * before underside, ends or sides of its shell get into it, where it stands in a single bend. */
double chassis_shell_bend(const struct kind *kind);

/* Finds the shell of a kind. Its underside is as high as the wheels can rise, and on wheels at
 * least 3/4 as high as the step that they climb. */
void chassis_shell_of(const struct kind *kind, const struct suspension *suspension,
                      struct chassis_shell *shell);

/* Moves the points before the outer wheels to where these wheels are in a sub-step. */
void chassis_shell_follow(struct chassis_shell *shell, const struct suspension *suspension);

/* Lets the ground act on the shell for dt_s: changes the body's velocity and spin. craters: those
 * that may be under the body, or NULL. */
struct chassis_shell_push chassis_shell_press(const struct chassis_shell *shell,
                                              const struct terrain *terrain,
                                              const struct crater_index *craters,
                                              const struct kind *kind, struct rigid_body *body,
                                              double dt_s);

#endif
