/* Lines of maps become roads. */
#include "supervisor/ground/road_map.h"
#include "supervisor/ground/grown_list.h"

#include "supervisor/ground/vector_map.h"
#include "world/maths/maths.h"
#include "world/terrain/ground_tile.h"
#include "world/terrain/terrain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIMPLIFY_M 2.0

/* Roads keep so far from the edge of the square, which ends the world. */
#define EDGE_M 1.0

/* A post's cover is as wide as the posts' spacing; wider spaced ones show no roads. */
#define PAVE_SPACING_M 40.0
#define PAVE_HALF_M    20.0

/* Half of the width of a road over water: the cover of a place is that of the nearest post, up to
 * 0.71 of their distance away, and so much is dry beside the middle of the road. */
#define DAM_POSTS 0.75
#define DAM_M     8.0
#define DAM_GRADE 0.15 /* a truck drives up and down it */

/* OpenStreetMap's words, the more important first. */
static const char *const words[] = {
    "motorway",     "motorway_link", "trunk",       "trunk_link",     "primary",
    "primary_link", "secondary",     "tertiary",    "secondary_link", "tertiary_link",
    "unclassified", "residential",   "road",        "living_street",  "service",
    "track",        "track_grade1",  "track_grade2"};
#define WORDS (sizeof words / sizeof words[0])

struct line {
    struct ground_road_point *points; /* [count] of its own */
    uint32_t count, rank;
    double length_m;
};

struct reading {
    const struct post_grid *grid;
    struct line *lines;
    uint32_t used, room;
    struct vector_map_track track; /* of the line that is read */
    struct road_map *map;
    bool no_memory;
};

static double between(const double a[2], const double b[2])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
}

/* Distance of p from the segment a b. */
static double off(const double p[2], const double a[2], const double b[2])
{
    double dx = b[0] - a[0], dz = b[1] - a[1], square = dx * dx + dz * dz;
    double share = square > 0.0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dz) / square : 0.0;
    share = maths_clamp(share, 0.0, 1.0);
    const double foot[2] = {a[0] + dx * share, a[1] + dz * share};
    return between(p, foot);
}

/* Keeps of track[0..count - 1] the points that are needed to stay within SIMPLIFY_M of it: from
 * each kept point it reaches as far as it can. Returns their number. */
static uint32_t simplify(double (*track)[2], uint32_t count)
{
    uint32_t kept = 1, from = 0;
    while (from + 1 < count) {
        uint32_t to = from + 1;
        bool good = true;
        while (good && to + 1 < count && to - from < 200) {
            for (uint32_t i = from + 1; i <= to && good; i++)
                good = off(track[i], track[from], track[to + 1]) <= SIMPLIFY_M;
            to += good;
        }
        from = to;
        /* What is kept never passes what is read. */
        track[kept][0] = track[to][0];
        track[kept++][1] = track[to][1];
    }
    return kept;
}

/* Adds the points of one stretch within the square as a line. */
static void add_line(struct reading *r, double (*track)[2], uint32_t count, uint32_t rank)
{
    double length = 0.0;
    struct line *lines = grown_list(r->lines, r->used, &r->room, 1024, sizeof *lines);
    r->no_memory |= !lines;
    if (!lines)
        return;
    r->lines = lines;
    struct line line = {.rank = rank, .points = calloc(count, sizeof *line.points)};
    r->no_memory |= !line.points;
    if (!line.points)
        return;
    for (uint32_t i = 0; i < count; i++) {
        length += i > 0 ? between(track[i - 1], track[i]) : 0.0;
        struct ground_road_point point = {(int32_t)floor(track[i][0] * 1000.0 + 0.5),
                                          (int32_t)floor(track[i][1] * 1000.0 + 0.5), 0};
        if (line.count == 0 || point.x_mm != line.points[line.count - 1].x_mm ||
            point.z_mm != line.points[line.count - 1].z_mm)
            line.points[line.count++] = point;
    }
    line.length_m = length;
    if (line.count < 2)
        free(line.points);
    else
        r->lines[r->used++] = line;
}

