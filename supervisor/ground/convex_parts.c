/* Ear clipping, then joining of triangles while the joined part stays convex (Hertel and Mehlhorn
 * 1983). */
#include "supervisor/ground/convex_parts.h"

#include "world/maths/maths.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef int32_t corner[2];

/* Twice the area of a triangle; positive: clockwise on a map whose z goes down. */
static int64_t turn_of(const corner a, const corner b, const corner c)
{
    return ((int64_t)b[0] - a[0]) * ((int64_t)c[1] - a[1]) -
           ((int64_t)b[1] - a[1]) * ((int64_t)c[0] - a[0]);
}

static bool same(const corner a, const corner b)
{
    return a[0] == b[0] && a[1] == b[1];
}

static int64_t twice_area(const struct convex_parts_ring *ring)
{
    int64_t area = 0;
    for (uint32_t i = 2; i < ring->count; i++)
        area += turn_of(ring->corner[0], ring->corner[i - 1], ring->corner[i]);
    return area;
}

double convex_parts_ring_area(const struct convex_parts_ring *ring)
{
    return (double)twice_area(ring) / 2e6;
}

/* Removes corners that repeat the one before or lie on a straight line or a spike. */
static void clean(struct convex_parts_ring *ring)
{
    bool changed = true;
    while (changed && ring->count >= 3) {
        uint32_t kept = 0, count = ring->count;
        changed = false;
        for (uint32_t i = 0; i < count; i++) {
            const int32_t *before = ring->corner[kept > 0 ? kept - 1 : count - 1];
            const int32_t *after = ring->corner[i + 1 < count ? i + 1 : 0];
            if (kept == 0 && i > 0)
                before = ring->corner[count - 1];
            if (same(before, ring->corner[i]) || turn_of(before, ring->corner[i], after) == 0) {
                changed = true;
                continue;
            }
            memmove(ring->corner[kept++], ring->corner[i], sizeof(corner));
        }
        ring->count = kept;
    }
    if (ring->count < 3)
        ring->count = 0;
}

static void reverse(struct convex_parts_ring *ring)
{
    for (uint32_t i = 0, k = ring->count; i + 1 < k; i++) {
        corner kept;
        memcpy(kept, ring->corner[i], sizeof kept);
        memcpy(ring->corner[i], ring->corner[--k], sizeof kept);
        memcpy(ring->corner[k], kept, sizeof kept);
    }
}

static int sign_of(int64_t value)
{
    return (value > 0) - (value < 0);
}

/* Returns true if the segments a b and c d have a point in common that is not an end of both. */
static bool crosses(const corner a, const corner b, const corner c, const corner d)
{
    if (same(a, c) || same(a, d) || same(b, c) || same(b, d))
        return false;
    int p = sign_of(turn_of(a, b, c)), q = sign_of(turn_of(a, b, d));
    int r = sign_of(turn_of(c, d, a)), s = sign_of(turn_of(c, d, b));
    if (p == 0 && q == 0) { /* on one line: do they overlap? */
        int k = a[0] != b[0] ? 0 : 1;
        int32_t low = a[k] < b[k] ? a[k] : b[k], high = a[k] < b[k] ? b[k] : a[k];
        return !((c[k] < low && d[k] < low) || (c[k] > high && d[k] > high));
    }
    return p * q <= 0 && r * s <= 0;
}

static bool crosses_ring(const corner a, const corner b, const struct convex_parts_ring *ring)
{
    for (uint32_t i = 0; i < ring->count; i++) {
        if (crosses(a, b, ring->corner[i], ring->corner[(i + 1) % ring->count]))
            return true;
    }
    return false;
}

/* Returns true if an outline or a courtyard crosses itself or another. */
static bool is_tangled(const struct convex_parts_ring *ring, uint32_t rings)
{
    for (uint32_t r = 0; r < rings; r++) {
        for (uint32_t i = 0; i < ring[r].count; i++) {
            const int32_t *a = ring[r].corner[i], *b = ring[r].corner[(i + 1) % ring[r].count];
            for (uint32_t q = r; q < rings; q++) {
                if (crosses_ring(a, b, &ring[q]))
                    return true;
            }
        }
    }
    return false;
}

/* Joins a courtyard to the outline by a bridge between their two nearest corners that see each
 * other. Returns false if there are none. outline has room for both and two more corners. */
