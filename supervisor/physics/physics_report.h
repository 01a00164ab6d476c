/* The result of a physics check: a table for people, or JSON (docs/replay.md). */
#ifndef JOLON_SUPERVISOR_PHYSICS_PHYSICS_REPORT_H
#define JOLON_SUPERVISOR_PHYSICS_PHYSICS_REPORT_H

#include "ipc/json/world_json.h"
#include "supervisor/physics/physics_check.h"

/* Prints the table to standard output, one line for each measure. */
void physics_report_print(const struct physics_check *check);

/* Adds the member "physics" to a JSON object. */
void physics_report_json(const struct physics_check *check, cJSON *object);

#endif
