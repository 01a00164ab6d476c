/* The picture: what the monitor knows of a world, taken from its topics.
 *
 * Everything comes over DDS, so that a monitor works as well from another machine. A world that is
 * not there, goes, or comes back is a state of the picture, not an error. */
#ifndef JOLON_MONITOR_PICTURE_H
#define JOLON_MONITOR_PICTURE_H

#include "reporter/dds_topics.h"

#include "status.h"

#include <stdbool.h>

#define PICTURE_ROLES_MAX 16u
#define PICTURE_KINDS_MAX 64u

/* No FrameStatus for this long: the reporter is gone or stopped. Ten come a second. */
#define PICTURE_SILENCE_NS 1500000000u

enum picture_reader {
    PICTURE_WORLD,
    PICTURE_PROCESS,
    PICTURE_FRAME,
    PICTURE_ENTITIES,
    PICTURE_READERS
};

struct picture {
    dds_entity_t reader[PICTURE_READERS];
    dds_entity_t waitset;
    const char *name; /* of the world, as asked for */

    bool has_world;
    jolon_WorldInfo world; /* its sequence points into kinds */
    jolon_KindInfo kinds[PICTURE_KINDS_MAX];

    uint64_t frame_ns; /* CLOCK_MONOTONIC when frame came, 0: none yet */
    jolon_FrameStatus frame;

    uint32_t role_count;
    jolon_ProcessStatus role[PICTURE_ROLES_MAX];

    /* The last whole batch, and the one of which parts are still to come. */
    struct picture_batch {
        jolon_Entity *entity;
        uint32_t count, room;
        uint64_t run, frame;
        uint32_t parts_left;
    } batch, coming;
    bool has_batch;
};

/* Makes the readers; -1 with the reason. */
int picture_open(struct picture *picture, const struct dds_link *link, const char *world,
                 struct reason *reason);
void picture_close(struct picture *picture);

/* Takes what has come. Does not block. */
void picture_take(struct picture *picture);

/* Waits for something to take, at most until_ns (CLOCK_MONOTONIC). */
void picture_wait(const struct picture *picture, uint64_t until_ns);

/* Does the world speak now? */
bool picture_live(const struct picture *picture, uint64_t now_ns);

/* Is there one of everything: world, frame, processes, entities? */
bool picture_whole(const struct picture *picture);

/* "?" when the world did not name it. */
const char *picture_kind_name(const struct picture *picture, uint32_t kind);

/* The words of ipc/status.idl's states; of the run also what follows from silence: "waiting" when
 * nothing ever came, "silent" when it stopped. */
const char *picture_process_state(jolon_ProcessState state);
const char *picture_run_state(const struct picture *picture, uint64_t now_ns);

#endif
