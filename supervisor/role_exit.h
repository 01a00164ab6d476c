/* What the keeper does when a process of the set has ended: restart, repair, or end of the run. */
#ifndef JOLON_SUPERVISOR_ROLE_EXIT_H
#define JOLON_SUPERVISOR_ROLE_EXIT_H

#include "supervisor/keeper.h"

/* Handles every child that has ended, stopped or continued since the last call. Does not wait for
 * one, but a repair runs a program to its end. */
void role_exit_reap(struct keeper *keeper);

#endif
