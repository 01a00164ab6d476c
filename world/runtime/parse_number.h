/* Numbers in texts from outside: command lines, commands, queries. */
#ifndef JOLON_WORLD_RUNTIME_PARSE_NUMBER_H
#define JOLON_WORLD_RUNTIME_PARSE_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* Return true, with the value, if the whole text is a number within the range. A whole number has
 * decimal digits only; a real number is read as by strtod(), is decimal, too, and must not
 * overflow. */
bool parse_whole(const char *text, uint64_t least, uint64_t most, uint64_t *value);
bool parse_real(const char *text, double low, double high, double *value);

#endif
