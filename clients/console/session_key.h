/* Comparing what must not be guessed. */
#ifndef JOLON_CLIENTS_CONSOLE_SESSION_KEY_H
#define JOLON_CLIENTS_CONSOLE_SESSION_KEY_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SESSION_KEY_BYTES 16u
#define SESSION_KEY_TEXT  (2 * SESSION_KEY_BYTES + 1)
#define SESSION_KEY_MAX   129u /* of a file's, with the NUL */

/* Are they equal? Takes as long wherever they differ; the length of given shows. */
bool session_key_equal(const char *kept, const char *given);

/* Bytes as hexadecimal digits. */
void session_key_text(char text[SESSION_KEY_TEXT], const uint8_t bytes[SESSION_KEY_BYTES]);

/* New random bytes; false when the system gives none. */
bool session_key_random(uint8_t bytes[SESSION_KEY_BYTES]);

/* The token that a file holds, one line of 16 to 128 letters, digits, - or _; a file that is not
 * there is made with a new one, mode 0600. 0, or -1 with the reason: others may read it, it holds
 * something else. */
int session_key_file(char token[SESSION_KEY_MAX], const char *path, struct error_text *error);

#endif
