/* From parts of outlines to buildings of a ground file. */
#include "supervisor/ground/buildings.h"
#include "supervisor/ground/grown_list.h"

#include "world/maths/maths.h"
#include "world/terrain/ground_file.h"
#include "world/terrain/terrain.h"

#include <stdlib.h>
#include <string.h>

#define FOOT_M     0.5  /* walls reach so far into the ground */
#define RIDGE_WIDE 18.0 /* [m] wider buildings have flat roofs */
#define SQUARE     0.15 /* tangent: so far sides may be off a right angle under a ridge */

struct building_draft {
    struct ground_building building; /* heights over the ground at its corners */
    struct ground_corner *corner;    /* its own */
    uint32_t corners;
    double area_m2;
};

/* Returns true if a part has four corners at nearly right angles, as a house with a ridge. */
static bool is_house(const struct convex_parts_ring *part)
{
    for (uint32_t i = 0; i < 4 && part->count == 4; i++) {
        const int32_t *a = part->corner[i], *b = part->corner[(i + 1) % 4],
                      *c = part->corner[(i + 2) % 4];
        double ux = (double)b[0] - a[0], uz = (double)b[1] - a[1];
        double vx = (double)c[0] - b[0], vz = (double)c[1] - b[1];
        if (fabs(ux * vx + uz * vz) > SQUARE * fabs(ux * vz - uz * vx))
            return false;
    }
    return part->count == 4;
}

/* Makes corners relative to the middle. */
static uint32_t put_part(struct building_draft *draft, const struct convex_parts_ring *part,
                         uint32_t number)
{
    for (uint32_t i = 0; i < part->count; i++)
        draft->corner[draft->corners + i] =
            (struct ground_corner){part->corner[i][0] - draft->building.x_mm,
                                   part->corner[i][1] - draft->building.z_mm, number};
    return part->count;
}

/* Returns true if a corner is too far from the middle of the draft. */
static bool is_too_large(const struct building_draft *draft, int32_t (*corner)[2], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (llabs((long long)corner[i][0] - draft->building.x_mm) > GROUND_BUILDING_REACH_MM ||
            llabs((long long)corner[i][1] - draft->building.z_mm) > GROUND_BUILDING_REACH_MM)
            return true;
    }
    return false;
}

/* Fills the draft from count parts. Returns false if they are too narrow, too far from each other
 * or not within the square. */
static bool fill(struct buildings *b, struct building_draft *draft,
                 const struct convex_parts_ring *part, uint32_t count, double side_m,
                 int32_t (*all)[2])
{
    uint32_t corners = 0;
    struct convex_parts_box box;
    for (uint32_t i = 0; i < count; i++) {
        memcpy(all + corners, part[i].corner, part[i].count * sizeof *all);
        corners += part[i].count;
    }
    for (uint32_t i = 0; i < corners; i++) {
        if (all[i][0] < 0 || all[i][1] < 0 || all[i][0] > side_m * 1000.0 ||
            all[i][1] > side_m * 1000.0)
            return false;
    }
    if (!convex_parts_box_of(&box, all, corners))
        return false;
    draft->building.x_mm = (int32_t)floor(box.x_mm + 0.5);
    draft->building.z_mm = (int32_t)floor(box.z_mm + 0.5);
    draft->building.turn = box.turn;
    draft->building.parts = 0;
    if (is_too_large(draft, all, corners))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t more = put_part(draft, &part[i], draft->building.parts);
        if (!ground_file_part_fits(draft->corner + draft->corners, more)) {
            b->lost_m2 += convex_parts_ring_area(&part[i]);
            continue;
        }
        draft->corners += more;
        draft->building.parts++;
        draft->area_m2 += convex_parts_ring_area(&part[i]);
    }
    bool ridge = draft->building.parts == 1 && count == 1 && is_house(part) &&
                 2.0 * box.half_width_mm <= RIDGE_WIDE * 1000.0;
    if (!ridge)
        draft->building.top_mm = draft->building.eaves_mm;
    return draft->building.parts > 0;
}

static int add_one(struct buildings *b, const struct convex_parts_ring *part, uint32_t count,
                   double height_m, double rise_m, double side_m)
{
    uint32_t corners = 0;
    for (uint32_t i = 0; i < count; i++)
        corners += part[i].count;
    struct building_draft *drafts = grown_list(b->draft, b->used, &b->room, 1024, sizeof *drafts);
    if (!drafts)
        return -1;
    b->draft = drafts;
    struct building_draft *draft = &b->draft[b->used];
    int32_t(*all)[2] = calloc(corners, sizeof *all);
    *draft = (struct building_draft){.corner = calloc(corners, sizeof *draft->corner)};
    draft->building.eaves_mm = (int32_t)(height_m * 1000.0);
    draft->building.top_mm = (int32_t)((height_m + rise_m) * 1000.0);
    int result = !all || !draft->corner ? -1 : fill(b, draft, part, count, side_m, all);
    if (result == 1)
        b->used++;
    else
        free(draft->corner);
    free(all);
    return result;
}

