/* The world's processes: their table, and the end of one, which the supervisor starts again. */
#ifndef JOLON_CLIENTS_CONSOLE_PROCESS_CONTROL_H
#define JOLON_CLIENTS_CONSOLE_PROCESS_CONTROL_H

#include "clients/console/world_query.h"

/* Writes the answer of /api/processes: the state and the times of each role's process. */
void process_control_list(const struct world_query *asked, struct http_answer *answer);

/* Sends SIGKILL to the role's process; restart: SIGTERM, but SIGKILL to the mover and the collider,
 * because the run ends when one of these ends by itself. Answers with the process id. */
void process_control_end(const struct world_reader *reader, const char *role, bool restart,
                         struct http_answer *answer);

#endif
