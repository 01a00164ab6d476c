/* A video file: pictures of one view, one after the other, with the times of the simulation. A
 * second of the video is a second of the simulation, however fast it went. What the file is follows
 * from its ending:
 *
 *     .mkv    Matroska, H.264
 *     .mp4    MP4, H.264
 *     .webm   WebM, VP8
 *
 * Without libx264 in the library, MPEG-4 part 2 takes the place of H.264. */
#ifndef JOLON_RENDERER_OUTPUT_VIDEO_H
#define JOLON_RENDERER_OUTPUT_VIDEO_H

#include "ipc/segment/segment.h"
#include "renderer/output/picture.h"

#include <stdint.h>

enum video_purpose {
    VIDEO_LIVE,   /* little work, and what is written can be played when the writer is killed */
    VIDEO_REPLAY, /* from a recording: nobody waits, so the better picture */
};

struct video;

/* What the file at this path is to be, without a file yet. fps: pictures a second at most; those
 * that come too soon are left out. NULL with the reason: no such ending, the library or an encoder
 * for it is not there. Loads libraries: before the sandbox. */
struct video *video_open(const char *path, double fps, enum video_purpose purpose,
                         struct error_text *error);

/* Where it is written to: a descriptor of a new file, which stays the caller's. Before the first
 * picture. */
void video_write_to(struct video *video, int fd);

/* Adds a picture. The first decides the size that all have, both sides rounded down to even
 * numbers. One that is not later than the last is left out. 0, or -1 with the reason. */
int video_put(struct video *video, const struct picture *picture, struct error_text *error);

uint64_t video_pictures(const struct video *video);
const char *video_codec(const struct video *video);

/* Completes the file and frees the rest. NULL is nothing. 0, or -1 with the reason: it cannot be
 * written. */
int video_close(struct video *video, struct error_text *error);

#endif
