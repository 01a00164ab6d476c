/* The world's processes: ending them, for whatever ended is started again by their keeper. */
#ifndef JOLON_CONSOLE_ROLES_H
#define JOLON_CONSOLE_ROLES_H

#include "console/answer.h"
#include "console/watch.h"

/* Kills the role's process, or asks it to end where that is enough to see it return; answers with
 * its pid. */
void roles_end(const struct watch *watch, const char *role, bool restart, struct answer *answer);

#endif
