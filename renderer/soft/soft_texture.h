/* Textures of the ground and the sky, laid out for looking up. Private to the ground's files. */
#ifndef JOLON_RENDERER_SOFT_SOFT_TEXTURE_H
#define JOLON_RENDERER_SOFT_SOFT_TEXTURE_H

#include <stdint.h>

#define SOFT_DETAIL_POWER 9 /* the largest mip has 2^9 texels a side, the last one */
#define SOFT_DETAIL_MIPS  (SOFT_DETAIL_POWER + 1)

/* Each row goes on with its first texels: one for what lies between the last and the first, the
 * others because rows of powers of two would fight for the same few places in the cache. */
#define SOFT_DETAIL_PAD 16

/* The fine texture. Each texel comes with the one below it, red and green of both, so that one load
 * of eight bytes finds all four around a place; the edges meet. */
struct soft_detail {
    uint8_t *mip[SOFT_DETAIL_MIPS]; /* the first owned, the others behind it */
};

/* 0, or -1 with errno ENOMEM. */
int soft_detail_make(struct soft_detail *detail);
void soft_detail_free(struct soft_detail *detail);

/* The clouds, a byte each: rows are followed by their first two texels again, and the last row by
 * the first. NULL with errno ENOMEM; free() it. */
uint8_t *soft_clouds_make(void);

#endif
