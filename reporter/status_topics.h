/* The status topics: WorldInfo once, EntityNames when they change, ProcessStatus of each role on
 * change and once a second, FrameStatus as often as the caller asks. Reads the segment and writes
 * only DDS samples. */
#ifndef JOLON_REPORTER_STATUS_TOPICS_H
#define JOLON_REPORTER_STATUS_TOPICS_H

#include "ipc/frame/snapshot.h"
#include "ipc/topics/dds_topics.h"

#include "status.h"

#define STATUS_TOPICS_RATE_SAMPLES                                                                 \
    11u /* of STATUS_TOPICS_PERIOD_NS: the frame rate over a second */
#define STATUS_TOPICS_PERIOD_NS 100000000u

struct status_topics {
    dds_entity_t world, names, process, frame; /* writers */
    uint64_t run;                              /* of the world that view shows */
    uint64_t markings;                         /* hash of those that were written */
    struct {
        jolon_ProcessState state;
        uint32_t pid;
        uint64_t restarts;
        uint64_t sent_ns; /* 0: never */
    } sent[ROLE_COUNT];
    struct {
        uint64_t at_ns, commit;
    } rate[STATUS_TOPICS_RATE_SAMPLES];
    uint32_t rate_next, rate_count;
    struct histogram whole;       /* frame times when the last FrameStatus was written */
    uint64_t commit, advanced_ns; /* last commit seen, and when it was first seen */
};

/* Makes the writers. Returns 0, or -1 with the reason. */
int status_topics_open(struct status_topics *topics, const struct view *view,
                       const struct dds_link *link, struct error_text *error);

/* Writes WorldInfo. Returns 0, or -1 with the reason. */
int status_topics_world(struct status_topics *topics, const struct view *view,
                        struct error_text *error);

/* Writes EntityNames. Returns 0, or -1 with the reason. */
int status_topics_names(const struct status_topics *topics, const struct view *view,
                        struct error_text *error);

/* Writes EntityNames again, with the markings of remote entities (world/entity/remote.h), when
 * those of the snapshot differ from those that were written; to be called once a second. Does
 * nothing in a world without room for remote entities. */
void status_topics_markings(struct status_topics *topics, const struct view *view,
                            const struct snapshot *snapshot);

/* Writes the ProcessStatus of each role that has changed, or was not written for a second. */
void status_topics_processes(struct status_topics *topics, const struct view *view,
                             uint64_t now_ns);

/* Writes FrameStatus of the last committed frame. To be called every STATUS_TOPICS_PERIOD_NS,
 * because the frame rate is measured over the calls. */
void status_topics_frame(struct status_topics *topics, const struct view *view, uint64_t now_ns);

#endif
