/* Confinement of the keeper, before it starts the first process of its set. */
#ifndef JOLON_SUPERVISOR_CONFINE_H
#define JOLON_SUPERVISOR_CONFINE_H

#include "supervisor/process_set.h"

/* Confines the calling process, and every process that it starts later, with sandbox_keeper() to
 * the folders of the plan's files, the runtime folder, and shared memory. The log and the world
 * must be open. Returns 0, or -1 with the reason. */
int confine_keeper(const struct plan *plan, struct error_text *error);

#endif
