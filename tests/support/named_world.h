/* Worlds with a name, for tests of creation, attachment and removal. The names contain the test's
 * pid, so that concurrent tests do not share a world. */
#ifndef JOLON_TESTS_SUPPORT_NAMED_WORLD_H
#define JOLON_TESTS_SUPPORT_NAMED_WORLD_H

#include "ipc/segment/segment.h"

struct scenario;

/* Writes a name that no other world has: "test-PID-N". */
void named_world_name(char name[SEGMENT_NAME_MAX]);

/* Creates and publishes a built world under a name. */
void named_world_publish(const char *name, const struct scenario *scenario,
                         const struct world_build *built);

/* Creates and publishes a world of the scenario's text (see fixture.h) under a new name. */
void named_world_make(char name[SEGMENT_NAME_MAX], const char *scenario_text);

/* Finds the paths of the world's files. Fails the test when there is no such world. */
void named_world_paths(struct segment_paths *paths, const char *name);

/* Removes the world and its lock file, even while a process holds a role. */
void named_world_remove(const char *name);

/* Counts the files of this test's worlds: objects in /dev/shm, and names, locks and sockets in the
 * runtime folder. */
int named_world_leftovers(void);

/* Removes these files, so that a failed test does not disturb the next. */
void named_world_clear(void);

/* Group tear-down for cmocka. Fails when such a file is left. */
int named_world_check_left(void **state);

#endif
