/* What this process sends through DDS, written down: a sendmsg() of its own stands in front of the
 * C library's, also for the DDS library. */
#ifndef JOLON_TESTS_RTPS_SENT_H
#define JOLON_TESTS_RTPS_SENT_H

#include <stdio.h>

/* From now on every datagram that is sent is appended to file: its length in two bytes, the low
 * one first, then the datagram. NULL: none is. The file stays the caller's. */
void sent_keep(FILE *file);

#endif
