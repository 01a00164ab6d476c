/* Images of a test's worlds, in a folder of its own that is gone at exit.
 *
 * Whatever fails in here fails the cmocka test that called it. */
#ifndef JOLON_TESTS_SUPPORT_IMAGE_FILE_H
#define JOLON_TESTS_SUPPORT_IMAGE_FILE_H

#include "recorder/archive/image_read.h"
#include "recorder/archive/image_write.h"
#include "recorder/replay/frame_stepper.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

/* "FOLDER/name"; the folder is made at the first call. */
const char *image_file_path(char path[PATH_MAX], const char *name);

/* How many files are in the folder. */
int image_file_count(void);

/* Writes the view's committed frame to path. */
void image_file_save(struct view *view, const char *path, bool inputs);

/* Reads path into a private view. */
void image_file_load(struct view *view, const char *path);

/* The whole file in memory; the caller frees. Writing makes the file anew. */
unsigned char *image_file_bytes(const char *path, size_t *bytes);
void image_file_put(const char *path, const void *bytes, size_t count);

/* Runs a private view alone up to a frame; state_digest() of its committed frame. */
void image_file_play(struct view *view, uint64_t frame);
uint64_t image_file_digest(const struct view *view);

#endif
