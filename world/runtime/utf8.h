/* Text in UTF-8: what can be seen of it, and cutting it between characters. */
#ifndef JOLON_WORLD_RUNTIME_UTF8_H
#define JOLON_WORLD_RUNTIME_UTF8_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes of the character that text begins with, and its code; 0 when it begins with none. Overlong
 * forms and surrogates are none; the NUL is one of a single byte. */
size_t utf8_read(const char *text, uint32_t *code);

/* Does the character leave a mark on the paper, or is it the plain space? False for control
 * characters, those that turn the direction of writing, spaces of other widths, fillers, variation
 * selectors, private and unassigned planes: with them two names could look the same. */
bool utf8_visible(uint32_t code);

/* Makes a text whole UTF-8: a character that was cut is removed, any other byte that belongs to no
 * character becomes '?'. Returns its length [byte]. */
size_t utf8_mend(char *text);

/* As vsnprintf(), but what does not fit is cut between two characters, and the result is the length
 * of what is there [byte]. */
size_t utf8_format(char *text, size_t bytes, const char *format, va_list arguments)
    __attribute__((format(printf, 3, 0)));

#endif
