/* The connections: who came when and asked when last, and who has to go so that others get in. A
 * client that holds many, or is slow to say what it wants, loses them; one that asks keeps its own.
 * It shuts sockets, and closes none. Under the console's lock. */
#ifndef JOLON_CONSOLE_CROWD_H
#define JOLON_CONSOLE_CROWD_H

#include "console/rate.h"

#include <stdbool.h>
#include <stdint.h>

#define CROWD_SEATS 256u /* beyond it who asked the longest ago goes */
#define CROWD_ROOM  320u /* connections in all: some on their way out */

#define CROWD_PATIENCE_NS 10000000000u /* with a request that does not come to its end, ... */
#define CROWD_BUSY_NS     30000000000u /* ... an answer that is not read to its end */

struct seat {
    int fd; /* of the connection */
    bool taken, busy, ending;
    uint64_t since_ns; /* it came, or its last request ended; busy: its request was whole */
    struct rate rate;
};

struct crowd {
    struct seat seat[CROWD_ROOM];
    uint32_t taken;
};

/* A connection came. Its seat; NULL when there is no room. */
struct seat *crowd_come(struct crowd *crowd, int fd, uint64_t now_ns);
void crowd_leave(struct crowd *crowd, struct seat *seat);

/* Its request is whole, and is answered and done with. */
void crowd_begin(struct seat *seat, uint64_t now_ns);
void crowd_done(struct seat *seat, uint64_t now_ns);

/* Shuts those who are out of time. To be called once a second. */
void crowd_sweep(struct crowd *crowd, uint64_t now_ns);

#endif
