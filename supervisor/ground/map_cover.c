/* Cover from areas, and plants in them. */
#include "supervisor/ground/map_cover.h"
#include "supervisor/ground/grown_list.h"

#include "supervisor/ground/free_ground.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"
#include "world/terrain/terrain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SQUARE_M_A_HA  10000.0
#define EDGE_M         2.0 /* plants keep so far from the edge of the square */
#define PLANT_M        2.2 /* radius of the largest tree and its branches near the ground */
#define ROWS_A_CELL    4   /* lines along which the plants of a row of cells stand */
#define CROWDED        4.0 /* so many times the room are planted at most, before some are left out */
#define BUILDING_GAP_M 1.5
#define STEPS_MAX      1e6 /* along a stretch of a river */

/* Coastlines are moved so far [post], so that none has a corner on a row: two stretches would cross
 * the row there at one place, in no order. */
#define OFF_EAST  1.0e-7
#define OFF_NORTH 3.7e-8

enum { DRAW_LINE, DRAW_X, DRAW_RANK, DRAW_KIND, DRAW_SIZE, DRAW_TURN };

/* --- cover -------------------------------------------------------------------------------------*/

/* Whole numbers: rows or columns. */
struct range {
    int32_t first, last;
};

/* Returns those from low to high of 0 .. count - 1. */
static struct range range_of(double low, double high, double count)
{
    return (struct range){(int32_t)maths_clamp(ceil(low), 0.0, count),
                          (int32_t)maths_clamp(floor(high), -1.0, count - 1.0)};
}

typedef void visit_post(void *context, size_t post);

/* Visits the posts within an area. 0; -1: no memory. */
static int visit(const struct area *area, const struct post_grid *grid, visit_post *each,
                 void *context)
{
    struct area_scan scan;
    const struct range rows =
        range_of(area->low[1] / grid->spacing_m, area->high[1] / grid->spacing_m, grid->side);
    if (area_scan_begin(&scan, area) != 0)
        return -1;
    for (int32_t row = rows.first; row <= rows.last; row++) {
        uint32_t count = area_scan_line(&scan, row * grid->spacing_m);
        for (uint32_t i = 0; i < count; i += 2) {
            const struct range columns =
                range_of(scan.crossing[i] / grid->spacing_m, scan.crossing[i + 1] / grid->spacing_m,
                         grid->side);
            for (int32_t column = columns.first; column <= columns.last; column++)
                each(context, (size_t)row * grid->side + (size_t)column);
        }
    }
    area_scan_end(&scan);
    return 0;
}

struct burning {
    float *posts;
    uint8_t *cover;
    float level;
    enum cover becomes;
};

static void find_lowest(void *context, size_t post)
{
    struct burning *b = context;
    b->level = b->posts[post] < b->level ? b->posts[post] : b->level;
}

static void flood(void *context, size_t post)
{
    struct burning *b = context;
    b->posts[post] = b->level;
    b->cover[post] = COVER_LAKE;
}

static void grow(void *context, size_t post)
{
    struct burning *b = context;
    if (!cover_is_water((enum cover)b->cover[post]))
        b->cover[post] = (uint8_t)b->becomes;
}

static void wet(void *context, size_t post)
{
    struct burning *b = context;
    if (b->cover[post] != COVER_SEA)
        b->cover[post] = COVER_LAKE;
}

int map_cover_areas(const struct features *features, const struct post_grid *grid, float *posts,
                    uint8_t *cover)
{
    int result = 0;
    for (uint32_t i = 0; i < features->areas && result == 0; i++) {
        const struct area *area = &features->area[i];
        struct burning b = {posts, cover, INFINITY, COVER_FOREST};
        if (area->use != FEATURE_LAKE)
            continue;
        result = visit(area, grid, find_lowest, &b);
        if (result == 0 && b.level < INFINITY)
            result = visit(area, grid, flood, &b);
    }
    for (uint32_t i = 0; i < features->areas && result == 0; i++) {
        const struct area *area = &features->area[i];
        struct burning b = {posts, cover, 0.0f,
                            area->use == FEATURE_WOOD ? COVER_FOREST : COVER_CHAPARRAL};
        if (area->use == FEATURE_WOOD || area->use == FEATURE_SCRUB)
            result = visit(area, grid, grow, &b);
    }
    return result;
}

