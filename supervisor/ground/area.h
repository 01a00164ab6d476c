/* Areas of a map: woods and water. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_AREA_H
#define JOLON_SUPERVISOR_GROUND_AREA_H

#include <stdbool.h>
#include <stdint.h>

/* Rings of places, one after the other, of an area and of the holes in it [m]. A point belongs to
 * the area if a line from it crosses an odd number of sides, whichever way the rings go around. */
struct area {
    double (*place)[2]; /* [end[rings - 1]] x to the east, z to the south */
    uint32_t *end;      /* [rings] */
    uint32_t rings;
    uint8_t use;            /* the caller's */
    double low[2], high[2]; /* of all places */
};

/* Adds a ring of three or more places; it need not be closed. Returns false without memory. */
bool area_add_ring(struct area *area, double (*place)[2], uint32_t count);
void area_free(struct area *area);

/* Its size without holes that lie across others [m2]. */
double area_size(const struct area *area);

/* Lines from west to east across an area, from north to south. */
struct area_scan {
    struct area_side *side; /* [sides] by their northern end */
    double *crossing;       /* of the line: x, ascending [m]; the 1st to the 2nd are inside, ... */
    uint32_t *open;         /* [opened] the sides that the line may cross */
    uint32_t sides, next, opened;
};

/* 0; -1: no memory. */
int area_scan_begin(struct area_scan *scan, const struct area *area);

/* Returns the number of crossings of a line, which is even. z_m ascends from call to call. */
uint32_t area_scan_line(struct area_scan *scan, double z_m);
void area_scan_end(struct area_scan *scan);

#endif
