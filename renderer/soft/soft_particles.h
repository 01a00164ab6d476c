/* Particles that are prepared for the picture: the set-up kernel fills this, the fill kernel reads
 * it. Private to soft_particles.c and its kernels. */
#ifndef JOLON_RENDERER_SOFT_SOFT_PARTICLES_H
#define JOLON_RENDERER_SOFT_SOFT_PARTICLES_H

#include "renderer/soft/band_lists.h"

#include <stdbool.h>

/* A particle uses the size of its picture whose texels are as large as its pixels, without
 * filtering. The largest size exceeds the texture's own, so that near particles look smooth. */
#define PARTICLE_LARGEST 256u
#define PARTICLE_LEVELS  8u /* 256 .. 2 */

/* Texels are evenly spaced in the picture if the particle faces the camera or is a strip at a
 * constant distance. For a streak, a strip whose distance varies, texel coordinates and depth are
 * divided by the distance. */
struct soft_particle {
    uint32_t texels; /* index of its picture's first texel */
    uint32_t level;  /* log2 of the side */
    float reach;     /* [texel] radius beyond which it is empty; of a streak: [pixel] half its width
                        around x */
    float x;
    float depth[3];       /* at pixel (0, 0), and its growth for each pixel to the right and down */
    float across[3];      /* texel column in the same form; of a streak, divided by the distance */
    float down[3];        /* texel row */
    float colour[3];      /* the particle's own, seen through the air; 255 for full */
    float air[3];         /* what the air in front of it adds */
    float dark, bright;   /* factor on the colour at brightness 0; its growth with brightness */
    float opacity;        /* opacity for each unit of the picture's opacity */
    float cover, hot;     /* share of the background that it hides; light that it adds */
    bool streak, clipped; /* clipped: the picture is not empty at the edges of its square */
    bool coarse;          /* large: one look-up for two by two pixels */
};

struct soft_particles {
    uint16_t *texels; /* owned: the opacity in the low byte, the brightness in the high byte */
    uint32_t first[PARTICLE_PICTURE_COUNT]
                  [PARTICLE_LEVELS + 1]; /* first texel of the level whose side is 2^i */
    float reach[PARTICLE_PICTURE_COUNT]; /* radius beyond which a picture is empty, in halves of its
                                            side */
    struct soft_particle *particles;     /* owned: those that can be seen, farthest first */
    struct band_rows *rows;              /* owned */
    size_t particle_room, row_room;
    uint32_t count;
    struct band_lists lists;
};

/* Returns NULL with the reason on failure. */
struct soft_particles *soft_particles_open(struct error_text *error);
void soft_particles_close(struct soft_particles *particles);
/* Sorts the particles into the bands. May run in a thread of its own. Returns 0, or -1 with errno
 * ENOMEM. */
int soft_particles_prepare(struct soft_particles *particles, const struct soft_frame *frame);

#endif
