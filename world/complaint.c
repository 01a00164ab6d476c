/* One line of text, cut to its room. */
#include "world/complaint.h"

#include <stdarg.h>
#include <stdio.h>

int complaint_say(const struct complaint *to, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(to->text, to->bytes, format, args);
    va_end(args);
    return -1;
}

int complaint_memory(const struct complaint *to)
{
    return complaint_say(to, "out of memory while making the world");
}
