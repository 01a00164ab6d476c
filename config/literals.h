/* Literals: numbers as people write them, made such that libconfig reads them right. It takes an
 * integer past 32 bits without the suffix L as some other number, without a word, and refuses an
 * array that holds 1 beside 2.5. */
#ifndef JOLON_CONFIG_LITERALS_H
#define JOLON_CONFIG_LITERALS_H

#include <stdint.h>

/* What a text would have the parser build. */
struct literals_shape {
    uint32_t deepest; /* groups, lists and arrays in each other */
    uint32_t fullest; /* settings of a group, of those no deeper than LITERALS_DEPTH */
    int deepest_line, fullest_line; /* from 1, where it first is so; 0: there is none */
    int open_line; /* where a string or comment begins that does not end; 0: there is none */
};

#define LITERALS_DEPTH 64u

/* Measures a text, whether or not it can be parsed, in one pass and no memory. */
void literals_measure(const char *text, struct literals_shape *shape);

/* A copy of text in which long integers end in L and arrays of numbers are lists, [1, 2.5] being
 * (1, 2.5), and the last line ends; strings, comments and line numbers stay. NULL when memory is
 * out; the caller frees. */
char *literals_widen(const char *text);

#endif
