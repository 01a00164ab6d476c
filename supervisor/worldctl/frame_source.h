/* A side of a comparison: an image, a log of commands, or a world that runs. */
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

/* What name stands for: a file that is an image or a log of commands, else the name of a world.
 * Ends the process (exit 1) when it is none of them. */
void frame_source_open(struct frame_source *source, const char *name, uint32_t threads);
void frame_source_close(struct frame_source *source);

/* Its present frame. Valid until it is stepped. */
struct compared frame_source_frame(const struct frame_source *source);
uint64_t frame_source_number(const struct frame_source *source);

/* May it be stepped by what it knows: of a log the next frame is known, of an image nothing is. */
bool frame_source_known(const struct frame_source *source);

/* Makes the next frame. False when the run cannot go on. A log that does not fit ends the process
 * (exit 1). Not for FRAME_SOURCE_WORLD. */
bool frame_source_step(struct frame_source *source);

#endif