static bool bridge(struct convex_parts_ring *outline, const struct convex_parts_ring *hole,
                   const struct convex_parts_ring *others, uint32_t other_count)
{
    double least = INFINITY;
    uint32_t from = 0, to = 0;
    for (uint32_t i = 0; i < outline->count; i++) {
        for (uint32_t k = 0; k < hole->count; k++) {
            const int32_t *a = outline->corner[i], *b = hole->corner[k];
            double x = (double)b[0] - a[0], z = (double)b[1] - a[1], square = x * x + z * z;
            bool clear = square < least && square > 0.0 && !crosses_ring(a, b, outline) &&
                         !crosses_ring(a, b, hole);
            for (uint32_t n = 0; n < other_count && clear; n++)
                clear = !crosses_ring(a, b, &others[n]);
            if (clear) {
                least = square;
                from = i;
                to = k;
            }
        }
    }
    if (least == INFINITY)
        return false;
    uint32_t more = hole->count + 2;
    memmove(outline->corner[from + 1 + more], outline->corner[from + 1],
            (outline->count - from - 1) * sizeof(corner));
    for (uint32_t k = 0; k <= hole->count; k++) {
        uint32_t at = to + k < hole->count ? to + k : to + k - hole->count;
        memcpy(outline->corner[from + 1 + k], hole->corner[at], sizeof(corner));
    }
    memcpy(outline->corner[from + more], outline->corner[from], sizeof(corner));
    outline->count += more;
    return true;
}

/* Returns true if the corner i can be cut off: no other corner lies in its triangle. */
static bool is_ear(const struct convex_parts_ring *ring, uint32_t i)
{
    uint32_t count = ring->count;
    const int32_t *a = ring->corner[(i + count - 1) % count], *b = ring->corner[i],
                  *c = ring->corner[(i + 1) % count];
    if (turn_of(a, b, c) <= 0)
        return false;
    for (uint32_t k = 0; k < count; k++) {
        const int32_t *p = ring->corner[k];
        if (!same(p, a) && !same(p, b) && !same(p, c) && turn_of(a, b, p) >= 0 &&
            turn_of(b, c, p) >= 0 && turn_of(c, a, p) >= 0)
            return false;
    }
    return true;
}

static bool add_part(struct convex_parts *parts, corner *corners, uint32_t count)
{
    struct convex_parts_ring *part = &parts->part[parts->count];
    /* Two parts that are joined have the corners of both. */
    part->corner = calloc(2 * (size_t)GROUND_PART_CORNERS_MAX + count, sizeof(corner));
    if (!part->corner)
        return false;
    part->count = count;
    memcpy(part->corner, corners, count * sizeof(corner));
    parts->count++;
    return true;
}

static enum convex_parts_result clip_ears(struct convex_parts *parts,
                                          struct convex_parts_ring *ring)
{
    while (ring->count >= 3) {
        uint32_t i = 0;
        while (i < ring->count && !is_ear(ring, i))
            i++;
        if (i == ring->count)
            return CONVEX_PARTS_TANGLED;
        corner triangle[3];
        memcpy(triangle[0], ring->corner[(i + ring->count - 1) % ring->count], sizeof(corner));
        memcpy(triangle[1], ring->corner[i], sizeof(corner));
        memcpy(triangle[2], ring->corner[(i + 1) % ring->count], sizeof(corner));
        if (!add_part(parts, triangle, 3))
            return CONVEX_PARTS_NO_MEMORY;
        memmove(ring->corner[i], ring->corner[i + 1], (ring->count - i - 1) * sizeof(corner));
        ring->count--;
        clean(ring);
    }
    return CONVEX_PARTS_GOOD;
}

static bool is_convex(const struct convex_parts_ring *ring)
{
    for (uint32_t i = 0; i < ring->count; i++) {
        if (turn_of(ring->corner[i], ring->corner[(i + 1) % ring->count],
                    ring->corner[(i + 2) % ring->count]) <= 0)
            return false;
    }
    return ring->count >= 3;
}

/* Joins q to p at the side from corner i of p to the next, which q has the other way around from
 * its corner k. Returns false, with p as it was, if they are not convex together. */
static bool join_at(struct convex_parts_ring *p, const struct convex_parts_ring *q, uint32_t i,
                    uint32_t k)
{
    corner joined[2 * GROUND_PART_CORNERS_MAX];
    struct convex_parts_ring both = {joined, 0};
    for (uint32_t n = 1; n <= p->count; n++)
        memcpy(joined[both.count++], p->corner[(i + n) % p->count], sizeof(corner));
    for (uint32_t n = 2; n < q->count; n++)
        memcpy(joined[both.count++], q->corner[(k + n) % q->count], sizeof(corner));
    int64_t area = twice_area(p) + twice_area(q);
    clean(&both);
    if (both.count > GROUND_PART_CORNERS_MAX || !is_convex(&both) || twice_area(&both) != area)
        return false;
    memcpy(p->corner, joined, both.count * sizeof(corner));
    p->count = both.count;
    return true;
}

static bool join(struct convex_parts_ring *p, const struct convex_parts_ring *q)
{
    for (uint32_t i = 0; i < p->count; i++) {
        for (uint32_t k = 0; k < q->count; k++) {
            if (same(p->corner[i], q->corner[(k + 1) % q->count]) &&
                same(p->corner[(i + 1) % p->count], q->corner[k]))
                return join_at(p, q, i, k);
        }
    }
    return false;
}

static void join_all(struct convex_parts *parts)
{
    for (uint32_t i = 0; i < parts->count; i++) {
        for (uint32_t k = i + 1; k < parts->count; k++) {
            if (!join(&parts->part[i], &parts->part[k]))
                continue;
            free(parts->part[k].corner);
            memmove(&parts->part[k], &parts->part[k + 1],
                    (parts->count - k - 1) * sizeof *parts->part);
            parts->count--;
            k = i; /* the larger part may reach others */
        }
    }
}

