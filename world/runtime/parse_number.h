/* Numbers of a text that comes from outside: command lines, commands, queries. */
#ifndef JOLON_WORLD_RUNTIME_PARSE_NUMBER_H
#define JOLON_WORLD_RUNTIME_PARSE_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* True when the whole text is a number within the range, which value then is. A whole number is
 * written in decimal digits alone; a real one as strtod() reads it, but it may not overflow. */
bool parse_whole(const char *text, uint64_t least, uint64_t most, uint64_t *value);
bool parse_real(const char *text, double low, double high, double *value);

#endif
