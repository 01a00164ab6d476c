/* Samples that no reporter would write. */
#ifndef JOLON_TESTS_RTPS_HOSTILE_H
#define JOLON_TESTS_RTPS_HOSTILE_H

#include "ipc/topics/dds_link.h"

/* Writes such samples on all status topics of a world for length_ns. The seed determines them:
 * invalid numbers, wrong counts, decreasing frames, names of random bytes. */
void hostile_write(const struct dds_link *link, uint64_t seed, uint64_t length_ns);

#endif
