/* Text by FreeType. Each letter of a size is rendered once and kept, since pictures repeat their
 * words. */
#include "renderer/image/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LETTER_FIRST ' '
#define LETTER_LAST  '~'
#define LETTERS      (LETTER_LAST - LETTER_FIRST + 1)
#define SIZES        16u /* kept at once; the least recently used is evicted */
#define RIM_SHARE    14u /* a rim's width is the letters' size over this, but at least a pixel */

/* A letter's coverage, one byte for each pixel. */
struct glyph {
    uint8_t *coverage; /* [width * rows], NULL if the letter is blank; owned */
    int32_t left, top; /* of the first pixel, from the pen; up is positive */
    uint32_t width, rows;
};

struct letter {
    struct glyph fill, rim;
    int32_t advance;
    bool rendered;
};

struct font_size {
    uint32_t size; /* [pixel], 0: empty */
    uint64_t used; /* clock at the last use */
    struct letter letters[LETTERS];
};

struct text {
    FT_Library library;
    FT_Face face;
    uint64_t clock; /* counts uses */
    struct font_size sizes[SIZES];
};

/* Distributions install it in these places; Debian's is first. */
static const char *const font_paths[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",
};

struct text *text_open(struct error_text *error)
{
    struct text *text = calloc(1, sizeof *text);
    if (text == NULL || FT_Init_FreeType(&text->library) != 0) {
        free(text);
        error_text_set(error, "no memory for the font");
        return NULL;
    }
    for (size_t i = 0; i < sizeof font_paths / sizeof font_paths[0]; i++)
        if (FT_New_Face(text->library, font_paths[i], 0, &text->face) == 0)
            return text;
    FT_Done_FreeType(text->library);
    free(text);
    error_text_set(error,
                   "no font for the pictures: %s is not there; on Debian and Ubuntu: apt-get "
                   "install fonts-dejavu-core",
                   font_paths[0]);
    return NULL;
}

static void clear_size(struct font_size *size)
{
    for (uint32_t i = 0; i < LETTERS; i++) {
        free(size->letters[i].fill.coverage);
        free(size->letters[i].rim.coverage);
    }
    memset(size, 0, sizeof *size);
}

void text_close(struct text *text)
{
    if (text == NULL)
        return;
    for (uint32_t i = 0; i < SIZES; i++)
        clear_size(&text->sizes[i]);
    FT_Done_Face(text->face);
    FT_Done_FreeType(text->library);
    free(text);
}

/* --- letters ---------------------------------------------------------------------------------- */

static void store_fill(struct glyph *glyph, FT_GlyphSlot slot)
{
    const FT_Bitmap *bitmap = &slot->bitmap;
    *glyph = (struct glyph){.left = slot->bitmap_left,
                            .top = slot->bitmap_top,
                            .width = bitmap->width,
                            .rows = bitmap->rows};
    if (bitmap->width == 0 || bitmap->rows == 0)
        return;
    glyph->coverage = malloc((size_t)bitmap->width * bitmap->rows);
    if (glyph->coverage == NULL)
        return;
    for (uint32_t row = 0; row < bitmap->rows; row++)
        memcpy(glyph->coverage + (size_t)row * bitmap->width,
               bitmap->buffer + (ptrdiff_t)row * bitmap->pitch, bitmap->width);
}

/* Renders the letter's rim: the greatest coverage within that reach of each pixel [pixel]. */
static void render_rim(struct glyph *rim, const struct glyph *fill, int32_t reach)
{
    if (fill->coverage == NULL)
        return;
    *rim = (struct glyph){.left = fill->left - reach,
                          .top = fill->top + reach,
                          .width = fill->width + 2 * (uint32_t)reach,
                          .rows = fill->rows + 2 * (uint32_t)reach};
    rim->coverage = calloc((size_t)rim->width * rim->rows, 1);
    if (rim->coverage == NULL)
        return;
    for (int32_t dy = -reach; dy <= reach; dy++)
        for (int32_t dx = -reach; dx <= reach; dx++) {
            if (dx * dx + dy * dy > reach * reach + 1)
                continue;
            for (uint32_t row = 0; row < fill->rows; row++) {
                const uint8_t *from = fill->coverage + (size_t)row * fill->width;
                uint8_t *to =
                    rim->coverage + (size_t)((int32_t)row + reach + dy) * rim->width + reach + dx;
                for (uint32_t column = 0; column < fill->width; column++)
                    to[column] = from[column] > to[column] ? from[column] : to[column];
            }
        }
}

