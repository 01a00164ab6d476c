/* Pictures in the colours of video: brightness for every pixel, colour for every four. Pure. */
#ifndef JOLON_RENDERER_IMAGE_YUV_H
#define JOLON_RENDERER_IMAGE_YUV_H

#include "renderer/image/image.h"

#include <stddef.h>
#include <stdint.h>

/* ITU-R BT.709 in its limited range, 4:2:0: Y' 16..235 and for two by two pixels Cb and Cr 16..240,
 * of their mean, so sited in their middle. */
struct yuv {
    uint8_t *plane[3]; /* Y', Cb, Cr; the caller's */
    int stride[3];     /* [byte] from row to row */
};

/* Converts the picture's width and height, each rounded down to an even number. */
void yuv_of_image(const struct yuv *yuv, const struct image *image);

#endif
