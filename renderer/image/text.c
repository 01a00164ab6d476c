/* Text by FreeType. Each letter is rendered when it is drawn: a picture has some hundred. */
#include "renderer/image/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <stdlib.h>

struct text {
    FT_Library library;
    FT_Face face;
};

/* Where distributions put it; Debian's first. */
static const char *const font_paths[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf",
    "/usr/share/fonts/dejavu-sans-mono-fonts/DejaVuSansMono.ttf",
    "/usr/share/fonts/TTF/DejaVuSansMono.ttf",
    "/usr/share/fonts/dejavu/DejaVuSansMono.ttf",
};

struct text *text_open(struct reason *reason)
{
    struct text *text = malloc(sizeof *text);
    if (text == NULL || FT_Init_FreeType(&text->library) != 0) {
        free(text);
        reason_set(reason, "no memory for the font");
        return NULL;
    }
    for (size_t i = 0; i < sizeof font_paths / sizeof font_paths[0]; i++)
        if (FT_New_Face(text->library, font_paths[i], 0, &text->face) == 0)
            return text;
    FT_Done_FreeType(text->library);
    free(text);
    reason_set(reason,
               "no font for the pictures: %s is not there; on Debian and Ubuntu: apt-get "
               "install fonts-dejavu-core",
               font_paths[0]);
    return NULL;
}

void text_close(struct text *text)
{
    FT_Done_Face(text->face);
    FT_Done_FreeType(text->library);
    free(text);
}

static void draw_letter(const FT_Bitmap *bitmap, struct image *image, int32_t x, int32_t y,
                        struct rgba colour)
{
    for (uint32_t row = 0; row < bitmap->rows; row++)
        for (uint32_t column = 0; column < bitmap->width; column++) {
            const uint8_t *line = bitmap->buffer + (ptrdiff_t)row * bitmap->pitch;
            if (line[column] != 0)
                image_blend(image, x + (int32_t)column, y + (int32_t)row, colour,
                            (float)line[column] / 255.0f);
        }
}

int32_t text_draw(struct text *text, struct image *image, int32_t x, int32_t y, uint32_t size,
                  struct rgba colour, const char *words)
{
    FT_Set_Pixel_Sizes(text->face, 0, size);
    for (const char *c = words; *c != '\0'; c++) {
        /* Names may hold anything; only printable ASCII is drawn. */
        FT_ULong letter = *c >= ' ' && *c <= '~' ? (FT_ULong)*c : '?';
        if (FT_Load_Char(text->face, letter, FT_LOAD_RENDER) != 0)
            continue;
        FT_GlyphSlot glyph = text->face->glyph;
        draw_letter(&glyph->bitmap, image, x + glyph->bitmap_left, y - glyph->bitmap_top, colour);
        x += (int32_t)(glyph->advance.x >> 6);
    }
    return x;
}

int32_t text_draw_rimmed(struct text *text, struct image *image, int32_t x, int32_t y,
                         uint32_t size, struct rgba colour, const char *words)
{
    const struct rgba rim = {8, 10, 14, 150};
    for (int32_t dy = -1; dy <= 1; dy++)
        for (int32_t dx = -1; dx <= 1; dx++)
            if (dx != 0 || dy != 0)
                text_draw(text, image, x + dx, y + dy, size, rim, words);
    return text_draw(text, image, x, y, size, colour, words);
}

int32_t text_width(struct text *text, uint32_t size, const char *words)
{
    int32_t width = 0;
    FT_Set_Pixel_Sizes(text->face, 0, size);
    for (const char *c = words; *c != '\0'; c++)
        if (FT_Load_Char(text->face, *c >= ' ' && *c <= '~' ? (FT_ULong)*c : '?',
                         FT_LOAD_DEFAULT) == 0)
            width += (int32_t)(text->face->glyph->advance.x >> 6);
    return width;
}