/* Cuts the segment a b to the square. Returns false if it lies outside. */
static bool cut(const struct reading *r, double a[2], double b[2])
{
    double low = EDGE_M, high = 2.0 * r->grid->projection.middle_m - EDGE_M, from = 0.0, to = 1.0;
    double way[2] = {b[0] - a[0], b[1] - a[1]}, first[2] = {a[0], a[1]};
    for (int k = 0; k < 2; k++) {
        if (way[k] == 0.0) {
            if (a[k] < low || a[k] > high)
                return false;
            continue;
        }
        double in = (low - a[k]) / way[k], out = (high - a[k]) / way[k];
        from = maths_max(from, maths_min(in, out));
        to = maths_min(to, maths_max(in, out));
    }
    if (from >= to)
        return false;
    for (int k = 0; k < 2; k++) {
        a[k] = from > 0.0 ? maths_clamp(first[k] + way[k] * from, low, high) : first[k];
        b[k] = to < 1.0 ? maths_clamp(first[k] + way[k] * to, low, high) : b[k];
    }
    return true;
}

/* Adds what of a line lies within the square: one line or several. */
static void add_cut(struct reading *r, uint32_t rank)
{
    double(*track)[2] = r->track.place;
    uint32_t kept = 0, count = simplify(track, r->track.count);
    double last[2] = {track[0][0], track[0][1]};
    for (uint32_t i = 1; i < count; i++) {
        double a[2] = {last[0], last[1]}, b[2] = {track[i][0], track[i][1]};
        memcpy(last, b, sizeof last);
        bool inside = cut(r, a, b);
        bool goes_on =
            inside && kept > 0 && a[0] == track[kept - 1][0] && a[1] == track[kept - 1][1];
        if (kept > 0 && !goes_on) {
            add_line(r, track, kept, rank);
            kept = 0;
        }
        if (!inside)
            continue;
        /* A stretch that begins anew has its beginning in place of the point before. */
        if (kept == 0)
            memcpy(track[kept++], a, sizeof a);
        memcpy(track[kept++], b, sizeof b);
    }
    if (kept > 1)
        add_line(r, track, kept, rank);
}

static void add_geometry(struct reading *r, struct vector_map *map, OGRGeometryH geometry,
                         uint32_t rank, long long number)
{
    OGRwkbGeometryType type =
        geometry ? wkbFlatten(OGR_G_GetGeometryType(geometry)) : wkbLineString;
    if (type == wkbLineString) {
        bool good = geometry && vector_map_track(map, geometry, &r->track) && r->track.count > 1;
        if (good)
            add_cut(r, rank);
        else if (r->map->bad++ == 0) {
            r->map->bad_map = map->path;
            r->map->bad_feature = number;
        }
    } else if (type == wkbMultiLineString) {
        for (int i = 0; i < OGR_G_GetGeometryCount(geometry); i++)
            add_geometry(r, map, OGR_G_GetGeometryRef(geometry, i), rank, number);
    }
}

/* Returns the rank of a feature's word, WORDS if it is no road. */
static uint32_t rank_of(OGRFeatureH feature)
{
    char buffer[8];
    int field = OGR_F_GetFieldIndex(feature, "highway");
    uint32_t rank = 0;
    field = field >= 0 ? field : OGR_F_GetFieldIndex(feature, "fclass");
    if (field < 0)
        return 0;
    const char *word = OGR_F_GetFieldAsString(feature, field);
    while (rank < WORDS && strcmp(word, words[rank]) != 0)
        rank++;
    /* The outline of a yard is no road. */
    if (rank < WORDS && strcmp(vector_map_tag(feature, "area", buffer, sizeof buffer), "yes") == 0)
        return WORDS;
    return rank;
}

static void take_feature(void *context, struct vector_map *map, OGRFeatureH feature,
                         OGRGeometryH geometry)
{
    uint32_t rank = rank_of(feature);
    if (rank < WORDS)
        add_geometry(context, map, geometry, rank, vector_map_number(feature));
}

/* The order does not depend on that of the maps or of their lines. */
static int by_importance(const void *a, const void *b)
{
    const struct line *p = a, *q = b;
    if (p->rank != q->rank)
        return p->rank < q->rank ? -1 : 1;
    if (p->length_m != q->length_m)
        return p->length_m > q->length_m ? -1 : 1;
    if (p->count != q->count)
        return p->count < q->count ? -1 : 1;
    return memcmp(p->points, q->points, p->count * sizeof *p->points);
}

