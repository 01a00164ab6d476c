/* A world's recipe: what it was made from, so that the same world can be made again. A row of
 * texts "key=value", each ended by NUL, in the order in which they were added; an empty one ends
 * it:
 *
 *     scenario   the scenario file's path, absolute
 *     image      or the path of the image that it goes on from, absolute,
 *     frame, commands   with that image's frame and the number of commands until then
 *     set        an override, "world.seed=7", in the order given
 *     seconds    how long it runs, where that was said so */
#ifndef JOLON_WORLD_PROVENANCE_H
#define JOLON_WORLD_PROVENANCE_H

#include <stdint.h>

#define PROVENANCE_BYTES_MAX (1u << 20)

/* Memory of its own; {0} is empty. */
struct provenance {
    char *text;
    uint32_t bytes;
};

/* Adds a text. 0, or -1 with errno ENOMEM or, beyond PROVENANCE_BYTES_MAX, EOVERFLOW. */
int provenance_add(struct provenance *recipe, const char *key, const char *value);
void provenance_free(struct provenance *recipe);

/* Room that a world keeps for a recipe of so many bytes [byte]: whole pages, the rest zero. */
uint32_t provenance_room(uint32_t bytes);

/* Walks along a recipe from *at = 0 on: the next text; NULL at its end, also where damage has taken
 * a NUL away. */
const char *provenance_next(const char *text, uint32_t bytes, uint32_t *at);

/* The value of the first text with this key, NULL when there is none. */
const char *provenance_find(const char *text, uint32_t bytes, const char *key);

/* The value of one text with this key, NULL when it has another. */
const char *provenance_value(const char *text, const char *key);

#endif
