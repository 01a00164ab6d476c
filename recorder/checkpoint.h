/* Checkpoints: every so many frames an image of the world into one file, the newest in place of the
 * one before. A file that cannot be written is warned of and tried again; the run goes on. */
#ifndef JOLON_RECORDER_CHECKPOINT_H
#define JOLON_RECORDER_CHECKPOINT_H

#include "recorder/archive/image_write.h"

#include <stdint.h>

struct checkpoint {
    struct image_place place;
    struct capture capture;
    uint64_t every;
    uint64_t due; /* frame from which on the next one is due */
    uint64_t written, failed;
    uint64_t warned_ns; /* log_due() */
};

/* every: frames, 1 or more. The first is due at the next multiple of it; at once when the file is
 * an earlier checkpoint of this very world and its next multiple has passed, as after a kill. 0; -1
 * with the reason when the file cannot be one or memory is out. */
int checkpoint_open(struct checkpoint *checkpoint, const struct view *view, const char *path,
                    uint64_t every, struct error_text *error);
void checkpoint_close(struct checkpoint *checkpoint);

/* Writes a checkpoint if one is due. Called in the loop of the view's role, whose heart beats
 * meanwhile; blocks for packing and for the disk, a fraction of a second on Hunter-Liggett. */
void checkpoint_turn(struct checkpoint *checkpoint, struct view *view);

/* Writes one of the last committed frame, due or not. 0, or -1 having warned. */
int checkpoint_write(struct checkpoint *checkpoint, struct view *view);

#endif
