/* Hashes of what never changes in a world. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_CHECK_H
#define JOLON_IPC_SEGMENT_SEGMENT_CHECK_H

#include "ipc/segment/segment.h"

#include <stdint.h>

struct params;

/* Takes the hash of every region that never changes into the header of a begun or private view. */
void segment_hash_static(struct view *view);

/* All of them as one. */
uint64_t segment_static_hash(const struct segment_header *header);

/* Hashes the static regions (about a millisecond) and compares. 0, or -1 with the reason. */
int segment_verify(const struct view *view, struct error_text *error);

/* Do the parameters that sizes and waits are computed from fit the header? path is for the message.
 * 0, or -1 with the reason. */
int segment_params_fit(const struct params *params, const struct segment_header *header,
                       const char *path, struct error_text *error);

#endif
