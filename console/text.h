/* JSON as it is written: into memory that grows up to a bound. Commas and quotes are put where they
 * belong; what text holds is escaped. cJSON makes a tree first, which costs more than all the rest
 * of an answer with thousands of numbers. Nothing here fails but text.failed, at the end. */
#ifndef JOLON_CONSOLE_TEXT_H
#define JOLON_CONSOLE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TEXT_MAX (16u << 20) /* [byte] of one answer */

struct text {
    char *bytes;
    size_t used, room;
    bool comma;  /* wanted before what comes next */
    bool failed; /* no memory, or too long */
};

void text_free(struct text *text);

/* '{' or '[', and what ends it. */
void text_begin(struct text *text, char bracket);
void text_end(struct text *text, char bracket);

/* Within an object, before a value. */
void text_key(struct text *text, const char *key);

void text_word(struct text *text, const char *word);
void text_whole(struct text *text, uint64_t value);
/* With at most so many decimals, 0..9; null when it is not finite or beyond 1e9. */
void text_number(struct text *text, double value, int decimals);
void text_bool(struct text *text, bool value);

/* Key and value at once. */
void text_key_word(struct text *text, const char *key, const char *word);
void text_key_whole(struct text *text, const char *key, uint64_t value);
void text_key_number(struct text *text, const char *key, double value, int decimals);
void text_key_bool(struct text *text, const char *key, bool value);

#endif