int buildings_add(struct buildings *buildings, const struct convex_parts *parts, double height_m,
                  double rise_m, double side_m)
{
    int added = 0;
    if (parts->area_m2 < BUILDINGS_LEAST_M2)
        return 0;
    for (uint32_t i = 0; i < parts->count; i += GROUND_BUILDING_PARTS_MAX) {
        uint32_t count = parts->count - i;
        count = count < GROUND_BUILDING_PARTS_MAX ? count : GROUND_BUILDING_PARTS_MAX;
        int result = add_one(buildings, parts->part + i, count, height_m, rise_m, side_m);
        if (result < 0)
            return -1;
        added += result;
    }
    if (added > 0)
        buildings->area_m2 += parts->area_m2;
    return added;
}

static int by_place(const void *left, const void *right)
{
    const struct building_draft *p = left, *q = right;
    const struct ground_building *a = &p->building, *b = &q->building;
    if (a->x_mm != b->x_mm)
        return a->x_mm < b->x_mm ? -1 : 1;
    if (a->z_mm != b->z_mm)
        return a->z_mm < b->z_mm ? -1 : 1;
    /* The one with a courtyard, if one map has the outline without it, too. */
    if (p->corners != q->corners)
        return p->corners > q->corners ? -1 : 1;
    if (a->eaves_mm != b->eaves_mm)
        return a->eaves_mm > b->eaves_mm ? -1 : 1;
    return memcmp(p->corner, q->corner, p->corners * sizeof *p->corner);
}

static int by_size(const void *left, const void *right)
{
    const struct building_draft *p = left, *q = right;
    if (p->area_m2 != q->area_m2)
        return p->area_m2 > q->area_m2 ? -1 : 1;
    return by_place(left, right);
}

/* Removes buildings at the place of another, and the smallest beyond the limit. */
static void choose(struct buildings *b)
{
    uint32_t kept = 0;
    if (b->used > 0)
        qsort(b->draft, b->used, sizeof *b->draft, by_place);
    for (uint32_t i = 0; i < b->used; i++) {
        const struct ground_building *last = kept > 0 ? &b->draft[kept - 1].building : NULL;
        const struct ground_building *own = &b->draft[i].building;
        if (last && last->x_mm == own->x_mm && last->z_mm == own->z_mm)
            free(b->draft[i].corner);
        else
            b->draft[kept++] = b->draft[i];
    }
    b->used = kept;
    if (kept <= GROUND_BUILDINGS_MAX)
        return;
    qsort(b->draft, kept, sizeof *b->draft, by_size);
    for (uint32_t i = GROUND_BUILDINGS_MAX; i < kept; i++)
        free(b->draft[i].corner);
    b->left_out = kept - GROUND_BUILDINGS_MAX;
    b->used = GROUND_BUILDINGS_MAX;
    qsort(b->draft, b->used, sizeof *b->draft, by_place);
}

static void stand(struct building_draft *draft, const struct terrain *terrain)
{
    struct ground_building *b = &draft->building;
    double x = b->x_mm / 1000.0, z = b->z_mm / 1000.0;
    double middle = terrain_base_height(terrain, x, z), low = 0.0, high = 0.0;
    for (uint32_t i = 0; i < draft->corners; i++) {
        double here = terrain_base_height(terrain, x + draft->corner[i].x_mm / 1000.0,
                                          z + draft->corner[i].z_mm / 1000.0);
        low = maths_min(low, here - middle);
        high = maths_max(high, here - middle);
    }
    int32_t lift_mm = (int32_t)ceil(high * 1000.0);
    b->foot_mm = (int32_t)floor((low - FOOT_M) * 1000.0);
    b->foot_mm = b->foot_mm < GROUND_BUILDING_FOOT_MM ? GROUND_BUILDING_FOOT_MM : b->foot_mm;
    b->eaves_mm += lift_mm;
    b->top_mm += lift_mm;
    if (b->top_mm > GROUND_BUILDING_TOP_MM)
        b->eaves_mm = b->top_mm = GROUND_BUILDING_TOP_MM;
}

int buildings_found(struct buildings *b, const struct terrain *terrain)
{
    uint32_t corners = 0, part = 0;
    choose(b);
    for (uint32_t i = 0; i < b->used; i++)
        corners += b->draft[i].corners;
    b->made = calloc(b->used + 1, sizeof *b->made);
    b->corner = calloc(corners + 1, sizeof *b->corner);
    if (!b->made || !b->corner)
        return -1;
    for (uint32_t i = 0; i < b->used; i++) {
        struct building_draft *draft = &b->draft[i];
        stand(draft, terrain);
        for (uint32_t k = 0; k < draft->corners; k++) {
            b->corner[b->corners] = draft->corner[k];
            b->corner[b->corners++].part += part;
        }
        part += draft->building.parts;
        b->made[b->count++] = draft->building;
    }
    return 0;
}

void buildings_free(struct buildings *b)
{
    for (uint32_t i = 0; i < b->used; i++)
        free(b->draft[i].corner);
    free(b->draft);
    free(b->made);
    free(b->corner);
    *b = (struct buildings){0};
}
