/* Roads by A* on every second node of the elevation grid, around water and over gentle grades, then
 * rounded. Later roads join earlier ones, which are cheaper than open ground. */
#include "world/making/generate_roads.h"

#include "world/making/geography.h"
#include "world/maths/maths.h"
#include "world/maths/noise.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GRID_STEP  2
#define GRID_SIDE  (400 / GRID_STEP + 1)
#define GRID_COUNT (GRID_SIDE * GRID_SIDE)
#define GRID_M     (GRID_STEP * ELEVATION_GRID_SPACING_M)

#define GRADE_EASY   0.06 /* a grade that doubles the effort */
#define SHORE_FREE_M 60.0 /* finer noise moves the shore by half of it */
#define LAKE_FREE_M  4.0  /* over the lake's surface */
#define ON_ROAD      0.55 /* effort on an earlier road, as a share of that on open ground */

/* Roads wind around small obstacles that no map shows, also on flat ground. */
#define TOIL       0.4
#define NOISE_TOIL 1400u

#define POINT_SPACING_M 60.0
#define ROUNDINGS       3
#define VIA_MAX         12

/* Steps from a node: eight neighbours and eight knight's moves. */
#define WAY_COUNT 16
static const int32_t way_x[WAY_COUNT] = {1, 1, 0, -1, -1, -1, 0, 1, 2, 1, -1, -2, -2, -1, 1, 2};
static const int32_t way_z[WAY_COUNT] = {0, 1, 1, 1, 0, -1, -1, -1, 1, 2, 2, 1, -1, -2, -2, -1};

/* Points that a road passes [m]; coastal roads keep near the shore. */
struct course {
    const char *name;
    int coastal;
    uint32_t count;
    double via[VIA_MAX][2];
};

static const struct course courses[] = {
    {"Mission Road", 0, 3, {{31500, 22450}, {27500, 19600}, {25050, 17600}}},
    {"Jolon Road to King City", 0, 3, {{31500, 22450}, {35000, 14500}, {37500, 0}}},
    {"Jolon Road to Lockwood and Bradley",
     0,
     4,
     {{31500, 22450}, {36600, 24600}, {40400, 26300}, {50000, 30800}}},
    {"Nacimiento-Fergusson Road",
     0,
     6,
     {{25050, 17600}, {20500, 20000}, {13300, 20900}, {9500, 19600}, {6300, 19300}, {3900, 20500}}},
    {"Highway 1",
     1,
     7,
     {{0, 17300},
      {3900, 20500},
      {4900, 27000},
      {7700, 32800},
      {15200, 40300},
      {18900, 44500},
      {20300, 50000}}},
    {"The Indians Road", 0, 4, {{25050, 17600}, {18900, 15400}, {12500, 12200}, {7000, 7250}}},
    {"Nacimiento Valley Road",
     0,
     5,
     {{13300, 20900}, {20300, 28200}, {29700, 34200}, {38500, 40000}, {50000, 45000}}},
    {"Interlake Road", 0, 4, {{40400, 26300}, {41000, 32600}, {45500, 37000}, {50000, 41300}}},
    {"Tank trail", 0, 3, {{31500, 22450}, {29500, 28000}, {29700, 34200}}},
    {"Highway 101", 0, 4, {{40000, 0}, {42800, 2900}, {45500, 6200}, {50000, 11000}}},
    {"Lockwood-San Lucas Road", 0, 3, {{40400, 26300}, {43500, 16000}, {45500, 6200}}},
    {"Bryson road", 0, 3, {{38500, 40000}, {33500, 43500}, {27000, 46500}}},
};
#define COURSE_COUNT (sizeof courses / sizeof courses[0])

struct waiting {
    float effort; /* so far, and at least from here to the goal */
    uint32_t node;
};

struct survey {
    const struct elevation_grid *grid;
    float *height, *inland; /* [GRID_COUNT, m] */
    float *toil;            /* [GRID_COUNT] effort of crossing, relative to plain ground */
    uint8_t *water, *road;  /* [GRID_COUNT] */
    float *effort;          /* [GRID_COUNT, m of level ground] from the start */
    uint32_t *from;         /* [GRID_COUNT] */
    uint8_t *done;          /* [GRID_COUNT] */
    struct waiting *heap;   /* [GRID_COUNT * WAY_COUNT] binary, least first */
    uint32_t heap_count;
    double *line, *rounded; /* x, z pairs of one road */
    uint32_t line_count;
};

#define LINE_MAX 16384u /* points of one road while it is rounded */

