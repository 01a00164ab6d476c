/* Images (checkpoints and dumps), opened and loaded: a good image of a small world with some
 * changed bytes. The first byte of the input says whether the hashes are corrected afterwards, so
 * that the code behind them is reached. Then come changes of 4 bytes: what is changed, where (two
 * bytes), and the new value. */
#include "tests/fuzz/support.h"

#include "recorder/archive/image_read.h"
#include "recorder/archive/image_write.h"
#include "world/runtime/check.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

#define FILE_MAX 65536u

enum how {
    HOW_CONTENT =
        1, /* changes beyond the header apply to the unpacked data, which is packed again */
    HOW_HASHED = 2, /* the hashes are corrected */
    HOW_CUT = 4     /* the last change gives the number of missing bytes */
};

static struct image_header good;
static unsigned char *content; /* unpacked */
static unsigned char packed[FILE_MAX];

static void read_good(const char *path)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    CHECK(fd >= 0 && read(fd, &good, sizeof good) == (ssize_t)sizeof good);
    CHECK(good.packed_bytes <= sizeof packed &&
          read(fd, packed, sizeof packed) == (ssize_t)good.packed_bytes);
    close(fd);
    content = malloc(good.content_bytes);
    CHECK(content && ZSTD_decompress(content, good.content_bytes, packed, good.packed_bytes) ==
                         good.content_bytes);
}

static void make_good(void)
{
    struct view view;
    struct capture capture;
    struct image_place place;
    struct error_text error;
    char path[PATH_MAX];
    support_world(&view);
    support_path(path, sizeof path, "models/k.obj");
    CHECK(capture_init(&capture, &view) == 0 && capture_take(&capture, &view, false) == 0);
    CHECK(image_place_open(&place, path, &error) == 0);
    CHECK(image_write(&place, &view, &capture, NULL, &error) == 0);
    image_place_close(&place);
    capture_free(&capture);
    segment_abandon(&view);
    read_good(path);
}

/* The changed image while it is made. */
struct changing {
    struct image_header header;
    unsigned char *content; /* [good.content_bytes] */
    unsigned char packed[FILE_MAX];
    size_t cut;
};

/* One change: what (bit 0: the header; bit 1: counted from the end), where, to what. */
static void change(struct changing *to, enum how how, const uint8_t bytes[4])
{
    size_t at = (size_t)bytes[1] << 8 | bytes[2];
    unsigned char *body = how & HOW_CONTENT ? to->content : to->packed;
    size_t size = how & HOW_CONTENT ? good.content_bytes : good.packed_bytes;
    if (bytes[0] & 1) {
        body = (unsigned char *)&to->header;
        size = sizeof to->header;
    }
    at %= size;
    body[bytes[0] & 2 ? size - 1 - at : at] = bytes[3];
    if (how & HOW_CUT)
        to->cut = bytes[3];
}

static void pack(struct changing *to)
{
    size_t bytes = ZSTD_compress(to->packed, sizeof to->packed, to->content, good.content_bytes, 1);
    CHECK(!ZSTD_isError(bytes));
    to->header.packed_bytes = bytes;
    to->header.content_hash = XXH3_64bits(to->content, good.content_bytes);
}

static void put(struct changing *to, enum how how)
{
    static unsigned char file[sizeof to->header + FILE_MAX];
    size_t bytes = to->header.packed_bytes <= FILE_MAX ? to->header.packed_bytes : FILE_MAX;
    if (how & HOW_HASHED) {
        to->header.packed_hash = XXH3_64bits(to->packed, bytes);
        to->header.header_hash = image_header_hash(&to->header);
    }
    memcpy(file, &to->header, sizeof to->header);
    memcpy(file + sizeof to->header, to->packed, bytes);
    bytes += sizeof to->header;
    support_put("models/k.obj", file, bytes - (to->cut < bytes ? to->cut : bytes));
}

/* As `jolon run --from` does. */
static void load(const char *path)
{
    static struct image image;
    struct view view;
    struct error_text error = {.text = ""};
    if (image_open(&image, path, &error) != 0) {
        CHECK(error.text[0] != '\0');
        return;
    }
    (void)image_branches(&image);
    struct segment_header header = image_segment(&image);
    if (segment_private(&view, &header, &error) == 0) {
        if (image_load(&view, &image, &error) == 0)
            CHECK(view.w[image.header.frame & 1].head->used <= view.header->capacity);
        segment_abandon(&view);
    }
    image_close(&image);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct changing to;
    char path[PATH_MAX];
    if (!content) {
        make_good();
        to.content = malloc(good.content_bytes);
        CHECK(to.content);
    }
    if (size < 1)
        return 0;
    enum how how = (enum how)data[0];
    to.header = good;
    to.cut = 0;
    memcpy(to.packed, packed, good.packed_bytes);
    if (how & HOW_CONTENT)
        memcpy(to.content, content, good.content_bytes);
    for (size_t at = 1; at + 4 <= size; at += 4)
        change(&to, how, data + at);
    if (how & HOW_CONTENT)
        pack(&to);
    put(&to, how);
    support_path(path, sizeof path, "models/k.obj");
    load(path);
    return 0;
}
