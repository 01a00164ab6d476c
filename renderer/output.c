/* Numbered pictures, a bounded number of them. */
#include "renderer/output.h"

#include "renderer/png.h"

#include <errno.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PATH_BYTES 1024

static int path_of(const struct output *output, char path[PATH_BYTES], const char *view,
                   const uint64_t *frame, const char *suffix)
{
    int length;
    if (frame != NULL)
        length = snprintf(path, PATH_BYTES, "%s/%s-%06llu.png%s", output->folder, view,
                          (unsigned long long)*frame, suffix);
    else
        length = snprintf(path, PATH_BYTES, "%s/%s.png%s", output->folder, view, suffix);
    return length > 0 && length < PATH_BYTES ? 0 : -1;
}

/* mkdir -p: the folders above it too. */
static int make_folders(const char *folder)
{
    char path[PATH_BYTES];
    int length = snprintf(path, sizeof path, "%s", folder);
    if (length <= 0 || length >= PATH_BYTES - 64) {
        errno = length <= 0 ? ENOENT : ENAMETOOLONG;
        return -1;
    }
    for (char *slash = strchr(path + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST)
            return -1;
        *slash = '/';
    }
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return -1;
    struct stat found;
    if (stat(path, &found) != 0)
        return -1;
    if (S_ISDIR(found.st_mode))
        return 0;
    errno = ENOTDIR;
    return -1;
}

/* Gives the frame's picture a place among those kept; the one that had it is removed. */
static void keep(const struct output *output, struct output_row *row, const char *view,
                 uint64_t frame)
{
    char old[PATH_BYTES];
    for (uint32_t i = 0; i < OUTPUT_KEPT; i++)
        if (row->frame[i] == frame)
            row->frame[i] = OUTPUT_NONE; /* of an earlier run: the file is the new one's now */
    uint64_t *place = &row->frame[row->written++ % OUTPUT_KEPT];
    if (*place != OUTPUT_NONE && path_of(output, old, view, place, "") == 0)
        unlink(old);
    *place = frame;
}

static void keep_found(const struct output *output, struct output_row *row, const char *view)
{
    char pattern[PATH_BYTES];
    glob_t found;
    for (uint32_t i = 0; i < OUTPUT_KEPT; i++)
        row->frame[i] = OUTPUT_NONE;
    int length = snprintf(pattern, sizeof pattern, "%s/%s-[0-9]*.png", output->folder, view);
    if (length < 0 || (size_t)length >= sizeof pattern || glob(pattern, 0, NULL, &found) != 0)
        return;
    for (size_t i = 0; i < found.gl_pathc; i++) {
        const char *number = strrchr(found.gl_pathv[i], '-') + 1;
        keep(output, row, view, strtoull(number, NULL, 10));
    }
    globfree(&found);
}

int output_open(struct output *output, const char *folder, struct reason *reason)
{
    memset(output, 0, sizeof *output);
    output->folder = folder;
    if (make_folders(folder) != 0)
        return reason_set(reason, "--out %s: cannot make the folder: %s", folder, strerror(errno));
    if (access(folder, W_OK | X_OK) != 0)
        return reason_set(reason, "--out %s: cannot write there: %s", folder, strerror(errno));
    keep_found(output, &output->chase, "chase");
    keep_found(output, &output->map, "map");
    return 0;
}

/* The latest picture is another name of the numbered file, so it is written once. */
static int point_latest(const char *numbered, const char *temporary, const char *latest)
{
    if (unlink(temporary) != 0 && errno != ENOENT)
        return -1;
    if (link(numbered, temporary) != 0)
        return -1;
    if (rename(temporary, latest) == 0)
        return 0;
    int cause = errno;
    unlink(temporary);
    errno = cause;
    return -1;
}

int output_picture(struct output *output, const char *view, const struct image *image,
                   uint64_t frame, const char *comment, struct reason *reason)
{
    struct output_row *row = view[0] == 'c' ? &output->chase : &output->map;
    char numbered[PATH_BYTES], latest[PATH_BYTES], temporary[PATH_BYTES];
    if (path_of(output, numbered, view, &frame, "") != 0 ||
        path_of(output, latest, view, NULL, "") != 0 ||
        path_of(output, temporary, view, NULL, ".tmp") != 0)
        return reason_set(reason, "--out %s: the path is too long", output->folder);
    if (output_file(numbered, image, comment, reason) != 0)
        return -1;
    /* File systems without links get a second copy. */
    if (point_latest(numbered, temporary, latest) != 0 &&
        output_file(latest, image, comment, reason) != 0)
        return -1;
    keep(output, row, view, frame);
    return 0;
}

int output_file(const char *path, const struct image *image, const char *comment,
                struct reason *reason)
{
    if (png_write_file(path, image, comment) == 0)
        return 0;
    return reason_set(reason, "cannot write %s: %s", path, strerror(errno));
}
