/* The light that every part of a picture agrees on: a Californian afternoon. */
#ifndef JOLON_RENDERER_LIGHT_H
#define JOLON_RENDERER_LIGHT_H

#include "world/maths.h"

/* Unit vector to the sun: bearing 250 degrees, 34 degrees high. */
#define SUN_X -0.7790
#define SUN_Y 0.5592
#define SUN_Z 0.2836

/* Light on a surface, as factors on its colour: the sky's from all round, the sun's straight on. */
#define SKY_LIGHT_RED   0.44f
#define SKY_LIGHT_GREEN 0.48f
#define SKY_LIGHT_BLUE  0.56f
#define SUN_LIGHT_RED   0.76f
#define SUN_LIGHT_GREEN 0.70f
#define SUN_LIGHT_BLUE  0.56f

static inline struct vec3 light_sun(void)
{
    return (struct vec3){SUN_X, SUN_Y, SUN_Z};
}

#endif
