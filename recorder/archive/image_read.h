/* Reads an image (image_write.h) into a world.
 *
 * The hashes find damage, not forgery: an image deserves as much trust as the users who may write
 * the file. */
#ifndef JOLON_RECORDER_ARCHIVE_IMAGE_READ_H
#define JOLON_RECORDER_ARCHIVE_IMAGE_READ_H

#include "recorder/archive/image_format.h"

#include <limits.h>
#include <stdbool.h>

struct image {
    struct image_header header;
    struct params params;  /* a copy of the header's; the caller changes it to branch off */
    unsigned char *packed; /* the zstd frame */
    char path[PATH_MAX];
};

/* Reads the file and checks it against its header. Sizes in the header are checked against bounds
 * before memory is allocated. Returns 0, or -1 with the reason: the file is missing, not a plain
 * file, not an image, of another version or build, damaged, too short or too long. */
int image_open(struct image *image, const char *path, struct error_text *error);
void image_close(struct image *image);

/* Reads the header alone and checks it as image_open() does. */
int image_peek(struct image_header *header, const char *path, struct error_text *error);

/* The header of the segment that image_load() fills (segment_private, segment_begin). */
struct segment_header image_segment(const struct image *image);

/* Returns true if image->params was changed so that the run differs: another seed, time step,
 * collision method or `cruise`. Pace, end and pictures do not change the run. */
bool image_branches(const struct image *image);

/* Fills a fresh segment with the image. The segment's words are set as if its frame had just been
 * committed and, if the image has inputs, the next frame had been moved. A branch is loaded without
 * the inputs, which were moved under the old parameters. Returns 0, or -1 with the reason; the
 * caller then abandons the segment. */
int image_load(struct view *view, const struct image *image, struct error_text *error);

#endif
