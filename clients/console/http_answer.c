/* Writes errors and reads the arguments of an address. */
#include "clients/console/http_answer.h"

#include "world/runtime/parse_number.h"
#include "world/runtime/utf8.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#define SHOWN_MAX 40 /* characters of a wrong value that the error repeats */

void http_answer_error(struct http_answer *answer, enum http_answer_status status, const char *next,
                       const char *format, ...)
{
    char what[512];
    va_list arguments;
    va_start(arguments, format);
    (void)utf8_format(what, sizeof what, format, arguments);
    va_end(arguments);
    json_writer_free(&answer->json);
    answer->status = status;
    json_writer_begin(&answer->json, '{');
    json_writer_key_word(&answer->json, "error", what);
    json_writer_key_word(&answer->json, "next", next);
    json_writer_end(&answer->json, '}');
}

const char *query_text(const struct query *query, const char *key)
{
    const char *text = query->value(query->context, key);
    return text ? text : "";
}

bool query_number(const struct query *query, const char *key, double low, double high,
                  double fallback, double *value, struct http_answer *answer)
{
    const char *text = query->value(query->context, key);
    *value = fallback;
    if (!text || !*text || parse_real(text, low, high, value))
        return true;
    http_answer_error(answer, HTTP_ANSWER_BAD, "ask with another value",
                      "%s=%.*s: a number from %g to %g", key, SHOWN_MAX, text, low, high);
    return false;
}

bool query_whole(const struct query *query, const char *key, uint64_t low, uint64_t high,
                 uint64_t fallback, uint64_t *value, struct http_answer *answer)
{
    const char *text = query->value(query->context, key);
    *value = fallback;
    if (!text || !*text || parse_whole(text, low, high, value))
        return true;
    http_answer_error(answer, HTTP_ANSWER_BAD, "ask with another value",
                      "%s=%.*s: a whole number from %llu to %llu", key, SHOWN_MAX, text,
                      (unsigned long long)low, (unsigned long long)high);
    return false;
}
