/* Pictures of trees, bushes and grass, painted leaf clump by leaf clump with the way each faces, so
 * that billboards of them are lit by the same sun as everything else. Pure. */
#ifndef JOLON_RENDERER_SCENE_MODEL_PLANT_IMPOSTORS_H
#define JOLON_RENDERER_SCENE_MODEL_PLANT_IMPOSTORS_H

#include <stdint.h>

#define PLANT_IMPOSTORS_SIDE 256u /* pixels of a picture's sides */

enum plant_impostors {
    PLANT_IMPOSTORS_OAK_A, /* coast live oak: broad, dark */
    PLANT_IMPOSTORS_OAK_B,
    PLANT_IMPOSTORS_OAK_C,
    PLANT_IMPOSTORS_VALLEY_OAK_A, /* lighter, higher */
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
    uint8_t facing[PLANT_IMPOSTORS_SIDE][PLANT_IMPOSTORS_SIDE][4]; /* unit normal to the right, up,
                                                      out of the picture: 128 + 127 n; and free */
};

/* The plant stands on the middle of the lower edge and fills the picture. */
void plant_impostors_paint(struct plant_impostors_picture *picture, enum plant_impostors which);

#endif
