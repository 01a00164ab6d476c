/* What is asked and what is answered, without HTTP's own: tests ask the same way. */
#ifndef JOLON_CLIENTS_CONSOLE_HTTP_ANSWER_H
#define JOLON_CLIENTS_CONSOLE_HTTP_ANSWER_H

#include "clients/console/json_writer.h"

#include <stdbool.h>
#include <stdint.h>

/* Statuses of answers, as HTTP has them. */
enum http_answer_status {
    HTTP_ANSWER_OK = 200,
    HTTP_ANSWER_BAD = 400,          /* what is asked makes no sense */
    HTTP_ANSWER_UNAUTHORIZED = 401, /* wants the token */
    HTTP_ANSWER_FORBIDDEN = 403,
    HTTP_ANSWER_NOT_FOUND = 404,
    HTTP_ANSWER_NOT_ALLOWED = 405, /* another method */
    HTTP_ANSWER_CONFLICT = 409,    /* the world says no */
    HTTP_ANSWER_TOO_LARGE = 413,
    HTTP_ANSWER_NOT_JSON = 415,
    HTTP_ANSWER_TOO_MANY = 429,
    HTTP_ANSWER_AWAY = 503,
    HTTP_ANSWER_NO_REPLY = 504,
};

struct http_answer {
    enum http_answer_status status;
    struct json_writer text; /* JSON */
};

/* {"error": what is wrong, "next": what to do}; what was written before is dropped. */
void http_answer_error(struct http_answer *answer, enum http_answer_status status, const char *next,
                       const char *format, ...) __attribute__((format(printf, 4, 5)));

/* The values of a request's address, ?KEY=VALUE&... */
struct query {
    const char *(*value)(void *context, const char *key); /* NULL: not given */
    void *context;
};

const char *query_text(const struct query *query, const char *key); /* "" when not given */

/* Fills value with the number of low..high that key gives, or fallback. False, with the answer,
 * when it is another. */
bool query_number(const struct query *query, const char *key, double low, double high,
                  double fallback, double *value, struct http_answer *answer);
bool query_whole(const struct query *query, const char *key, uint64_t low, uint64_t high,
                 uint64_t fallback, uint64_t *value, struct http_answer *answer);

#endif
