/* JPEG by libjpeg-turbo, which reads four-byte pixels directly. */
#include "renderer/image/jpeg.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>

#define HEADERS_BYTES 4096u

struct jpeg_failure {
    struct jpeg_error_mgr manager; /* must be first: libjpeg points to it */
    jmp_buf back;
};

_Noreturn static void on_error(j_common_ptr jpeg)
{
    struct jpeg_failure *failure = (struct jpeg_failure *)jpeg->err;
    longjmp(failure->back, 1);
}

static void on_message(j_common_ptr jpeg)
{
    (void)jpeg;
}

/* All variables live in the caller, because longjmp() may discard those of this function. */
static int compress(struct jpeg_compress_struct *jpeg, struct jpeg_failure *failure,
                    const struct image *image, int quality, unsigned char **buffer,
                    unsigned long *length)
{
    if (setjmp(failure->back) != 0)
        return -1;
    jpeg_create_compress(jpeg);
    jpeg_mem_dest(jpeg, buffer, length);
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
    struct jpeg_failure failure;
    struct jpeg_compress_struct jpeg = {.err = jpeg_std_error(&failure.manager)};
    failure.manager.error_exit = on_error;
    failure.manager.output_message = on_message;
    /* This holds noise at the best quality, so that libjpeg allocates no buffer of its own. Memory
     * that is not written to costs nothing. */
    unsigned long length = ((image->width + 15ul) & ~15ul) * ((image->height + 15ul) & ~15ul) * 4;
    length += HEADERS_BYTES;
    unsigned char *buffer = malloc(length), *made = buffer;
    int result = buffer != NULL ? compress(&jpeg, &failure, image, quality, &made, &length) : -1;
    if (buffer != NULL)
        jpeg_destroy_compress(&jpeg);
    if (result == 0)
        CHECK(made == buffer);
    unsigned char *fitting = result == 0 ? realloc(buffer, length) : NULL;
    if (fitting == NULL) {
        free(buffer);
        errno = ENOMEM;
        return -1;
    }
    *bytes = fitting;
    *count = length;
    return 0;
}
