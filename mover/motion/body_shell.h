/* The shell of a vehicle on its wheels: the points of its body that the ground may touch. The
 * underside is as high as the wheels can rise. Pure; any thread. */
#ifndef JOLON_MOVER_MOTION_BODY_SHELL_H
#define JOLON_MOVER_MOTION_BODY_SHELL_H

#include "mover/motion/ground_contacts.h"

/* Four points each of the underside, of the ends and of the roof. */
#define BODY_SHELL_POINTS 12u

struct body_shell {
    struct vec3 point[BODY_SHELL_POINTS]; /* [m] body axes */
    double reach_m;
};

/* Finds the shell of a kind. */
void body_shell_of(const struct kind *kind, struct body_shell *shell);

/* What the ground does to a shell in a sub-step. */
struct body_shell_push {
    struct vec3 velocity_mps, spin_rps; /* pseudo-velocity out of the ground */
    double impulse_ns;                  /* along the normals; 0: the shell does not touch */
    double hard_j;                      /* energy of the impact, if it is a hard one */
};

/* Lets the shell act on the ground: changes the body's velocity and spin. */
struct body_shell_push body_shell_touch(const struct body_shell *shell,
                                        const struct step_context *context, const struct kind *kind,
                                        struct rigid_body *body, double dt_s);

#endif
