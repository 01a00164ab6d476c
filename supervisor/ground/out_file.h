/* What a verb may write over. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_OUT_FILE_H
#define JOLON_SUPERVISOR_GROUND_OUT_FILE_H

#include <stdint.h>

struct error_text;

/* Checks that a file can be written aside of `path` and renamed to it. Returns 0, or -1 with the
 * reason: there is a folder, a pipe or a device, which the renaming would replace or could not; it
 * is one of the maps [count] that are read, by this or another name; its folder cannot be written;
 * or a map is a pipe or a device. A map that does not exist is no reason. */
int out_file_check(const char *path, char *const *maps, uint32_t count, struct error_text *error);

#endif
