/* The account of a storm as a table, or as one JSON object. */
#ifndef JOLON_TESTS_STORM_REPORT_H
#define JOLON_TESTS_STORM_REPORT_H

#include "tests/storm/accounts.h"
#include "tests/storm/victim.h"
#include "tests/storm/watcher.h"
#include "tests/storm/witness.h"

struct outcome {
    const struct storm_options *options;
    const struct victims *victims;
    struct watcher *watcher;
    const struct witness *witness;
    const struct band *band;
    const struct accounts *accounts;
    uint64_t sent, answered; /* commands */
    int stop_code;           /* of `jolon stop` */
    int processes_left, files_left;
    double wall_s;
    bool broken; /* the storm ended before its time */
};

/* Is everything as it must be? */
bool report_good(const struct outcome *outcome);

/* Prints to standard output. */
void report_table(const struct outcome *outcome);
void report_json(const struct outcome *outcome);

#endif
