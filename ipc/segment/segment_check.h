/* Hashes of the regions that never change, and the check of the parameters. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_CHECK_H
#define JOLON_IPC_SEGMENT_SEGMENT_CHECK_H

#include "ipc/segment/segment.h"

#include <stdint.h>

struct params;

/* Writes the hash of every region that never changes into the header of a begun or private view. */
void segment_hash_static(struct view *view);

/* Returns one hash of all these hashes. */
uint64_t segment_static_hash(const struct segment_header *header);

/* Hashes the regions that never change (about 1 ms) and compares with the header. Returns 0, or -1
 * with the names of the damaged regions. */
int segment_verify(const struct view *view, struct error_text *error);

/* Checks that the parameters fit the header, and that those on which sizes and waits depend are in
 * range. path is for the message. Returns 0, or -1 with the reason. */
int segment_params_fit(const struct params *params, const struct segment_header *header,
                       const char *path, struct error_text *error);

#endif
