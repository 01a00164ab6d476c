/* The light that every part of a picture agrees on: a Californian afternoon. */
#ifndef JOLON_RENDERER_SCENE_FRAME_LIGHT_H
#define JOLON_RENDERER_SCENE_FRAME_LIGHT_H

#include "world/maths/maths.h"

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

/* Colours of the sky and of what is in the air, as three numbers: shaders take them as text. */
#define SKY_DEEP     0.215f, 0.405f, 0.715f /* overhead */
#define SKY_MID      0.475f, 0.645f, 0.860f
#define HORIZON_COOL 0.700f, 0.785f, 0.865f /* away from the sun */
#define HORIZON_WARM 0.955f, 0.885f, 0.770f /* below it */
#define FOG_WHITE    0.800f, 0.820f, 0.830f
#define SUN_WARM     1.000f, 0.860f, 0.620f /* the sun and the glow around it */
#define CLOUD_SHADE  0.800f, 0.830f, 0.880f
#define CLOUD_LIT    1.000f, 0.975f, 0.930f
#define FOAM_WHITE   0.900f, 0.930f, 0.930f

/* The air. Haze is everywhere; fog lies in the valleys and thins out upwards. */
#define HAZE_PER_M     (1.0 / 36000.0)
#define CLEAR_PER_M    (1.0 / 400000.0) /* without haze */
#define FOG_PER_M      (1.0 / 9000.0)   /* at its base */
#define FOG_BASE_M     180.0
#define FOG_FALL_PER_M (1.0 / 120.0)

/* The sun is a disc whose edge lies between these cosines of the angle to its middle. */
#define SUN_EDGE  0.99990f
#define SUN_WHOLE 0.99995f

/* The fine texture over the paintings: its period, and where it fades out: from further away it
 * would be seen to repeat. */
#define FINE_M       11.3f
#define FINE_FADES_M 50.0f
#define FINE_FADED_M 350.0f

/* Waves are the fine texture, too: the unit of their periods, how steep they are, the distance at
 * which they look half so steep, and how much higher in the sky a rough sea's reflections come
 * from. */
#define WAVES_M     131.0f
#define WAVE_STEEP  0.22f
#define WAVE_HALF_M 450.0f
#define WAVE_LIFT   0.07f

#define SURF_S 7.8f /* from one wave on the shore to the next */

/* Alpha of a painting, 0..1: water up to the first, where the sea meets the land, ground from the
 * second on. */
#define SHORE_WATER  0.26f
#define SHORE_GROUND 0.35f

/* Text of a macro's value. */
#define LIGHT_TEXT(...)    LIGHT_TEXT_OF(__VA_ARGS__)
#define LIGHT_TEXT_OF(...) #__VA_ARGS__

static inline struct vec3 light_sun(void)
{
    return (struct vec3){SUN_X, SUN_Y, SUN_Z};
}

#endif
