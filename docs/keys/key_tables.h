/* The tables of docs/scenario.md, made from the rows of config/syntax/schema.h. In the document a
 * table stands between a line that names it and the line "<!-- end -->":
 *
 *     <!-- keys of collision -->                the scenario keys below the group "collision"
 *     <!-- keys of vehicles[] -->               the keys of a list's entries
 *     <!-- keys of a kind -->                   the keys of a kind's file
 *     <!-- words of collision.method -->        the allowed words of a key
 */
#ifndef JOLON_DOCS_KEYS_KEY_TABLES_H
#define JOLON_DOCS_KEYS_KEY_TABLES_H

#include <stdio.h>

/* Writes the document with every table made anew. Returns 0, or -1 with `problem`: a line names no
 * table, a table has no end, or a key of the schema is in no table or in two. */
int key_tables_write(FILE *to, const char *document, char *problem, size_t bytes);

#endif
