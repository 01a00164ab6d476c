/* Puffs made ready for the picture: what set-up leaves for the bands. Private to soft_particles.c
 * and its kernels. */
#ifndef JOLON_RENDERER_SOFT_SOFT_PARTICLES_H
#define JOLON_RENDERER_SOFT_SOFT_PARTICLES_H

#include "renderer/soft/band_lists.h"

#include <stdbool.h>

/* Pictures at falling sizes: a puff takes the one whose texels are as large as its pixels, and
 * reads it without filtering. They begin larger than they are painted: smooth when seen from near.
 */
#define PARTICLE_LARGEST 256u
#define PARTICLE_LEVELS  8u /* 256 .. 2 */

/* A puff's texels lie evenly in the picture: it faces it, or is a strip that keeps its distance. Of
 * a streak, a strip that does not, texels and depth do so only over the distance. */
struct soft_particle {
    uint32_t texels; /* where its picture begins at its level */
    uint32_t level;  /* log2 of the side */
    float reach;     /* [texel] beyond it there is nothing; of a streak [pixel], about: */
    float x;
    float depth[3];       /* of pixels 0, 0, and its growth to the right and down */
    float across[3];      /* texel column, likewise; of a streak over the distance */
    float down[3];        /* texel row */
    float colour[3];      /* the puff's own, seen through the air; 255 for full */
    float air[3];         /* what the air in front of it adds */
    float dark, bright;   /* factors on the colour: where the picture is black, and by a step */
    float much;           /* of what the picture's 255 stands for */
    float cover, hot;     /* how far it covers what is behind it; and adds light of its own */
    bool streak, clipped; /* clipped: the picture ends at the edge of its square, not within */
    bool coarse;          /* large: a texel for two by two pixels */
};

struct soft_particles {
    uint16_t *texels; /* owned: low byte how much, high byte how bright */
    uint32_t first[PARTICLE_PICTURE_COUNT]
                  [PARTICLE_LEVELS + 1]; /* of the level whose side is 2^i */
    float reach[PARTICLE_PICTURE_COUNT]; /* what is farther from the middle is empty: 1 is half a
                                            side */
    struct soft_particle *particles;     /* owned: those that can be seen, farthest first */
    struct band_rows *rows;              /* owned, theirs */
    size_t particle_room, row_room;
    uint32_t count;
    struct band_lists lists;
};

/* NULL with the reason. */
struct soft_particles *soft_particles_open(struct error_text *error);
void soft_particles_close(struct soft_particles *particles);
/* Sorts the particles of the scene into the bands. May run in a thread of its own. 0, or -1 with
 * errno ENOMEM. */
int soft_particles_prepare(struct soft_particles *particles, const struct soft_frame *frame);

#endif
