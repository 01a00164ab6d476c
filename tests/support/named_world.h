/* Worlds with a name: for tests of creation, attachment and removal. Names hold the
 * test's pid, so that tests side by side do not meet. */
#ifndef JOLON_TESTS_SUPPORT_NAMED_WORLD_H
#define JOLON_TESTS_SUPPORT_NAMED_WORLD_H

#include "ipc/segment/segment.h"

struct scenario;

/* A name that no other world has: "test-PID-N". */
void named_world_name(char name[SEGMENT_NAME_MAX]);

/* Creates and publishes a built world under a name. */
void named_world_publish(const char *name, const struct scenario *scenario,
                         const struct world_build *built);

/* Creates and publishes a world of the scenario's text (see fixture.h) under a new name. */
void named_world_make(char name[SEGMENT_NAME_MAX], const char *scenario_text);

/* Where it is; fails the test when it is not there. */
void named_world_paths(struct segment_paths *paths, const char *name);

/* Removes it and its lock file, whoever holds a role. */
void named_world_remove(const char *name);

/* Files of this test's worlds: objects in /dev/shm; names, locks, sockets in the runtime folder. */
int named_world_leftovers(void);

/* Removes them: what a failed part of a test left must not disturb the next. */
void named_world_clear(void);

/* Group tear-down for cmocka: fails when something is left over. */
int named_world_check_left(void **state);

#endif
