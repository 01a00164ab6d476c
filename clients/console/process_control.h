/* The world's processes: ending them, for whatever ended is started again by their keeper. */
#ifndef JOLON_CLIENTS_CONSOLE_PROCESS_CONTROL_H
#define JOLON_CLIENTS_CONSOLE_PROCESS_CONTROL_H

#include "clients/console/http_answer.h"
#include "clients/console/world_reader.h"

/* Kills the role's process, or asks it to end where that is enough to see it return; answers with
 * its pid. */
void process_control_end(const struct world_reader *watch, const char *role, bool restart,
                         struct http_answer *answer);

#endif
