/* The results of a storm as a table or as one JSON object. */
#ifndef JOLON_TESTS_STORM_REPORT_H
#define JOLON_TESTS_STORM_REPORT_H

#include "tests/storm/consistency.h"
#include "tests/storm/fault_injector.h"
#include "tests/storm/recovery_monitor.h"
#include "tests/storm/invariant_monitor.h"

struct outcome {
    const struct storm_options *options;
    const struct fault_injector *injector;
    struct recovery_monitor *monitor;
    const struct invariant_monitor *invariants;
    const struct tested_set *set;
    const struct consistency *consistency;
    uint64_t sent, answered; /* commands */
    int stop_code;           /* of `jolon stop` */
    int processes_left, files_left;
    double wall_s;
    bool broken; /* the storm ended before all strikes were made */
};

/* Returns true if all strikes were made and nothing was lost, repeated, torn or leaked. */
bool report_good(const struct outcome *outcome);

/* Prints to standard output. */
void report_table(const struct outcome *outcome);
void report_json(const struct outcome *outcome);

#endif
