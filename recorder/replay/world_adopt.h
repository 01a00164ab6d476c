/* Adoption: what a set that died left under a world's name, and whether it goes on. */
#ifndef JOLON_RECORDER_REPLAY_WORLD_ADOPT_H
#define JOLON_RECORDER_REPLAY_WORLD_ADOPT_H

#include "recorder/archive/image_format.h"

#include <stdbool.h>

struct params;

/* True, having said so, when the world called name is the one that would be made now: of the same
 * scenario and settings, and where image is not NULL either made from that very image or the one
 * that the image was taken of; it goes on from its newest whole frame. Any other world of that name
 * is removed: false. Ends the process with the reason (exit 1) when it is in use, and when it is
 * damaged and there is no image to go on from. */
bool world_adopt_world(const char *name, const struct params *params,
                       const struct image_header *image);

#endif
