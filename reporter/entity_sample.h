/* An entity as the topics tell it. */
#ifndef JOLON_REPORTER_ENTITY_SAMPLE_H
#define JOLON_REPORTER_ENTITY_SAMPLE_H

#include "ipc/frame/snapshot.h"

#include "status.h"

/* Returns a row of the snapshot as its fields say. Pure; any thread. */
jolon_Entity entity_sample_of(const struct world *world, const struct snapshot *snapshot,
                              uint32_t row);

#endif
