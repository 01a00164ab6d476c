/* Records of remote entities for tests. */
#ifndef JOLON_TESTS_SUPPORT_REMOTES_H
#define JOLON_TESTS_SUPPORT_REMOTES_H

#include "tests/support/steps.h"
#include "world/entity/remote.h"

/* Returns a TRACK of an entity at rest: a red tank of the number remote, with its heading 0. */
struct remote_record remotes_track(const struct fixture *fixture, uint64_t remote,
                                   struct vec3 place);

/* Appends a record to the gateway's ring. Computes no frame. */
void remotes_send(struct fixture *fixture, struct remote_record record);

/* Returns the row of a remote entity in the committed frame, or SLOT_NONE. */
uint32_t remotes_row(const struct fixture *fixture, uint64_t remote);

/* Draws a record that is possible often, but not always. */
struct remote_record remotes_any(const struct fixture *fixture, uint64_t *random);

#endif
