/* Rewrites numbers so that libconfig reads them correctly. libconfig reads an integer of more than
 * 32 bits without the suffix L as another number, without an error, and refuses an array such as
 * [1, 2.5]. */
#ifndef JOLON_CONFIG_SYNTAX_LITERALS_H
#define JOLON_CONFIG_SYNTAX_LITERALS_H

#include <stdint.h>

/* The size of the tree that libconfig would build from a text. */
struct literals_shape {
    uint32_t deepest; /* levels of groups, lists and arrays */
    uint32_t fullest; /* most settings of a group that is no deeper than LITERALS_DEPTH */
    int deepest_line, fullest_line; /* the first line, from 1, of each maximum; 0: none */
    int open_line; /* where a string or comment begins that does not end; 0: none */
};

#define LITERALS_DEPTH 64u

/* Measures any text, also one that cannot be parsed, in one pass and without allocation. */
void literals_measure(const char *text, struct literals_shape *shape);

/* A copy of text in which long integers end in L, arrays of numbers are lists ([1, 2.5] becomes
 * (1, 2.5)) and the last line has an end. Strings, comments and line numbers stay. The caller frees
 * it; NULL: no memory. */
char *literals_widen(const char *text);

#endif
