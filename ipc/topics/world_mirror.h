/* The mirror: what a program without shared memory knows of a world, taken from its topics.
 *
 * Everything comes over DDS, so that a monitor works as well from another machine. A world that is
 * not there, goes, or comes back is a state of the mirror, not an error. */
#ifndef JOLON_IPC_TOPICS_WORLD_MIRROR_H
#define JOLON_IPC_TOPICS_WORLD_MIRROR_H

#include "ipc/topics/dds_topics.h"
#include "ipc/topics/names_reader.h"

#include "status.h"

#include <stdbool.h>

#define WORLD_MIRROR_ROLES_MAX 16u
#define WORLD_MIRROR_KINDS_MAX 64u
#define WORLD_MIRROR_PARTS_MAX 1024u /* of a batch; a reporter's largest has 128 */

/* No FrameStatus for this long: the reporter is gone or stopped. Ten come a second. */
#define WORLD_MIRROR_SILENCE_NS 1500000000u

/* How often the mirror looks whether whoever described the world is still there. */
#define WORLD_MIRROR_LOOK_NS 1000000000u

enum world_mirror_reader {
    WORLD_MIRROR_WORLD,
    WORLD_MIRROR_PROCESS,
    WORLD_MIRROR_FRAME,
    WORLD_MIRROR_ENTITIES,
    WORLD_MIRROR_READERS
};

struct world_mirror {
    const struct dds_link *link; /* the caller's */
    dds_entity_t reader[WORLD_MIRROR_READERS];
    int readers; /* the first of them; the entities' is the last */
    dds_entity_t waitset;
    struct names_reader names_reader;
    const char *name; /* of the world, as asked for */

    bool has_world;
    jolon_WorldInfo world; /* its sequence points into kinds */
    jolon_KindInfo kinds[WORLD_MIRROR_KINDS_MAX];
    struct name_table names; /* of its vehicles */
    dds_instance_handle_t world_writer;
    uint64_t looked_ns;

    uint64_t frame_ns; /* CLOCK_MONOTONIC when frame came, 0: none yet */
    jolon_FrameStatus frame;

    uint32_t role_count;
    jolon_ProcessStatus role[WORLD_MIRROR_ROLES_MAX];

    /* The last whole batch, and the one of which parts are still to come. */
    struct world_mirror_batch {
        jolon_Entity *entity;
        uint32_t count, room;
        uint64_t run, frame;
        uint32_t parts_left;
        bool part[WORLD_MIRROR_PARTS_MAX]; /* it is in */
    } batch, coming;
    bool has_batch;
};

/* Makes the readers on the link, which must outlive the mirror, that of the entities, which are
 * most of what comes, only where they are wanted; -1 with the reason. */
int world_mirror_open(struct world_mirror *mirror, const struct dds_link *link, const char *world,
                      bool entities, struct error_text *error);
void world_mirror_close(struct world_mirror *mirror);

/* Takes what has come. Does not block. */
void world_mirror_take(struct world_mirror *mirror);

/* Waits for something to take, at most until_ns (CLOCK_MONOTONIC). */
void world_mirror_wait(const struct world_mirror *mirror, uint64_t until_ns);

/* Does the world speak now? */
bool world_mirror_live(const struct world_mirror *mirror, uint64_t now_ns);

/* Is there one of everything that is read: world, frame, processes, entities? */
bool world_mirror_whole(const struct world_mirror *mirror);

/* The entity of the last whole batch with this id, NULL when it is gone. */
const jolon_Entity *world_mirror_entity(const struct world_mirror *mirror, uint32_t id);

/* What the world says of a kind, NULL when it did not name it. */
const jolon_KindInfo *world_mirror_kind(const struct world_mirror *mirror, uint32_t kind);

/* "?" when the world did not name it. */
const char *world_mirror_kind_name(const struct world_mirror *mirror, uint32_t kind);

/* The words of ipc/topics/status.idl's states; of the run also what follows from silence: "waiting"
 * when nothing ever came, "silent" when it stopped. */
const char *world_mirror_process_state(jolon_ProcessState state);
const char *world_mirror_run_state(const struct world_mirror *mirror, uint64_t now_ns);

#endif
