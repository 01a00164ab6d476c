/* Says how a battle went, beside what is known of real weapons, and what is out of bounds. */
#ifndef JOLON_TESTS_BENCH_AGENTS_BATTLE_REPORT_H
#define JOLON_TESTS_BENCH_AGENTS_BATTLE_REPORT_H

#include "tests/bench/agents/battle_count.h"

/* Prints the report to the standard output. */
void battle_report(const struct battle_count *count, const struct view *view, uint32_t frames);

/* Prints what is out of bounds, a line each, for a battle of half an hour. Returns the number of
 * these lines. */
uint32_t battle_report_wrong(const struct battle_count *count, const struct view *view);

#endif
