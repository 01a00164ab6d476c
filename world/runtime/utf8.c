/* Reading and repairing UTF-8. */
#include "world/runtime/utf8.h"

#include <stdio.h>

/* Returns the bytes of the character that begins with this one, 0 for a byte that begins none. */
static size_t bytes_after(unsigned char first)
{
    if (first < 0x80)
        return 1;
    if (first < 0xc2 || first > 0xf4)
        return 0;
    return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

/* Returns how many of the character's bytes are there. */
static size_t bytes_there(const char *text, size_t wanted)
{
    size_t count = 1;
    while (count < wanted && ((unsigned char)text[count] & 0xc0) == 0x80)
        count++;
    return count;
}

size_t utf8_read(const char *text, uint32_t *code)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    unsigned char first = (unsigned char)text[0];
    size_t bytes = bytes_after(first);
    if (bytes == 0 || bytes_there(text, bytes) < bytes)
        return 0;
    *code = bytes == 1 ? first : first & (0x7fu >> bytes);
    for (size_t i = 1; i < bytes; i++)
        *code = *code << 6 | ((unsigned char)text[i] & 0x3f);
    bool good = *code >= least[bytes] && *code <= 0x10ffff && (*code < 0xd800 || *code > 0xdfff);
    return good ? bytes : 0;
}

bool utf8_visible(uint32_t code)
{
    static const uint32_t hidden[][2] = {
        {0x0, 0x1f},        /* control characters */
        {0x7f, 0xa0},       /* more of them, and the space that does not break */
        {0xad, 0xad},       /* soft hyphen */
        {0x34f, 0x34f},     /* grapheme joiner */
        {0x61c, 0x61c},     /* Arabic letter mark */
        {0x115f, 0x1160},   /* Hangul fillers */
        {0x1680, 0x1680},   /* Ogham space */
        {0x17b4, 0x17b5},   /* Khmer vowels that are not written */
        {0x180b, 0x180f},   /* Mongolian selectors */
        {0x2000, 0x200f},   /* spaces, joiners, marks of direction */
        {0x2028, 0x202f},   /* ends of lines, embeddings and overrides, a narrow space */
        {0x205f, 0x206f},   /* a space, invisible operators, isolates */
        {0x2800, 0x2800},   /* Braille without a dot */
        {0x3000, 0x3000},   /* wide space */
        {0x3164, 0x3164},   /* Hangul filler */
        {0xd800, 0xf8ff},   /* surrogates, private use */
        {0xfe00, 0xfe0f},   /* variation selectors */
        {0xfeff, 0xfeff},   /* byte order mark */
        {0xffa0, 0xffa0},   /* half-width filler */
        {0xfff0, 0xffff},   /* specials */
        {0x1bca0, 0x1bca3}, /* shorthand controls */
        {0x1d173, 0x1d17a}, /* musical controls */
        {0xe0000, UINT32_MAX},
    };
    for (size_t i = 0; i < sizeof hidden / sizeof hidden[0]; i++) {
        if (code >= hidden[i][0] && code <= hidden[i][1])
            return false;
    }
    return true;
}

size_t utf8_mend(char *text)
{
    size_t length = 0;
    for (const char *at = text; *at != '\0';) {
        uint32_t code;
        size_t bytes = utf8_read(at, &code), wanted = bytes_after((unsigned char)*at);
        size_t there = bytes_there(at, wanted);
        if (bytes == 0 && there < wanted) { /* the character was cut off */
            at += there;
            continue;
        }
        for (size_t i = 0; i < bytes; i++)
            text[length++] = at[i];
        if (bytes == 0)
            text[length++] = '?';
        at += bytes > 0 ? bytes : 1;
    }
    text[length] = '\0';
    return length;
}

size_t utf8_format(char *text, size_t bytes, const char *format, va_list arguments)
{
    if (vsnprintf(text, bytes, format, arguments) < 0)
        text[0] = '\0';
    return utf8_mend(text);
}
