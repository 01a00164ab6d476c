/* The fixed objects' records, sorted by strip and west edge. This takes most of a collider's start,
 * so a radix sort is used. */
#include "collider/broad_phase/static_boxes.h"

#include "world/terrain/fixed_index.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

/* More than a float's step at 50 km, so that a record's box contains the object's. */

/* Returns how far the object reaches on the map [m], for either collision.shape. */
static double reach_of(const struct world *world, const struct fixed_object *object)
{
    return fixed_index_of_fixed(object, world->kinds) + pair_filter_slack(world);
}

struct span {
    uint32_t first, last;
};

static struct span strips_of(const struct static_boxes *fixed_boxes, const struct world *world,
                             const struct fixed_object *object)
{
    double reach = reach_of(world, object);
    return (struct span){bin_strip(fixed_boxes->steps_per_m, (float)(object->z - reach)),
                         bin_strip(fixed_boxes->steps_per_m, (float)(object->z + reach))};
}

/* --- from west to east -------------------------------------------------------------------------*/

struct place {
    int32_t min_x;
    uint32_t object;
};

#define DIGIT_BITS 13 /* two digits hold any min_x */
#define DIGITS     (1u << DIGIT_BITS)
_Static_assert(2 * DIGIT_BITS >= BIN_BITS, "two passes sort by all of min_x");

/* Stable: objects that are equal in this digit stay in their order. */
static void sort_digit(const struct place *from, struct place *to, uint32_t count, unsigned shift)
{
    uint32_t next[DIGITS] = {0}, total = 0;
    for (uint32_t i = 0; i < count; i++)
        next[(uint32_t)from[i].min_x >> shift & (DIGITS - 1)]++;
    for (uint32_t digit = 0; digit < DIGITS; digit++) {
        uint32_t of_digit = next[digit];
        next[digit] = total;
        total += of_digit;
    }
    for (uint32_t i = 0; i < count; i++)
        to[next[(uint32_t)from[i].min_x >> shift & (DIGITS - 1)]++] = from[i];
}

/* Returns the objects by west edge, then by index; the caller frees them. NULL: out of memory. */
static struct place *from_west(const struct static_boxes *fixed_boxes, const struct world *world)
{
    uint32_t count = world->counts.fixed;
    struct place *place = calloc(2 * ((size_t)count + 1), sizeof *place);
    if (!place)
        return NULL;
    for (uint32_t i = 0; i < count; i++) {
        const struct fixed_object *object = &world->fixed[i];
        place[i] = (struct place){
            bin_steps(fixed_boxes->steps_per_m, (float)(object->x - reach_of(world, object))), i};
    }
    sort_digit(place, place + count, count, 0);
    sort_digit(place + count, place, count, DIGIT_BITS);
    return place;
}

/* --- into strips -------------------------------------------------------------------------------*/

static void put(const struct static_boxes *fixed_boxes, const struct world *world,
                const struct place *place, uint32_t *next)
{
    const struct fixed_object *object = &world->fixed[place->object];
    double reach = reach_of(world, object);
    struct span span = strips_of(fixed_boxes, world, object);
    for (uint32_t strip = span.first; strip <= span.last; strip++)
        fixed_boxes->record[next[strip]++] = (struct bin_record){
            .min_x = place->min_x,
            .max_x = bin_steps(fixed_boxes->steps_per_m, (float)(object->x + reach)),
            .z = bin_z(fixed_boxes->steps_per_m, (float)(object->z - reach),
                       (float)(object->z + reach), strip),
            .tag = place->object | (span.last > span.first ? BIN_SPANS : 0),
        };
}

static void finish_strip(struct static_boxes *fixed_boxes, uint32_t strip)
{
    uint32_t begin = fixed_boxes->start[strip],
             end = fixed_boxes->start[strip + 1] - STATIC_BOXES_AHEAD, i = begin;
    for (uint32_t n = 0; n < STATIC_BOXES_AHEAD; n++)
        fixed_boxes->record[end + n] = (struct bin_record){.min_x = INT32_MAX, .max_x = INT32_MAX};
    for (uint32_t column = 0; column < STATIC_BOXES_COLUMNS; column++) {
        while (column > 0 && i < end &&
               (uint32_t)fixed_boxes->record[i].max_x >> STATIC_BOXES_COLUMN_BITS < column)
            i++;
        fixed_boxes->first[strip * STATIC_BOXES_COLUMNS + column] = i;
    }
}

int static_boxes_init(struct static_boxes *fixed_boxes, const struct world *world)
{
    uint32_t next[STRIP_COUNT], count[STRIP_COUNT] = {0}, total = 0;
    fixed_boxes->steps_per_m = bin_steps_per_m(world->terrain.squares.world_m);
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        struct span span = strips_of(fixed_boxes, world, &world->fixed[i]);
        for (uint32_t strip = span.first; strip <= span.last; strip++)
            count[strip]++;
    }
    for (uint32_t strip = 0; strip < STRIP_COUNT; strip++) {
        fixed_boxes->start[strip] = next[strip] = total;
        total += count[strip] + STATIC_BOXES_AHEAD;
    }
    fixed_boxes->start[STRIP_COUNT] = total;
    fixed_boxes->record = malloc(total * sizeof *fixed_boxes->record);
    fixed_boxes->first = malloc(STRIP_COUNT * STATIC_BOXES_COLUMNS * sizeof *fixed_boxes->first);
    struct place *place = from_west(fixed_boxes, world);
    if (!fixed_boxes->record || !fixed_boxes->first || !place) {
        free(place);
        static_boxes_free(fixed_boxes);
        return -1;
    }
    for (uint32_t i = 0; i < world->counts.fixed; i++)
        put(fixed_boxes, world, &place[i], next);
    free(place);
    for (uint32_t strip = 0; strip < STRIP_COUNT; strip++)
        finish_strip(fixed_boxes, strip);
    return 0;
}

void static_boxes_free(struct static_boxes *fixed_boxes)
{
    free(fixed_boxes->record);
    free(fixed_boxes->first);
    memset(fixed_boxes, 0, sizeof *fixed_boxes);
}

uint32_t static_boxes_strip(const struct static_boxes *fixed_boxes, const struct world *world,
                            const struct fixed_object *object)
{
    return strips_of(fixed_boxes, world, object).first;
}
