/* Contacts between the points of a rigid body and the ground, for one sub-step of its motion. Pure;
 * any thread. */
#ifndef JOLON_MOVER_MOTION_GROUND_CONTACTS_H
#define JOLON_MOVER_MOTION_GROUND_CONTACTS_H

#include "mover/motion/rigid_body.h"
#include "world/body_points.h"

/* Most contacts of a body. Of more points near the ground the nearest ones count. */
#define GROUND_CONTACTS_MAX 64u

/* A depth that stays, so that a body at rest keeps its contacts [m]. */
#define GROUND_CONTACTS_SLOP_M 0.002

enum { CONTACT_NORMAL, CONTACT_ALONG, CONTACT_ACROSS, CONTACT_AXES };

struct ground_contact {
    double gap_m;                    /* along the normal; negative: a depth */
    double friction;                 /* coefficient; the body's, unless the caller changes it */
    struct vec3 arm;                 /* [m, world axes] from the centre of mass */
    struct vec3 axis[CONTACT_AXES];  /* unit: the normal of the ground and two tangents */
    struct vec3 lever[CONTACT_AXES]; /* [m] arm x axis */
    struct vec3 twist[CONTACT_AXES]; /* [1/(kg m)] change of spin by a unit impulse */
    double mass_kg[CONTACT_AXES];    /* impulse for a unit change of speed at the point */
    double impulse_ns[CONTACT_AXES]; /* so far */
    double closing_mps;              /* before the contacts act */
    double least_mps;                /* speed along the normal that it must leave with */
    double push_kgmps;               /* impulse of the pseudo-velocity so far [N s] */
};

struct ground_contacts {
    uint32_t count;
    double friction;     /* Coulomb's coefficient of the kind on the ground */
    double restitution;  /* of a slow impact */
    double plough_s2pm2; /* by which ploughing adds the square of the speed to the friction */
    struct ground_contact contact[GROUND_CONTACTS_MAX];
};

/* Sets the friction and the restitution of a kind on the ground; no contacts. */
void ground_contacts_begin(struct ground_contacts *contacts, const struct kind *kind);

/* Makes the body a field of pieces, which do not bounce and plough more. */
void ground_contacts_break(struct ground_contacts *contacts);

/* Finds the points that can reach the ground within dt_s at the body's velocity and spin. */
void ground_contacts_find(struct ground_contacts *contacts, const struct step_context *context,
                          const struct body_points *points, const struct rigid_body *body,
                          double dt_s);

/* Adds the contact of a point with ground of this normal (unit, n.y > 0). arm: from the centre of
 * mass, in world axes. inverse: of the body's inertia, in world axes. A full list drops the contact
 * with the greatest gap. */
void ground_contacts_add(struct ground_contacts *contacts, const struct rigid_body *body,
                         const struct mat3 *inverse, struct vec3 arm, struct vec3 normal,
                         double gap_m);

/* Changes velocity and spin so that no point goes through the ground within dt_s: impulses along
 * the normals, friction, restitution. Returns the sum of the impulses along the normals [N s]; 0:
 * the body does not touch the ground. */
double ground_contacts_solve(struct ground_contacts *contacts, struct rigid_body *body,
                             double dt_s);

/* Returns the energy that the ground has taken from the body along its normals in the last solution
 * [J]. */
double ground_contacts_taken(const struct ground_contacts *contacts, const struct rigid_body *body);

/* Returns true if the ground that bears the body is steeper than the friction of its kind holds. */
bool ground_contacts_too_steep(const struct ground_contacts *contacts);

/* Slows a body that ploughs through the soil under this sum of impulses. */
void ground_contacts_plough(struct ground_contacts *contacts, struct rigid_body *body,
                            double impulse_ns);

/* Slows the spin by the resistance of soil against rolling. */
void ground_contacts_roll(const struct ground_contacts *contacts, struct rigid_body *body);

/* Finds the pseudo-velocity and pseudo-spin that bring points out of the ground. They displace the
 * body and do not become its velocity and spin. */
void ground_contacts_push(struct ground_contacts *contacts, const struct rigid_body *body,
                          double dt_s, struct vec3 *velocity_mps, struct vec3 *spin_rps);

/* Returns the share of a pseudo-spin, 0..1, that beside this pseudo-velocity brings no point deeper
 * that is in the ground. */
double ground_contacts_twist_share(const struct ground_contacts *contacts, struct vec3 velocity_mps,
                                   struct vec3 spin_rps);

/* Returns the greatest depth of a point that was found [m]. */
double ground_contacts_depth(const struct ground_contacts *contacts);

#endif
