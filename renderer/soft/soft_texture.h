/* Textures of the ground and the sky, laid out for fast look-up. Private to renderer/soft. */
#ifndef JOLON_RENDERER_SOFT_SOFT_TEXTURE_H
#define JOLON_RENDERER_SOFT_SOFT_TEXTURE_H

#include <stdint.h>

#define SOFT_DETAIL_POWER 9 /* the largest mip has 2^9 texels a side, the smallest 1 */
#define SOFT_DETAIL_MIPS  (SOFT_DETAIL_POWER + 1)

/* Each row is followed by its first texels again: one for the look-up between the last and the
 * first; the others because rows of a power of two would compete for the same cache lines. */
#define SOFT_DETAIL_PAD 16

/* The detail texture. Each texel is stored with the one below it, red and green of both, so that
 * one load of eight bytes finds the four texels around a point. It repeats without a seam. */
struct soft_detail {
    uint8_t *mip[SOFT_DETAIL_MIPS]; /* [0] owns the memory of all */
};

/* Returns 0, or -1 with errno ENOMEM. */
int soft_detail_make(struct soft_detail *detail);
void soft_detail_free(struct soft_detail *detail);

/* Returns the cloud texture, one byte a texel: each row is followed by its first two texels again,
 * and the last row by the first. Returns NULL with errno ENOMEM. The caller frees it. */
uint8_t *soft_clouds_make(void);

#endif
