#include "tests/support/scenario_text.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

void scenario_text_add(struct scenario_text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text->at + text->used, sizeof text->at - text->used, format, arguments);
    va_end(arguments);
    assert_true(length >= 0 && text->used + (size_t)length < sizeof text->at);
    text->used += (size_t)length;
}
