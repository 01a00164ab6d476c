/* Light and air, which are the same in all parts of a picture: a Californian afternoon. */
#ifndef JOLON_RENDERER_SCENE_FRAME_LIGHT_H
#define JOLON_RENDERER_SCENE_FRAME_LIGHT_H

#include "world/maths/maths.h"

/* Unit vector to the sun: bearing 250 degrees, 34 degrees high. */
#define SUN_X -0.7790
#define SUN_Y 0.5592
#define SUN_Z 0.2836

/* Light on a surface, as factors on its colour: from the sky on all sides, and from the sun at a
 * right angle. */
#define SKY_LIGHT_RED   0.44f
#define SKY_LIGHT_GREEN 0.48f
#define SKY_LIGHT_BLUE  0.56f
#define SUN_LIGHT_RED   0.76f
#define SUN_LIGHT_GREEN 0.70f
#define SUN_LIGHT_BLUE  0.56f

/* Colours of the sky and of the air as three numbers each, because shaders take them as text. */
#define SKY_DEEP     0.215f, 0.405f, 0.715f /* overhead */
#define SKY_MID      0.475f, 0.645f, 0.860f
#define HORIZON_COOL 0.700f, 0.785f, 0.865f /* away from the sun */
#define HORIZON_WARM 0.955f, 0.885f, 0.770f /* below the sun */
#define FOG_WHITE    0.800f, 0.820f, 0.830f
#define SUN_WARM     1.000f, 0.860f, 0.620f /* the sun and the glow around it */
#define CLOUD_SHADE  0.800f, 0.830f, 0.880f
#define CLOUD_LIT    1.000f, 0.975f, 0.930f
#define FOAM_WHITE   0.900f, 0.930f, 0.930f

/* The air. Haze is everywhere. Fog lies in the valleys and becomes thinner with height. */
#define HAZE_PER_M     (1.0 / 36000.0)
#define CLEAR_PER_M    (1.0 / 400000.0) /* without haze */
#define FOG_PER_M      (1.0 / 9000.0)   /* at its base */
#define FOG_BASE_M     180.0
#define FOG_FALL_PER_M (1.0 / 120.0)

/* The sun is a disc whose edge lies between these cosines of the angle to its middle. */
#define SUN_EDGE  0.99990f
#define SUN_WHOLE 0.99995f

/* The fine texture over the ground textures: its period, and where it fades out, because from
 * farther away its repetition would be visible. */
#define FINE_M       11.3f
#define FINE_FADES_M 50.0f
#define FINE_FADED_M 350.0f

/* Waves use the fine texture as well: the unit of their periods, their steepness, the distance at
 * which they look half as steep, and how much higher in the sky a rough sea's reflections come
 * from. */
#define WAVES_M     131.0f
#define WAVE_STEEP  0.22f
#define WAVE_HALF_M 450.0f
#define WAVE_LIFT   0.07f

#define SURF_S 7.8f /* time between two waves on the shore */

/* Alpha of a ground texture, 0..1: water up to the first, ground from the second on, the shore of
 * the sea in between. */
#define SHORE_WATER  0.26f
#define SHORE_GROUND 0.35f

/* The value of a macro as text. */
#define LIGHT_TEXT(...)    LIGHT_TEXT_OF(__VA_ARGS__)
#define LIGHT_TEXT_OF(...) #__VA_ARGS__

static inline struct vec3 light_sun(void)
{
    return (struct vec3){SUN_X, SUN_Y, SUN_Z};
}

#endif
