/* What jolon-ctl needs to know of the world before it sends a command: the vehicles' names, the
 * frame rate, the kinds and the world's place on the earth. It is read when first needed: of a
 * world on this machine from the shared memory, of a remote world from the topics. */
#ifndef JOLON_CLIENTS_CTL_LOOKUP_H
#define JOLON_CLIENTS_CTL_LOOKUP_H

#include "ipc/segment/segment.h"
#include "ipc/topics/names_reader.h"
#include "world/terrain/location.h"

#include <stdbool.h>

struct lookup {
    const struct view *view;     /* of a world on this machine, or NULL */
    const struct dds_link *link; /* to a remote world */
    bool reading;                /* the members below are being read, or have been read */
    struct name_table names;
    dds_entity_t world, waitset;
    struct names_reader names_reader;
    double hz;                          /* 0: not known yet */
    struct location_frame frame;        /* known when hz is */
    char vehicles[512], munitions[512]; /* kinds that can be spawned and fired: "tank, jeep" */
};

/* Waits for the names and the world's description until until_ns (CLOCK_MONOTONIC). Returns false
 * if they did not come. */
bool lookup_wait(struct lookup *lookup, uint64_t until_ns);

void lookup_close(struct lookup *lookup);

#endif
