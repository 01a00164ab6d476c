/* Where a vehicle that cruises is on the ground. Pure; any thread. */
#ifndef JOLON_WORLD_CRUISE_POSE_H
#define JOLON_WORLD_CRUISE_POSE_H

#include "world/entity/told_motion.h"
#include "world/entity/table_write.h"
#include "world/maths/maths.h"

#include <stdint.h>

struct crater_index;
struct world;

struct cruise_pose {
    struct vec3 at;                          /* [m] */
    double heading_rad, pitch_rad, roll_rad; /* as the fields of an entity */
};

/* Returns how row i stands at the tick: as its fields say unless it cruises then. craters: of the
 * committed world, or NULL for none. */
struct cruise_pose cruise_pose_of(const struct world *world, const struct crater_index *craters,
                                  const struct entities *e, uint32_t i, uint64_t tick);

/* Returns how row i moves from the tick on: as it cruises then, else straight on. At the end of its
 * stretch it is where its fields say; between, a land vehicle is up to some decimetres off the
 * ground. */
struct told_motion cruise_pose_motion(const struct world *world, const struct crater_index *craters,
                                      const struct entities *e, uint32_t i, uint64_t tick);

/* Ends the stretch of row i at the tick, if it cruises then: its fields say from now on where it
 * is at that tick, and what fuel it has by then. now: the tick of the frame, at most `tick`.
 * Returns true if it did. */
bool cruise_pose_end(const struct table_writer *writer, const struct world *world,
                     const struct crater_index *craters, uint32_t i, uint64_t tick, uint64_t now);

/* Ends the stretches of all rows of a frame that nobody else has: its fields then say where they
 * are. The frame is no longer what its checksum is of. world->params are those under which the
 * stretches began. */
void cruise_pose_settle(const struct entities *own, const struct world *world,
                        const struct crater_index *craters, uint32_t used, uint64_t tick);

/* Does the same for row i alone. */
void cruise_pose_settle_row(const struct entities *own, const struct world *world,
                            const struct crater_index *craters, uint32_t i, uint64_t tick);

#endif
