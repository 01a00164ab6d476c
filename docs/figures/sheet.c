/* Figures for the documents: one picture in few colours, or several with captions on one sheet. */
#include "docs/figures/palette.h"
#include "renderer/image/text.h"

#include <png.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MARGIN         10 /* [pixel] around each picture of a sheet */
#define CAPTION_SIZE   15u
#define CAPTION_HEIGHT 32
#define FIGURES_MAX    32

static const char usage_text[] =
    "usage: sheet reduce FROM.png TO.png\n"
    "       sheet compose TO.png COLUMNS WIDTHxHEIGHT CAPTION FILE [CAPTION FILE]...\n"
    "Writes PNG files of 256 colours: a picture of its own size, or pictures scaled down to a "
    "size\n"
    "and laid out in columns with captions.\n";

static _Noreturn void refuse(const char *what, const char *detail)
{
    fprintf(stderr, "sheet: %s: %s\n", what, detail);
    exit(1);
}

static void read_picture(struct image *image, const char *path)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&png, path))
        refuse(path, png.message);
    png.format = PNG_FORMAT_RGBA;
    if (image_init(image, png.width, png.height) != 0)
        refuse(path, "no memory");
    if (!png_image_finish_read(&png, NULL, image->pixels, 0, NULL))
        refuse(path, png.message);
}

static void write_picture(const struct image *image, const char *path)
{
    static struct palette palette;
    uint8_t *indices = malloc((size_t)image->width * image->height);
    if (indices == NULL || palette_reduce(&palette, indices, image) != 0)
        refuse(path, "no memory");
    png_image png = {.version = PNG_IMAGE_VERSION,
                     .width = image->width,
                     .height = image->height,
                     .format = PNG_FORMAT_RGB_COLORMAP,
                     .colormap_entries = palette.count};
    if (!png_image_write_to_file(&png, path, 0, indices, 0, palette.colours))
        refuse(path, png.message);
    free(indices);
}

/* Returns the mean of one channel over the part of a picture that a pixel of the sheet covers. */
static uint8_t covered_mean(const struct image *from, double x0, double y0, double x1, double y1,
                            uint32_t channel)
{
    double sum = 0.0, area = 0.0;
    for (uint32_t y = (uint32_t)y0; y < from->height && y < y1; y++)
        for (uint32_t x = (uint32_t)x0; x < from->width && x < x1; x++) {
            double left = x > x0 ? x : x0, right = x + 1.0 < x1 ? x + 1.0 : x1;
            double top = y > y0 ? y : y0, bottom = y + 1.0 < y1 ? y + 1.0 : y1;
            double share = (right - left) * (bottom - top);
            sum += share * from->pixels[((size_t)y * from->width + x) * 4 + channel];
            area += share;
        }
    return (uint8_t)(sum / area + 0.5);
}

static void scale_into(struct image *sheet, int32_t left, int32_t top, uint32_t width,
                       uint32_t height, const struct image *from)
{
    double across = (double)from->width / width, down = (double)from->height / height;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint8_t *pixel =
                sheet->pixels +
                ((size_t)(top + (int32_t)y) * sheet->width + (size_t)(left + (int32_t)x)) * 4;
            for (uint32_t i = 0; i < 3; i++)
                pixel[i] =
                    covered_mean(from, x * across, y * down, (x + 1) * across, (y + 1) * down, i);
        }
}

static void compose(int count, char **figures, const char *to, uint32_t columns, uint32_t width,
                    uint32_t height)
{
    uint32_t rows = ((uint32_t)count + columns - 1) / columns;
    struct image sheet, picture;
    struct error_text error;
    struct text *text = text_open(&error);
    if (text == NULL)
        refuse("font", error.text);
    if (image_init(&sheet, columns * (width + MARGIN) + MARGIN,
                   rows * (height + CAPTION_HEIGHT) + MARGIN) != 0)
        refuse(to, "no memory");
    image_rectangle(&sheet, 0, 0, (int32_t)sheet.width, (int32_t)sheet.height,
                    (struct rgba){22, 26, 30, 255});
    for (uint32_t i = 0; i < (uint32_t)count; i++) {
        int32_t left = MARGIN + (int32_t)(i % columns * (width + MARGIN));
        int32_t top = MARGIN + (int32_t)(i / columns * (height + CAPTION_HEIGHT));
        read_picture(&picture, figures[i * 2 + 1]);
        scale_into(&sheet, left, top, width, height, &picture);
        image_free(&picture);
        text_draw(text, &sheet, left, top + (int32_t)(height + CAPTION_SIZE * 5 / 4), CAPTION_SIZE,
                  (struct rgba){226, 230, 228, 255}, figures[i * 2]);
    }
    write_picture(&sheet, to);
    image_free(&sheet);
    text_close(text);
}

int main(int argc, char **argv)
{
    struct image picture;
    unsigned columns, width, height;
    if (argc == 4 && strcmp(argv[1], "reduce") == 0) {
        read_picture(&picture, argv[2]);
        write_picture(&picture, argv[3]);
        image_free(&picture);
        return 0;
    }
    int figures = (argc - 5) / 2;
    if (argc >= 7 && argc % 2 == 1 && figures <= FIGURES_MAX && strcmp(argv[1], "compose") == 0 &&
        sscanf(argv[3], "%2u", &columns) == 1 && columns > 0 &&
        sscanf(argv[4], "%4ux%4u", &width, &height) == 2 && width > 0 && height > 0) {
        compose(figures, argv + 5, argv[2], columns, width, height);
        return 0;
    }
    fputs(usage_text, stderr);
    return 2;
}
