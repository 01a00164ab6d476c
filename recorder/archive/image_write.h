/* Writes an image: one world at one committed frame, as a file. An image serves as a checkpoint,
 * and as the dump of a frame on which a role dies. docs/checkpoints.md says what it holds. */
#ifndef JOLON_RECORDER_ARCHIVE_IMAGE_WRITE_H
#define JOLON_RECORDER_ARCHIVE_IMAGE_WRITE_H

#include "recorder/archive/capture.h"

#include <limits.h>
#include <stdint.h>

/* A file that images are written to. Its folder stays open. */
struct image_place {
    int folder;
    char path[PATH_MAX];
    const char *name; /* within path */
};

/* Refuses a path whose folder does not exist, and a path that names something other than a plain
 * file (a symbolic link, a device, a folder). Removes the temporary files that a killed writer left
 * in the folder. Returns 0, or -1 with the reason. */
int image_place_open(struct image_place *place, const char *path, struct error_text *error);
void image_place_close(struct image_place *place);

struct image_written {
    uint64_t bytes;         /* of the file */
    uint64_t content_bytes; /* before compression */
};

/* Writes the capture of the view's world into the place's file. The file is written whole or not at
 * all, also when the process is killed or the disk is full. It is on the disk when the function
 * returns. Opens no file outside the place's folder. Blocks for the disk. Beats the view's role, if
 * it has one, at least once a megabyte. done may be NULL. Returns 0, or -1 with the reason; the old
 * file is then unchanged. */
int image_write(const struct image_place *place, struct view *view, const struct capture *capture,
                struct image_written *done, struct error_text *error);

#endif
