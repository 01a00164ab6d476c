/* Packs the world into a temporary file, which is renamed at the end. */
#include "recorder/archive/image_write.h"

#include "ipc/segment/segment_check.h"
#include "recorder/archive/image_format.h"
#include "ipc/process/crash_point.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/stale_files.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

#define LEVEL       3                   /* docs/checkpoints.md compares the levels */
#define CHUNK_BYTES ((size_t)1 << 20)   /* packed between two heartbeats */
#define SYNC_BYTES  ((uint64_t)8 << 20) /* limits each wait for the disk */

/* --- the file ----------------------------------------------------------------------------------*/

/* Returns 0 if an image may replace the file at the path, if there is one. */
static int check_target(const struct image_place *place, struct error_text *error)
{
    struct stat status;
    if (fstatat(place->folder, place->name, &status, AT_SYMLINK_NOFOLLOW) != 0)
        return errno == ENOENT ? 0 : error_text_set(error, "%s: %s", place->path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return error_text_set(error, "%s: is %s; name a plain file, or one that is not there yet",
                              place->path,
                              S_ISDIR(status.st_mode)   ? "a folder"
                              : S_ISLNK(status.st_mode) ? "a symbolic link"
                                                        : "a device or pipe");
    return 0;
}

static void temporary_name(const struct image_place *place, char name[NAME_MAX + 1])
{
    snprintf(name, NAME_MAX + 1, "%s.new-%d", place->name, (int)getpid());
}

int image_place_open(struct image_place *place, const char *path, struct error_text *error)
{
    char folder[PATH_MAX] = ".", prefix[NAME_MAX + 1];
    *place = (struct image_place){.folder = -1};
    if ((size_t)snprintf(place->path, sizeof place->path, "%s", path) >= sizeof place->path)
        return error_text_set(error, "%.64s...: is too long for a path", path);
    char *slash = strrchr(place->path, '/');
    place->name = slash ? slash + 1 : place->path;
    if (slash)
        snprintf(folder, sizeof folder, "%.*s",
                 slash == place->path ? 1 : (int)(slash - place->path), place->path);
    /* Room for ".new-" and a pid behind the name. */
    if (place->name[0] == '\0' || strlen(place->name) > NAME_MAX - 16)
        return error_text_set(error, "%s: must end in a file's name of 1 to %d bytes", path,
                              NAME_MAX - 16);
    place->folder = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (place->folder < 0)
        return error_text_set(error, "%s: cannot open its folder: %s", path, strerror(errno));
    if (check_target(place, error) != 0) {
        image_place_close(place);
        return -1;
    }
    snprintf(prefix, sizeof prefix, "%s.new-", place->name);
    stale_files_sweep(folder, prefix);
    return 0;
}

void image_place_close(struct image_place *place)
{
    if (place->folder >= 0)
        close(place->folder);
    place->folder = -1;
}

/* --- its content -------------------------------------------------------------------------------*/

struct writer {
    struct view *view;
    int fd;
    ZSTD_CCtx *zstd;
    XXH3_state_t *content, *packed;
    unsigned char *out;
    size_t out_bytes;
    uint64_t content_bytes, packed_bytes, synced_bytes;
};

static int write_at(int fd, const void *bytes, size_t count, uint64_t offset)
{
    for (size_t done = 0; done < count;) {
        CRASH_POINT("write to an image");
        ssize_t wrote = pwrite(fd, (const char *)bytes + done, CRASH_POINT_PART(count - done),
                               (off_t)(offset + done));
        if (wrote < 0 && errno != EINTR)
            return -1;
        done += wrote > 0 ? (size_t)wrote : 0;
    }
    return 0;
}

static void beat(const struct writer *writer)
{
    if (writer->view->role < ROLE_COUNT)
        frame_protocol_beat(writer->view);
}

static int put_packed(struct writer *writer, size_t bytes)
{
    XXH3_64bits_update(writer->packed, writer->out, bytes);
    if (write_at(writer->fd, writer->out, bytes,
                 sizeof(struct image_header) + writer->packed_bytes) != 0)
        return -1;
    writer->packed_bytes += bytes;
    if (writer->packed_bytes - writer->synced_bytes < SYNC_BYTES)
        return 0;
    writer->synced_bytes = writer->packed_bytes;
    return fdatasync(writer->fd);
}

/* Packs bytes. ZSTD_e_end also writes what zstd still buffers. */
static int pack(struct writer *writer, const void *at, size_t bytes, ZSTD_EndDirective directive)
{
    ZSTD_inBuffer in = {at, bytes, 0};
    size_t left;
    do {
        ZSTD_outBuffer out = {writer->out, writer->out_bytes, 0};
        left = ZSTD_compressStream2(writer->zstd, &out, &in, directive);
        if (ZSTD_isError(left)) {
            errno = ENOMEM; /* any other error would be a programming error */
            return -1;
        }
        if (put_packed(writer, out.pos) != 0)
            return -1;
    } while (directive == ZSTD_e_end ? left != 0 : in.pos < in.size);
    return 0;
}

static int pack_part(struct writer *writer, const struct image_part *part)
{
    for (size_t done = 0; done < part->bytes;) {
        const unsigned char *at = (const unsigned char *)part->at + done;
        size_t bytes = part->bytes - done < CHUNK_BYTES ? part->bytes - done : CHUNK_BYTES;
        XXH3_64bits_update(writer->content, at, bytes);
        if (pack(writer, at, bytes, ZSTD_e_continue) != 0)
            return -1;
        beat(writer);
        done += bytes;
    }
    writer->content_bytes += part->bytes;
    return 0;
}

static struct image_header header_of(const struct view *view, const struct capture *capture)
{
    const struct state_head *head = &capture->snapshot.head;
    struct image_header header;
    memset(&header, 0, sizeof header); /* padding is written too */
    header.magic = IMAGE_MAGIC;
    header.version = IMAGE_VERSION;
    header.header_bytes = sizeof header;
    header.layout_hash = layout_hash();
    header.frame = head->frame;
    header.event_end = head->event_end;
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        header.ring_first[i] = capture->ring[i].first;
        header.ring_end[i] = capture->ring[i].end;
    }
    header.used = head->used;
    header.craters = head->crater_count;
    header.dents = head->dent_count;
    header.contacts = head->contact_count;
    header.inputs = capture->inputs;
    header.moved_used = capture->inputs ? capture->moved_head.used : 0;
    header.intents = capture->inputs ? capture->moved_head.intent_count : 0;
    header.segment = *view->header;
    header.params = *view->world.params;
    return header;
}

