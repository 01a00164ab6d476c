/* Measures the encoding of pictures of a live renderer: PNG, JPEG, colour conversion, and video,
 * one after the other in one thread, on moving pictures of the standard scene. */
#include "tests/bench/bench.h"
#include "tests/bench/scene.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "renderer/image/jpeg.h"
#include "renderer/image/png.h"
#include "renderer/image/yuv.h"
#include "renderer/output/video.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#define ENCODED_MAX 10000u
#define QUALITY     80 /* as for the stream */
#define FPS         60.0
#define FIRST_FRAME 1800u /* as for jolon-bench render */

enum way { WAY_PNG, WAY_JPEG, WAY_COLOURS, WAY_VIDEO };

static const struct {
    const char *name;
    enum way way;
    const char *file; /* of a video */
} ways[] = {{"png", WAY_PNG, NULL},
            {"jpeg", WAY_JPEG, NULL},
            {"colours", WAY_COLOURS, NULL},
            {"mkv (h264)", WAY_VIDEO, "live.mkv"},
            {"webm (vp8)", WAY_VIDEO, "live.webm"}};
#define WAYS (sizeof ways / sizeof ways[0])

struct encoding {
    double cpu_ms[WAYS][ENCODED_MAX];
    size_t bytes[WAYS];
    struct video *video[WAYS];
    int fd[WAYS];
    uint8_t *planes; /* of the colours */
    uint32_t count;
};

static double cpu_now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec / 1e6;
}

static struct encoding *begin(void)
{
    struct error_text error;
    struct encoding *encoding = calloc(1, sizeof *encoding);
    if (encoding == NULL)
        die_refused("out of memory");
    for (size_t i = 0; i < WAYS; i++) {
        if (ways[i].way != WAY_VIDEO)
            continue;
        encoding->video[i] = video_open(ways[i].file, FPS, VIDEO_LIVE, &error);
        if (encoding->video[i] == NULL)
            die_refused("%s", error.text);
        encoding->fd[i] = memfd_create(ways[i].file, MFD_CLOEXEC);
        if (encoding->fd[i] < 0)
            die_refused("cannot make a file in memory: %s", strerror(errno));
        video_write_to(encoding->video[i], encoding->fd[i]);
    }
    return encoding;
}

static void encode_colours(struct encoding *encoding, const struct image *image)
{
    uint32_t width = image->width & ~1u, height = image->height & ~1u;
    size_t luma = (size_t)width * height;
    if (encoding->planes == NULL && (encoding->planes = malloc(2 * luma)) == NULL)
        die_refused("out of memory");
    uint8_t *plane = encoding->planes;
    const struct yuv yuv = {.plane = {plane, plane + luma, plane + luma + luma / 4},
                            .stride = {(int)width, (int)(width / 2), (int)(width / 2)}};
    yuv_of_image(&yuv, image);
}

/* bytes of the picture, if they are known at once */
static size_t encode(struct encoding *encoding, size_t i, const struct picture *picture)
{
    struct error_text error;
    uint8_t *bytes = NULL;
    size_t count = 0;
    int result = 0;
    switch (ways[i].way) {
    case WAY_PNG:
        result = png_encode(&picture->image, "jolon-bench", &bytes, &count);
        break;
    case WAY_JPEG:
        result = jpeg_encode(&picture->image, QUALITY, &bytes, &count);
        break;
    case WAY_COLOURS:
        encode_colours(encoding, &picture->image);
        break;
    case WAY_VIDEO:
        if (video_put(encoding->video[i], picture, &error) != 0)
            die_refused("%s", error.text);
        break;
    }
    if (result != 0)
        die_refused("out of memory");
    free(bytes);
    return count;
}

static void encode_all(struct encoding *encoding, const struct image *image, double time_s)
{
    const struct picture picture = {.image = *image, .time_s = time_s};
    for (size_t i = 0; i < WAYS; i++) {
        double before = cpu_now_ms();
        encoding->bytes[i] += encode(encoding, i, &picture);
        encoding->cpu_ms[i][encoding->count] = cpu_now_ms() - before;
    }
    encoding->count++;
}

static void close_video(struct encoding *encoding, size_t i)
{
    struct error_text error;
    if (video_close(encoding->video[i], &error) != 0)
        die_refused("%s", error.text);
    off_t length = lseek(encoding->fd[i], 0, SEEK_END);
    encoding->bytes[i] = length > 0 ? (size_t)length : 0;
    close(encoding->fd[i]);
}

static void tell(struct encoding *encoding, bool json)
{
    /* An encoder allocates its memory with the first picture. */
    uint32_t skip = encoding->count > 1 ? 1 : 0;
    for (size_t i = 0; i < WAYS; i++) {
        if (ways[i].way == WAY_VIDEO)
            close_video(encoding, i);
        double median = bench_quantile(encoding->cpu_ms[i] + skip, encoding->count - skip, 0.5);
        double kilobytes = (double)encoding->bytes[i] / 1e3 / (double)encoding->count;
        printf(json ? "{\"encode\":\"%s\",\"cpu_ms\":%.3f,\"kilobytes\":%.1f}\n"
                    : "  %-12s %8.2f ms of the processor, %7.1f kB a picture\n",
               ways[i].name, median, kilobytes);
    }
    free(encoding->planes);
    free(encoding);
}

int bench_encode(struct bench_options options)
{
    static struct bench_scene scene;
    if (options.frames < 2 || options.frames > ENCODED_MAX)
        die_usage("--frames %u: must be from 2 to %u", options.frames, ENCODED_MAX);
    struct encoding *encoding = begin();
    bench_scene_open(&scene, &(struct bench_scene_options){.frame = FIRST_FRAME,
                                                           .width = options.size.width,
                                                           .height = options.size.height,
                                                           .threads = 1,
                                                           .soft = true,
                                                           .view = VIEW_CHASE});
    for (uint32_t i = 0; i < options.frames; i++) {
        struct frame_view frame_view = bench_scene_frame_view(&scene);
        bench_scene_build(&scene, &frame_view);
        bench_scene_draw(&scene, &frame_view);
        encode_all(encoding, &scene.image, frame_view_time_s(&frame_view));
        bench_scene_step(&scene);
    }
    tell(encoding, options.json);
    bench_scene_close(&scene);
    return EXIT_OK;
}
