/* Samples that no reporter would write. */
#ifndef JOLON_TESTS_RTPS_HOSTILE_H
#define JOLON_TESTS_RTPS_HOSTILE_H

#include "ipc/topics/dds_link.h"

/* Writes such samples on every topic of a world's status for length_ns. What they hold follows from
 * seed: numbers that are none, counts that do not fit, frames that go back, names of any bytes. */
void hostile_write(const struct dds_link *link, uint64_t seed, uint64_t length_ns);

#endif
