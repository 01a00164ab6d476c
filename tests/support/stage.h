/* The real loops of mover and collider as children on a private or named world: what main.c does,
 * without its options. */
#ifndef JOLON_TESTS_SUPPORT_STAGE_H
#define JOLON_TESTS_SUPPORT_STAGE_H

#include "ipc/segment/segment.h"

#include <sys/types.h>

/* Starts the role's loop on a private view (see segment_private). The loop's standard error goes to
 * /dev/null when quiet. It ends with 0 as the process would. */
pid_t stage_start(const struct view *view, enum role role, bool quiet);

#endif