static struct font_size *find_size(struct text *text, uint32_t size)
{
    struct font_size *oldest = &text->sizes[0];
    text->clock++;
    for (uint32_t i = 0; i < SIZES; i++) {
        struct font_size *font_size = &text->sizes[i];
        if (font_size->size == size) {
            font_size->used = text->clock;
            return font_size;
        }
        if (font_size->used < oldest->used)
            oldest = font_size;
    }
    clear_size(oldest);
    oldest->size = size;
    oldest->used = text->clock;
    return oldest;
}

/* Returns a letter. Characters other than printable ASCII are drawn as '?'. A letter that cannot be
 * rendered for lack of memory is blank. */
static const struct letter *find_letter(struct text *text, struct font_size *size, char c)
{
    uint32_t index = c >= LETTER_FIRST && c <= LETTER_LAST ? (uint32_t)(c - LETTER_FIRST)
                                                           : (uint32_t)('?' - LETTER_FIRST);
    struct letter *letter = &size->letters[index];
    if (!letter->rendered) {
        letter->rendered = true;
        if (FT_Set_Pixel_Sizes(text->face, 0, size->size) != 0 ||
            FT_Load_Char(text->face, LETTER_FIRST + index, FT_LOAD_RENDER) != 0)
            return letter;
        uint32_t reach = size->size / RIM_SHARE;
        letter->advance = (int32_t)(text->face->glyph->advance.x >> 6);
        store_fill(&letter->fill, text->face->glyph);
        render_rim(&letter->rim, &letter->fill, reach > 1 ? (int32_t)reach : 1);
    }
    return letter;
}

/* --- drawing ---------------------------------------------------------------------------------- */

/* Emitted light is roughly the square of the stored value. Mixing the squares keeps thin strokes
 * equally strong on dark and on bright ground. The square root is exact, so the result is the same
 * everywhere. */
static uint8_t mix(uint8_t under, uint8_t over, float share)
{
    float u = (float)under * (float)under, o = (float)over * (float)over;
    return (uint8_t)(sqrtf(u + (o - u) * share) + 0.5f);
}

static void draw_glyph(const struct glyph *glyph, struct image *image, int32_t x, int32_t y,
                       struct rgba colour)
{
    if (glyph->coverage == NULL)
        return;
    x += glyph->left;
    y -= glyph->top;
    int32_t first = x < 0 ? -x : 0, end = (int32_t)glyph->width;
    if (x + end > (int32_t)image->width)
        end = (int32_t)image->width - x;
    for (int32_t row = 0; row < (int32_t)glyph->rows; row++) {
        if (y + row < 0 || y + row >= (int32_t)image->height)
            continue;
        const uint8_t *line = glyph->coverage + (size_t)row * glyph->width;
        uint8_t *pixels = image->pixels + ((size_t)(y + row) * image->width) * 4;
        for (int32_t column = first; column < end; column++) {
            if (line[column] == 0)
                continue;
            uint8_t *pixel = pixels + (size_t)(x + column) * 4;
            float share = (float)(line[column] * colour.a) * (1.0f / 65025.0f);
            pixel[0] = mix(pixel[0], colour.r, share);
            pixel[1] = mix(pixel[1], colour.g, share);
            pixel[2] = mix(pixel[2], colour.b, share);
        }
    }
}

int32_t text_draw(struct text *text, struct image *image, int32_t x, int32_t y, uint32_t size,
                  struct rgba colour, const char *string)
{
    struct font_size *font_size = find_size(text, size);
    for (const char *c = string; *c != '\0'; c++) {
        const struct letter *letter = find_letter(text, font_size, *c);
        draw_glyph(&letter->fill, image, x, y, colour);
        x += letter->advance;
    }
    return x;
}

int32_t text_draw_rimmed(struct text *text, struct image *image, int32_t x, int32_t y,
                         uint32_t size, struct rgba colour, const char *string)
{
    const struct rgba rim = {8, 10, 14, 190};
    struct font_size *font_size = find_size(text, size);
    int32_t pen = x;
    for (const char *c = string; *c != '\0'; c++) {
        const struct letter *letter = find_letter(text, font_size, *c);
        draw_glyph(&letter->rim, image, pen, y, rim);
        pen += letter->advance;
    }
    return text_draw(text, image, x, y, size, colour, string);
}

int32_t text_width(struct text *text, uint32_t size, const char *string)
{
    struct font_size *font_size = find_size(text, size);
    int32_t width = 0;
    for (const char *c = string; *c != '\0'; c++)
        width += find_letter(text, font_size, *c)->advance;
    return width;
}
