/* Images: one world at one committed frame, as a file. A checkpoint to go on from, and the dump of
 * a frame on which a role dies. docs/checkpoints.md says what is in it and what is not.
 *
 * Hashes find damage, not forgery: an image is as trusted as whoever may write the file. */
#ifndef JOLON_RECORDER_ARCHIVE_IMAGE_H
#define JOLON_RECORDER_ARCHIVE_IMAGE_H

#include "recorder/archive/capture.h"
#include "recorder/archive/format.h"
#include "ipc/segment/segment.h"
#include "world/params.h"

#include <limits.h>
#include <stdint.h>

/* --- writing -----------------------------------------------------------------------------------*/

/* A file that images are written to, and its folder held open. */
struct image_place {
    int folder;
    char path[PATH_MAX];
    const char *name; /* within path */
};

/* Refuses a path whose folder does not exist, or that is there and is no plain file (a symbolic
 * link, a device, a folder). Removes what a writer that was killed left beside it. 0, or -1 with
 * the reason. */
int image_place_open(struct image_place *place, const char *path, struct reason *reason);
void image_place_close(struct image_place *place);

struct image_written {
    uint64_t bytes;         /* of the file */
    uint64_t content_bytes; /* of what it holds */
};

/* Writes the capture of the view's world into the place's file: whole or not at all, whatever is
 * killed or full, and on the disk when it returns. Needs no open file but the place's. Blocks for
 * the disk; beats the view's role, if it has one, at least with every megabyte. done may be NULL.
 * 0, or -1 with the reason and the old file as it was. */
int image_write(const struct image_place *place, struct view *view, const struct capture *capture,
                struct image_written *done, struct reason *reason);

/* --- reading -----------------------------------------------------------------------------------*/

struct image {
    struct image_header header;
    struct params params;  /* the image's; another's to branch off, see image_load() */
    unsigned char *packed; /* the zstd frame */
    char path[PATH_MAX];
};

/* Reads the file and checks it against its header, whose sizes are held against bounds before
 * anything is allocated. 0, or -1 with the reason: not there, no plain file, not an image, another
 * version's or build's, damaged, cut off, too long. */
int image_open(struct image *image, const char *path, struct reason *reason);
void image_close(struct image *image);

/* The header alone, checked as image_open() does. */
int image_peek(struct image_header *header, const char *path, struct reason *reason);

/* The header to begin a segment with (segment_private, segment_begin) that image_load() fills. */
struct segment_header image_segment(const struct image *image);

/* Does image->params, where it was changed, make another run of it: another seed, another step of
 * time, other collisions? Pace, end and pictures do not. */
bool image_branches(const struct image *image);

/* Fills a fresh segment: everything of the image, and the words as if its frame had just been
 * committed (and, with inputs, the next one moved). A branch goes without the inputs: they were
 * moved under the old parameters. 0, or -1 with the reason; the segment is then to be abandoned.*/
int image_load(struct view *view, const struct image *image, struct reason *reason);

#endif
