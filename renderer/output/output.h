/* Where pictures go: a folder with the latest picture of each view and the last of them by frame
 * number. */
#ifndef JOLON_RENDERER_OUTPUT_H
#define JOLON_RENDERER_OUTPUT_H

#include "ipc/segment.h"
#include "renderer/image/image.h"

#include <stdint.h>

#define OUTPUT_KEPT 120u /* numbered pictures of a view; older ones are removed: about 150 MB */

#define OUTPUT_NONE UINT64_MAX

#define OUTPUT_ROWS       8u
#define OUTPUT_VIEW_BYTES 24u

struct output_row {
    char view[OUTPUT_VIEW_BYTES]; /* "": not in use */
    uint64_t frame[OUTPUT_KEPT];  /* of the numbered pictures there are; OUTPUT_NONE: none */
    uint64_t written;
};

struct output {
    const char *path; /* of the folder, as the user named it */
    int folder;       /* its descriptor: names are looked up beneath it alone */
    struct output_row row[OUTPUT_ROWS];
};

/* Makes the folder if need be, mode 0700, and tries that it can be written to. 0, or -1 with the
 * reason. */
int output_open(struct output *output, const char *folder, struct reason *reason);
void output_close(struct output *output);

/* Makes a folder there, mode 0700, for what the graphics driver wants to keep, and tells its path.
 * 0, or -1 with errno; a link of its name is no folder. */
int output_cache(const struct output *output, char *path, size_t bytes);

/* Writes "VIEW-FRAME.png" and makes "VIEW.png" the same picture, each in one step: a reader never
 * finds half a picture. Of a view's numbered pictures the last OUTPUT_KEPT are kept, those among
 * them that an earlier renderer left there; of OUTPUT_ROWS views at most. 0, or -1 with the reason.
 */
int output_picture(struct output *output, const char *view, const struct image *image,
                   uint64_t frame, const char *comment, struct reason *reason);

/* Writes one picture to a path. 0, or -1 with the reason. */
int output_file(const char *path, const struct image *image, const char *comment,
                struct reason *reason);

#endif
