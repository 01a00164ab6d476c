/* PNG output: fast settings, since pictures are many and disks are large. */
#include "renderer/image/png.h"

#include <png.h>

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PATH_BYTES 4096

static void on_error(png_structp png, png_const_charp text)
{
    /* libpng says only that writing failed; the errno of the write is what people need. */
    (void)text;
    if (errno == 0)
        errno = EIO;
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

/* Everything that setjmp may return over lives in the caller's frame. */
static int encode(png_structp png, png_infop info, FILE *file, const struct image *image,
                  png_textp text)
{
    if (setjmp(png_jmpbuf(png)) != 0)
        return -1;
    png_init_io(png, file);
    png_set_compression_level(png, 1);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_IHDR(png, info, image->width, image->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_text(png, info, text, 1);
    png_write_info(png, info);
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (uint32_t row = 0; row < image->height; row++)
        png_write_row(png, image->pixels + (size_t)row * image->width * 4);
    png_write_end(png, info);
    return 0;
}

static int write_stream(FILE *file, const struct image *image, const char *comment)
{
    char key[] = "Description";
    char *words = strdup(comment);
    png_structp png = NULL;
    png_infop info = NULL;
    int result = -1;
    if (words == NULL)
        return -1;
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, on_warning);
    if (png != NULL)
        info = png_create_info_struct(png);
    if (info == NULL) {
        errno = ENOMEM;
    } else {
        png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE, .key = key, .text = words};
        text.text_length = strlen(words);
        errno = 0;
        result = encode(png, info, file, image, &text);
    }
    int cause = errno;
    png_destroy_write_struct(&png, &info);
    free(words);
    errno = cause;
    return result;
}

/* What a renderer with our number left there when it was killed is in the way. */
static FILE *make_file(int folder, const char *path)
{
    const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    int fd = openat(folder, path, flags, 0600);
    if (fd < 0 && errno == EEXIST && unlinkat(folder, path, 0) == 0)
        fd = openat(folder, path, flags, 0600);
    if (fd < 0)
        return NULL;
    FILE *file = fdopen(fd, "wb");
    if (file == NULL)
        close(fd);
    return file;
}

int png_write_file(int folder, const char *path, const struct image *image, const char *comment)
{
    char temporary[PATH_BYTES];
    int length = snprintf(temporary, sizeof temporary, "%s.%ld.tmp", path, (long)getpid());
    if (length < 0 || (size_t)length >= sizeof temporary) {
        errno = ENAMETOOLONG;
        return -1;
    }
    FILE *file = make_file(folder, temporary);
    if (file == NULL)
        return -1;
    int result = write_stream(file, image, comment);
    int cause = errno;
    /* A full disk may show only when the last bytes are flushed. */
    if (fclose(file) != 0 && result == 0) {
        result = -1;
        cause = errno;
    }
    if (result == 0 && renameat(folder, temporary, folder, path) != 0) {
        result = -1;
        cause = errno;
    }
    if (result != 0)
        unlinkat(folder, temporary, 0);
    errno = cause;
    return result;
}
