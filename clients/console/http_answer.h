/* The arguments of a request and its answer, without the HTTP server, so that tests can make them.
 */
#ifndef JOLON_CLIENTS_CONSOLE_HTTP_ANSWER_H
#define JOLON_CLIENTS_CONSOLE_HTTP_ANSWER_H

#include "clients/console/json_writer.h"

#include <stdbool.h>
#include <stdint.h>

/* HTTP status codes. */
enum http_answer_status {
    HTTP_ANSWER_OK = 200,
    HTTP_ANSWER_BAD = 400,          /* malformed request */
    HTTP_ANSWER_UNAUTHORIZED = 401, /* the token is missing */
    HTTP_ANSWER_FORBIDDEN = 403,
    HTTP_ANSWER_NOT_FOUND = 404,
    HTTP_ANSWER_NOT_ALLOWED = 405, /* another method */
    HTTP_ANSWER_CONFLICT = 409,    /* the world's state does not allow it */
    HTTP_ANSWER_TOO_LARGE = 413,
    HTTP_ANSWER_NOT_JSON = 415,
    HTTP_ANSWER_TOO_MANY = 429,
    HTTP_ANSWER_AWAY = 503,
    HTTP_ANSWER_NO_REPLY = 504,
};

struct http_answer {
    enum http_answer_status status;
    struct json_writer json; /* JSON */
};

/* Replaces the answer by {"error": what is wrong, "next": what to do}. */
void http_answer_error(struct http_answer *answer, enum http_answer_status status, const char *next,
                       const char *format, ...) __attribute__((format(printf, 4, 5)));

/* The arguments of a request's address, ?KEY=VALUE&... */
struct query {
    const char *(*value)(void *context, const char *key); /* NULL: not given */
    void *context;
};

const char *query_text(const struct query *query, const char *key); /* "" when not given */

/* Fills value with the key's number, or with fallback if the key is missing. Returns false, with
 * the answer, if the value is no number of low..high. */
bool query_number(const struct query *query, const char *key, double low, double high,
                  double fallback, double *value, struct http_answer *answer);
bool query_whole(const struct query *query, const char *key, uint64_t low, uint64_t high,
                 uint64_t fallback, uint64_t *value, struct http_answer *answer);

#endif
