/* One line of text, cut to its room. */
#include "world/complaint.h"

#include "world/utf8.h"

#include <stdarg.h>

int complaint_say(const struct complaint *to, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    (void)utf8_format(to->text, to->bytes, format, args);
    va_end(args);
    return -1;
}

int complaint_memory(const struct complaint *to)
{
    return complaint_say(to, "out of memory while making the world");
}
