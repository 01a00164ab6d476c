/* libjpeg-turbo, which takes our pixels as they are. */
#include "renderer/image/jpeg.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>

#define HEADERS_BYTES 4096u

struct failing {
    struct jpeg_error_mgr manager; /* first: libjpeg knows no more of it */
    jmp_buf back;
};

_Noreturn static void on_error(j_common_ptr jpeg)
{
    struct failing *failing = (struct failing *)jpeg->err;
    longjmp(failing->back, 1);
}

static void on_message(j_common_ptr jpeg)
{
    (void)jpeg;
}

/* Everything that longjmp may return over lives in the caller's frame. */
static int compress(struct jpeg_compress_struct *jpeg, struct failing *failing,
                    const struct image *image, int quality, unsigned char **room,
                    unsigned long *length)
{
    if (setjmp(failing->back) != 0)
        return -1;
    jpeg_create_compress(jpeg);
    jpeg_mem_dest(jpeg, room, length);
    jpeg->image_width = image->width;
    jpeg->image_height = image->height;
    jpeg->input_components = 4;
    jpeg->in_color_space = JCS_EXT_RGBX;
    jpeg_set_defaults(jpeg);
    jpeg_set_quality(jpeg, quality, TRUE);
    jpeg_start_compress(jpeg, TRUE);
    while (jpeg->next_scanline < jpeg->image_height) {
        JSAMPROW row = image->pixels + (size_t)jpeg->next_scanline * image->width * 4;
        jpeg_write_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_compress(jpeg);
    return 0;
}

int jpeg_encode(const struct image *image, int quality, uint8_t **bytes, size_t *count)
{
    struct failing failing;
    struct jpeg_compress_struct jpeg = {.err = jpeg_std_error(&failing.manager)};
    failing.manager.error_exit = on_error;
    failing.manager.output_message = on_message;
    /* More than noise of the best quality takes, so that libjpeg makes no buffer of its own; memory
     * that is not written to costs nothing. */
    unsigned long length = ((image->width + 15ul) & ~15ul) * ((image->height + 15ul) & ~15ul) * 4;
    length += HEADERS_BYTES;
    unsigned char *room = malloc(length), *made = room;
    int result = room != NULL ? compress(&jpeg, &failing, image, quality, &made, &length) : -1;
    if (room != NULL)
        jpeg_destroy_compress(&jpeg);
    if (result == 0)
        CHECK(made == room);
    unsigned char *fitting = result == 0 ? realloc(room, length) : NULL;
    if (fitting == NULL) {
        free(room);
        errno = ENOMEM;
        return -1;
    }
    *bytes = fitting;
    *count = length;
    return 0;
}
