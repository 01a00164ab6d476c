/* The motions that receivers know: of each row what they were told last, by which they compute
 * where it is. A row is told again when that is no longer near enough, as by the dead reckoning of
 * DIS. A vehicle that stands or goes straight on is not told again for as long as it does.
 *
 * Belongs to one thread; does not block. */
#ifndef JOLON_IPC_FRAME_MOTION_TABLE_H
#define JOLON_IPC_FRAME_MOTION_TABLE_H

#include "ipc/frame/snapshot.h"
#include "world/entity/told_motion.h"

/* A row is told again when receivers have it so far off, or its speed. */
#define MOTION_TABLE_OFF_M   0.25
#define MOTION_TABLE_OFF_MPS 0.25
#define MOTION_TABLE_OFF_RAD 0.035 /* also turret and gun */

/* Shares of a full tank, of the throttle and of the engine's power. */
#define MOTION_TABLE_OFF_SHARE 0.02

/* What receivers see of a row beside its motion. */
struct motion_marks {
    uint64_t driver;
    uint32_t target, rounds, reload_tick;
    float turret, gun, fuel_l, throttle, spool;
    uint16_t kind;
    uint8_t state, force, behaviour, damage, gear, grounded, pull_up;
};

struct motion_told {
    struct told_motion motion; /* from the tick on, in which the row was told last */
    uint64_t tick;
    uint64_t next_frame; /* the frame after it, 0: never */
    double row_x, row_z; /* its columns then: as long as they stay, it does what was told */
    uint32_t row_tick;
    uint32_t id; /* with marks.state ENTITY_FREE: of the entity that left the row */
    struct motion_marks marks;
};

struct motion_table {
    struct motion_told *told; /* [capacity] */
    uint32_t capacity;
    uint32_t used;        /* rows that were ever told */
    uint64_t from_frame;  /* of the first snapshot since the table was made or cleared */
    uint64_t frame, tick; /* of the last one */
    uint32_t count;       /* rows that were told with it */
};

/* Makes an empty table. Returns 0, or -1 without memory. */
int motion_table_init(struct motion_table *table, uint32_t capacity);
void motion_table_free(struct motion_table *table);

/* Forgets what was told: the next update tells all rows. */
void motion_table_clear(struct motion_table *table);

/* Tells the rows of a snapshot that need it. The snapshot is as snapshot_take() left it, without
 * poses. */
void motion_table_update(struct motion_table *table, const struct world *world,
                         struct snapshot *snapshot);

/* Returns true if the row was told with the snapshot of this frame or a later one: its entity's
 * motion, or with marks.state ENTITY_FREE that it left. */
static inline bool motion_table_told(const struct motion_table *table, uint32_t row, uint64_t frame)
{
    return table->told[row].next_frame > frame;
}

#endif
