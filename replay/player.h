/* A player: mover's and collider's steps on a world in this process's own memory (segment_private),
 * frame by frame, without a clock, doorbells or other processes. The frame that it makes is to the
 * bit the one that the roles make of the same world and commands. */
#ifndef JOLON_REPLAY_PLAYER_H
#define JOLON_REPLAY_PLAYER_H

#include "collider/step.h"
#include "ipc/segment.h"
#include "mover/step.h"
#include "world/workers.h"

#include <stdint.h>

struct player {
    struct view *view; /* the caller's; writable */
    struct workers *workers;
    struct mover mover;
    struct collider collider;
};

/* On a view that is filled (segment_fill, image_load) and stays where it is until player_free.
 * threads 1..WORKERS_MAX. 0; -1 with errno ENOMEM or EAGAIN and nothing to free. */
int player_init(struct player *player, struct view *view, uint32_t threads);
void player_free(struct player *player);

/* What the mover would take now: each ring of the view up to its head. */
void player_sources(const struct view *view, struct command_source sources[COMMAND_RING_COUNT]);

/* The frame after the committed one: moved with the commands of sources (NULL: player_sources()),
 * which a moved table that holds that frame already makes superfluous; collided; committed. */
void player_step(struct player *player, const struct command_source *sources);

/* The two halves of it: the moved table anew, whatever it holds; the commit of what it holds. */
void player_move(struct player *player, const struct command_source *sources);
void player_collide(struct player *player);

/* The last committed frame. */
uint64_t player_frame(const struct player *player);

#endif