static int write_all(struct writer *writer, struct image_header *header,
                     const struct capture *capture)
{
    struct image_part part[IMAGE_PARTS_MAX];
    struct image_tables tables = {.view = writer->view,
                                  .state = snapshot_state(&capture->snapshot, writer->view),
                                  .moved = capture->moved};
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        tables.ring[i] = capture->ring[i].slot;
    tables.moved.head = (struct state_head *)(uintptr_t)&capture->moved_head;
    header->content_bytes = image_content_bytes(header, &writer->view->layout);
    ZSTD_CCtx_setParameter(writer->zstd, ZSTD_c_compressionLevel, LEVEL);
    ZSTD_CCtx_setParameter(writer->zstd, ZSTD_c_checksumFlag, 1);
    ZSTD_CCtx_setPledgedSrcSize(writer->zstd, header->content_bytes);
    uint32_t parts = image_parts(header, &tables, part);
    for (uint32_t i = 0; i < parts; i++) {
        if (pack_part(writer, &part[i]) != 0)
            return -1;
    }
    CHECK(writer->content_bytes == header->content_bytes);
    if (pack(writer, NULL, 0, ZSTD_e_end) != 0)
        return -1;
    header->packed_bytes = writer->packed_bytes;
    header->packed_hash = XXH3_64bits_digest(writer->packed);
    header->content_hash = XXH3_64bits_digest(writer->content);
    header->header_hash = image_header_hash(header);
    return write_at(writer->fd, header, sizeof *header, 0);
}