static int survey_init(struct survey *s, const struct elevation_grid *grid)
{
    *s = (struct survey){.grid = grid};
    s->height = malloc(GRID_COUNT * sizeof *s->height);
    s->inland = malloc(GRID_COUNT * sizeof *s->inland);
    s->toil = malloc(GRID_COUNT * sizeof *s->toil);
    s->water = calloc(GRID_COUNT, 1);
    s->road = calloc(GRID_COUNT, 1);
    s->done = calloc(GRID_COUNT, 1);
    s->effort = malloc(GRID_COUNT * sizeof *s->effort);
    s->from = malloc(GRID_COUNT * sizeof *s->from);
    s->heap = malloc(GRID_COUNT * WAY_COUNT * sizeof *s->heap);
    s->line = malloc(2 * LINE_MAX * sizeof *s->line);
    s->rounded = malloc(2 * LINE_MAX * sizeof *s->rounded);
    return s->height && s->inland && s->toil && s->water && s->road && s->done && s->effort &&
                   s->from && s->heap && s->line && s->rounded
               ? 0
               : -1;
}

static void survey_free(struct survey *s)
{
    free(s->height);
    free(s->inland);
    free(s->toil);
    free(s->water);
    free(s->road);
    free(s->done);
    free(s->effort);
    free(s->from);
    free(s->heap);
    free(s->line);
    free(s->rounded);
}

static int wet(const struct elevation_grid *grid, uint32_t node)
{
    return grid->inland[node] < (float)SHORE_FREE_M ||
           (grid->lake[node] && grid->height[node] < (float)(GEOGRAPHY_LAKE_M + LAKE_FREE_M));
}

/* Reads heights, and marks water wherever a node within two of the elevation grid's is wet:
 * rounding the roads and noise at the shore move them by less than that. */
static void read_land(struct survey *s)
{
    for (uint32_t i = 0; i < GRID_COUNT; i++) {
        uint32_t column = i % GRID_SIDE * GRID_STEP + ELEVATION_GRID_MARGIN;
        uint32_t row = i / GRID_SIDE * GRID_STEP + ELEVATION_GRID_MARGIN;
        s->height[i] = s->grid->height[row * ELEVATION_GRID_SIDE + column];
        s->inland[i] = s->grid->inland[row * ELEVATION_GRID_SIDE + column];
        double bumps =
            noise_fractal(NOISE_TOIL, column * (GRID_M / 1400.0), row * (GRID_M / 1400.0), 2);
        s->toil[i] = (float)maths_max(1.0 + TOIL * bumps, ON_ROAD);
        for (uint32_t k = 0; k < 25; k++)
            s->water[i] |=
                (uint8_t)wet(s->grid, (row + k / 5 - 2) * ELEVATION_GRID_SIDE + column + k % 5 - 2);
    }
}

static void heap_push(struct survey *s, float effort, uint32_t node)
{
    uint32_t i = s->heap_count++;
    for (; i > 0 && s->heap[(i - 1) / 2].effort > effort; i = (i - 1) / 2)
        s->heap[i] = s->heap[(i - 1) / 2];
    s->heap[i] = (struct waiting){effort, node};
}

static struct waiting heap_pop(struct survey *s)
{
    struct waiting least = s->heap[0], last = s->heap[--s->heap_count];
    uint32_t i = 0, child;
    while ((child = 2 * i + 1) < s->heap_count) {
        if (child + 1 < s->heap_count && s->heap[child + 1].effort < s->heap[child].effort)
            child++;
        if (s->heap[child].effort >= last.effort)
            break;
        s->heap[i] = s->heap[child];
        i = child;
    }
    s->heap[i] = last;
    return least;
}

static uint32_t grid_node(const double via[2])
{
    double column = floor(via[0] / GRID_M + 0.5), row = floor(via[1] / GRID_M + 0.5);
    return (uint32_t)row * GRID_SIDE + (uint32_t)column;
}

static double grid_distance(uint32_t a, uint32_t b)
{
    double dx = (double)(a % GRID_SIDE) - (double)(b % GRID_SIDE);
    double dz = (double)(a / GRID_SIDE) - (double)(b / GRID_SIDE);
    return GRID_M * sqrt(dx * dx + dz * dz);
}

/* The nearest dry node. */
static uint32_t dry_node(const struct survey *s, uint32_t node)
{
    uint32_t best = node;
    double least = INFINITY;
    if (!s->water[node])
        return node;
    for (uint32_t i = 0; i < GRID_COUNT; i++) {
        if (!s->water[i] && grid_distance(i, node) < least) {
            least = grid_distance(i, node);
            best = i;
        }
    }
    return best;
}

static double step_effort(const struct survey *s, uint32_t a, uint32_t b, int coastal)
{
    double length = grid_distance(a, b);
    double grade = (double)(s->height[b] - s->height[a]) / length / GRADE_EASY;
    double effort = length * ((double)s->toil[b] + grade * grade);
    if (coastal)
        effort *= 1.0 + maths_max((double)s->inland[b] - 700.0, 0.0) / 900.0;
    return s->road[a] && s->road[b] ? effort * ON_ROAD : effort;
}

/* Finds the path of least effort from start to goal; from[] leads back. Returns 0, or -1 if water
 * is between. */
