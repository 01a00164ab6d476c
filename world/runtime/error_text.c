/* Error texts. */
#include "world/runtime/error_text.h"

#include "world/runtime/utf8.h"

#include <stdarg.h>

int error_text_set(struct error_text *error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    (void)utf8_format(error->text, sizeof error->text, format, args);
    va_end(args);
    error->foreign = error->damaged = false;
    return -1;
}

int error_text_memory(struct error_text *error)
{
    return error_text_set(error, "out of memory while making the world");
}
