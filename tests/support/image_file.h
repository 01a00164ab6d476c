/* Image files of a test's worlds, in a folder of this test that is removed at exit. A failure in
 * here fails the calling cmocka test. */
#ifndef JOLON_TESTS_SUPPORT_IMAGE_FILE_H
#define JOLON_TESTS_SUPPORT_IMAGE_FILE_H

#include "recorder/archive/image_read.h"
#include "recorder/archive/image_write.h"
#include "recorder/replay/frame_stepper.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

/* Writes "FOLDER/name" to path and returns it. The folder is made at the first call. */
const char *image_file_path(char path[PATH_MAX], const char *name);

/* Returns the number of files in the folder. */
int image_file_count(void);

/* Writes the view's committed frame to path. */
void image_file_save(struct view *view, const char *path, bool inputs);

/* Reads path into a private view. */
void image_file_load(struct view *view, const char *path);

/* Read and write a whole file. The caller frees the returned bytes. */
unsigned char *image_file_bytes(const char *path, size_t *bytes);
void image_file_put(const char *path, const void *bytes, size_t count);

/* Computes frames of a private view up to this frame. */
void image_file_run(struct view *view, uint64_t frame);
uint64_t image_file_digest(const struct view *view);

#endif
