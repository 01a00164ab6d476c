/* What the segment_*.c files share and nobody else calls. */
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

/* segment.c: points the view's tables into its memory; layout and header are set. */
void segment_bind(struct view *view);

/* segment_attach.c: a view of this name and role with nothing mapped; takes the role's lock into
 * lock_fd, or only opens its file for later; maps the object that the name leads to, for writing
 * where writable says so (NULL: nowhere), and points the tables into it. 0, or -1 with the reason.
 */
typedef bool segment_writable(enum role role, enum region region);
int segment_view_named(struct view *view, const char *name, enum role role,
                       struct error_text *error);
int segment_lock(struct view *view, const char *path, bool later, struct error_text *error);
int segment_map(struct view *view, segment_writable *writable, struct error_text *error);

/* segment_locks.c. Each returns -1 with the reason when it fails; the first two set errno as well.
 * segment_open_lock: the lock file's descriptor (flags: O_RDONLY or O_RDWR, and O_CREAT).
 * segment_lock_name: the same with the byte of it that keeps creation and removal of the name
 * apart, as long as it is open (made: the file was not there before).
 * segment_first_held: the first of the roles 0 .. last that is held, ROLE_NONE when none is. */
int segment_open_lock(const char *path, int flags, struct error_text *error);
int segment_lock_name(const char *path, bool *made, struct error_text *error);
int segment_first_held(const char *path, enum role last, struct error_text *error);

/* The role's byte of the lock file, as fcntl() takes it. */
struct flock segment_role_byte(enum role role);

/* segment_check.c: the hashes of the header and of a region that never changes. */
uint64_t segment_head_hash(const struct segment_header *header);
uint64_t segment_region_hash(const struct view *view, int region);

/* Is the object a world's by kind, owner, mode and size (into bytes)? Is the header this build's,
 * whole, and of such a size (layout follows from it)? Are the parameters of a mapped view whole,
 * and do they fit its header? 0, or -1 with the reason. */
int segment_check_object(int fd, const char *path, size_t *bytes, struct error_text *error);
int segment_check_header(const struct segment_header *header, size_t bytes, const char *path,
                         struct layout *layout, struct error_text *error);
int segment_check_params(const struct view *view, const char *path, struct error_text *error);

#endif