/* Returns true if all of q lies on the outer side of a side of p. */
static bool lies_beyond(const struct convex_parts_ring *p, const struct convex_parts_ring *q)
{
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t k = 0;
        while (k < q->count &&
               turn_of(p->corner[i], p->corner[(i + 1) % p->count], q->corner[k]) <= 0)
            k++;
        if (k == q->count)
            return true;
    }
    return false;
}

static bool overlap(const struct convex_parts *parts)
{
    for (uint32_t i = 0; i < parts->count; i++) {
        for (uint32_t k = i + 1; k < parts->count; k++) {
            if (!lies_beyond(&parts->part[i], &parts->part[k]) &&
                !lies_beyond(&parts->part[k], &parts->part[i]))
                return true;
        }
    }
    return false;
}

/* Joins the courtyards to the outline, and splits it. room: corners that outline->corner holds. */
static enum convex_parts_result split(struct convex_parts *parts, struct convex_parts_ring *outline,
                                      const struct convex_parts_ring *holes, uint32_t hole_count)
{
    for (uint32_t i = 0; i < hole_count; i++) {
        if (holes[i].count > 0 && !bridge(outline, &holes[i], holes + i + 1, hole_count - i - 1))
            return CONVEX_PARTS_TANGLED;
    }
    parts->area_m2 = convex_parts_ring_area(outline);
    enum convex_parts_result result = clip_ears(parts, outline);
    if (result != CONVEX_PARTS_GOOD)
        return result;
    join_all(parts);
    return overlap(parts) ? CONVEX_PARTS_TANGLED : CONVEX_PARTS_GOOD;
}

enum convex_parts_result convex_parts_split(struct convex_parts *parts,
                                            struct convex_parts_ring *ring, uint32_t rings)
{
    uint32_t all = 0;
    *parts = (struct convex_parts){0};
    for (uint32_t i = 0; i < rings; i++) {
        clean(&ring[i]);
        int64_t area = twice_area(&ring[i]);
        if ((area < 0) == (i == 0))
            reverse(&ring[i]);
        all += ring[i].count + 2;
    }
    if (rings == 0 || ring[0].count == 0)
        return CONVEX_PARTS_EMPTY;
    if (all > CONVEX_PARTS_CORNERS_MAX || is_tangled(ring, rings))
        return CONVEX_PARTS_TANGLED;
    struct convex_parts_ring outline = {calloc(all, sizeof(corner)), ring[0].count};
    parts->part = calloc(all, sizeof *parts->part);
    enum convex_parts_result result = CONVEX_PARTS_NO_MEMORY;
    if (outline.corner && parts->part) {
        memcpy(outline.corner, ring[0].corner, ring[0].count * sizeof(corner));
        result = split(parts, &outline, ring + 1, rings - 1);
    }
    free(outline.corner);
    return result;
}

void convex_parts_free(struct convex_parts *parts)
{
    for (uint32_t i = 0; i < parts->count; i++)
        free(parts->part[i].corner);
    free(parts->part);
    *parts = (struct convex_parts){0};
}

/* Sets the box whose length or width has this direction, if it is smaller. */
static void try_direction(struct convex_parts_box *box, double *least, double x, double z,
                          corner *corners, uint32_t count)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        const double off[2] = {corners[i][0] * x + corners[i][1] * z,
                               corners[i][1] * x - corners[i][0] * z};
        for (int k = 0; k < 2; k++) {
            low[k] = maths_min(low[k], off[k]);
            high[k] = maths_max(high[k], off[k]);
        }
    }
    double length = high[0] - low[0], width = high[1] - low[1];
    double along = 0.5 * (low[0] + high[0]), across = 0.5 * (low[1] + high[1]);
    if (length < width || length * width >= *least)
        return;
    *least = length * width;
    *box = (struct convex_parts_box){.x_mm = along * x - across * z,
                                     .z_mm = along * z + across * x,
                                     .half_length_mm = 0.5 * length,
                                     .half_width_mm = 0.5 * width,
                                     .along_x = x,
                                     .along_z = z};
}

bool convex_parts_box_of(struct convex_parts_box *box, int32_t (*corners)[2], uint32_t count)
{
    double least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t next = (i + 1) % count;
        double x = (double)corners[next][0] - corners[i][0];
        double z = (double)corners[next][1] - corners[i][1], length = sqrt(x * x + z * z);
        if (length == 0.0)
            continue;
        try_direction(box, &least, x / length, z / length, corners, count);
        try_direction(box, &least, -z / length, x / length, corners, count);
    }
    if (least == INFINITY || box->half_width_mm <= 0.0)
        return false;
    double heading = maths_wrap_turn(maths_heading(box->along_x, box->along_z));
    box->turn = (uint16_t)(uint32_t)(heading * (65536.0 / TWO_PI) + 0.5);
    return true;
}
