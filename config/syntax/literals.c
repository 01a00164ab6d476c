/* Goes through a text once, token by token. */
#include "config/syntax/literals.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Integers of at most so many digits fit 32 bits. */
#define DECIMAL_DIGITS_SAFE 9
#define HEX_DIGITS_SAFE     7
#define DECIMAL_MOST        "9223372036854775807" /* of an integer of 64 bits */

#define DECIMAL_DIGITS "0123456789"
#define HEX_DIGITS     "0123456789abcdefABCDEF"

struct copying {
    const char *from;
    char *to;
    bool array; /* inside an array that becomes a list */
};

static void copy(struct copying *copying, size_t count)
{
    memcpy(copying->to, copying->from, count);
    copying->from += count;
    copying->to += count;
}

static size_t string_length(const char *text, bool *ends)
{
    size_t length = 1;
    while (text[length] != '\0' && text[length] != '"')
        length += text[length] == '\\' && text[length + 1] != '\0' ? 2 : 1;
    *ends = text[length] == '"';
    return length + *ends;
}

static size_t comment_length(const char *text, bool *ends)
{
    const char *end = strstr(text + 2, "*/");
    *ends = end != NULL;
    return *ends ? (size_t)(end - text) + 2 : strlen(text);
}

/* Length of the string or comment at the beginning of text; 0: there is none. ends: false when it
 * does not end in the text. */
static size_t opaque_length(const char *text, bool *ends)
{
    *ends = true;
    if (text[0] == '"')
        return string_length(text, ends);
    if (text[0] == '/' && text[1] == '*')
        return comment_length(text, ends);
    return text[0] == '#' || (text[0] == '/' && text[1] == '/') ? strcspn(text, "\n") : 0;
}

/* Returns true if so many decimal digits are no integer of 64 bits. */
static bool exceeds(const char *text, size_t digits)
{
    size_t zeros = strspn(text, "0");
    size_t most = sizeof DECIMAL_MOST - 1, left = digits - (zeros < digits ? zeros : digits);
    return left > most || (left == most && strncmp(text + zeros, DECIMAL_MOST, most) > 0);
}

static void copy_number(struct copying *copying)
{
    const char *text = copying->from + (copying->from[0] == '+' || copying->from[0] == '-');
    bool hex = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    size_t digits = hex ? strspn(text + 2, HEX_DIGITS) : strspn(text, DECIMAL_DIGITS);
    const char *end = text + digits + (hex ? 2 : 0);
    bool whole = !isalnum((unsigned char)*end) && *end != '.';
    if (!whole) { /* a fraction, an exponent or a suffix stays as it is */
        while (isalnum((unsigned char)*end) || *end == '.' ||
               ((*end == '+' || *end == '-') && (end[-1] == 'e' || end[-1] == 'E')))
            end++;
    }
    copy(copying, end > copying->from ? (size_t)(end - copying->from) : 1);
    if (whole && !hex && exceeds(text, digits)) {
        memcpy(copying->to, ".0", 2); /* it is read as a fraction, and not cut off */
        copying->to += 2;
    } else if (whole && digits > (hex ? HEX_DIGITS_SAFE : DECIMAL_DIGITS_SAFE)) {
        *copying->to++ = 'L';
    }
}

/* Returns true if the array that begins at "[" has only numbers. */
static bool is_number_array(const char *text)
{
    size_t length = 1 + strspn(text + 1, HEX_DIGITS "xXL+-.,; \t\r\n");
    return text[length] == ']' && length > 1;
}

void literals_measure(const char *text, struct literals_shape *shape)
{
    uint32_t members[LITERALS_DEPTH + 1] = {0};
    uint32_t depth = 0;
    int line = 1;
    memset(shape, 0, sizeof(*shape));
    for (const char *at = text; *at != '\0';) {
        bool ends;
        size_t length = opaque_length(at, &ends);
        if (length > 0) {
            if (!ends)
                shape->open_line = line;
            for (size_t i = 0; i < length; i++)
                line += at[i] == '\n';
            at += length;
            continue;
        }
        if (strchr("([{", *at) != NULL) {
            if (++depth <= LITERALS_DEPTH)
                members[depth] = 0;
            if (depth > shape->deepest) {
                shape->deepest = depth;
                shape->deepest_line = line;
            }
        } else if (strchr(")]}", *at) != NULL) {
            depth -= depth > 0;
        } else if ((*at == '=' || *at == ':') && depth <= LITERALS_DEPTH) {
            if (++members[depth] > shape->fullest) {
                shape->fullest = members[depth];
                shape->fullest_line = line;
            }
        }
        line += *at++ == '\n';
    }
}

char *literals_widen(const char *text)
{
    /* A character is added after eight or more characters of a number, two after nineteen or more,
     * and one at the end. */
    size_t bytes = strlen(text);
    char *widened = malloc(bytes + bytes / 8 + 3);
    struct copying copying = {text, widened, false};
    if (widened == NULL)
        return NULL;
    while (*copying.from != '\0') {
        unsigned char c = (unsigned char)*copying.from;
        bool ends;
        size_t opaque = opaque_length(copying.from, &ends);
        if (opaque > 0) {
            copy(&copying, opaque);
        } else if (isalpha(c) || c == '*' || c == '_') {
            do
                copy(&copying, 1);
            while (isalnum((unsigned char)*copying.from) ||
                   (*copying.from != '\0' && strchr("-_*", *copying.from) != NULL));
        } else if (isdigit(c) || c == '+' || c == '-') {
            copy_number(&copying);
        } else {
            bool opens = c == '[' && is_number_array(copying.from);
            bool closes = c == ']' && copying.array;
            copy(&copying, 1);
            if (opens || closes) {
                copying.to[-1] = opens ? '(' : ')';
                copying.array = opens;
            }
        }
    }
    if (copying.to > widened && copying.to[-1] != '\n')
        *copying.to++ = '\n'; /* without it libconfig refuses a comment at the end */
    *copying.to = '\0';
    return widened;
}
