/* Where a renderer's pictures go, all of it: PNG files in a folder, a video file, a live stream.
 * Each has its own threads and takes what it can; the drawing thread only hands over. */
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

/* What is wanted; strings are the caller's and stay. */
struct output_set_options {
    const char *world;      /* its name, for people */
    const char *folder;     /* of PNG files; NULL: none */
    double stills_fps;      /* of those, pictures a second of the clock at most; 0: every one */
    const char *video;      /* path; NULL: none */
    const char *video_view; /* NULL: that of the first picture */
    double video_fps;       /* pictures a second of the simulation at most */
    bool replay;            /* the video is from a recording: every picture is waited for */
    int video_fd;           /* of a replay: where it goes, which stays the caller's */
    int stream_port;        /* below 0: none */
    const char *stream_address;
    bool serves_requests; /* gives pictures to who asks, on the socket of this role */
    enum role role;
    struct stream_painter painter;
};

/* A view's last picture that is not a still yet. */
struct output_set_view {
    char view[PICTURE_VIEW_BYTES];
    struct picture *pending; /* NULL: it is one */
    uint64_t still_ns;       /* CLOCK_MONOTONIC of the last still */
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
    bool video_over;                  /* it failed, which was said */
    struct stream *stream;            /* NULL: none */
    struct picture_pool request_pool; /* of pictures that clients ask for, of many sizes */
    uint64_t lost;                    /* pictures that there was no memory for */
    bool started;
};

/* Makes the folder and the video file, loads libraries and listens: all that a sandbox forbids. A
 * video file that is there already is left alone: the new one gets a number, "NAME-2.mkv". 0, or -1
 * with the reason. */
int output_set_open(struct output_set *outputs, const struct output_set_options *options,
                    struct error_text *error);

/* Starts the threads. 0, or -1 with the reason. */
int output_set_start(struct output_set *outputs, struct error_text *error);

/* Hands a view's picture to each outlet, taking the image's pixels and giving it others, whose
 * content is anything. Blocks only for a replay. 0, or -1 with the reason when PNG files cannot be
 * written, or a replay; a live video that cannot is said once and left. */
int output_set_put(struct output_set *outputs, const char *view, struct image *image,
                   uint64_t frame, double time_s, const char *comment, struct error_text *error);

/* Answers a wish of the stream's (stream_requests_read) with a picture, taking the image's pixels
 * and giving it others; image NULL: there is no such vehicle. */
void output_set_answer(struct output_set *outputs, uint32_t row, uint64_t generation,
                       struct image *image, uint64_t frame, double time_s);

/* Completes all files, each view's last picture among them, and ends the threads. 0, or -1 with the
 * reason, as output_set_put(). */
int output_set_close(struct output_set *outputs, struct error_text *error);

#endif
