/* The schema's rows by type, for a destination D and its field. What follows the positional
 * arguments are members of struct key: .unit, .meaning, .required, .unset. */
#ifndef JOLON_CONFIG_SYNTAX_SCHEMA_INTERNAL_H
#define JOLON_CONFIG_SYNTAX_SCHEMA_INTERNAL_H

#include "config/syntax/schema.h"
#include "world/terrain/gridsquare.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#define ROW(key, of_type, how, D, field, ...)                                                      \
    {                                                                                              \
        .name = (key), .type = (of_type), .store = (how), .offset = offsetof(D, field),            \
        __VA_ARGS__                                                                                \
    }
#define WHOLE32(key, D, field, min, max, value, ...)                                               \
    ROW(key, KEY_INTEGER, STORE_U32, D, field, .low = (min), .high = (max), .fallback = (value),   \
        __VA_ARGS__)
#define WHOLE64(key, D, field, min, max, value, ...)                                               \
    ROW(key, KEY_INTEGER, STORE_U64, D, field, .low = (min), .high = (max), .fallback = (value),   \
        __VA_ARGS__)
#define SCALED(key, D, field, min, max, factor, value, ...)                                        \
    ROW(key, KEY_NUMBER, STORE_DOUBLE, D, field, .low = (min), .high = (max), .scale = (factor),   \
        .fallback = (value), __VA_ARGS__)
#define NUMBER(key, D, field, min, max, value, ...)                                                \
    SCALED(key, D, field, min, max, 1.0, value, __VA_ARGS__)
/* The choices of a CHOICE. ALL: the words of a function of world/, for 0..count - 1. SOME: an
 * array, where the function has the words of the choices without a name. WORDS: an array with
 * names. */
#define ALL(function, count)  .choice_count = (count), .word = (function)
#define SOME(array, function) .choices = (array), .choice_count = COUNT(array), .word = (function)
#define WORDS(array)          .choices = (array), .choice_count = COUNT(array)
#define CHOICE(key, D, field, how, words, value, ...)                                              \
    ROW(key, KEY_CHOICE, how, D, field, words, .fallback = (value), __VA_ARGS__)
#define BOOLEAN(key, D, field, how, value, ...)                                                    \
    ROW(key, KEY_BOOLEAN, how, D, field, .low = 0.0, .high = 1.0, .fallback = (value), __VA_ARGS__)
#define TEXT(key, D, field, value, ...)                                                            \
    ROW(key, KEY_TEXT, STORE_TEXT, D, field, .size = sizeof(((D *)0)->field), .fallback = (value), \
        __VA_ARGS__)
#define PLACE(key, of_type, how, D, field, ...)                                                    \
    ROW(key, of_type, how, D, field, .low = 0.0, .high = WORLD_SIDE_DEFAULT_M, .unit = "m",        \
        __VA_ARGS__)

#define NUMBERS(key, D, field, min, max, ...)                                                      \
    ROW(key, KEY_NUMBERS, STORE_DOUBLE, D, field,                                                  \
        .size = sizeof(((D *)0)->field) / sizeof(double), .low = (min), .high = (max),             \
        __VA_ARGS__)

/* Defines the table of an entry's rows, with a row for each of `count` keys. */
#define KEY_TABLE(table, path, rows, D, count)                                                     \
    _Static_assert(COUNT(rows) == (count), "a row for each key");                                  \
    const struct key_table table = {path, rows, COUNT(rows), sizeof(D)}

#endif
