/* What jolon-ctl asks of the world before it sends an order: who is called how, how many frames
 * there are a second, which kinds there are. Each topic is read when it is first needed. */
#ifndef JOLON_CTL_LOOKUP_H
#define JOLON_CTL_LOOKUP_H

#include "topics/names.h"

#include "status.h"

#include <stdbool.h>

struct lookup {
    const struct dds_link *link;
    bool reading;
    struct names names;
    dds_entity_t world, waitset;
    double hz;                          /* 0: not known yet */
    char vehicles[512], munitions[512]; /* "tank, jeep", kinds that can be spawned, fired */
};

/* Waits for the names and the world's description until until_ns (CLOCK_MONOTONIC); false when they
 * did not come. */
bool lookup_wait(struct lookup *lookup, uint64_t until_ns);

void lookup_close(struct lookup *lookup);

#endif
