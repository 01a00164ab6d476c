/* A folder of PNG files: the latest picture of each view, and the last ones by frame number. */
#ifndef JOLON_RENDERER_OUTPUT_PICTURE_FOLDER_H
#define JOLON_RENDERER_OUTPUT_PICTURE_FOLDER_H

#include "ipc/segment/segment.h"
#include "renderer/image/image.h"

#include <stdint.h>

#define PICTURE_FOLDER_KEPT                                                                        \
    120u /* numbered pictures of a view, about 150 MB; older ones are removed */

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

/* Makes the folder with mode 0700 if it does not exist, and checks that it is writable. Returns 0,
 * or -1 with the reason. */
int picture_folder_open(struct picture_folder *output, const char *folder,
                        struct error_text *error);
void picture_folder_close(struct picture_folder *output);

/* Makes a folder in it with mode 0700 for the graphics driver's cache, and copies its path. Returns
 * 0, or -1 with errno, also when a symbolic link has its name. */
int picture_folder_cache(const struct picture_folder *output, char *path, size_t bytes);

/* Writes "VIEW-FRAME.png" and makes "VIEW.png" the same picture, each atomically. Keeps a view's
 * last PICTURE_FOLDER_KEPT numbered pictures, including those of earlier renderers. Returns 0, or
 * -1 with the reason, also for more than PICTURE_FOLDER_ROWS views. */
int picture_folder_picture(struct picture_folder *output, const char *view,
                           const struct image *image, uint64_t frame, const char *comment,
                           struct error_text *error);

/* Writes one picture to a path. Returns 0, or -1 with the reason. */
int picture_folder_file(const char *path, const struct image *image, const char *comment,
                        struct error_text *error);

#endif
