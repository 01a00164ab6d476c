/* Takes the pages of a table in shared memory before a step needs them (world/runtime/prefault.h).
 */
#ifndef JOLON_WORLD_ENTITY_TABLE_TOUCH_H
#define JOLON_WORLD_ENTITY_TABLE_TOUCH_H

#include <stdbool.h>
#include <stdint.h>

struct entities;

/* Takes the pages of the first rows, for writing or only for reading. */
void table_touch(const struct entities *entities, uint32_t rows, bool writes);

/* Returns how many rows a stage should take memory for when this many are in use: some more will
 * be. At most capacity. */
uint32_t table_touch_rows(uint32_t used, uint32_t capacity);

#endif
