/* One view of what is to be drawn, and its camera. */
#ifndef JOLON_RENDERER_VIEW_PICTURE_H
#define JOLON_RENDERER_VIEW_PICTURE_H

#include "renderer/scene/camera/view_camera.h"
#include "renderer/views.h"

#include <stdint.h>

struct view_picture {
    struct view_wish wish;
    struct view_camera_wish aim_wish;
    struct view_camera aim;
    uint32_t slot; /* of its vehicle in the moment that is drawn; SLOT_NONE for none */
};

#endif
