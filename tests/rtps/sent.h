/* Records what this process sends through DDS. A sendmsg() of its own replaces that of the C
 * library, also for the DDS library. */
#ifndef JOLON_TESTS_RTPS_SENT_H
#define JOLON_TESTS_RTPS_SENT_H

#include <stdio.h>

/* Appends every datagram that is sent from now on to file: two bytes of length, low byte first,
 * then the datagram. NULL stops recording. The caller owns the file. */
void sent_keep(FILE *file);

#endif
