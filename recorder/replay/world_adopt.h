/* Adoption: continues the world that a dead set has left under a name. */
#ifndef JOLON_RECORDER_REPLAY_WORLD_ADOPT_H
#define JOLON_RECORDER_REPLAY_WORLD_ADOPT_H

#include "recorder/archive/image_format.h"

#include <stdbool.h>

struct params;

/* Returns true, and prints that, if the world called name is the one that would be made now: it has
 * the same scenario and settings, and if image is not NULL, it was made from that image or the
 * image was taken of it. That world continues from its newest whole frame. Another world of that
 * name is removed, and false is returned. Ends the process with the reason (exit 1) if the world is
 * in use, or damaged without an image to continue from. */
bool world_adopt(const char *name, const struct params *params, const struct image_header *image);

#endif
