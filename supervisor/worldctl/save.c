/* Verb save: writes an image of a world's current frame. */
#include "ipc/segment/segment_attach.h"
#include "supervisor/worldctl/verbs.h"

#include "recorder/archive/image_write.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "recorder/replay/arguments.h"

#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>

static void take(const struct arguments *arguments, const struct view *view,
                 struct capture *capture)
{
    if (capture_init(capture, view) != 0)
        die_refused("out of memory for a copy of the world");
    if (capture_take(capture, view, arguments->inputs) == 0)
        return;
    if (errno == EBADMSG)
        die_refused("world \"%s\" is damaged: its last frame fails its checksum", arguments->world);
    die_refused(
        "world \"%s\" goes on faster than it can be copied; pause it with `jolon ctl pause`",
        arguments->world);
}

int verb_save(const struct arguments *arguments)
{
    struct image_place place;
    struct image_written written;
    struct capture capture;
    struct view view;
    struct error_text error;
    if (!arguments->path)
        die_usage("save: needs the FILE to write, for example save world.image");
    signal(SIGXFSZ, SIG_IGN); /* a write beyond the file size limit then fails with EFBIG */
    arguments_attach(arguments, &view);
    if (image_place_open(&place, arguments->path, &error) != 0)
        die_refused("%s", error.text);
    take(arguments, &view, &capture);
    uint64_t began = clock_now_ns();
    if (image_write(&place, &view, &capture, &written, &error) != 0)
        die_refused("%s", error.text);
    printf("%s: world \"%s\" at frame %" PRIu64 "%s: %.1f MB, %.1f MB unpacked, %.0f ms\n",
           arguments->path, arguments->world, capture.snapshot.head.frame,
           capture.inputs ? " and the inputs of the next" : "", (double)written.bytes / 1e6,
           (double)written.content_bytes / 1e6, (double)(clock_now_ns() - began) / 1e6);
    capture_free(&capture);
    image_place_close(&place);
    segment_detach(&view);
    return EXIT_OK;
}
