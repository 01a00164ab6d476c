/* Areas and the lines across them. */
#include "supervisor/ground/area.h"

#include "world/maths/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct area_side {
    double low_z, high_z, x, slope; /* x at low_z; [m] of x a metre of z */
};

bool area_add_ring(struct area *area, double (*place)[2], uint32_t count)
{
    uint32_t used = area->rings > 0 ? area->end[area->rings - 1] : 0;
    double(*places)[2] = realloc(area->place, ((size_t)used + count) * sizeof *places);
    if (!places)
        return false;
    area->place = places;
    uint32_t *end = realloc(area->end, (area->rings + 1) * sizeof *end);
    if (!end)
        return false;
    area->end = end;
    for (int k = 0; k < 2 && area->rings == 0; k++) {
        area->low[k] = INFINITY;
        area->high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 2; k++) {
            places[used + i][k] = place[i][k];
            area->low[k] = maths_min(area->low[k], place[i][k]);
            area->high[k] = maths_max(area->high[k], place[i][k]);
        }
    }
    area->end[area->rings++] = used + count;
    return true;
}

void area_free(struct area *area)
{
    free(area->place);
    free(area->end);
    *area = (struct area){0};
}

double area_size(const struct area *area)
{
    double size = 0.0;
    for (uint32_t r = 0, first = 0; r < area->rings; first = area->end[r++]) {
        double ring = 0.0;
        for (uint32_t i = first; i < area->end[r]; i++) {
            const double *a = area->place[i],
                         *b = area->place[i + 1 < area->end[r] ? i + 1 : first];
            ring += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        }
        size += r == 0 ? fabs(ring) : -fabs(ring);
    }
    return maths_max(size, 0.0);
}

static int by_low(const void *left, const void *right)
{
    const struct area_side *a = left, *b = right;
    if (a->low_z != b->low_z)
        return a->low_z < b->low_z ? -1 : 1;
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    return (a->slope > b->slope) - (a->slope < b->slope);
}

int area_scan_begin(struct area_scan *scan, const struct area *area)
{
    uint32_t places = area->rings > 0 ? area->end[area->rings - 1] : 0;
    *scan = (struct area_scan){.side = calloc(places + 1, sizeof *scan->side),
                               .open = calloc(places + 1, sizeof *scan->open),
                               .crossing = calloc(places + 1, sizeof *scan->crossing)};
    if (!scan->side || !scan->open || !scan->crossing) {
        area_scan_end(scan);
        return -1;
    }
    for (uint32_t r = 0, first = 0; r < area->rings; first = area->end[r++]) {
        for (uint32_t i = first; i < area->end[r]; i++) {
            const double *a = area->place[i],
                         *b = area->place[i + 1 < area->end[r] ? i + 1 : first];
            const double *low = a[1] <= b[1] ? a : b, *high = a[1] <= b[1] ? b : a;
            if (low[1] < high[1])
                scan->side[scan->sides++] = (struct area_side){
                    low[1], high[1], low[0], (high[0] - low[0]) / (high[1] - low[1])};
        }
    }
    qsort(scan->side, scan->sides, sizeof *scan->side, by_low);
    return 0;
}

static int ascending(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

uint32_t area_scan_line(struct area_scan *scan, double z_m)
{
    uint32_t kept = 0;
    while (scan->next < scan->sides && scan->side[scan->next].low_z <= z_m)
        scan->open[scan->opened++] = scan->next++;
    /* A side counts from its northern end to just before its southern one. */
    for (uint32_t i = 0; i < scan->opened; i++) {
        const struct area_side *side = &scan->side[scan->open[i]];
        if (side->high_z <= z_m)
            continue;
        scan->crossing[kept] = side->x + (z_m - side->low_z) * side->slope;
        scan->open[kept++] = scan->open[i];
    }
    scan->opened = kept;
    qsort(scan->crossing, kept, sizeof *scan->crossing, ascending);
    return kept & ~1u;
}

void area_scan_end(struct area_scan *scan)
{
    free(scan->side);
    free(scan->open);
    free(scan->crossing);
    *scan = (struct area_scan){0};
}
