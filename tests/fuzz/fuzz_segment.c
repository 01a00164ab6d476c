/* Segments: a process attaches to the object of a world. The header, parameters and heads of a good
 * object are changed in some words, or the header is arbitrary bytes. The first byte says what else
 * is done. Then come changes of 6 bytes: the part, the word, and its new value. */
#include "ipc/segment/frame_check.h"
#include "ipc/segment/segment_attach.h"
#include "tests/fuzz/support.h"

#include "ipc/segment/segment.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/runtime/check.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

/* The file system of a small machine would refuse larger objects. */
#define OBJECT_BYTES_MAX (UINT64_C(1) << 32)

enum how {
    HOW_HASHED = 1, /* the header's hash is corrected, and the words of this build */
    HOW_SIZED = 2,  /* the object has the size of the header's counts */
    HOW_ROLE = 4,   /* attaches as the mover, which writes, and not as a reader */
    HOW_BYTES = 8   /* the other bytes are the header */
};

enum piece { PIECE_HEADER, PIECE_PARAMS, PIECE_WORLD, PIECE_MOVED, PIECES };

/* The parts of an object that are written. The other bytes are zero. */
struct object {
    struct segment_header header;
    struct params params;
    struct state_head world, moved; /* of frame 0 */
};

static struct object good;

static char name[SEGMENT_NAME_MAX];
static struct segment_paths paths;
static char object_path[SEGMENT_PATH_MAX];

static void remove_files(void)
{
    unlink(object_path);
    unlink(paths.name);
    unlink(paths.lock);
}

static void make_good(void)
{
    struct view view;
    support_world(&view);
    good = (struct object){*view.header, *view.world.params, *view.w[0].head, *view.m.head};
    segment_abandon(&view);
}

static void open_files(void)
{
    struct error_text error;
    make_good();
    snprintf(name, sizeof name, "fuzz-%d", (int)getpid());
    CHECK(segment_paths(&paths, name, &error) == 0);
    snprintf(object_path, sizeof object_path, "/dev/shm/jolon.%u.%s.%032x", (unsigned)getuid(),
             name, (unsigned)getpid());
    CHECK(symlink(object_path, paths.name) == 0);
    (void)atexit(remove_files);
    int fd = open(paths.lock, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
    CHECK(fd >= 0);
    close(fd);
}

/* As in ipc/segment/segment.c: every word except the magic and the hash itself. */
static void seal(struct segment_header *header)
{
    header->magic = 0;
    header->head_hash = 0;
    header->head_hash = XXH3_64bits(header, sizeof *header);
    header->magic = SEGMENT_MAGIC;
}

/* A change: the part, the word, the new value. */
static void change(struct object *object, const uint8_t bytes[6])
{
    unsigned char *const part[PIECES] = {
        (unsigned char *)&object->header, (unsigned char *)&object->params,
        (unsigned char *)&object->world, (unsigned char *)&object->moved};
    static const size_t size[PIECES] = {sizeof object->header, sizeof object->params,
                                        sizeof object->world, sizeof object->moved};
    unsigned which = bytes[0] % PIECES;
    memcpy(part[which] + bytes[1] % (size[which] / 4) * 4, bytes + 2, 4);
}

static void write_at(int fd, const void *bytes, size_t size, size_t at, uint64_t end)
{
    if (at >= end)
        return;
    if (size > end - at)
        size = (size_t)(end - at);
    CHECK(pwrite(fd, bytes, size, (off_t)at) == (ssize_t)size);
}

static void write_object(const struct object *from, const struct layout *layout, uint64_t bytes)
{
    unlink(object_path);
    int fd = open(object_path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    CHECK(fd >= 0 && ftruncate(fd, (off_t)bytes) == 0);
    write_at(fd, &from->header, sizeof from->header, 0, bytes);
    if (layout->total > 0) {
        write_at(fd, &from->params, sizeof from->params, layout->offset[REGION_PARAMS], bytes);
        write_at(fd, &from->world, sizeof from->world, layout->offset[REGION_WORLD_A], bytes);
        write_at(fd, &from->moved, sizeof from->moved, layout->offset[REGION_MOVED], bytes);
    }
    close(fd);
}

/* Writes the object and returns its size. */
static uint64_t put(enum how how, const uint8_t *data, size_t size)
{
    struct object changed = good;
    struct layout layout = {.total = 0};
    uint64_t bytes = size;
    if (how & HOW_BYTES)
        memcpy(&changed.header, data, size < sizeof good.header ? size : sizeof good.header);
    for (size_t at = 0; !(how & HOW_BYTES) && at + 6 <= size; at += 6)
        change(&changed, data + at);
    if (how & HOW_HASHED) {
        changed.header.version = SEGMENT_VERSION;
        changed.header.header_bytes = sizeof changed.header;
        changed.header.layout_hash = layout_hash();
    }
    bool fits = layout_compute(&layout, &changed.header) == 0 && layout.total <= OBJECT_BYTES_MAX;
    if (!fits)
        layout.total = 0;
    if ((how & HOW_SIZED) && fits)
        bytes = changed.header.total_bytes = layout.total;
    if (how & HOW_HASHED)
        seal(&changed.header);
    write_object(&changed, &layout, bytes);
    return bytes;
}

/* Checks that every region lies within the object and that its ends can be read. */
static void check(const struct view *view, uint64_t bytes)
{
    const unsigned char *base = view->base;
    CHECK(view->layout.total == bytes);
    for (int i = 0; i < REGION_COUNT; i++) {
        size_t at = view->layout.offset[i], length = view->layout.bytes[i];
        CHECK(at <= bytes && length <= bytes - at);
        if (length > 0) {
            (void)*(const volatile unsigned char *)(base + at);
            (void)*(const volatile unsigned char *)(base + at + length - 1);
        }
    }
    for (int i = 0; i < 2; i++)
        CHECK((const unsigned char *)(view->w[i].contacts + view->header->contact_slots) <=
              base + bytes);
    CHECK(view->world.params->capacity <= CAPACITY_MAX);
    CHECK(view->world.terrain.spacing_m > 0.0);
    struct error_text error;
    (void)segment_check_state(view, 0, &error);
    (void)segment_check_moved(view, 0, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct view view;
    struct error_text error = {.text = ""};
    if (name[0] == '\0')
        open_files();
    if (size < 1)
        return 0;
    enum how how = (enum how)data[0];
    uint64_t bytes = put(how, data + 1, size - 1);
    enum role role = how & HOW_ROLE ? ROLE_MOVER : ROLE_NONE;
    if (segment_attach(&view, name, role, &error) == 0) {
        check(&view, bytes);
        segment_detach(&view);
    } else {
        CHECK(error.text[0] != '\0' && !view.base && view.lock_fd < 0);
    }
    return 0;
}
