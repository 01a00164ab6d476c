/* The way back of a damaged world to its newest whole frame. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_REPAIR_H
#define JOLON_IPC_SEGMENT_SEGMENT_REPAIR_H

struct error_text;

/* Looks at a world that no mover and no collider runs (their locks are held meanwhile) and puts its
 * words right: when the last frame is damaged it goes back to the one before, if that is whole;
 * when the moved table is, the frame is moved again. What was lost is computed again, to the same
 * bytes. 0 when the world is good, 1 when it was repaired, -1 when it cannot be or is run; report
 * says in one line what was found and done. Hashes the whole world: milliseconds, more with many
 * entities. */
int segment_repair(const char *name, struct error_text *report);

#endif
