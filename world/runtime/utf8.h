/* Text in UTF-8: visible characters, and cutting between characters. */
#ifndef JOLON_WORLD_RUNTIME_UTF8_H
#define JOLON_WORLD_RUNTIME_UTF8_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Returns the bytes of the character with which text begins, and its code; 0 if it begins with
 * none. Overlong forms and surrogates are not characters; the NUL is one of a single byte. */
size_t utf8_read(const char *text, uint32_t *code);

/* Returns true if the character is visible or is the plain space. False for control characters,
 * those that change the direction of writing, spaces of other widths, fillers, variation selectors,
 * private and unassigned planes: with them two names could look the same. */
bool utf8_visible(uint32_t code);

/* Makes a text valid UTF-8: a character that was cut off is removed, any other byte that belongs to
 * no character becomes '?'. Returns its length [byte]. */
size_t utf8_mend(char *text);

/* Like vsnprintf(), but text that is too long is cut between two characters, and the result is the
 * length of the text written [byte]. */
size_t utf8_format(char *text, size_t bytes, const char *format, va_list arguments)
    __attribute__((format(printf, 3, 0)));

#endif
