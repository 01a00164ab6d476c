/* Words in pictures, from an installed font (FreeType). Each letter of a size is rendered once,
 * hinted to whole pixels, and kept; it is laid over the picture in proportion to light. */
#ifndef JOLON_RENDERER_IMAGE_TEXT_H
#define JOLON_RENDERER_IMAGE_TEXT_H

#include "ipc/segment/segment.h"
#include "renderer/image/image.h"

struct text; /* a font, opened */

/* Opens the DejaVu Sans font. NULL with the reason when it is not installed. */
struct text *text_open(struct error_text *error);
void text_close(struct text *text); /* NULL is nothing */

/* Writes ASCII words with their left end and baseline at (x, y); size is a line's height [pixel].
 * Returns where the next word would begin. */
int32_t text_draw(struct text *text, struct image *image, int32_t x, int32_t y, uint32_t size,
                  struct rgba colour, const char *words);

/* The same with a dark rim, to be read on any ground. */
int32_t text_draw_rimmed(struct text *text, struct image *image, int32_t x, int32_t y,
                         uint32_t size, struct rgba colour, const char *words);

/* Pixels that the words would take. */
int32_t text_width(struct text *text, uint32_t size, const char *words);

#endif
