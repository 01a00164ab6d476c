/* Decides when a checkpoint is due, writes it and logs the result. */
#include "recorder/checkpoint.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "recorder/archive/image_read.h"

#include <errno.h>
#include <inttypes.h>

#define WARN_INTERVAL_NS (10 * (uint64_t)NS_PER_S)

static uint64_t next_multiple(uint64_t frame, uint64_t every)
{
    return (frame / every + 1) * every;
}

static uint64_t committed(const struct view *view)
{
    return atomic_load_explicit(&view->commit->commit, memory_order_acquire);
}

int checkpoint_open(struct checkpoint *checkpoint, const struct view *view, const char *path,
                    uint64_t every, struct error_text *error)
{
    struct image_header before;
    struct error_text none;
    *checkpoint = (struct checkpoint){.every = every};
    if (image_place_open(&checkpoint->place, path, error) != 0)
        return -1;
    if (capture_init(&checkpoint->capture, view) != 0) {
        image_place_close(&checkpoint->place);
        return error_text_set(error, "%s: out of memory for a copy of the world", path);
    }
    checkpoint->due = next_multiple(committed(view), every);
    if (image_peek(&before, path, &none) == 0 && before.segment.made == view->header->made)
        checkpoint->due = next_multiple(before.frame, every);
    return 0;
}

void checkpoint_close(struct checkpoint *checkpoint)
{
    capture_free(&checkpoint->capture);
    image_place_close(&checkpoint->place);
}

static int refuse(struct checkpoint *checkpoint, const char *text)
{
    checkpoint->failed++;
    if (log_due(&checkpoint->warned_ns, WARN_INTERVAL_NS))
        log_warn("checkpoint: %s; %" PRIu64 " failed so far, tries again every %" PRIu64 " frames",
                 text, checkpoint->failed, checkpoint->every);
    return -1;
}

int checkpoint_write(struct checkpoint *checkpoint, struct view *view)
{
    struct image_written written;
    struct error_text error;
    uint64_t began = clock_now_ns();
    if (capture_take(&checkpoint->capture, view, false) != 0)
        return refuse(checkpoint, errno == EBADMSG
                                      ? "the world's last frame fails its checksum"
                                      : "the world goes on faster than it can be copied");
    if (image_write(&checkpoint->place, view, &checkpoint->capture, &written, &error) != 0)
        return refuse(checkpoint, error.text);
    checkpoint->written++;
    log_info("checkpoint %s: frame %" PRIu64 ", %" PRIu64 " bytes, %.0f ms", checkpoint->place.path,
             checkpoint->capture.snapshot.head.frame, written.bytes,
             (double)(clock_now_ns() - began) / 1e6);
    return 0;
}

void checkpoint_write_if_due(struct checkpoint *checkpoint, struct view *view)
{
    uint64_t frame = committed(view);
    if (frame < checkpoint->due)
        return;
    checkpoint->due = next_multiple(frame, checkpoint->every);
    (void)checkpoint_write(checkpoint, view);
}
