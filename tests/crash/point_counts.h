/* Counts of crash points: which points exist, how often an undisturbed run reaches each, and how
 * many processes died there. */
#ifndef JOLON_TESTS_CRASH_POINT_COUNTS_H
#define JOLON_TESTS_CRASH_POINT_COUNTS_H

#include <stdbool.h>
#include <stdint.h>

#define POINT_COUNTS_MAX 1024

struct point_count {
    char role[32], name[64];
    uint64_t crossings, deaths;
};

struct point_counts {
    int count;
    struct point_count point[POINT_COUNTS_MAX];
};

/* Reads the counts that the processes of one run wrote through JOLON_CRASH_COUNT. Fails the test
 * when a process has two points with the same name. */
void point_counts_read(struct point_counts *counts, const char *path);

/* Returns the point of a role. Adds it if it is new. */
struct point_count *point_counts_find(struct point_counts *counts, const char *role,
                                      const char *name);

/* Returns the number of deaths at a point over all roles. */
uint64_t point_counts_deaths(const struct point_counts *counts, const char *name);

#endif
