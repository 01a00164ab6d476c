/* Pictures of trees, bushes and grass for billboards. Each pixel has a colour and a normal, so that
 * plants are lit like everything else. Pure. */
#ifndef JOLON_RENDERER_SCENE_MODEL_PLANT_IMPOSTORS_H
#define JOLON_RENDERER_SCENE_MODEL_PLANT_IMPOSTORS_H

#include <stdint.h>

#define PLANT_IMPOSTORS_SIDE 256u /* side of a picture [pixel] */

enum plant_impostors {
    PLANT_IMPOSTORS_OAK_A, /* coast live oak: broad, dark */
    PLANT_IMPOSTORS_OAK_B,
    PLANT_IMPOSTORS_OAK_C,
    PLANT_IMPOSTORS_VALLEY_OAK_A, /* lighter, taller */
    PLANT_IMPOSTORS_VALLEY_OAK_B,
    PLANT_IMPOSTORS_PINE_A, /* gray pine: open, grey-green */
    PLANT_IMPOSTORS_PINE_B,
    PLANT_IMPOSTORS_FIR, /* narrow cone */
    PLANT_IMPOSTORS_BUSH_A,
    PLANT_IMPOSTORS_BUSH_B,
    PLANT_IMPOSTORS_BUSH_C,
    PLANT_IMPOSTORS_STUMP,
    PLANT_IMPOSTORS_GRASS_A,
    PLANT_IMPOSTORS_GRASS_B,
    PLANT_IMPOSTORS_COUNT
};

struct plant_impostors_picture {
    uint8_t colour[PLANT_IMPOSTORS_SIDE][PLANT_IMPOSTORS_SIDE][4]; /* RGBA, rows from the top */
    uint8_t facing[PLANT_IMPOSTORS_SIDE][PLANT_IMPOSTORS_SIDE]
                  [4]; /* unit normal to the right, up, out of the picture: 128 + 127 n; unused */
};

/* Draws a plant. It stands on the middle of the lower edge and fills the picture. */
void plant_impostors_paint(struct plant_impostors_picture *picture, enum plant_impostors which);

#endif
