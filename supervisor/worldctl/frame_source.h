/* A source of frames to compare: an image, a command log, or a running world. */
#ifndef JOLON_SUPERVISOR_WORLDCTL_FRAME_SOURCE_H
#define JOLON_SUPERVISOR_WORLDCTL_FRAME_SOURCE_H

#include "ipc/frame/snapshot.h"
#include "recorder/replay/log_replay.h"
#include "supervisor/worldctl/compare.h"

#include <stdbool.h>
#include <stdint.h>

enum frame_source_kind { FRAME_SOURCE_IMAGE, FRAME_SOURCE_LOG, FRAME_SOURCE_WORLD };

struct frame_source {
    enum frame_source_kind kind;
    const char *name; /* as given */
    struct view view;
    struct snapshot snapshot;     /* FRAME_SOURCE_WORLD */
    struct log_replay replay;     /* FRAME_SOURCE_LOG */
    struct frame_stepper stepper; /* FRAME_SOURCE_LOG; FRAME_SOURCE_IMAGE once it is stepped */
    uint32_t threads;
};

/* Opens what name stands for: a file that is an image or a command log, otherwise the world of that
 * name. Ends the process (exit 1) if it is none of these. */
void frame_source_open(struct frame_source *source, const char *name, uint32_t threads);
void frame_source_close(struct frame_source *source);

/* The current frame, and its number. Valid until the next step. */
struct compared frame_source_frame(const struct frame_source *source);
uint64_t frame_source_number(const struct frame_source *source);

/* Returns true if the next frame is known: that of a log up to its last known frame, none of the
 * others. */
bool frame_source_known(const struct frame_source *source);

/* Computes the next frame. Returns false if the run cannot go on. A log that does not fit its world
 * ends the process (exit 1). Not for FRAME_SOURCE_WORLD. */
bool frame_source_step(struct frame_source *source);

#endif