/* Wets the posts nearest to a line, and those within half its width. */
static void wet_line(const struct feature_line *line, const struct post_grid *grid,
                     struct burning *b)
{
    double reach = maths_max(0.5 * line->width_m / grid->spacing_m, 0.5);
    for (uint32_t i = 0; i + 1 < line->count; i++) {
        double x = line->place[i][0] / grid->spacing_m, z = line->place[i][1] / grid->spacing_m;
        double dx = line->place[i + 1][0] / grid->spacing_m - x;
        double dz = line->place[i + 1][1] / grid->spacing_m - z;
        /* No square is so large that one of its rivers needs more. */
        uint32_t steps = (uint32_t)maths_min(4.0 * sqrt(dx * dx + dz * dz), STEPS_MAX) + 1;
        for (uint32_t n = 0; n <= steps; n++) {
            double px = x + dx * n / steps, pz = z + dz * n / steps;
            const struct range columns = range_of(px - reach, px + reach, grid->side);
            const struct range rows = range_of(pz - reach, pz + reach, grid->side);
            for (int32_t row = rows.first; row <= rows.last; row++) {
                for (int32_t column = columns.first; column <= columns.last; column++)
                    wet(b, (size_t)row * grid->side + (size_t)column);
            }
        }
    }
}

int map_cover_rivers(const struct features *features, const struct post_grid *grid, uint8_t *cover)
{
    struct burning b = {.cover = cover};
    int result = 0;
    for (uint32_t i = 0; i < features->areas && result == 0; i++) {
        if (features->area[i].use == FEATURE_RIVER)
            result = visit(&features->area[i], grid, wet, &b);
    }
    for (uint32_t i = 0; i < features->lines; i++) {
        if (features->line[i].width_m > 0.0)
            wet_line(&features->line[i], grid, &b);
    }
    return result;
}

/* --- coasts ------------------------------------------------------------------------------------*/

/* Where a coastline crosses a row of posts, or their first column. */
struct crossing {
    uint32_t row; /* in the column: the row that follows */
    double at;    /* along the row or column [post] */
    bool land;    /* lies beyond, to the east or south */
};

struct crossings {
    struct crossing *crossing;
    uint32_t count, room;
    bool no_memory;
};

static void add_crossing(struct crossings *list, struct crossing crossing)
{
    struct crossing *larger =
        grown_list(list->crossing, list->count, &list->room, 4096, sizeof *larger);
    list->no_memory |= !larger;
    if (!larger)
        return;
    list->crossing = larger;
    list->crossing[list->count++] = crossing;
}

/* Adds the crossings of a stretch from a to b [post], which has land on its left. */
static void cross_rows(struct crossings *rows, struct crossings *column, const double a[2],
                       const double b[2], uint32_t side)
{
    const struct range range =
        range_of(maths_min(a[1], b[1]), ceil(maths_max(a[1], b[1])) - 1.0, side);
    for (int32_t row = range.first; row <= range.last; row++) {
        double x = a[0] + (b[0] - a[0]) * (row - a[1]) / (b[1] - a[1]);
        add_crossing(rows, (struct crossing){(uint32_t)row, x, b[1] > a[1]});
    }
    if ((a[0] <= 0.0) != (b[0] <= 0.0)) {
        double z = a[1] + (b[1] - a[1]) * (0.0 - a[0]) / (b[0] - a[0]);
        if (z > 0.0 && z <= side - 1.0)
            add_crossing(column, (struct crossing){(uint32_t)ceil(z), z, b[0] < a[0]});
    }
}

static int by_row(const void *a, const void *b)
{
    const struct crossing *p = a, *q = b;
    if (p->row != q->row)
        return p->row < q->row ? -1 : 1;
    return (p->at > q->at) - (p->at < q->at);
}

/* Notes that two coastlines contradict each other at a place [post]. */
static void tear(struct map_cover_sea *sea, const struct post_grid *grid, double x, double z)
{
    if (sea->torn++ > 0)
        return;
    sea->torn_x = x * grid->spacing_m;
    sea->torn_z = z * grid->spacing_m;
}

/* Finds for each row whether its first post is land, on the way down the first column: from the
 * row's first crossing, or from the crossings of the column since the row before. Rows before the
 * first of them are what it has on its other side. */
