/* Repairs a damaged world: goes back to its newest whole frame. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_REPAIR_H
#define JOLON_IPC_SEGMENT_SEGMENT_REPAIR_H

struct error_text;

/* Checks a world and corrects its frame words. The locks of mover and collider are held meanwhile,
 * so neither may run. When the last frame is damaged, the frame before is committed again if it is
 * whole; when the moved table is damaged, the frame is moved again. What was lost is computed
 * again, to the same bytes. Returns 0 when the world is good, 1 when it was repaired, -1 when it
 * cannot be repaired or a role is held; report says in one line what was found and done. Hashes the
 * whole world: milliseconds, more with many entities. */
int segment_repair(const char *name, struct error_text *report);

#endif