static int keep(struct road_map *map, struct reading *r, struct error_text *error)
{
    if (r->used > 0)
        qsort(r->lines, r->used, sizeof *r->lines, by_importance);
    map->points = calloc(GROUND_ROAD_POINTS_MAX, sizeof *map->points);
    if (!map->points || r->no_memory)
        return error_text_memory(error);
    for (uint32_t i = 0; i < r->used; i++) {
        const struct line *line = &r->lines[i];
        /* Two maps may have the same road. */
        if (i > 0 && by_importance(line - 1, line) == 0)
            continue;
        map->all_m += line->length_m;
        if (map->left_out > 0 || line->count > GROUND_ROAD_POINTS_MAX - map->count) {
            map->left_out++;
            continue;
        }
        for (uint32_t k = 0; k < line->count; k++) {
            map->points[map->count] = line->points[k];
            map->points[map->count++].road = map->roads;
        }
        map->kept_m += line->length_m;
        map->roads++;
    }
    return 0;
}

int road_map_read(struct road_map *map, char *const *paths, uint32_t count,
                  const struct post_grid *grid, struct vector_map_gaps *gaps,
                  struct error_text *error)
{
    struct reading r = {.grid = grid, .map = map};
    int result = 0;
    memset(map, 0, sizeof *map);
    for (uint32_t i = 0; i < count && result == 0; i++)
        result =
            vector_map_read(paths[i], grid, VECTOR_MAP_LINES, "lines, of which roads could be made",
                            take_feature, &r, gaps, error);
    if (result == 0)
        result = keep(map, &r, error);
    for (uint32_t i = 0; i < r.used; i++)
        free(r.lines[i].points);
    free(r.lines);
    vector_map_track_free(&r.track);
    return result;
}

void road_map_free(struct road_map *map)
{
    free(map->points);
    map->points = NULL;
}

/* A place on a road, a quarter of the distance of posts from the next. */
struct road_step {
    double place[2], level_m; /* [m] level: of a dam there */
    bool is_bank;             /* dry ground that is no shore */
};

static size_t nearest_post(const struct post_grid *grid, const double here[2])
{
    uint32_t column = (uint32_t)(here[0] / grid->spacing_m + 0.5);
    uint32_t row = (uint32_t)(here[1] / grid->spacing_m + 0.5);
    return (size_t)row * grid->side + column;
}

/* Returns true if a post is dry and one of those around it is water. */
static bool is_shore(const struct post_grid *grid, const uint8_t *cover, size_t at)
{
    size_t column = at % grid->side, row = at / grid->side, last = grid->side - 1;
    for (size_t r = row > 0 ? row - 1 : 0; r <= row + 1 && r <= last; r++) {
        for (size_t c = column > 0 ? column - 1 : 0; c <= column + 1 && c <= last; c++) {
            if (cover_is_water((enum cover)cover[r * grid->side + c]))
                return !cover_is_water((enum cover)cover[at]);
        }
    }
    return false;
}

/* Raises a post of water or shore to the dam. */
static void raise_post(const struct post_grid *grid, const struct road_step *step, size_t at,
                       float *posts, const uint8_t *cover)
{
    if (step->level_m > (double)posts[at] &&
        (cover_is_water((enum cover)cover[at]) || is_shore(grid, cover, at)))
        posts[at] = ground_tile_round(step->level_m);
}

/* Raises the posts that are as near to a place of a road as its dam is wide, or makes them dry. */
static void dam(const struct post_grid *grid, const struct road_step *step, bool raises,
                float *posts, uint8_t *cover)
{
    double spacing = grid->spacing_m, reach = DAM_POSTS * spacing + DAM_M;
    double last = (double)(grid->side - 1);
    uint32_t from[2], to[2];
    for (int k = 0; k < 2; k++) {
        from[k] = (uint32_t)maths_clamp(ceil((step->place[k] - reach) / spacing), 0.0, last);
        to[k] = (uint32_t)maths_clamp(floor((step->place[k] + reach) / spacing), 0.0, last);
    }
    for (uint32_t row = from[1]; row <= to[1]; row++) {
        for (uint32_t column = from[0]; column <= to[0]; column++) {
            const double post[2] = {column * spacing, row * spacing};
            size_t at = (size_t)row * grid->side + column;
            if (between(step->place, post) >= reach)
                continue;
            if (raises)
                raise_post(grid, step, at, posts, cover);
            else if (cover_is_water((enum cover)cover[at]))
                cover[at] = COVER_ROAD;
        }
    }
}

