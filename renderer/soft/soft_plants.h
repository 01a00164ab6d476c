/* Plants that are prepared for the picture: the set-up kernel fills this, the fill kernels read it.
 * Private to soft_plants.c and its kernels. */
#ifndef JOLON_RENDERER_SOFT_SOFT_PLANTS_H
#define JOLON_RENDERER_SOFT_SOFT_PLANTS_H

#include "renderer/scene/model/plant_impostors.h"
#include "renderer/soft/band_lists.h"

#include <stdbool.h>

#define PLANT_LEVELS 8u    /* sizes of a picture: 256 .. 2 texels a side */
#define PLANT_OPEN   1.05f /* the greatest share of light that reaches a texel */

/* A texel: its colour under the sky's light, and alpha; its normal, and the share of light that
 * reaches it, 255 for PLANT_OPEN. */
struct soft_leaf {
    uint32_t colour, facing;
};

/* A picture that stands in space or lies on the ground. depth, across, down: the value at the
 * centre of pixel (0, 0), and its growth for each pixel to the right and down. */
struct soft_billboard {
    float depth[3];
    float across[3];     /* texel column / distance */
    float down[3];       /* texel row / distance */
    int16_t left, right; /* columns left .. right - 1 of the picture may show it */
    uint16_t level;      /* log2 of its side [texel] */
    uint16_t cut;        /* texels with a smaller alpha are transparent */
    uint32_t leaves;     /* index of the picture's first texel */
};

struct soft_plant {
    struct soft_billboard board;
    float sky[3], sun[3]; /* factors on a texel's colour, seen through the air; 255 for full */
    float air[3];         /* what the air in front of it adds */
    float to_sun[3];      /* unit vector: to the right, up, out of the picture */
    bool mixed;           /* with bilinear filtering */
};

/* The shadow of a plant. */
struct soft_plant_shadow {
    struct soft_billboard board;
    uint32_t dark; /* 1 .. SOFT_SHADOW_FULL */
};

struct soft_plants {
    struct soft_leaf *leaves; /* owned */
    uint32_t first[PLANT_IMPOSTORS_COUNT]
                  [PLANT_LEVELS + 1];  /* first texel of the level whose side is 2^i */
    struct soft_plant *plants;         /* owned: those that can be seen */
    struct soft_plant_shadow *shadows; /* owned */
    struct band_rows *rows, *shadow_rows;
    size_t plant_room, shadow_room, row_room, shadow_row_room;
    uint32_t count, shadow_count;
    struct band_lists lists, shadow_lists;
};

/* Returns NULL with the reason on failure. */
struct soft_plants *soft_plants_open(struct error_text *error);
void soft_plants_close(struct soft_plants *plants);
/* Sorts the plants and their shadows into the bands. May run in a thread of its own. Returns 0, or
 * -1 with errno ENOMEM. */
int soft_plants_prepare(struct soft_plants *plants, const struct soft_frame *frame);

#endif
