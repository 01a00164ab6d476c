/* The fixed objects' records, sorted by strip and west edge. */
#include "collider/standing.h"

#include "world/reach.h"

#include <stdlib.h>
#include <string.h>

/* More than a float's step at 50 km: the records' boxes hold the objects'. */
#define SLACK_M 0.01

/* How far it reaches on the map, whatever collision.shape says. */
static double reach_of(const struct world *world, const struct fixed_object *object)
{
    return reach_of_fixed(object, world->kinds) + SLACK_M;
}

struct span {
    uint32_t first, last;
};

static struct span strips_of(const struct world *world, const struct fixed_object *object)
{
    double reach = reach_of(world, object);
    return (struct span){bin_strip((float)(object->z - reach)),
                         bin_strip((float)(object->z + reach))};
}

static void put(const struct standing *standing, const struct world *world, uint32_t i,
                uint32_t *next)
{
    const struct fixed_object *object = &world->fixed[i];
    struct span span = strips_of(world, object);
    double reach = reach_of(world, object);
    for (uint32_t strip = span.first; strip <= span.last; strip++)
        standing->record[next[strip]++] = (struct bin_record){
            .min_x = bin_steps((float)(object->x - reach)),
            .max_x = bin_steps((float)(object->x + reach)),
            .z = bin_z((float)(object->z - reach), (float)(object->z + reach), strip),
            .tag = i | (span.last > span.first ? BIN_SPANS : 0),
        };
}

static int by_west(const void *p, const void *q)
{
    const struct bin_record *a = p, *b = q;
    if (a->min_x != b->min_x)
        return a->min_x < b->min_x ? -1 : 1;
    return (a->tag & BIN_OBJECT) < (b->tag & BIN_OBJECT) ? -1 : 1;
}

static void finish_strip(struct standing *standing, uint32_t strip)
{
    uint32_t begin = standing->start[strip], end = standing->start[strip + 1] - STANDING_AHEAD,
             i = begin;
    qsort(standing->record + begin, end - begin, sizeof *standing->record, by_west);
    for (uint32_t n = 0; n < STANDING_AHEAD; n++)
        standing->record[end + n] = (struct bin_record){.min_x = INT32_MAX, .max_x = INT32_MAX};
    for (uint32_t column = 0; column < STANDING_COLUMNS; column++) {
        while (column > 0 && i < end &&
               (uint32_t)standing->record[i].max_x >> STANDING_COLUMN_BITS < column)
            i++;
        standing->first[strip * STANDING_COLUMNS + column] = i;
    }
}

int standing_init(struct standing *standing, const struct world *world)
{
    uint32_t next[STRIP_COUNT], count[STRIP_COUNT] = {0}, total = 0;
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        struct span span = strips_of(world, &world->fixed[i]);
        for (uint32_t strip = span.first; strip <= span.last; strip++)
            count[strip]++;
    }
    for (uint32_t strip = 0; strip < STRIP_COUNT; strip++) {
        standing->start[strip] = next[strip] = total;
        total += count[strip] + STANDING_AHEAD;
    }
    standing->start[STRIP_COUNT] = total;
    standing->record = malloc(total * sizeof *standing->record);
    standing->first = malloc(STRIP_COUNT * STANDING_COLUMNS * sizeof *standing->first);
    if (!standing->record || !standing->first) {
        standing_free(standing);
        return -1;
    }
    for (uint32_t i = 0; i < world->counts.fixed; i++)
        put(standing, world, i, next);
    for (uint32_t strip = 0; strip < STRIP_COUNT; strip++)
        finish_strip(standing, strip);
    return 0;
}

void standing_free(struct standing *standing)
{
    free(standing->record);
    free(standing->first);
    memset(standing, 0, sizeof *standing);
}

uint32_t standing_strip(const struct world *world, const struct fixed_object *object)
{
    return strips_of(world, object).first;
}
