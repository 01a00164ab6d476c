/* Literals: numbers as people write them, made such that libconfig reads them right. It takes an
 * integer past 32 bits without the suffix L as some other number, without a word, and refuses an
 * array that holds 1 beside 2.5. */
#ifndef JOLON_CONFIG_LITERALS_H
#define JOLON_CONFIG_LITERALS_H

/* A copy of text in which long integers end in L and arrays of numbers are lists, [1, 2.5] being
 * (1, 2.5); strings, comments and line numbers stay. NULL when memory is out; the caller frees. */
char *literals_widen(const char *text);

#endif
