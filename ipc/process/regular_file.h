/* Plain files that a user names, to be read. */
#ifndef JOLON_IPC_PROCESS_REGULAR_FILE_H
#define JOLON_IPC_PROCESS_REGULAR_FILE_H

#include <stdint.h>

struct error_text;

/* Opens a plain file for reading: no link, pipe, device or folder. Never blocks. The descriptor and
 * the file's size, or -1 with the reason. */
int regular_file_open(const char *path, uint64_t *bytes, struct error_text *error);

#endif
