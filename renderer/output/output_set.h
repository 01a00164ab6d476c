/* All outputs of a renderer: PNG files in a folder, a video file, a live stream. Each has its own
 * threads, and drops pictures that come too fast. */
#ifndef JOLON_RENDERER_OUTPUT_OUTPUT_SET_H
#define JOLON_RENDERER_OUTPUT_OUTPUT_SET_H

#include "ipc/segment/segment.h"
#include "renderer/output/output_queue.h"
#include "renderer/output/picture_folder.h"
#include "renderer/output/picture.h"
#include "renderer/output/stream.h"
#include "renderer/output/video.h"

#include <stdbool.h>
#include <stdint.h>

#define OUTPUT_SET_VIEWS_MAX  16u
#define OUTPUT_SET_PATH_BYTES 1024

/* Which outputs there are. The strings are borrowed. */
struct output_set_options {
    const char *world;      /* its name, for the stream's page */
    const char *folder;     /* of PNG files; NULL: none */
    double stills_fps;      /* PNG files a second at most; 0: all pictures */
    const char *video;      /* path; NULL: none */
    const char *video_view; /* NULL: that of the first picture */
    double video_fps;       /* pictures a second of the simulation at most */
    bool replay;            /* the video is of a recorded run: no picture is dropped */
    int video_fd;           /* of a replay: the file, which the caller closes */
    int stream_port;        /* below 0: none */
    const char *stream_address;
    bool serves_requests; /* answers requests on the Unix socket of this role */
    enum role role;
    struct stream_painter painter;
};

/* A view, and its last picture if that was not written as a PNG file. */
struct output_set_view {
    char view[PICTURE_VIEW_BYTES];
    struct picture *pending; /* NULL: it was written */
    uint64_t still_ns;       /* CLOCK_MONOTONIC of the last PNG file */
};

struct output_set {
    struct output_set_options options;
    struct picture_pool pool;
    struct picture_folder output;
    struct output_queue stills, video_queue;
    struct output_set_view row[OUTPUT_SET_VIEWS_MAX];
    struct video *video; /* NULL: none */
    char video_path[OUTPUT_SET_PATH_BYTES];
    char video_view[PICTURE_VIEW_BYTES]; /* "" before the first picture */
    int video_fd;
    bool video_over;                  /* it has failed, which was logged */
    struct stream *stream;            /* NULL: none */
    struct picture_pool request_pool; /* of requested pictures, which have many sizes */
    uint64_t lost;                    /* pictures dropped because memory was short */
    bool started;
};

/* Makes the folder and the video file, loads libraries and listens: all that the sandbox forbids.
 * If the video file exists, the new one gets a number: "NAME-2.mkv". Returns 0, or -1 with the
 * reason. */
int output_set_open(struct output_set *outputs, const struct output_set_options *options,
                    struct error_text *error);

/* Starts the threads. Returns 0, or -1 with the reason. */
int output_set_start(struct output_set *outputs, struct error_text *error);

/* Gives a view's picture to each output. Takes the image's pixels and gives it others of undefined
 * content. Blocks only for a replay. Returns 0, or -1 with the reason when PNG files or a replay
 * cannot be written. A live video that fails is logged once and given up. */
int output_set_put(struct output_set *outputs, const char *view, struct image *image,
                   uint64_t frame, double time_s, const char *comment, struct error_text *error);

/* Answers a request of the stream (stream_requests_read) with a picture, taking the image's pixels
 * and giving it others; image NULL: there is no such vehicle. */
void output_set_answer(struct output_set *outputs, uint32_t row, uint64_t generation,
                       struct image *image, uint64_t frame, double time_s);

/* Writes each view's last picture, completes the files and ends the threads. Returns 0, or -1 with
 * the reason, as output_set_put(). */
int output_set_close(struct output_set *outputs, struct error_text *error);

#endif
