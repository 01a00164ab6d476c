/* Reads an image. Each size and hash is checked before the bytes that it describes are used. */
#include "recorder/archive/image_read.h"

#include "ipc/process/crash_point.h"
#include "ipc/process/regular_file.h"
#include "ipc/segment/frame_check.h"
#include "ipc/segment/segment_check.h"
#include "world/checksum.h"
#include "world/params.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

#define CHUNK_BYTES ((size_t)1 << 20)

/* --- the file ----------------------------------------------------------------------------------*/

/* Returns 0, or -1 with errno. A file that ends before count bytes gives EIO. */
static int read_at(int fd, void *bytes, size_t count, uint64_t offset)
{
    for (size_t done = 0; done < count;) {
        ssize_t got = pread(fd, (char *)bytes + done, count - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            errno = got == 0 ? EIO : errno;
            return -1;
        }
        done += (size_t)got;
    }
    return 0;
}

/* --- the header --------------------------------------------------------------------------------*/

static bool counts_fit(const struct image_header *header, struct layout *layout)
{
    const struct segment_header *segment = &header->segment;
    if (layout_compute(layout, segment) != 0 || header->used > segment->capacity ||
        header->craters > segment->crater_slots || header->dents > segment->dent_slots ||
        header->contacts > segment->contact_slots || header->inputs > 1 ||
        header->moved_used > segment->capacity || header->intents > segment->intents_per_frame)
        return false;
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        if (header->ring_first[i] > header->ring_end[i] ||
            header->ring_end[i] - header->ring_first[i] > layout_ring_slots(segment, i))
            return false;
    }
    return true;
}

static int check_header(const struct image_header *header, uint64_t file_bytes, const char *path,
                        struct error_text *error)
{
    struct layout layout;
    if (header->magic != IMAGE_MAGIC)
        return error_text_set(error, "%s: magic: not an image of a world", path);
    if (header->version != IMAGE_VERSION)
        return error_text_set(error, "%s: version %u; this program knows %u", path, header->version,
                              IMAGE_VERSION);
    if (header->header_bytes != sizeof *header || header->layout_hash != layout_hash())
        return error_text_set(
            error,
            "%s: layout: written by another build of Jolon; go on from it with that "
            "build",
            path);
    if (header->header_hash != image_header_hash(header))
        return error_text_set(error, "%s: header hash: the header is damaged", path);
    if (!counts_fit(header, &layout))
        return error_text_set(error, "%s: counts: out of range", path);
    if (header->content_bytes != image_content_bytes(header, &layout) ||
        header->packed_bytes > ZSTD_compressBound(header->content_bytes))
        return error_text_set(error, "%s: sizes: do not fit its counts", path);
    if (file_bytes != sizeof *header + header->packed_bytes)
        return error_text_set(error, "%s: size %" PRIu64 "; its header says %" PRIu64 ": %s", path,
                              file_bytes, sizeof *header + header->packed_bytes,
                              file_bytes < sizeof *header + header->packed_bytes
                                  ? "it was cut off"
                                  : "something was added");
    return 0;
}

static int read_header(int fd, uint64_t file_bytes, struct image_header *header, const char *path,
                       struct error_text *error)
{
    if (file_bytes < sizeof *header)
        return error_text_set(error, "%s: size %" PRIu64 " is too small for an image", path,
                              file_bytes);
    if (read_at(fd, header, sizeof *header, 0) != 0)
        return error_text_set(error, "%s: cannot read: %s", path, strerror(errno));
    return check_header(header, file_bytes, path, error);
}

int image_peek(struct image_header *header, const char *path, struct error_text *error)
{
    uint64_t bytes = 0;
    int fd = regular_file_open(path, &bytes, error);
    if (fd < 0)
        return -1;
    int result = read_header(fd, bytes, header, path, error);
    close(fd);
    return result;
}

static int read_packed(int fd, struct image *image, struct error_text *error)
{
    const struct image_header *header = &image->header;
    image->packed = malloc(header->packed_bytes);
    if (!image->packed)
        return error_text_set(error, "%s: out of memory for %" PRIu64 " bytes", image->path,
                              header->packed_bytes);
    if (read_at(fd, image->packed, header->packed_bytes, sizeof *header) != 0)
        return error_text_set(error, "%s: cannot read: %s", image->path, strerror(errno));
    if (XXH3_64bits(image->packed, header->packed_bytes) != header->packed_hash)
        return error_text_set(error, "%s: packed hash: the file is damaged", image->path);
    if (ZSTD_getFrameContentSize(image->packed, header->packed_bytes) != header->content_bytes)
        return error_text_set(error, "%s: zstd: unpacks to another size than the header says",
                              image->path);
    return 0;
}

int image_open(struct image *image, const char *path, struct error_text *error)
{
    uint64_t bytes = 0;
    image->packed = NULL;
    if ((size_t)snprintf(image->path, sizeof image->path, "%s", path) >= sizeof image->path)
        return error_text_set(error, "%.64s...: is too long for a path", path);
    int fd = regular_file_open(path, &bytes, error);
    if (fd < 0)
        return -1;
    int result = read_header(fd, bytes, &image->header, path, error);
    if (result == 0)
        result = read_packed(fd, image, error);
    close(fd);
    if (result != 0)
        image_close(image);
    else
        image->params = image->header.params;
    return result;
}

void image_close(struct image *image)
{
    free(image->packed);
    image->packed = NULL;
}

struct segment_header image_segment(const struct image *image)
{
    struct segment_header header = image->header.segment;
    header.origin = image->header.header_hash;
    header.first_event = image->header.event_end;
    return header;
}

