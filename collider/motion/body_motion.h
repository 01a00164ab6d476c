/* How the bodies move within the frame: each row's path and its rotation along it. Rows rotate from
 * the committed pose to the mover's until the response to a contact changes it: freely, by the
 * committed spin, if that is what the mover did, else the shorter way. The collider's own
 * memory; one thread changes it, any number may read between changes. */
#ifndef JOLON_COLLIDER_MOTION_BODY_MOTION_H
#define JOLON_COLLIDER_MOTION_BODY_MOTION_H

#include "collider/geometry/time_of_impact.h"
#include "world/entity/cruise.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/maths/rotation.h"
#include "world/state.h"
#include "world/world.h"

#include <stdatomic.h>
#include <stdint.h>

/* Rotations at path.since and at 1. */
struct rotation_path {
    struct quat from, to;
    struct free_turn turn; /* how the body gets there; without steps the shorter way */
    double driven_rps;     /* about the vertical, added to the row's own spin: by its driver and its
                              tyres */
};

/* The rotation of three angles. */
struct known_pose {
    double angle[3]; /* heading, pitch and roll [rad] */
    struct quat turn;
    uint64_t known; /* 1: it has been computed */
};

/* A body is near to a line along its heading: on the map all of it is within beside_m of what leads
 * from behind_m behind its position to ahead_m before it, however it leans, while its gun points
 * ahead. beside_m is INFINITY where bodies are spheres. */
struct body_axis {
    double behind_m, ahead_m, beside_m;
};

struct body_motion {
    const struct world *world;
    const struct state *committed;
    const struct state *next;
    const struct crater_index *craters;
    /* The committed rows. In a world in which rows cruise those whose path has been computed:
     * copies whose place and angles are where the row was when the frame began. */
    struct entities before;
    bool models;                   /* bodies collide by their models, not as spheres */
    struct path *path;             /* [capacity] of the rows whose path has been computed */
    uint8_t *computed;             /* [capacity] 1: its path has been computed */
    _Atomic uint8_t *known;        /* [words] 1: computed or fall of one of its 64 rows is set */
    struct rotation_path *changed; /* rotations that responses changed */
    uint32_t changes;
    uint32_t *change; /* [capacity] index + 1 into changed; 0: rotates as the mover has it */
    uint32_t *row;    /* [changes] the row of each changed rotation */
    /* [capacity] the turn about the vertical by which resting contacts part a row from what it
     * overlaps [rad/s]. It is part of its path, but no motion that an impact can take. */
    double *parting_rps;
    uint8_t *fall; /* [capacity] whether a row falls freely (collider/motion/free_fall.h); 0: not
                      known yet */
    /* [2 * capacity] of each row in both world buffers, kept from frame to frame. The angles are
     * compared, so that it saves work and changes no result. */
    struct known_pose *pose;
    struct entity *begins;                 /* [capacity] such copies */
    struct body_axis axis[KIND_COUNT_MAX]; /* of each kind */
};

/* Returns 0, or -1 with errno ENOMEM. */
int body_motion_init(struct body_motion *motion, const struct world *world);
void body_motion_free(struct body_motion *motion);

/* Takes the memory for this many rows before a step needs it. */
void body_motion_touch(const struct body_motion *motion, uint32_t rows);

/* Begins a frame: no path of next's rows in use has been computed. craters: of the committed
 * world. */
void body_motion_begin(struct body_motion *motion, const struct state *committed,
                       const struct state *next, const struct crater_index *craters);

/* Computes the row's path from its committed position to its position in next. A row that is new in
 * this frame does not move. Any thread, for different rows. Most paths are never needed, so each is
 * computed on its first use; this must be before next's row changes. */
void body_motion_compute(struct body_motion *motion, uint32_t row);

/* Returns the same path without storing it. */
struct path body_motion_path(const struct body_motion *motion, uint32_t row);

/* A line on the map that a body stays near to: its centre within around_m. left_s: of a stretch. */
struct body_line {
    struct vec3 from, to;
    double around_m, left_s;
};

/* Returns the line from where a row that cruises in this frame is when it begins to the end of its
 * stretch. */
struct body_line body_motion_line(const struct body_motion *motion, uint32_t row);

/* Return the line that all of the row's body stays near to, not just its centre: it is longer at
 * both ends by the body's axis, and as wide as what is beside that, instead of as all of its reach
 * reach_m. Of a row that cruises in this frame until a tick of its stretch; of one that does not
 * from the begin of the frame to its end; of one that stands where it is in next. What does not
 * point along its line is within all of its reach of it. */
struct body_line body_motion_line_around(const struct body_motion *motion, uint32_t row,
                                         uint64_t tick, double reach_m);
struct body_line body_motion_frame_line(const struct body_motion *motion, uint32_t row,
                                        double reach_m);
struct body_line body_motion_standing_line(const struct body_motion *motion, uint32_t row,
                                           double reach_m);

/* Returns a path for the box around what is left of the stretch of a row that cruises in this
 * frame: it begins where the frame does, and its heights hold those of the ground between. */
struct path body_motion_stretch(const struct body_motion *motion, uint32_t row);

/* Notes that computed or fall of the row is set in this frame. Any thread. */
static inline void body_motion_note_known(const struct body_motion *motion, uint32_t row)
{
    atomic_store_explicit(&motion->known[row / 64], 1, memory_order_relaxed);
}

