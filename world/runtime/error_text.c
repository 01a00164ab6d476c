/* One line of text, cut to its room. */
#include "world/runtime/error_text.h"

#include "world/runtime/utf8.h"

#include <stdarg.h>

int error_text_say(const struct error_text *to, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    (void)utf8_format(to->text, to->bytes, format, args);
    va_end(args);
    return -1;
}

int error_text_memory(const struct error_text *to)
{
    return error_text_say(to, "out of memory while making the world");
}
