/* What the log says of the entities of other simulators (gateway/notices.h). One thread. */
#ifndef JOLON_GATEWAY_REMOTE_NOTICES_H
#define JOLON_GATEWAY_REMOTE_NOTICES_H

#include "gateway/remote_input.h"

/* Writes what was refused so far and why, each reason that there was. Returns false, and "", when
 * nothing was. */
bool remote_notices_text(const struct remote_input *input, char *text, size_t size);

/* Tell what was refused, and what the world has refused. input: a struct remote_input. Return true
 * if there was something new. */
bool remote_notices_refusals(void *input, uint64_t now_ns);
bool remote_notices_world(void *input, uint64_t now_ns);

/* Tells of types that are not in the table. kinds: of the world. */
bool remote_notices_types(struct remote_input *input, const struct kind *kinds);

#endif