/* Computes the row's path if that has not been done yet. */
static inline void body_motion_require(struct body_motion *motion, uint32_t row)
{
    if (!motion->computed[row])
        body_motion_compute(motion, row);
}

/* Returns true if the row holds the same entity as in the committed frame. */
static inline bool body_motion_old(const struct body_motion *motion, uint32_t row)
{
    return row < motion->committed->head->used &&
           motion->committed->entities.row[row].id == motion->next->entities.row[row].id;
}

/* Returns the table in which a row whose path has been computed begins the frame: a body that is
 * new in this frame has no committed row. */
static inline const struct entities *body_motion_before(const struct body_motion *motion,
                                                        uint32_t row)
{
    return body_motion_old(motion, row) ? &motion->before : &motion->next->entities;
}

/* The same for what does not change while a row cruises: velocity, spin, gun, flags. Of any row. */
static inline const struct entities *body_motion_committed(const struct body_motion *motion,
                                                           uint32_t row)
{
    return body_motion_old(motion, row) ? &motion->committed->entities : &motion->next->entities;
}

/* Returns true if the row cruises in this frame (world/entity/cruise.h): its fields in next do not
 * say where it is. */
static inline bool body_motion_cruises(const struct body_motion *motion, uint32_t row)
{
    return cruise_goes(&motion->next->entities, row, motion->next->head->tick - 1);
}

/* Returns true if the mover rotated the row. */
static inline bool body_motion_rotated(const struct body_motion *motion, uint32_t row)
{
    const struct entities *w = &motion->committed->entities, *n = &motion->next->entities;
    return body_motion_old(motion, row) &&
           (cruise_goes(w, row, motion->committed->head->tick) ||
            w->row[row].heading != n->row[row].heading || w->row[row].pitch != n->row[row].pitch ||
            w->row[row].roll != n->row[row].roll);
}

/* Returns true if the mover turned the row's turret or raised its gun, and these collide on their
 * own. */
static inline bool body_motion_aimed(const struct body_motion *motion, uint32_t row)
{
    const struct entities *w = &motion->committed->entities, *n = &motion->next->entities;
    return body_motion_old(motion, row) &&
           (w->row[row].turret != n->row[row].turret || w->row[row].gun != n->row[row].gun) &&
           motion->world->kinds[n->row[row].kind].part_count > 0;
}

/* Returns true if the mover moved or rotated the row, and not only its turret or its gun.
 * Spheres do not rotate. Computes its path. */
static inline bool body_motion_moves(struct body_motion *motion, uint32_t row)
{
    body_motion_require(motion, row);
    const struct vec3 along = motion->path[row].along;
    return along.x != 0.0 || along.y != 0.0 || along.z != 0.0 ||
           (motion->models && body_motion_rotated(motion, row));
}

/* Returns true if a row whose path has no length still moves because its shape rotates, or a part
 * of it. */
static inline bool body_motion_rotates(const struct body_motion *motion, uint32_t row)
{
    return motion->models && (body_motion_rotated(motion, row) || body_motion_aimed(motion, row));
}

/* Keeps the rotations of the row at both ends of the frame, so that what follows does not compute
 * them from their angles again. Any thread, for different rows. */
void body_motion_note_poses(struct body_motion *motion, uint32_t row);

struct rotation_path body_motion_rotation(const struct body_motion *motion, uint32_t row);

/* Returns what is left of the row's rotation at a time in [path.since, 1]. */
struct rotation_path body_motion_rotation_from(const struct body_motion *motion, uint32_t row,
                                               double time);

/* Returns the row's rotation at a time in [path.since, 1]. */
struct quat body_motion_orientation(const struct body_motion *motion, uint32_t row, double time);

/* Gives the row another path and rotation. */
void body_motion_change(struct body_motion *motion, uint32_t row, const struct path *path,
                        const struct rotation_path *rotation);

/* Return the row, and a fixed object, as bodies for the narrow phase. A row that spins freely
 * points to *turn, which holds how. Turret and gun point as in the committed frame: they turn when
 * all bodies have moved (collider/guard/turret_guard.h). */
struct swept_body body_motion_body(const struct body_motion *motion, uint32_t row,
                                   struct free_turn *turn);
struct swept_body body_motion_fixed(const struct world *world, uint32_t object);

/* Puts the row into *body, which lasts: what is not read of a body whose turret and gun are at rest
 * (where these parts begin) stays as it was. A body is large, and such a row is put in each frame.
 */
void body_motion_put(const struct body_motion *motion, uint32_t row, struct free_turn *turn,
                     struct swept_body *body);

/* Returns one side of a pair: a row, or a fixed object with PAIR_FIXED. */
struct swept_body body_motion_side(const struct body_motion *motion, uint32_t side,
                                   struct free_turn *turn);

/* Returns one side of a pair as it stands in a table, at rest. Turret and gun point as in the
 * committed frame. */
struct swept_body body_motion_standing(const struct body_motion *motion,
                                       const struct entities *entities, uint32_t side);

/* Puts a row as it stands in a table into *body, as body_motion_put() does. */
void body_motion_put_standing(const struct body_motion *motion, const struct entities *entities,
                              uint32_t row, struct swept_body *body);

/* Makes turret and gun of the row's body point and turn like this [rad]. Those of a kind without a
 * turret stay as they are. */
void body_motion_aim(const struct body_motion *motion, uint32_t row, double turret, double gun,
                     double turret_turn, double gun_turn, struct swept_body *body);

#endif
