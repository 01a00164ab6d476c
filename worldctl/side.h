/* A side of a comparison: an image, a log of commands, or a world that runs. */
#ifndef JOLON_WORLDCTL_SIDE_H
#define JOLON_WORLDCTL_SIDE_H

#include "ipc/snapshot.h"
#include "replay/tape.h"
#include "worldctl/compare.h"

#include <stdbool.h>
#include <stdint.h>

enum side_kind { SIDE_IMAGE, SIDE_LOG, SIDE_WORLD };

struct side {
    enum side_kind kind;
    const char *name; /* as given */
    struct view view;
    struct snapshot snapshot; /* SIDE_WORLD */
    struct tape tape;         /* SIDE_LOG */
    struct player player;     /* SIDE_LOG; SIDE_IMAGE once it is stepped */
    uint32_t threads;
};

/* What name stands for: a file that is an image or a log of commands, else the name of a world.
 * Ends the process (exit 1) when it is none of them. */
void side_open(struct side *side, const char *name, uint32_t threads);
void side_close(struct side *side);

/* Its present frame. Valid until it is stepped. */
struct compared side_frame(const struct side *side);
uint64_t side_number(const struct side *side);

/* May it be stepped by what it knows: of a log the next frame is known, of an image nothing is. */
bool side_known(const struct side *side);

/* Makes the next frame. False when the run cannot go on. A log that does not fit ends the process
 * (exit 1). Not for SIDE_WORLD. */
bool side_step(struct side *side);

#endif
