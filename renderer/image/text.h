/* Text in pictures, from an installed font (FreeType). Each letter of a size is rendered once,
 * hinted to whole pixels, and kept. */
#ifndef JOLON_RENDERER_IMAGE_TEXT_H
#define JOLON_RENDERER_IMAGE_TEXT_H

#include "ipc/segment/segment.h"
#include "renderer/image/image.h"

struct text; /* an open font */

/* Opens the DejaVu Sans font. Returns NULL with the reason when it is not installed. */
struct text *text_open(struct error_text *error);
void text_close(struct text *text); /* NULL is allowed */

/* Writes ASCII text with its left end and baseline at (x, y); size is a line's height [pixel].
 * Returns the x at which further text would begin. */
int32_t text_draw(struct text *text, struct image *image, int32_t x, int32_t y, uint32_t size,
                  struct rgba colour, const char *string);

/* The same with a dark rim, which keeps the text legible on any ground. */
int32_t text_draw_rimmed(struct text *text, struct image *image, int32_t x, int32_t y,
                         uint32_t size, struct rgba colour, const char *string);

/* Returns the text's width [pixel]. */
int32_t text_width(struct text *text, uint32_t size, const char *string);

#endif
