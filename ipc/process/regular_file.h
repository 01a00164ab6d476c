/* Opening a regular file that a user names. */
#ifndef JOLON_IPC_PROCESS_REGULAR_FILE_H
#define JOLON_IPC_PROCESS_REGULAR_FILE_H

#include <stdint.h>

struct error_text;

/* Opens a regular file for reading. A link, pipe, device or folder is refused. Never blocks.
 * Returns the descriptor and sets bytes to the file's size, or returns -1 with the reason in
 * error. */
int regular_file_open(const char *path, uint64_t *bytes, struct error_text *error);

#endif
