/* Writes JSON into memory that grows up to a limit. It places commas and quotes and escapes
 * strings. cJSON would build a tree first, which costs more than the rest of an answer of thousands
 * of numbers. The functions return no error: check `failed` at the end. */
#ifndef JOLON_CLIENTS_CONSOLE_JSON_WRITER_H
#define JOLON_CLIENTS_CONSOLE_JSON_WRITER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define JSON_WRITER_MAX (16u << 20) /* [byte] of one answer */

struct json_writer {
    char *bytes;
    size_t used, room;
    bool comma;  /* needed before the next value */
    bool failed; /* no memory, or too long */
};

void json_writer_free(struct json_writer *json);

/* Opening bracket, '{' or '[', and the closing one. */
void json_writer_begin(struct json_writer *json, char bracket);
void json_writer_end(struct json_writer *json, char bracket);

/* Called before each value of an object. */
void json_writer_key(struct json_writer *json, const char *key);

void json_writer_word(struct json_writer *json, const char *word);
void json_writer_whole(struct json_writer *json, uint64_t value);
/* Writes at most `decimals` (0..9) decimals; null if the value is not finite or beyond 1e9. */
void json_writer_number(struct json_writer *json, double value, int decimals);
void json_writer_bool(struct json_writer *json, bool value);

/* Writes a key and its value. */
void json_writer_key_word(struct json_writer *json, const char *key, const char *word);
void json_writer_key_whole(struct json_writer *json, const char *key, uint64_t value);
void json_writer_key_number(struct json_writer *json, const char *key, double value, int decimals);
void json_writer_key_bool(struct json_writer *json, const char *key, bool value);

#endif