bool image_branches(const struct image *image)
{
    const struct params *then = &image->header.params, *now = &image->params;
    return then->seed != now->seed || then->hz != now->hz || then->cruise != now->cruise ||
           XXH3_64bits(&then->collision, sizeof then->collision) !=
               XXH3_64bits(&now->collision, sizeof now->collision);
}

/* --- the world ---------------------------------------------------------------------------------*/

struct unpacking {
    ZSTD_DCtx *zstd;
    ZSTD_inBuffer in;
    size_t left; /* 0: the frame is complete, checked by its own checksum */
    XXH3_state_t *content;
};

/* One step; false on an error and when nothing is left to unpack. */
static bool unpack_some(struct unpacking *unpacking, ZSTD_outBuffer *out)
{
    size_t from = unpacking->in.pos, to = out->pos;
    unpacking->left = ZSTD_decompressStream(unpacking->zstd, out, &unpacking->in);
    return !ZSTD_isError(unpacking->left) && (unpacking->in.pos > from || out->pos > to);
}

static int unpack_part(struct unpacking *unpacking, const struct image_part *part)
{
    for (size_t done = 0; done < part->bytes;) {
        size_t bytes = part->bytes - done < CHUNK_BYTES ? part->bytes - done : CHUNK_BYTES;
        ZSTD_outBuffer out = {(unsigned char *)part->at + done, bytes, 0};
        while (out.pos < out.size) {
            if (!unpack_some(unpacking, &out))
                return -1;
        }
        XXH3_64bits_update(unpacking->content, out.dst, bytes);
        done += bytes;
    }
    return 0;
}

/* Nothing may follow the parts but the frame's own end. */
static int unpack_end(struct unpacking *unpacking)
{
    unsigned char none;
    ZSTD_outBuffer out = {&none, 0, 0};
    while (unpacking->left != 0 && unpack_some(unpacking, &out))
        ;
    return unpacking->left == 0 && unpacking->in.pos == unpacking->in.size ? 0 : -1;
}

static int unpack(const struct image *image, const struct image_part *part, uint32_t parts,
                  struct error_text *error)
{
    struct unpacking unpacking = {.zstd = ZSTD_createDCtx(),
                                  .in = {image->packed, image->header.packed_bytes, 0},
                                  .left = 1,
                                  .content = XXH3_createState()};
    int result = -1;
    if (!unpacking.zstd || !unpacking.content) {
        error_text_set(error, "%s: out of memory to unpack it", image->path);
        goto done;
    }
    XXH3_64bits_reset(unpacking.content);
    result = 0;
    for (uint32_t i = 0; i < parts && result == 0; i++)
        result = unpack_part(&unpacking, &part[i]);
    if (result != 0 || unpack_end(&unpacking) != 0)
        result = error_text_set(error, "%s: zstd: cannot be unpacked", image->path);
    else if (XXH3_64bits_digest(unpacking.content) != image->header.content_hash)
        result = error_text_set(error, "%s: content hash: the file is damaged", image->path);
done:
    ZSTD_freeDCtx(unpacking.zstd);
    XXH3_freeState(unpacking.content);
    return result;
}

/* Checks that the frame matches the header, whose sizes placed its parts, and passes its checksums.
 * An image holds no hashes of rows. They are computed here. */
static int check_state(const struct view *view, const struct image *image, struct error_text *error)
{
    const struct image_header *header = &image->header;
    const struct state_head *head = view->w[header->frame & 1].head, *moved = view->m.head;
    struct error_text what;
    if (head->event_end != header->event_end || head->used != header->used ||
        head->crater_count != header->craters || head->dent_count != header->dents ||
        head->contact_count != header->contacts)
        return error_text_set(error, "%s: its frame does not fit its header", image->path);
    table_hash(state_table(&view->w[header->frame & 1]), 0, head->used, NULL);
    if (segment_check_state(view, header->frame, &what) != 0)
        return error_text_set(error, "%s: %s", image->path, what.text);
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        if (head->command_cursor[i] < header->ring_first[i] ||
            head->command_cursor[i] > header->ring_end[i])
            return error_text_set(error, "%s: its commands do not fit its frame", image->path);
    }
    if (!header->inputs)
        return 0;
    if (moved->used != header->moved_used || moved->intent_count != header->intents)
        return error_text_set(error, "%s: its moved table does not fit its header", image->path);
    table_hash(moved_table(&view->m), 0, moved->used, NULL);
    if (segment_check_moved(view, header->frame + 1, &what) != 0)
        return error_text_set(error, "%s: %s", image->path, what.text);
    return 0;
}

int image_load(struct view *view, const struct image *image, struct error_text *error)
{
    const struct image_header *header = &image->header;
    struct image_tables tables = {
        .view = view, .state = view->w[header->frame & 1], .moved = view->m};
    struct image_part part[IMAGE_PARTS_MAX];
    if (segment_params_fit(&image->params, view->header, image->path, error) != 0)
        return -1;
    CRASH_POINT("image's parameters");
    *(struct params *)(uintptr_t)view->world.params = image->params;
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        tables.ring[i] = view->commands[i]->slot;
    uint32_t parts = image_parts(header, &tables, part);
    CRASH_POINT_GUARD_PAGES(view->base, view->layout.total);
    int unpacked = unpack(image, part, parts, error);
    CRASH_POINT_UNGUARD();
    if (unpacked != 0 || check_state(view, image, error) != 0)
        return -1;
    bool moved = header->inputs && !image_branches(image);
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        CRASH_POINT("image's commands");
        atomic_store(&view->commands[i]->head, header->ring_end[i]);
    }
    CRASH_POINT("image's commit");
    atomic_store(&view->commit->commit, header->frame);
    CRASH_POINT("image's writing");
    atomic_store(&view->commit->writing, header->frame);
    CRASH_POINT("image's moved");
    atomic_store(&view->moved_word->moved, header->frame + (moved ? 1 : 0));
    return 0;
}
