/* One view of what is to be drawn, and its camera. */
#ifndef JOLON_RENDERER_SHOT_H
#define JOLON_RENDERER_SHOT_H

#include "renderer/scene/aim.h"
#include "renderer/views.h"

#include <stdint.h>

struct shot {
    struct view_wish wish;
    struct aim_wish aim_wish;
    struct aim aim;
    uint32_t slot; /* of its vehicle in the moment that is drawn; SLOT_NONE for none */
};

#endif
