/* Worlds made from an image, for the verb create with --from FILE and for replays. */
#ifndef JOLON_RECORDER_REPLAY_IMAGE_RESUME_H
#define JOLON_RECORDER_REPLAY_IMAGE_RESUME_H

#include "recorder/archive/image_read.h"
#include "recorder/replay/arguments.h"

/* Opens the image --from and applies --set and --seconds, or ends the process with the reason. The
 * caller calls image_close(). */
void image_resume_open(const struct arguments *arguments, struct image *image);

/* Fills a fresh segment that was made with image_segment(). Returns 0, or -1 with the reason. */
int image_resume_fill(struct view *view, const struct arguments *arguments,
                      const struct image *image, struct error_text *error);

/* Opens the image at path and loads it unchanged into a private segment, or ends the process with
 * the reason (exit 1). The caller calls segment_abandon() and image_close(). */
void image_resume_private(struct view *view, struct image *image, const char *path);

/* Makes the world of the image --from with --set and --seconds. Returns an exit code. A wrong image
 * or setting ends the process with the reason. */
int image_resume_world(const struct arguments *arguments);

#endif