static void find_west(const struct crossings *rows, const struct crossings *column,
                      const struct post_grid *grid, uint8_t *west, struct map_cover_sea *sea)
{
    uint32_t at = 0, beyond = 0;
    bool known = false, land = false;
    for (uint32_t row = 0; row < grid->side; row++) {
        for (; beyond < column->count && column->crossing[beyond].row <= row; beyond++) {
            if (known && column->crossing[beyond].land == land)
                tear(sea, grid, 0.0, column->crossing[beyond].at);
            land = column->crossing[beyond].land;
            if (!known)
                memset(west, !land, row);
            known = true;
        }
        if (at < rows->count && rows->crossing[at].row == row) {
            bool before = land;
            land = !rows->crossing[at].land;
            for (; at < rows->count && rows->crossing[at].row == row; at++)
                land = rows->crossing[at].at <= 0.0 ? rows->crossing[at].land : land;
            if (known && land != before)
                tear(sea, grid, 0.0, row);
            if (!known)
                memset(west, land, row);
            known = true;
        }
        west[row] = land;
    }
}

/* Fills a row, of which count crossings are known. */
static void fill_sea(const struct crossing *crossing, uint32_t count, bool land, uint32_t row,
                     const struct post_grid *grid, float *posts, uint8_t *cover,
                     struct map_cover_sea *sea)
{
    uint32_t column = 0;
    for (uint32_t i = 0; i <= count; i++) {
        double end = i < count ? crossing[i].at : (double)grid->side;
        bool torn = i > 0 && i < count && crossing[i].land == land;
        double turn = torn ? 0.5 * (crossing[i - 1].at + crossing[i].at) : end;
        if (torn)
            tear(sea, grid, turn, row);
        for (; column < grid->side && column <= end; column++) {
            size_t post = (size_t)row * grid->side + column;
            if (column > turn ? !land : land)
                continue;
            posts[post] = 0.0f;
            cover[post] = COVER_SEA;
            sea->posts++;
        }
        land = i < count && crossing[i].land;
    }
}

/* Notes the first place of a coastline that lies in the square. */
static void find_coast(const struct feature_line *line, const struct post_grid *grid,
                       struct map_cover_sea *sea)
{
    double side = 2.0 * grid->projection.middle_m;
    for (uint32_t i = 0; i < line->count && !sea->coast; i++) {
        const double *p = line->place[i];
        sea->coast = p[0] >= 0.0 && p[1] >= 0.0 && p[0] <= side && p[1] <= side;
        sea->coast_x = p[0];
        sea->coast_z = p[1];
    }
}

int map_cover_coasts(const struct features *features, const struct post_grid *grid, float *posts,
                     uint8_t *cover, struct map_cover_sea *sea)
{
    struct crossings rows = {0}, column = {0};
    *sea = (struct map_cover_sea){0};
    for (uint32_t i = 0; i < features->lines; i++) {
        const struct feature_line *line = &features->line[i];
        if (line->width_m == 0.0)
            find_coast(line, grid, sea);
        for (uint32_t k = 0; line->width_m == 0.0 && k + 1 < line->count; k++) {
            const double *p = line->place[k], *q = line->place[k + 1];
            const double a[2] = {p[0] / grid->spacing_m + OFF_EAST,
                                 p[1] / grid->spacing_m - OFF_NORTH};
            const double b[2] = {q[0] / grid->spacing_m + OFF_EAST,
                                 q[1] / grid->spacing_m - OFF_NORTH};
            cross_rows(&rows, &column, a, b, grid->side);
        }
    }
    uint8_t *west = calloc(grid->side, 1);
    bool no_memory = rows.no_memory || column.no_memory || !west;
    if (!no_memory && rows.count + column.count > 0) {
        if (rows.count > 0)
            qsort(rows.crossing, rows.count, sizeof *rows.crossing, by_row);
        if (column.count > 0)
            qsort(column.crossing, column.count, sizeof *column.crossing, by_row);
        find_west(&rows, &column, grid, west, sea);
        for (uint32_t row = 0, at = 0; row < grid->side; row++) {
            uint32_t first = at;
            while (at < rows.count && rows.crossing[at].row == row)
                at++;
            const struct crossing *crossing = at > first ? &rows.crossing[first] : NULL;
            bool land = crossing ? !crossing->land : west[row];
            fill_sea(crossing, at - first, land, row, grid, posts, cover, sea);
        }
    }
    free(rows.crossing);
    free(column.crossing);
    free(west);
    return no_memory ? -1 : 0;
}

/* --- plants ------------------------------------------------------------------------------------*/

struct plant {
    struct ground_object object;
    uint64_t rank; /* the lower ones are kept; 0: it stands in a map */
};

struct planting {
    const struct post_grid *grid;
    const struct terrain *terrain;
    struct free_ground *free;
    struct plant *plant;
    uint32_t used, room;
    double cell_m;
    uint64_t seed;
};

