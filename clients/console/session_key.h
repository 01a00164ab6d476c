/* The token and the players' keys. */
#ifndef JOLON_CLIENTS_CONSOLE_SESSION_KEY_H
#define JOLON_CLIENTS_CONSOLE_SESSION_KEY_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SESSION_KEY_BYTES 16u
#define SESSION_KEY_TEXT  (2 * SESSION_KEY_BYTES + 1)
#define SESSION_KEY_MAX   129u /* longest token of a file, with the NUL */

/* Returns true if the keys are equal. The time depends only on the length of given. */
bool session_key_equal(const char *kept, const char *given);

/* Writes the bytes as hexadecimal digits. */
void session_key_text(char text[SESSION_KEY_TEXT], const uint8_t bytes[SESSION_KEY_BYTES]);

/* Makes random bytes. Returns false if the system has none. */
bool session_key_random(uint8_t bytes[SESSION_KEY_BYTES]);

/* Reads the token from a file with one line of 16 to 128 letters, digits, - or _. A missing file is
 * made with a new token, mode 0600. Returns 0, or -1 with the error, for example if other users may
 * read the file. */
int session_key_file(char token[SESSION_KEY_MAX], const char *path, struct error_text *error);

#endif
