/* Verb create with --from FILE: a world out of an image. */
#ifndef JOLON_RECORDER_REPLAY_IMAGE_RESUME_H
#define JOLON_RECORDER_REPLAY_IMAGE_RESUME_H

#include "recorder/archive/image_read.h"
#include "recorder/replay/arguments.h"

/* Its two halves, for those who play the run again. Opens the image --from with those changes, or
 * ends the process with the reason; image_close frees it. */
void image_resume_open(const struct arguments *arguments, struct image *image);

/* Fills a fresh segment of image_segment(). 0, or -1 with the reason. */
int image_resume_fill(struct view *view, const struct arguments *arguments,
                      const struct image *image, struct error_text *error);

/* Makes the world that the image holds, with the changes of --set and --seconds; an exit code.
 * Wrong images and settings end the process with the reason. */
int image_resume_world(const struct arguments *arguments);

#endif
