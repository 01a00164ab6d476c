/* Plants made ready for the picture: what set-up leaves for the bands. Private to soft_plants.c and
 * its kernels. */
#ifndef JOLON_RENDERER_SOFT_SOFT_PLANTS_H
#define JOLON_RENDERER_SOFT_SOFT_PLANTS_H

#include "renderer/scene/model/plant_impostors.h"
#include "renderer/soft/band_lists.h"

#include <stdbool.h>

#define PLANT_LEVELS 8u    /* of a picture: 256 .. 2 texels a side */
#define PLANT_OPEN   1.05f /* most light that a texel's place in the picture lets through */

/* A texel: its colour as the sky's light there leaves it, and alpha; the way it faces, and how much
 * light its place gets, 255 for PLANT_OPEN. */
struct soft_leaf {
    uint32_t colour, facing;
};

/* A picture standing in space or lying on the ground: its texels and 1 / distance over the picture.
 * The three numbers: at the centre of pixel (0, 0), and growth to the right and down. */
struct soft_billboard {
    float depth[3];
    float across[3];     /* texel column over the distance */
    float down[3];       /* texel row, likewise */
    int16_t left, right; /* columns of the picture that may hold it */
    uint16_t level;      /* log2 of the side */
    uint16_t cut;        /* of alpha: less is not there */
    uint32_t leaves;     /* where its picture begins at its level */
};

struct soft_plant {
    struct soft_billboard board;
    float sky[3], sun[3]; /* light on a texel's colour, seen through the air; 255 for full */
    float air[3];         /* what the air before it adds */
    float to_sun[3];      /* unit: to the right, up, out of the picture */
    bool mixed;           /* between four texels each */
};

/* Its shadow. */
struct soft_cast {
    struct soft_billboard board;
    uint32_t dark; /* 1 .. SOFT_SHADOW_FULL */
};

struct soft_plants {
    struct soft_leaf *leaves;                                /* owned */
    uint32_t first[PLANT_IMPOSTORS_COUNT][PLANT_LEVELS + 1]; /* of the level whose side is 2^i */
    struct soft_plant *plants;                               /* owned: those in the picture */
    struct soft_cast *casts;                                 /* owned */
    struct band_rows *rows, *cast_rows;
    size_t plant_room, cast_room, row_room, cast_row_room;
    uint32_t count, cast_count;
    struct band_lists lists, cast_lists;
};

/* NULL with the reason. */
struct soft_plants *soft_plants_open(struct error_text *error);
void soft_plants_close(struct soft_plants *plants);
/* Sorts the plants of the scene into the bands, and their shadows. May run in a thread of its own.
 * 0, or -1 with errno ENOMEM. */
int soft_plants_prepare(struct soft_plants *plants, const struct soft_frame *frame);

#endif
