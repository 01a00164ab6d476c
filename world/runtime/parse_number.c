/* Numbers in texts from outside. */
#include "world/runtime/parse_number.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

bool parse_whole(const char *text, uint64_t least, uint64_t most, uint64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 && *value >= least &&
           *value <= most;
}

bool parse_real(const char *text, double low, double high, double *value)
{
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    /* strtod() reads hexadecimal numbers, too. */
    return errno == 0 && end != text && *end == '\0' && !strpbrk(text, "xX") && *value >= low &&
           *value <= high;
}