static bool add_plant(struct planting *p, const struct plant *plant)
{
    struct plant *larger = grown_list(p->plant, p->used, &p->room, 4096, sizeof *larger);
    if (!larger)
        return false;
    p->plant = larger;
    p->plant[p->used++] = *plant;
    return true;
}

static uint64_t draw(const struct planting *p, uint64_t cell, int what)
{
    return random_u64(p->seed, cell, (uint64_t)what, RANDOM_FOREST);
}

static double share(uint64_t drawn)
{
    return (double)(drawn >> 11) * 0x1.0p-53;
}

/* Plants the cell if its plant stands on this line and between these crossings. */
static bool plant_cell(struct planting *p, enum feature_use use, double column, double z,
                       uint64_t cell, const double crossing[2])
{
    double x = (column + share(draw(p, cell, DRAW_X))) * p->cell_m;
    double side = 2.0 * p->grid->projection.middle_m;
    if (!(x > crossing[0] && x < crossing[1] && x > EDGE_M && z > EDGE_M && x < side - EDGE_M &&
          z < side - EDGE_M) ||
        cover_is_water(terrain_cover(p->terrain, x, z)) || !free_ground_is(p->free, x, z, PLANT_M))
        return true;
    double pines = maths_clamp(0.15 + terrain_base_height(p->terrain, x, z) / 1600.0, 0.15, 0.85);
    bool pine = share(draw(p, cell, DRAW_KIND)) < pines;
    struct plant plant = {{(int32_t)(x * 1000.0), (int32_t)(z * 1000.0),
                           (uint8_t)(use == FEATURE_SCRUB ? GROUND_BUSH
                                     : pine               ? GROUND_PINE
                                                          : GROUND_TREE),
                           (uint8_t)(80 + draw(p, cell, DRAW_SIZE) % 41),
                           (uint16_t)draw(p, cell, DRAW_TURN)},
                          draw(p, cell, DRAW_RANK) | 1u};
    return add_plant(p, &plant);
}

static bool plant_line(struct planting *p, const struct area *area, struct area_scan *scan,
                       int32_t row, int line)
{
    double z = (row + (line + 0.5) / ROWS_A_CELL) * p->cell_m;
    double cells = floor(2.0 * p->grid->projection.middle_m / p->cell_m) + 1.0;
    uint32_t count = area_scan_line(scan, z);
    bool good = true;
    for (uint32_t i = 0; i < count && good; i += 2) {
        const struct range columns = range_of(floor(scan->crossing[i] / p->cell_m),
                                              scan->crossing[i + 1] / p->cell_m, cells);
        for (int32_t column = columns.first; column <= columns.last && good; column++) {
            uint64_t cell = (uint64_t)(uint32_t)row << 32 | (uint32_t)column;
            if (draw(p, cell, DRAW_LINE) % ROWS_A_CELL == (uint64_t)line)
                good =
                    plant_cell(p, (enum feature_use)area->use, column, z, cell, &scan->crossing[i]);
        }
    }
    return good;
}

static int plant_area(struct planting *p, const struct area *area)
{
    struct area_scan scan;
    double cells = floor(2.0 * p->grid->projection.middle_m / p->cell_m) + 1.0;
    const struct range rows =
        range_of(floor(area->low[1] / p->cell_m), area->high[1] / p->cell_m, cells);
    if (area_scan_begin(&scan, area) != 0)
        return -1;
    bool good = true;
    for (int32_t row = rows.first; row <= rows.last && good; row++) {
        for (int line = 0; line < ROWS_A_CELL && good; line++)
            good = plant_line(p, area, &scan, row, line);
    }
    area_scan_end(&scan);
    return good ? 0 : -1;
}

static int by_place(const void *left, const void *right)
{
    const struct plant *p = left, *q = right;
    const struct ground_object *a = &p->object, *b = &q->object;
    if (a->x_mm != b->x_mm)
        return a->x_mm < b->x_mm ? -1 : 1;
    if (a->z_mm != b->z_mm)
        return a->z_mm < b->z_mm ? -1 : 1;
    if (p->rank != q->rank)
        return p->rank < q->rank ? -1 : 1;
    /* Of two at one place the tower counts, and then the larger. */
    if (a->type != b->type)
        return a->type > b->type ? -1 : 1;
    if (a->size_percent != b->size_percent)
        return a->size_percent > b->size_percent ? -1 : 1;
    return (a->turn < b->turn) - (a->turn > b->turn);
}

static int by_rank(const void *left, const void *right)
{
    const struct plant *p = left, *q = right;
    if (p->rank != q->rank)
        return p->rank < q->rank ? -1 : 1;
    return by_place(left, right);
}

