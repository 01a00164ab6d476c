/* Which rows may have something near them, of all rows of a strip at once. In the first frame of a
 * world that is asked of every row, and a query for each waits for memory. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_RECORD_OVERLAPS_H
#define JOLON_COLLIDER_BROAD_PHASE_RECORD_OVERLAPS_H

#include "collider/broad_phase/query_index.h"
#include "collider/broad_phase/static_boxes.h"

#include <stdatomic.h>
#include <stdint.h>

/* Sets near of the strip's rows whose records meet that of another row or of a fixed object, and of
 * those whose records are narrower than their boxes. near: [rows]; others are left as they are. Any
 * thread, each its own strips. */
void record_overlaps_find(const struct query_index *index, const struct static_boxes *fixed_boxes,
                          uint32_t strip, _Atomic uint8_t *near);

#endif
