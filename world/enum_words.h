/* The macro that gives an enumeration its words. */
#ifndef JOLON_WORLD_ENUM_WORDS_H
#define JOLON_WORLD_ENUM_WORDS_H

#include <stddef.h>

/* Defines a function that returns the word of each of an enumeration's count values, from 0 on. */
#define WORDS(function, type, count, ...)                                                          \
    const char *function(enum type value)                                                          \
    {                                                                                              \
        static const char *const words[] = {__VA_ARGS__};                                          \
        _Static_assert(sizeof words / sizeof words[0] == (count), "a word for each value");        \
        return (size_t)value < (count) ? words[value] : "?";                                       \
    }

#endif
