/* Checkpoints: every N frames an image of the world, which replaces the previous one in the same
 * file. A failed write gives a warning and is tried again; the run goes on. */
#ifndef JOLON_RECORDER_CHECKPOINT_H
#define JOLON_RECORDER_CHECKPOINT_H

#include "recorder/archive/image_write.h"

#include <stdint.h>

struct checkpoint {
    struct image_place place;
    struct capture capture;
    uint64_t every;
    uint64_t due; /* frame from which a checkpoint is due */
    uint64_t written, failed;
    uint64_t warned_ns; /* for log_due() */
};

/* every: frames, 1 or more. The first checkpoint is due at the next multiple of it. If the file is
 * an earlier checkpoint of this world, the first is due at the multiple after that one, which may
 * have passed already. Returns 0, or -1 with the reason: the file cannot be a checkpoint, or memory
 * is out. */
int checkpoint_open(struct checkpoint *checkpoint, const struct view *view, const char *path,
                    uint64_t every, struct error_text *error);
void checkpoint_close(struct checkpoint *checkpoint);

/* Writes a checkpoint if one is due. Beats the view's role meanwhile. Blocks while it packs and
 * writes: a fraction of a second on Hunter-Liggett. */
void checkpoint_write_if_due(struct checkpoint *checkpoint, struct view *view);

/* Writes a checkpoint of the last committed frame. Returns 0, or -1 after a warning. */
int checkpoint_write(struct checkpoint *checkpoint, struct view *view);

#endif
