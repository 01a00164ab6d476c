/* Conversion of pictures to video colours: luma for every pixel, chroma for every four. Pure. */
#ifndef JOLON_RENDERER_IMAGE_YUV_H
#define JOLON_RENDERER_IMAGE_YUV_H

#include "renderer/image/image.h"

#include <stddef.h>
#include <stdint.h>

/* ITU-R BT.709 in its limited range, 4:2:0: Y' 16..235 for each pixel, Cb and Cr 16..240 for the
 * mean of each two by two pixels, sited in their middle. */
struct yuv {
    uint8_t *plane[3]; /* Y', Cb, Cr; owned by the caller */
    int stride[3];     /* [byte] from row to row */
};

/* Converts the picture, its width and height each rounded down to an even number. */
void yuv_of_image(const struct yuv *yuv, const struct image *image);

#endif