static void writer_free(struct writer *writer)
{
    ZSTD_freeCCtx(writer->zstd);
    XXH3_freeState(writer->content);
    XXH3_freeState(writer->packed);
    free(writer->out);
}

static int writer_make(struct writer *writer, struct view *view, int fd)
{
    *writer = (struct writer){.view = view, .fd = fd, .out_bytes = ZSTD_CStreamOutSize()};
    writer->zstd = ZSTD_createCCtx();
    writer->content = XXH3_createState();
    writer->packed = XXH3_createState();
    writer->out = malloc(writer->out_bytes);
    if (!writer->zstd || !writer->content || !writer->packed || !writer->out) {
        writer_free(writer);
        errno = ENOMEM;
        return -1;
    }
    XXH3_64bits_reset(writer->content);
    XXH3_64bits_reset(writer->packed);
    return 0;
}

/* Fills the temporary file and flushes it to the disk. */
static int fill(int fd, struct view *view, const struct capture *capture,
                struct image_written *done)
{
    struct image_header header = header_of(view, capture);
    struct writer writer;
    if (writer_make(&writer, view, fd) != 0)
        return -1;
    int result = write_all(&writer, &header, capture);
    beat(&writer);
    CRASH_POINT("image on the disk");
    if (result == 0)
        result = fsync(fd);
    beat(&writer);
    *done = (struct image_written){sizeof header + writer.packed_bytes, header.content_bytes};
    int code = errno;
    writer_free(&writer);
    errno = code;
    return result;
}

/* Sets the reason of a failed write. error: its errno. */
static int refuse_write(const struct image_place *place, int code, struct error_text *error)
{
    if (code == ENOSPC || code == EDQUOT || code == EFBIG)
        return error_text_set(error, "%s: no room to write it (%s); the file is as it was",
                              place->path, strerror(code));
    return error_text_set(error, "%s: cannot write: %s", place->path, strerror(code));
}

int image_write(const struct image_place *place, struct view *view, const struct capture *capture,
                struct image_written *done, struct error_text *error)
{
    char temporary[NAME_MAX + 1];
    struct image_written own;
    if (check_target(place, error) != 0)
        return -1;
    /* A world whose static regions are damaged must not replace a good image. */
    struct error_text what;
    if (view->header->magic == SEGMENT_MAGIC && segment_verify(view, &what) != 0)
        return error_text_set(error, "%s: not written: the world is %s", place->path, what.text);
    temporary_name(place, temporary);
    unlinkat(place->folder, temporary, 0); /* left by an earlier process with the same pid */
    CRASH_POINT("image's temporary");
    int fd =
        openat(place->folder, temporary, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (fd < 0)
        return error_text_set(error, "%s: cannot create %s beside it: %s", place->path, temporary,
                              strerror(errno));
    int result = fill(fd, view, capture, done ? done : &own);
    int code = errno;
    if (close(fd) != 0 && result == 0) {
        result = -1;
        code = errno;
    }
    CRASH_POINT("image's name");
    if (result == 0 && renameat(place->folder, temporary, place->folder, place->name) != 0) {
        result = -1;
        code = errno;
    }
    if (result != 0) {
        unlinkat(place->folder, temporary, 0);
        return refuse_write(place, code, error);
    }
    CRASH_POINT("after the image's name");
    /* Some file systems do not support fsync of a folder. The rename has succeeded anyway. */
    if (fsync(place->folder) != 0 && errno != EINVAL)
        return error_text_set(
            error,
            "%s: is the new image, but its folder cannot be put on the disk (%s): "
            "after a power cut it may be the one before",
            place->path, strerror(errno));
    return 0;
}
