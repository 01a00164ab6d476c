/* Pictures of trees, bushes and grass, painted leaf clump by leaf clump with the way each faces, so
 * that billboards of them are lit by the same sun as everything else. Pure. */
#ifndef JOLON_RENDERER_FOLIAGE_H
#define JOLON_RENDERER_FOLIAGE_H

#include <stdint.h>

#define FOLIAGE_SIDE 256u /* pixels of a picture's sides */

enum foliage {
    FOLIAGE_OAK_A, /* coast live oak: broad, dark */
    FOLIAGE_OAK_B,
    FOLIAGE_OAK_C,
    FOLIAGE_VALLEY_OAK_A, /* lighter, higher */
    FOLIAGE_VALLEY_OAK_B,
    FOLIAGE_PINE_A, /* gray pine: open, grey-green */
    FOLIAGE_PINE_B,
    FOLIAGE_FIR, /* narrow cone */
    FOLIAGE_BUSH_A,
    FOLIAGE_BUSH_B,
    FOLIAGE_BUSH_C,
    FOLIAGE_STUMP,
    FOLIAGE_GRASS_A,
    FOLIAGE_GRASS_B,
    FOLIAGE_COUNT
};

struct foliage_picture {
    uint8_t colour[FOLIAGE_SIDE][FOLIAGE_SIDE][4]; /* RGBA, rows from the top */
    uint8_t facing[FOLIAGE_SIDE][FOLIAGE_SIDE][4]; /* unit normal to the right, up, out of the
                                                      picture: 128 + 127 n; and free */
};

/* The plant stands on the middle of the lower edge and fills the picture. */
void foliage_paint(struct foliage_picture *picture, enum foliage which);

#endif
