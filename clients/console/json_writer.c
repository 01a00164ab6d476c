/* Writes JSON into a buffer. */
#include "clients/console/json_writer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS_MAX 24

static void put(struct json_writer *json, const char *bytes, size_t count)
{
    if (json->failed)
        return;
    if (count > json->room - json->used) {
        size_t room = json->room ? json->room : 512;
        while (room - json->used < count)
            room *= 2;
        char *grown = room <= JSON_WRITER_MAX ? realloc(json->bytes, room) : NULL;
        if (!grown) {
            json->failed = true;
            return;
        }
        json->bytes = grown;
        json->room = room;
    }
    memcpy(json->bytes + json->used, bytes, count);
    json->used += count;
}

static void put_comma(struct json_writer *json)
{
    if (json->comma)
        put(json, ",", 1);
    json->comma = true;
}

void json_writer_free(struct json_writer *json)
{
    free(json->bytes);
    *json = (struct json_writer){0};
}

void json_writer_begin(struct json_writer *json, char bracket)
{
    put_comma(json);
    put(json, &bracket, 1);
    json->comma = false;
}

void json_writer_end(struct json_writer *json, char bracket)
{
    put(json, &bracket, 1);
    json->comma = true;
}

static void put_escaped(struct json_writer *json, const char *word)
{
    static const char hex[] = "0123456789abcdef";
    put(json, "\"", 1);
    for (const char *c = word; *c; c++) {
        unsigned char byte = (unsigned char)*c;
        if (byte == '"' || byte == '\\') {
            const char pair[2] = {'\\', *c};
            put(json, pair, sizeof pair);
        } else if (byte < 0x20 || byte == 0x7f) {
            const char code[6] = {'\\', 'u', '0', '0', hex[byte >> 4], hex[byte & 15]};
            put(json, code, sizeof code);
        } else {
            put(json, c, 1);
        }
    }
    put(json, "\"", 1);
}

void json_writer_key(struct json_writer *json, const char *key)
{
    put_comma(json);
    put_escaped(json, key);
    put(json, ":", 1);
    json->comma = false;
}

void json_writer_word(struct json_writer *json, const char *word)
{
    put_comma(json);
    put_escaped(json, word);
}

/* Writes the digits of value at the end of the array and returns where they begin. */
static char *digits_of(char digits[DIGITS_MAX], uint64_t value)
{
    char *at = digits + DIGITS_MAX;
    do {
        *--at = (char)('0' + value % 10);
        value /= 10;
    } while (value);
    return at;
}

void json_writer_whole(struct json_writer *json, uint64_t value)
{
    char digits[DIGITS_MAX];
    char *at = digits_of(digits, value);
    put_comma(json);
    put(json, at, (size_t)(digits + DIGITS_MAX - at));
}

void json_writer_number(struct json_writer *json, double value, int decimals)
{
    static const double power[] = {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
    put_comma(json);
    if (!isfinite(value) || fabs(value) > 1e9) {
        put(json, "null", 4);
        return;
    }
    char digits[DIGITS_MAX], whole[DIGITS_MAX];
    uint64_t scale = (uint64_t)power[decimals];
    uint64_t scaled = (uint64_t)llround(fabs(value) * power[decimals]);
    if (value < 0.0 && scaled > 0)
        put(json, "-", 1);
    char *at = digits_of(whole, scaled / scale);
    put(json, at, (size_t)(whole + DIGITS_MAX - at));
    if (scaled % scale == 0)
        return;
    /* The digit 1 before the fraction keeps the fraction's leading zeros. */
    uint64_t fraction = scaled % scale + scale;
    while (fraction % 10 == 0)
        fraction /= 10;
    at = digits_of(digits, fraction) + 1;
    put(json, ".", 1);
    put(json, at, (size_t)(digits + DIGITS_MAX - at));
}

void json_writer_bool(struct json_writer *json, bool value)
{
    put_comma(json);
    put(json, value ? "true" : "false", value ? 4 : 5);
}

void json_writer_key_word(struct json_writer *json, const char *key, const char *word)
{
    json_writer_key(json, key);
    json_writer_word(json, word);
}

void json_writer_key_whole(struct json_writer *json, const char *key, uint64_t value)
{
    json_writer_key(json, key);
    json_writer_whole(json, value);
}

void json_writer_key_number(struct json_writer *json, const char *key, double value, int decimals)
{
    json_writer_key(json, key);
    json_writer_number(json, value, decimals);
}

void json_writer_key_bool(struct json_writer *json, const char *key, bool value)
{
    json_writer_key(json, key);
    json_writer_bool(json, value);
}
