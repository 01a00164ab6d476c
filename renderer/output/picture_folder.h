/* Where pictures go: a folder with the latest picture of each view and the last of them by frame
 * number. */
#ifndef JOLON_RENDERER_OUTPUT_PICTURE_FOLDER_H
#define JOLON_RENDERER_OUTPUT_PICTURE_FOLDER_H

#include "ipc/segment/segment.h"
#include "renderer/image/image.h"

#include <stdint.h>

#define PICTURE_FOLDER_KEPT                                                                        \
    120u /* numbered pictures of a view; older ones are removed: about 150 MB */

#define PICTURE_FOLDER_NONE UINT64_MAX

#define PICTURE_FOLDER_ROWS       8u
#define PICTURE_FOLDER_VIEW_BYTES 24u

struct picture_folder_row {
    char view[PICTURE_FOLDER_VIEW_BYTES]; /* "": not in use */
    uint64_t frame[PICTURE_FOLDER_KEPT]; /* of the numbered pictures there are; PICTURE_FOLDER_NONE:
                                            none */
    uint64_t written;
};

struct picture_folder {
    const char *path; /* of the folder, as the user named it */
    int folder;       /* its descriptor: names are looked up beneath it alone */
    struct picture_folder_row row[PICTURE_FOLDER_ROWS];
};

/* Makes the folder if need be, mode 0700, and tries that it can be written to. 0, or -1 with the
 * reason. */
int picture_folder_open(struct picture_folder *output, const char *folder,
                        struct error_text *error);
void picture_folder_close(struct picture_folder *output);

/* Makes a folder there, mode 0700, for what the graphics driver wants to keep, and tells its path.
 * 0, or -1 with errno; a link of its name is no folder. */
int picture_folder_cache(const struct picture_folder *output, char *path, size_t bytes);

/* Writes "VIEW-FRAME.png" and makes "VIEW.png" the same picture, each in one step: a reader never
 * finds half a picture. Of a view's numbered pictures the last PICTURE_FOLDER_KEPT are kept, those
 * among them that an earlier renderer left there; of PICTURE_FOLDER_ROWS views at most. 0, or -1
 * with the reason.
 */
int picture_folder_picture(struct picture_folder *output, const char *view,
                           const struct image *image, uint64_t frame, const char *comment,
                           struct error_text *error);

/* Writes one picture to a path. 0, or -1 with the reason. */
int picture_folder_file(const char *path, const struct image *image, const char *comment,
                        struct error_text *error);

#endif
