/* Comparing what must not be guessed. */
#ifndef JOLON_CONSOLE_SECRET_H
#define JOLON_CONSOLE_SECRET_H

#include "ipc/segment.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SECRET_BYTES 16u
#define SECRET_TEXT  (2 * SECRET_BYTES + 1)
#define SECRET_MAX   129u /* of a file's, with the NUL */

/* Are they equal? Takes as long wherever they differ; the length of given shows. */
bool secret_equal(const char *kept, const char *given);

/* Bytes as hexadecimal digits. */
void secret_text(char text[SECRET_TEXT], const uint8_t bytes[SECRET_BYTES]);

/* New random bytes; false when the system gives none. */
bool secret_random(uint8_t bytes[SECRET_BYTES]);

/* The token that a file holds, one line of 16 to 128 letters, digits, - or _; a file that is not
 * there is made with a new one, mode 0600. 0, or -1 with the reason: others may read it, it holds
 * something else. */
int secret_file(char token[SECRET_MAX], const char *path, struct reason *reason);

#endif
