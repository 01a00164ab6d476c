/* Ground from a ground file. Called at creation only. */
#ifndef JOLON_WORLD_MAKING_GROUND_LOAD_H
#define JOLON_WORLD_MAKING_GROUND_LOAD_H

struct error_text;
struct world_build;

/* Fills built's posts, cover and roads from the scenario's ground file. 0, or -1 with the reason:
 * the file is damaged, or is no longer the one that the scenario was read with. */
int ground_load(struct world_build *built, struct error_text *error);

#endif
