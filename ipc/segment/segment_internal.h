/* What the files of this folder share that no other folder needs. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_INTERNAL_H
#define JOLON_IPC_SEGMENT_SEGMENT_INTERNAL_H

#include "ipc/segment/segment.h"

#include <fcntl.h>
#include <stddef.h>

#define SEGMENT_DIR "/dev/shm"

static inline void *segment_part(const struct view *view, int region)
{
    return (unsigned char *)view->base + view->layout.offset[region];
}

/* segment.c: points the view's tables into its memory. Layout and header must be set. */
void segment_bind(struct view *view);

/* segment_attach.c. segment_view_named() makes a view of this name and role with nothing mapped.
 * segment_lock() opens the lock file into lock_fd and, unless later is set, takes the role's byte
 * of it. segment_map() maps the object that the name leads to, for writing the regions that
 * writable() allows (NULL: none), and binds the tables. All return 0, or -1 with the reason. */
typedef bool segment_writable(enum role role, enum region region);
int segment_view_named(struct view *view, const char *name, enum role role,
                       struct error_text *error);
int segment_lock(struct view *view, const char *path, bool later, struct error_text *error);
int segment_map(struct view *view, segment_writable *writable, struct error_text *error);

/* segment_locks.c. segment_open_lock() returns the lock file's descriptor (flags: O_RDONLY or
 * O_RDWR, and O_CREAT). segment_lock_name() also locks the name's byte as long as the descriptor is
 * open, which excludes other creators and removers (made: the file was not there before).
 * segment_first_held() returns the first of the roles 0 .. last that is held, ROLE_NONE for none.
 * Each returns -1 with the reason when it fails; the first two set errno as well. */
int segment_open_lock(const char *path, int flags, struct error_text *error);
int segment_lock_name(const char *path, bool *made, struct error_text *error);
int segment_first_held(const char *path, enum role last, struct error_text *error);

/* Returns the role's byte of the lock file for fcntl(). */
struct flock segment_role_byte(enum role role);

/* segment_check.c: the hashes of the header and of a region that never changes. */
uint64_t segment_head_hash(const struct segment_header *header);
uint64_t segment_region_hash(const struct view *view, int region);

/* Checks that the object is a world's by type, owner, mode and size (returned in bytes); that the
 * header is whole, of this build and fits the size (layout is computed from it); that the
 * parameters of a mapped view are whole and fit its header. Each returns 0, or -1 with the
 * reason. */
int segment_check_object(int fd, const char *path, size_t *bytes, struct error_text *error);
int segment_check_header(const struct segment_header *header, size_t bytes, const char *path,
                         struct layout *layout, struct error_text *error);
int segment_check_params(const struct view *view, const char *path, struct error_text *error);

#endif
