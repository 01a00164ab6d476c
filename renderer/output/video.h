/* A video file of one view. A second of the video is a second of the simulation, however fast that
 * runs. The name's ending selects the format:
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
    VIDEO_LIVE,   /* fast, and the file can be played even if the writer is killed */
    VIDEO_REPLAY, /* of a recorded run: slower and with better quality */
};

struct video;

/* Prepares a video of the path's format, without a file yet. fps: pictures a second at most; others
 * are left out. Loads libraries, so it must come before the sandbox. Returns NULL with the reason:
 * unknown ending, missing library or encoder. */
struct video *video_open(const char *path, double fps, enum video_purpose purpose,
                         struct error_text *error);

/* Sets the descriptor of a new file, which the caller closes, before the first picture. */
void video_write_to(struct video *video, int fd);

/* Adds a picture. The first one sets the size, rounded down to even numbers. A picture that is not
 * later than the last is left out. Returns 0, or -1 with the reason. */
int video_put(struct video *video, const struct picture *picture, struct error_text *error);

uint64_t video_pictures(const struct video *video);
const char *video_codec(const struct video *video);

/* Completes the file and frees the video. NULL is allowed. Returns 0, or -1 with the reason: the
 * file cannot be written. */
int video_close(struct video *video, struct error_text *error);

#endif
