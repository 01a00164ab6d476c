/* Textures that are computed once: fine ground, clouds, smoke and flames. Pure. */
#ifndef JOLON_RENDERER_SCENE_DRAW_LIST_TEXTURE_H
#define JOLON_RENDERER_SCENE_DRAW_LIST_TEXTURE_H

#include "renderer/scene/draw_list/draw_list.h"

#include <stdint.h>

#define TEXTURE_DETAIL_SIDE   512u
#define TEXTURE_CLOUD_SIDE    256u
#define TEXTURE_PARTICLE_SIDE 128u

/* Two channels that repeat without a seam, both with mean 128: grass, and scrub from above. */
void texture_detail(uint8_t (*texels)[2]);

/* One channel that repeats without a seam: cloud cover. */
void texture_clouds(uint8_t *texels);

/* First channel: opacity. Second channel: brightness, 128 is neutral. */
void texture_particle(uint8_t (*texels)[2], enum particle_picture picture);

#endif