/* Fills the steps of a road of points [count]; returns their number. With steps of NULL it counts
 * them alone. */
static size_t find_steps(const struct ground_road_point *points, uint32_t count, double apart_m,
                         struct road_step *steps)
{
    size_t used = 0;
    for (uint32_t i = 0; i + 1 < count; i++) {
        const double a[2] = {points[i].x_mm / 1000.0, points[i].z_mm / 1000.0};
        const double b[2] = {points[i + 1].x_mm / 1000.0, points[i + 1].z_mm / 1000.0};
        int parts = (int)(between(a, b) / apart_m) + 1;
        for (int n = 0; n <= parts; n++, used++) {
            if (!steps)
                continue;
            steps[used] = (struct road_step){
                .place = {a[0] + (b[0] - a[0]) * n / parts, a[1] + (b[1] - a[1]) * n / parts}};
        }
    }
    return used;
}

/* Finds how high a dam is at each step: from both banks it falls by DAM_GRADE, on the shore, too,
 * where that is steeper. */
static void find_levels(struct road_step *steps, size_t count, const struct post_grid *grid,
                        const float *posts, const uint8_t *cover)
{
    double from_first = -INFINITY, from_last = -INFINITY;
    for (size_t n = 0; n < count; n++) {
        size_t at = nearest_post(grid, steps[n].place);
        bool water = cover_is_water((enum cover)cover[at]);
        bool bank = !water && !is_shore(grid, cover, at);
        if (n > 0)
            from_first -= DAM_GRADE * between(steps[n - 1].place, steps[n].place);
        if (!water && (bank || (double)posts[at] > from_first))
            from_first = (double)posts[at];
        steps[n].level_m = from_first;
        steps[n].is_bank = bank;
    }
    for (size_t n = count; n-- > 0;) {
        if (n + 1 < count)
            from_last -= DAM_GRADE * between(steps[n + 1].place, steps[n].place);
        if (steps[n].is_bank || steps[n].level_m > from_last)
            from_last = steps[n].level_m;
        steps[n].level_m = from_last;
    }
}

static int pave(const struct ground_road_point *points, uint32_t count,
                const struct post_grid *grid, float *posts, uint8_t *cover)
{
    double apart_m = 0.25 * grid->spacing_m;
    size_t used = find_steps(points, count, apart_m, NULL);
    struct road_step *steps = calloc(used + 1, sizeof *steps);
    if (!steps)
        return -1;
    (void)find_steps(points, count, apart_m, steps);
    find_levels(steps, used, grid, posts, cover);
    for (size_t n = 0; n < used; n++)
        dam(grid, &steps[n], true, posts, cover);
    for (size_t n = 0; n < used; n++) {
        size_t at = nearest_post(grid, steps[n].place);
        const double post[2] = {(double)(at % grid->side) * grid->spacing_m,
                                (double)(at / grid->side) * grid->spacing_m};
        if (grid->spacing_m <= PAVE_SPACING_M && between(steps[n].place, post) < PAVE_HALF_M &&
            !cover_is_water((enum cover)cover[at]))
            cover[at] = COVER_ROAD;
        dam(grid, &steps[n], false, posts, cover);
    }
    free(steps);
    return 0;
}

int road_map_pave(const struct road_map *map, const struct post_grid *grid, float *posts,
                  uint8_t *cover)
{
    uint32_t first = 0;
    int result = 0;
    for (uint32_t i = 1; i <= map->count && result == 0; i++) {
        if (i < map->count && map->points[i].road == map->points[first].road)
            continue;
        result = pave(map->points + first, i - first, grid, posts, cover);
        first = i;
    }
    return result;
}