static int find_way(struct survey *s, uint32_t start, uint32_t goal, int coastal)
{
    for (uint32_t i = 0; i < GRID_COUNT; i++)
        s->effort[i] = INFINITY;
    memset(s->done, 0, GRID_COUNT);
    s->heap_count = 0;
    s->effort[start] = 0.0f;
    heap_push(s, 0.0f, start);
    while (s->heap_count > 0) {
        uint32_t node = heap_pop(s).node;
        int32_t x = (int32_t)(node % GRID_SIDE), z = (int32_t)(node / GRID_SIDE);
        if (node == goal)
            return 0;
        if (s->done[node])
            continue;
        s->done[node] = 1;
        for (int k = 0; k < WAY_COUNT; k++) {
            int32_t nx = x + way_x[k], nz = z + way_z[k];
            if (nx < 0 || nz < 0 || nx >= GRID_SIDE || nz >= GRID_SIDE)
                continue;
            uint32_t next = (uint32_t)(nz * GRID_SIDE + nx);
            float effort = s->effort[node] + (float)step_effort(s, node, next, coastal);
            if (s->water[next] || s->done[next] || !(effort < s->effort[next]))
                continue;
            s->effort[next] = effort;
            s->from[next] = node;
            heap_push(s, effort + (float)(ON_ROAD * grid_distance(next, goal)), next);
        }
    }
    return -1;
}

/* Appends the path found to the road's line, start first; a start that is already the line's end is
 * not repeated. */
static void add_way(struct survey *s, uint32_t start, uint32_t goal)
{
    uint32_t length = 0;
    for (uint32_t node = goal; node != start; node = s->from[node])
        length++;
    uint32_t at = s->line_count == 0 ? 0 : s->line_count - 1, node = goal;
    s->line_count = at + length + 1;
    for (uint32_t i = s->line_count; i-- > at;) {
        s->line[2 * i] = node % GRID_SIDE * GRID_M;
        s->line[2 * i + 1] = node / GRID_SIDE * GRID_M;
        s->road[node] = 1;
        node = s->from[node];
    }
}

/* Chaikin's corner cutting: replaces each corner by two, a quarter along the lines beside it. */
static void round_corners(struct survey *s)
{
    uint32_t count = 0;
    const double *p = s->line;
    double *to = s->rounded;
    memcpy(to, p, 2 * sizeof *p);
    count++;
    for (uint32_t i = 0; i + 1 < s->line_count; i++, p += 2) {
        for (int k = 0; k < 2; k++) {
            double t = k == 0 ? 0.25 : 0.75;
            to[2 * count] = p[0] + (p[2] - p[0]) * t;
            to[2 * count + 1] = p[1] + (p[3] - p[1]) * t;
            count++;
        }
    }
    memcpy(&to[2 * count], p, 2 * sizeof *p);
    s->rounded = s->line;
    s->line = to;
    s->line_count = count + 1;
}

/* Writes points at even distances along the line, and its end. */
static int emit(const struct survey *s, uint32_t road, struct road_point *roads, uint32_t road_max,
                uint32_t *road_count)
{
    double ahead = 0.0; /* from the last corner to the next point */
    for (uint32_t i = 0; i + 1 < s->line_count; i++) {
        const double *p = &s->line[2 * i];
        double dx = p[2] - p[0], dz = p[3] - p[1], length = sqrt(dx * dx + dz * dz);
        int last = i + 2 == s->line_count;
        for (; ahead <= length || last; ahead += POINT_SPACING_M) {
            double t = ahead < length ? ahead / length : 1.0;
            if (*road_count == road_max) {
                errno = ENOBUFS;
                return -1;
            }
            /* Rounded, as they have been since points of roads were floats. */
            roads[(*road_count)++] = (struct road_point){.x = maths_as_float(p[0] + dx * t),
                                                         .z = maths_as_float(p[1] + dz * t),
                                                         .road = road};
            if (last && ahead >= length)
                return 0;
        }
        ahead -= length;
    }
    return 0;
}

/* Returns 0; -1 with errno EHOSTUNREACH if water is between two of its points. */
static int lay_course(struct survey *s, const struct course *course)
{
    uint32_t start = dry_node(s, grid_node(course->via[0]));
    s->line_count = 0;
    for (uint32_t i = 1; i < course->count; i++) {
        uint32_t goal = dry_node(s, grid_node(course->via[i]));
        if (find_way(s, start, goal, course->coastal) != 0) {
            errno = EHOSTUNREACH;
            return -1;
        }
        add_way(s, start, goal);
        start = goal;
    }
    for (int i = 0; i < ROUNDINGS; i++)
        round_corners(s);
    return 0;
}

int generate_roads(const struct elevation_grid *grid, struct road_point *roads, uint32_t road_max,
                   uint32_t *road_count)
{
    struct survey s;
    int result = survey_init(&s, grid);
    *road_count = 0;
    if (result == 0)
        read_land(&s);
    for (uint32_t i = 0; i < COURSE_COUNT && result == 0; i++) {
        result = lay_course(&s, &courses[i]);
        if (result == 0)
            result = emit(&s, i, roads, road_max, road_count);
    }
    survey_free(&s);
    return result;
}
