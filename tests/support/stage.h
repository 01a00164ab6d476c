/* Runs the real loops of mover and collider as children, on a private or a named world, as their
 * main.c does with options. */
#ifndef JOLON_TESTS_SUPPORT_STAGE_H
#define JOLON_TESTS_SUPPORT_STAGE_H

#include "ipc/segment/segment.h"

#include <sys/types.h>

/* Starts the role's loop on a private view (see segment_private()). When quiet, its standard error
 * goes to /dev/null. Returns the child's pid. The child exits with 0 where the process would. */
pid_t stage_start(const struct view *view, enum role role, bool quiet);

#endif
