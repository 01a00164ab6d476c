/* The provenance of a world: what it was made from, so that the same world can be made again. A
 * list of texts "key=value", each ended by NUL, in the order in which they were added; an empty
 * text ends it:
 *
 *     scenario   the scenario file's path, absolute
 *     image      or the path of the image from which it was resumed, absolute,
 *     frame, commands   with that image's frame and the number of commands until then
 *     set        an override, "world.seed=7", in the order given
 *     ground     of a world on a ground file: the hash of its ground, a blank and its path
 *     seconds    how long it runs, if that was given */
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

/* Returns the room that a world keeps for a provenance of this length [byte]: whole pages, the rest
 * zero. */
uint32_t provenance_room(uint32_t bytes);

/* Returns the next text from *at on (0 at first) and advances *at. NULL at the end, also if damage
 * has removed a NUL. */
const char *provenance_next(const char *text, uint32_t bytes, uint32_t *at);

/* Returns the value of the first text with this key, NULL if there is none. */
const char *provenance_find(const char *text, uint32_t bytes, const char *key);

/* Returns the value of one text with this key, NULL if it has another. */
const char *provenance_value(const char *text, const char *key);

#endif
