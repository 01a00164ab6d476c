/* Writing PNG files, and removing the oldest. */
#include "renderer/output/picture_folder.h"

#include "ipc/process/process.h"
#include "renderer/image/png.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PATH_BYTES 1024
#define NAME_BYTES 64
#define CACHE_NAME ".shaders"

/* Writes "VIEW-FRAME.png", or "VIEW.png" without a frame. */
static void name_of(char name[NAME_BYTES], const char *view, const uint64_t *frame,
                    const char *suffix)
{
    if (frame != NULL)
        snprintf(name, NAME_BYTES, "%s-%06llu.png%s", view, (unsigned long long)*frame, suffix);
    else
        snprintf(name, NAME_BYTES, "%s.png%s", view, suffix);
}

/* Makes a folder and those above it with mode 0700. Returns its descriptor, or -1 with errno. */
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
        if (mkdir(path, 0700) != 0 && errno != EEXIST)
            return -1;
        *slash = '/';
    }
    if (mkdir(path, 0700) != 0 && errno != EEXIST)
        return -1;
    return open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

/* Adds the frame to the ring of kept pictures and removes the file that it replaces. */
static void keep(const struct picture_folder *output, struct picture_folder_row *row,
                 const char *view, uint64_t frame)
{
    char old[NAME_BYTES];
    for (uint32_t i = 0; i < PICTURE_FOLDER_KEPT; i++)
        if (row->frame[i] == frame)
            row->frame[i] = PICTURE_FOLDER_NONE; /* the file of an earlier run was replaced */
    uint64_t *place = &row->frame[row->written++ % PICTURE_FOLDER_KEPT];
    if (*place != PICTURE_FOLDER_NONE) {
        name_of(old, view, place, "");
        unlinkat(output->folder, old, 0);
    }
    *place = frame;
}

static int is_numbered(const struct dirent *entry)
{
    return fnmatch("*-[0-9]*.png", entry->d_name, 0) == 0;
}

/* Fills the row's ring with the numbered pictures that exist. */
static void keep_found(const struct picture_folder *output, struct picture_folder_row *row,
                       const char *view)
{
    struct dirent **found;
    size_t length = strlen(view);
    for (uint32_t i = 0; i < PICTURE_FOLDER_KEPT; i++)
        row->frame[i] = PICTURE_FOLDER_NONE;
    int count = scandirat(output->folder, ".", &found, is_numbered, versionsort);
    for (int i = 0; i < count; i++) {
        const char *name = found[i]->d_name;
        if (strncmp(name, view, length) == 0 && name[length] == '-')
            keep(output, row, view, strtoull(name + length + 1, NULL, 10));
        free(found[i]);
    }
    if (count >= 0)
        free(found);
}

static int is_temporary(const struct dirent *entry)
{
    return fnmatch("*.png.[0-9]*.tmp", entry->d_name, 0) == 0;
}

/* Removes partial files of renderers that were killed. */
static void sweep_temporaries(int folder)
{
    struct dirent **found;
    int count = scandirat(folder, ".", &found, is_temporary, NULL);
    for (int i = 0; i < count; i++) {
        const char *number = strstr(found[i]->d_name, ".png.") + strlen(".png.");
        long pid = strtol(number, NULL, 10);
        if (pid > 0 && process_has_ended((int)pid))
            unlinkat(folder, found[i]->d_name, 0);
        free(found[i]);
    }
    if (count >= 0)
        free(found);
}

int picture_folder_open(struct picture_folder *output, const char *folder, struct error_text *error)
{
    *output = (struct picture_folder){.path = folder, .folder = make_folders(folder)};
    if (output->folder < 0)
        return error_text_set(error, "--out %s: cannot make the folder: %s", folder,
                              strerror(errno));
    if (faccessat(output->folder, ".", W_OK | X_OK, 0) != 0) {
        error_text_set(error, "--out %s: cannot write there: %s", folder, strerror(errno));
        picture_folder_close(output);
        return -1;
    }
    sweep_temporaries(output->folder);
    return 0;
}

/* Returns the view's row, NULL when all are in use. A new row finds pictures of earlier renderers.
 */
static struct picture_folder_row *row_of(struct picture_folder *output, const char *view)
{
    for (uint32_t i = 0; i < PICTURE_FOLDER_ROWS; i++) {
        struct picture_folder_row *row = &output->row[i];
        if (strcmp(row->view, view) == 0)
            return row;
        if (row->view[0] != '\0')
            continue;
        snprintf(row->view, sizeof row->view, "%s", view);
        keep_found(output, row, view);
        return row;
    }
    return NULL;
}

void picture_folder_close(struct picture_folder *output)
{
    close(output->folder);
    output->folder = -1;
}

int picture_folder_cache(const struct picture_folder *output, char *path, size_t bytes)
{
    int length = snprintf(path, bytes, "%s/" CACHE_NAME, output->path);
    if (length < 0 || (size_t)length >= bytes) {
        errno = ENAMETOOLONG;
        return -1;
    }
    if (mkdirat(output->folder, CACHE_NAME, 0700) != 0 && errno != EEXIST)
        return -1;
    int fd = openat(output->folder, CACHE_NAME, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0)
        return -1;
    close(fd);
    return 0;
}

/* Makes latest a hard link to the numbered file, atomically. Returns 0, or -1 with errno. */
static int point_latest(int folder, const char *numbered, const char *temporary, const char *latest)
{
    if (unlinkat(folder, temporary, 0) != 0 && errno != ENOENT)
        return -1;
    if (linkat(folder, numbered, folder, temporary, 0) != 0)
        return -1;
    if (renameat(folder, temporary, folder, latest) == 0)
        return 0;
    int cause = errno;
    unlinkat(folder, temporary, 0);
    errno = cause;
    return -1;
}

int picture_folder_picture(struct picture_folder *output, const char *view,
                           const struct image *image, uint64_t frame, const char *comment,
                           struct error_text *error)
{
    struct picture_folder_row *row = row_of(output, view);
    char numbered[NAME_BYTES], latest[NAME_BYTES], temporary[NAME_BYTES];
    if (row == NULL)
        return error_text_set(error, "pictures of more than %u views", PICTURE_FOLDER_ROWS);
    name_of(numbered, view, &frame, "");
    name_of(latest, view, NULL, "");
    name_of(temporary, view, NULL, ".tmp");
    /* On a file system without hard links the picture is written twice. */
    if (png_write_file(output->folder, numbered, image, comment) != 0 ||
        (point_latest(output->folder, numbered, temporary, latest) != 0 &&
         png_write_file(output->folder, latest, image, comment) != 0))
        return error_text_set(error, "cannot write %s/%s: %s", output->path, numbered,
                              strerror(errno));
    keep(output, row, view, frame);
    return 0;
}

int picture_folder_file(const char *path, const struct image *image, const char *comment,
                        struct error_text *error)
{
    if (png_write_file(AT_FDCWD, path, image, comment) == 0)
        return 0;
    return error_text_set(error, "cannot write %s: %s", path, strerror(errno));
}
