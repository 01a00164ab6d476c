/* The entities that a receiver of the topic MotionBatch knows: of each row what it was told last.
 * Belongs to one thread; does not block. */
#ifndef JOLON_IPC_TOPICS_MOTION_MIRROR_H
#define JOLON_IPC_TOPICS_MOTION_MIRROR_H

#include "status.h"

#include <stdbool.h>

struct motion_mirror_row {
    jolon_Entity entity; /* as it was told; state ENTITY_FREE: the row is empty */
    jolon_Course course;
    double told_s;  /* simulation time of that */
    uint32_t whole; /* the number of the whole batch of which it was a part last */
};

struct motion_mirror {
    uint64_t writer, taken; /* who tells, and the number of its last sample among all; 0: free */
    struct motion_mirror_row *row; /* [room] */
    uint32_t room, used;
    uint32_t count; /* rows that are not empty */
    uint64_t run, frame;
    double time_s;
    bool known;           /* a whole batch has come; from then on all entities are here */
    uint32_t whole;       /* number of the last whole batch */
    uint32_t whole_parts; /* that are still to come of it */
};

/* What each writer tells is kept apart, so that one who tells what is false leaves nothing behind.
 * Of more writers the one that was silent for longest is forgotten, until its next whole batch. */
#define MOTION_MIRRORS 4u

struct motion_mirrors {
    struct motion_mirror of[MOTION_MIRRORS];
    uint64_t taken; /* samples */
};

void motion_mirrors_close(struct motion_mirrors *mirrors);

/* Returns the mirror for a sample of this writer, which is any number but 0. */
struct motion_mirror *motion_mirrors_for(struct motion_mirrors *mirrors, uint64_t writer);

void motion_mirror_close(struct motion_mirror *mirror);

/* Takes a sample that samples_good() has passed. Returns true if all entities are known, and all
 * parts of this batch have come. */
bool motion_mirror_take(struct motion_mirror *mirror, const jolon_MotionBatch *batch);

/* Writes where each entity is in the frame of the last sample. entity: [mirror->count]. */
void motion_mirror_entities(const struct motion_mirror *mirror, jolon_Entity *entity);

#endif