/* Removes plants at the place of another, and those beyond the room. */
static void choose(struct planting *p, uint32_t room, uint32_t *left_out)
{
    uint32_t kept = 0;
    if (p->used > 0)
        qsort(p->plant, p->used, sizeof *p->plant, by_place);
    for (uint32_t i = 0; i < p->used; i++) {
        const struct ground_object *last = kept > 0 ? &p->plant[kept - 1].object : NULL;
        const struct ground_object *own = &p->plant[i].object;
        if (!last || last->x_mm != own->x_mm || last->z_mm != own->z_mm)
            p->plant[kept++] = p->plant[i];
    }
    *left_out = kept > room ? kept - room : 0;
    p->used = kept - *left_out;
    if (*left_out == 0)
        return;
    qsort(p->plant, kept, sizeof *p->plant, by_rank);
    qsort(p->plant, p->used, sizeof *p->plant, by_place);
}

static struct free_ground *find_free(const struct features *features, double side_m,
                                     const struct ground_road_point *roads, uint32_t road_points)
{
    const struct buildings *b = &features->buildings;
    double(*disc)[3] = calloc(b->count + 1, sizeof *disc);
    struct free_ground *found = NULL;
    uint32_t at = 0, part = 0;
    for (uint32_t i = 0; i < b->count && disc; i++) {
        double reach = 0.0;
        for (part += b->made[i].parts; at < b->corners && b->corner[at].part < part; at++)
            reach = maths_max(reach, sqrt((double)b->corner[at].x_mm * b->corner[at].x_mm +
                                          (double)b->corner[at].z_mm * b->corner[at].z_mm));
        disc[i][0] = b->made[i].x_mm / 1000.0;
        disc[i][1] = b->made[i].z_mm / 1000.0;
        disc[i][2] = reach / 1000.0 + BUILDING_GAP_M;
    }
    if (disc)
        found = free_ground_make(side_m, roads, road_points, disc, b->count);
    free(disc);
    return found;
}

/* Returns how many plants a hectare has. Far more than there is room for are not planted first. */
static double density_of(const struct features *features, double side_m, double per_ha,
                         uint32_t room)
{
    double hectares = 0.0;
    for (uint32_t i = 0; i < features->areas; i++) {
        const struct area *area = &features->area[i];
        if (area->use == FEATURE_WOOD || area->use == FEATURE_SCRUB)
            hectares += maths_min(area_size(area), side_m * side_m) / SQUARE_M_A_HA;
    }
    double most = hectares > 0.0 ? CROWDED * room / hectares : per_ha;
    return maths_min(per_ha, most);
}

static int plant_all(struct planting *p, const struct features *features)
{
    int result = 0;
    for (uint32_t i = 0; i < features->objects && result == 0; i++) {
        const struct plant plant = {features->object[i], 0};
        result = add_plant(p, &plant) ? 0 : -1;
    }
    for (uint32_t i = 0; i < features->areas && result == 0; i++) {
        uint8_t use = features->area[i].use;
        if ((use == FEATURE_WOOD || use == FEATURE_SCRUB) && p->cell_m > 0.0)
            result = plant_area(p, &features->area[i]);
    }
    return result;
}

int map_cover_plant(struct map_cover_plants *plants, const struct features *features,
                    const struct post_grid *grid, const struct terrain *terrain,
                    const struct ground_road_point *roads, uint32_t road_points, double per_ha,
                    uint64_t seed)
{
    double side = 2.0 * grid->projection.middle_m;
    uint32_t room = GROUND_OBJECTS_MAX - features->buildings.count;
    *plants = (struct map_cover_plants){.planted_per_ha = density_of(features, side, per_ha, room)};
    struct planting p = {
        .grid = grid,
        .terrain = terrain,
        .free = find_free(features, side, roads, road_points),
        .cell_m = plants->planted_per_ha > 0.0 ? sqrt(SQUARE_M_A_HA / plants->planted_per_ha) : 0.0,
        .seed = seed};
    int result = p.free ? plant_all(&p, features) : -1;
    if (result == 0) {
        choose(&p, room, &plants->left_out);
        plants->object = calloc(p.used + 1, sizeof *plants->object);
        result = plants->object ? 0 : -1;
    }
    for (uint32_t i = 0; i < p.used && result == 0; i++)
        plants->object[plants->count++] = p.plant[i].object;
    free_ground_free(p.free);
    free(p.plant);
    return result;
}

void map_cover_free(struct map_cover_plants *plants)
{
    free(plants->object);
    *plants = (struct map_cover_plants){0};
}
