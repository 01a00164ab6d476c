/* The mirror: a world's state as its topics describe it, for programs that do not use shared
 * memory.
 *
 * Everything comes over DDS, so a monitor also works from another machine. A world that does not
 * exist, ends or returns is a state of the mirror, not an error. */
#ifndef JOLON_IPC_TOPICS_WORLD_MIRROR_H
#define JOLON_IPC_TOPICS_WORLD_MIRROR_H

#include "ipc/topics/dds_topics.h"
#include "ipc/topics/motion_mirror.h"
#include "ipc/topics/names_reader.h"

#include "status.h"

#include <stdbool.h>

#define WORLD_MIRROR_ROLES_MAX 16u
#define WORLD_MIRROR_KINDS_MAX 64u
#define WORLD_MIRROR_PARTS_MAX 1024u /* of a batch; a reporter sends at most 128 */

/* Without a FrameStatus for this long the reporter has ended or is stopped. Ten come a second. */
#define WORLD_MIRROR_SILENCE_NS 1500000000u

/* How often the mirror checks that the writer of WorldInfo still exists. */
#define WORLD_MIRROR_LOOK_NS 1000000000u

enum world_mirror_reader {
    WORLD_MIRROR_WORLD,
    WORLD_MIRROR_PROCESS,
    WORLD_MIRROR_FRAME,
    WORLD_MIRROR_ENTITIES,
    WORLD_MIRROR_READERS
};

/* What a mirror reads of the entities, which are most of the data. */
enum world_mirror_entities {
    WORLD_MIRROR_NOTHING,
    WORLD_MIRROR_BATCHES, /* exact */
    WORLD_MIRROR_MOTIONS  /* less data; 0.25 m off (ipc/frame/motion_table.h) */
};

struct world_mirror {
    const struct dds_link *link; /* the caller's */
    dds_entity_t reader[WORLD_MIRROR_READERS];
    enum dds_topic topic[WORLD_MIRROR_READERS];
    int readers; /* number of readers; the entities' reader is the last */
    dds_entity_t waitset;
    struct names_reader names_reader;
    const char *name; /* of the world */

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

    /* The last whole batch, and the batch of which parts are still to come. */
    struct world_mirror_batch {
        jolon_Entity *entity;
        uint32_t count, room;
        uint64_t run, frame;
        uint32_t parts_left;
        bool part[WORLD_MIRROR_PARTS_MAX]; /* it has come */
    } batch, pending;
    bool has_batch;
    struct motion_mirrors motions; /* from which the batch is computed with WORLD_MIRROR_MOTIONS */
};

/* Makes the readers on the link, which must outlive the mirror. Returns 0, or -1 with the reason.
 */
int world_mirror_open(struct world_mirror *mirror, const struct dds_link *link, const char *world,
                      enum world_mirror_entities entities, struct error_text *error);
void world_mirror_close(struct world_mirror *mirror);

/* Takes the samples that have come. None is taken from a link that is not single
 * (dds_link_is_single()). Does not block. */
void world_mirror_take(struct world_mirror *mirror);

/* Waits for samples, at most until until_ns (CLOCK_MONOTONIC). */
void world_mirror_wait(const struct world_mirror *mirror, uint64_t until_ns);

/* Returns true if the world's FrameStatus came lately. */
bool world_mirror_live(const struct world_mirror *mirror, uint64_t now_ns);

/* Returns true if one sample of everything that is read has come: world, frame, processes,
 * entities and their names. */
bool world_mirror_whole(const struct world_mirror *mirror);

/* Returns the entity of the last whole batch with this id, NULL when there is none. */
const jolon_Entity *world_mirror_entity(const struct world_mirror *mirror, uint32_t id);

/* Returns the world's description of a kind, NULL when there is none. */
const jolon_KindInfo *world_mirror_kind(const struct world_mirror *mirror, uint32_t kind);

/* Returns the kind's name, "?" when there is none. */
const char *world_mirror_kind_name(const struct world_mirror *mirror, uint32_t kind);

/* Return the words for the states of ipc/topics/status.idl. A run is also "waiting" when no sample
 * ever came, and "silent" when they stopped. */
const char *world_mirror_process_state(jolon_ProcessState state);
const char *world_mirror_run_state(const struct world_mirror *mirror, uint64_t now_ns);

#endif
