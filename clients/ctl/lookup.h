/* What jolon-ctl asks of the world before it sends an order: who is called how, how many frames
 * there are a second, which kinds there are. Of a world on this machine it reads the shared memory,
 * of another the topics, when they are first needed. */
#ifndef JOLON_CLIENTS_CTL_LOOKUP_H
#define JOLON_CLIENTS_CTL_LOOKUP_H

#include "ipc/segment/segment.h"
#include "ipc/topics/names_reader.h"

#include <stdbool.h>

struct lookup {
    const struct view *view;     /* of a world on this machine, NULL: ... */
    const struct dds_link *link; /* ... the world is at the other end of this */
    bool reading;                /* the names and what follows are being read, or are here */
    struct name_table names;
    dds_entity_t world, waitset;
    struct names_reader names_reader;
    double hz;                          /* 0: not known yet */
    char vehicles[512], munitions[512]; /* "tank, jeep", kinds that can be spawned, fired */
};

/* Waits for the names and the world's description until until_ns (CLOCK_MONOTONIC); false when they
 * did not come. */
bool lookup_wait(struct lookup *lookup, uint64_t until_ns);

void lookup_close(struct lookup *lookup);

#endif
