/* The books of the crash points: which there are, how often a calm run comes to each, who died
 * where. */
#ifndef JOLON_TESTS_CRASH_LEDGER_H
#define JOLON_TESTS_CRASH_LEDGER_H

#include <stdbool.h>
#include <stdint.h>

#define LEDGER_POINTS_MAX 1024

struct ledger_point {
    char role[32], name[64];
    uint64_t crossings, deaths;
};

struct ledger {
    int count;
    struct ledger_point point[LEDGER_POINTS_MAX];
};

/* Reads what the processes of one run wrote by JOLON_CRASH_COUNT. Fails the test when a process has
 * two points of one name. */
void ledger_read(struct ledger *ledger, const char *path);

/* The point of a role; made when it is not yet there. */
struct ledger_point *ledger_point(struct ledger *ledger, const char *role, const char *name);

/* Deaths at a point, of whatever role. */
uint64_t ledger_deaths(const struct ledger *ledger, const char *name);

#endif
