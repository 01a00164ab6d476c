/* Tests a line square by square. The ground between posts is flat triangles, so a line that is
 * above their edges is above the ground. Earthworks have edges too. Craters and waves are curved
 * and are sampled. A square is skipped when the line is above everything in it. */
#include "mover/query/line_of_sight.h"

#include "world/terrain/crater.h"
#include "world/terrain/fixed_index.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/terrain.h"
#include "world/world.h"

#include <stdlib.h>

#define CRATER_SAMPLES 12 /* along the part of the line that is over a crater */
#define WAVE_SAMPLES   32 /* the same for an earthwork with waves */
#define FIRST_LOOKS    7  /* points of the line that are tried first, because most hills are wide */
#define LEAST_M        1.0 /* on the map: nearer points always see each other */

struct line {
    const struct line_of_sight *sight;
    struct vec3 from, delta; /* the point at t in 0..1 is from + delta * t */
    double level;            /* length on the map */
};

double line_of_sight_kept(enum damage damage)
{
    static const double kept[DAMAGE_COUNT] = {1.0, 1.0, 0.75, 0.25, 0.1};
    return kept[damage < DAMAGE_COUNT ? damage : DAMAGE_DESTROYED];
}

/* --- the skyline -------------------------------------------------------------------------------*/

static double object_height(const struct world *world, const struct fixed_object *object)
{
    const struct kind *kind = &world->kinds[object->kind];
    return kind->height_m * fixed_scale(object, kind);
}

/* Builds the lists of the objects whose visible box reaches into each square. */
static int build_reach(struct line_of_sight *sight)
{
    const struct world *world = sight->world;
    struct kind *kinds = calloc(world->counts.kinds + 1, sizeof *kinds);
    if (!kinds)
        return -1;
    for (uint32_t k = 0; k < world->counts.kinds; k++) {
        double length = world->kinds[k].length_m, width = world->kinds[k].width_m;
        kinds[k] = world->kinds[k];
        kinds[k].level_m = 0.5 * sqrt(length * length + width * width);
    }
    int result = fixed_index_build(&world->terrain.squares, world->fixed, world->counts.fixed,
                                   kinds, &sight->reach_start, &sight->reach);
    free(kinds);
    return result;
}

static uint32_t objects_of(const struct line_of_sight *sight, uint32_t square,
                           const uint32_t **objects)
{
    *objects = sight->reach + sight->reach_start[square];
    return sight->reach_start[square + 1] - sight->reach_start[square];
}

/* A square_bounds_function: the context is a struct line_of_sight. */
static uint16_t skyline(const void *context, uint32_t square)
{
    const struct line_of_sight *sight = context;
    const struct world *world = sight->world;
    const uint32_t *objects;
    uint32_t count = objects_of(sight, square, &objects);
    uint16_t top = square_bounds_height(&world->terrain, square);
    for (uint32_t n = 0; n < count; n++) {
        const struct fixed_object *object = &world->fixed[objects[n]];
        uint16_t high =
            square_bounds_above_height((double)object->y + object_height(world, object));
        top = high > top ? high : top;
    }
    return top;
}

int line_of_sight_init(struct line_of_sight *sight, const struct world *world,
                       const struct crater_index *craters)
{
    *sight = (struct line_of_sight){.world = world, .craters = craters};
    if (square_bounds_init(&sight->skyline, &world->terrain.squares, skyline, sight) == 0 &&
        build_reach(sight) == 0)
        return 0;
    line_of_sight_free(sight);
    return -1;
}

void line_of_sight_free(struct line_of_sight *sight)
{
    square_bounds_free(&sight->skyline);
    free(sight->reach_start);
    free(sight->reach);
    *sight = (struct line_of_sight){0};
}

/* --- the ground --------------------------------------------------------------------------------*/

static double height_at(const struct line *line, double t)
{
    return line->from.y + line->delta.y * t;
}

static bool ground_above(const struct line *line, double t)
{
    return terrain_height(&line->sight->world->terrain, line->sight->craters,
                          line->from.x + line->delta.x * t,
                          line->from.z + line->delta.z * t) > height_at(line, t);
}

/* Returns true if the ground is above the line where start + delta * t is a whole number of
 * spacings, for t in t0..t1. */
static bool edges_above(const struct line *line, double start, double delta, double t0, double t1)
{
    double spacing = line->sight->world->terrain.spacing_m;
    double a = (start + delta * t0) / spacing, b = (start + delta * t1) / spacing;
    int64_t last = (int64_t)floor(maths_max(a, b));
    if (delta == 0.0)
        return false;
    for (int64_t k = (int64_t)floor(maths_min(a, b)) + 1; k <= last; k++) {
        if (ground_above(line, maths_clamp(((double)k * spacing - start) / delta, t0, t1)))
            return true;
    }
    return false;
}

/* Returns true if the ground is above the line within one crater, rim included. */
static bool crater_above(const struct line *line, const struct crater *crater, double t0, double t1)
{
    double reach = CRATER_RIM * (double)crater->radius_m, square = line->level * line->level;
    double dx = crater->x - line->from.x, dz = crater->z - line->from.z;
    double middle = (dx * line->delta.x + dz * line->delta.z) / square;
    double off = dx * dx + dz * dz - middle * middle * square;
    if (off >= reach * reach)
        return false;
    double half = sqrt((reach * reach - off) / square);
    double first = maths_max(middle - half, t0), last = maths_min(middle + half, t1);
    for (int n = 0; n <= CRATER_SAMPLES && first < last; n++) {
        if (ground_above(line, first + (last - first) * (double)n / CRATER_SAMPLES))
            return true;
    }
    /* The crest of the rim is one bowl radius from the centre. */
    double bowl = (double)crater->radius_m * (double)crater->radius_m - off;
    double crest = bowl > 0.0 ? sqrt(bowl / square) : 0.0;
    return (middle - crest > t0 && middle - crest < t1 && ground_above(line, middle - crest)) ||
           (middle + crest > t0 && middle + crest < t1 && ground_above(line, middle + crest));
}

/* The shares of a work's height along the line, and 1 and 0: value + rate * t each. Where two of
 * them are equal the ground may have an edge. */
enum { WORK_BACK, WORK_FRONT, WORK_RIGHT, WORK_LEFT, WORK_TOP, WORK_FOOT, WORK_SHARES };
struct work_share {
    double value, rate;
};

static void shares_along(const struct line *line, const struct earthwork *work,
                         struct work_share share[WORK_SHARES])
{
    double dx = line->from.x - work->x, dz = line->from.z - work->z;
    double along = dx * work->sine - dz * work->cosine;
    double across = dx * work->cosine + dz * work->sine;
    double along_rate = line->delta.x * work->sine - line->delta.z * work->cosine;
    double across_rate = line->delta.x * work->cosine + line->delta.z * work->sine;
    share[WORK_BACK] =
        (struct work_share){(work->half_length + along) / work->back_m, along_rate / work->back_m};
    share[WORK_FRONT] = (struct work_share){(work->half_length - along) / work->front_m,
                                            -along_rate / work->front_m};
    share[WORK_RIGHT] = (struct work_share){(work->half_width - across) / work->side_m,
                                            -across_rate / work->side_m};
    share[WORK_LEFT] =
        (struct work_share){(work->half_width + across) / work->side_m, across_rate / work->side_m};
    share[WORK_TOP] = (struct work_share){1.0, 0.0};
    share[WORK_FOOT] = (struct work_share){0.0, 0.0};
}

/* Returns true if the ground is above the line at an edge of the work. */
static bool work_edges_above(const struct line *line, const struct earthwork *work, double t0,
                             double t1)
{
    struct work_share share[WORK_SHARES];
    shares_along(line, work, share);
    for (int a = 0; a < WORK_SHARES; a++) {
        for (int b = 0; b < a; b++) {
            double t = (share[b].value - share[a].value) / (share[a].rate - share[b].rate);
            if (t > t0 && t < t1 && ground_above(line, t))
                return true;
        }
    }
    return false;
}

/* Returns true if the ground is above the line within one earthwork. */
static bool work_above(const struct line *line, const struct earthwork *work, double t0, double t1)
{
    double reach = work->half_length + work->half_width, square = line->level * line->level;
    double dx = work->x - line->from.x, dz = work->z - line->from.z;
    double middle = (dx * line->delta.x + dz * line->delta.z) / square;
    double off = dx * dx + dz * dz - middle * middle * square;
    if (work->height_m == 0.0 || off >= reach * reach)
        return false;
    double half = sqrt((reach * reach - off) / square);
    double first = maths_max(middle - half, t0), last = maths_min(middle + half, t1);
    if (!(first < last))
        return false;
    for (int n = 0; n <= WAVE_SAMPLES && work->wave_m > 0.0; n++) {
        if (ground_above(line, first + (last - first) * (double)n / WAVE_SAMPLES))
            return true;
    }
    return work_edges_above(line, work, first, last);
}

static bool works_above(const struct line *line, uint32_t square, double t0, double t1)
{
    const struct earthworks *earthworks = &line->sight->world->terrain.earthworks;
    uint32_t count;
    const uint32_t *items = earthwork_in_square(earthworks, square, &count);
    for (uint32_t n = 0; n < count; n++) {
        if (work_above(line, &earthworks->works[items[n]], t0, t1))
            return true;
    }
    return false;
}

static bool ground_hides(const struct line *line, uint32_t square, double t0, double t1)
{
    const struct crater_index *craters = line->sight->craters;
    const struct vec3 *from = &line->from, *delta = &line->delta;
    if (ground_above(line, t1) || edges_above(line, from->x, delta->x, t0, t1) ||
        edges_above(line, from->z, delta->z, t0, t1) ||
        edges_above(line, from->x - from->z, delta->x - delta->z, t0, t1))
        return true;
    for (uint32_t link = craters->head[square]; link != 0; link = craters->links[link - 1].next) {
        if (crater_above(line, &craters->craters[craters->links[link - 1].crater], t0, t1))
            return true;
    }
    return works_above(line, square, t0, t1);
}

/* --- fixed objects -----------------------------------------------------------------------------*/

/* Narrows t0..t1 to where the line is between two parallel sides of a box. Returns false if it
 * never is. */
static bool within_side(double start, double delta, double half, double *t0, double *t1)
{
    if (delta == 0.0)
        return fabs(start) <= half;
    double a = (-half - start) / delta, b = (half - start) / delta;
    *t0 = maths_max(*t0, maths_min(a, b));
    *t1 = maths_min(*t1, maths_max(a, b));
    return *t0 < *t1;
}

static bool object_hides(const struct line *line, uint32_t index)
{
    const struct world *world = line->sight->world;
    const struct fixed_object *object = &world->fixed[index];
    const struct kind *kind = &world->kinds[object->kind];
    double scale = fixed_scale(object, kind);
    double length = 0.5 * scale * kind->length_m, width = 0.5 * scale * kind->width_m;
    double dx = line->from.x - object->x, dz = line->from.z - object->z;
    double across = (dx * line->delta.z - dz * line->delta.x) / line->level;
    if (across * across > length * length + width * width || kind->object_class == OBJECT_POLE)
        return false;
    double top =
        (double)object->y +
        scale * kind->height_m * line_of_sight_kept((enum damage)line->sight->fixed_damage[index]);
    double sine, cosine, t0 = 0.0, t1 = 1.0;
    maths_sincos(fixed_heading(object), &sine, &cosine);
    if (!within_side(dx * sine - dz * cosine, line->delta.x * sine - line->delta.z * cosine, length,
                     &t0, &t1) ||
        !within_side(dx * cosine + dz * sine, line->delta.x * cosine + line->delta.z * sine, width,
                     &t0, &t1))
        return false;
    if (t0 <= 0.0 || t1 >= 1.0) /* an end of the line is in the box */
        return false;
    return maths_min(height_at(line, t0), height_at(line, t1)) < top;
}

static bool objects_hide(const struct line *line, uint32_t square)
{
    const uint32_t *objects;
    uint32_t count = objects_of(line->sight, square, &objects);
    for (uint32_t n = 0; n < count; n++) {
        if (object_hides(line, objects[n]))
            return true;
    }
    return false;
}

/* --- square by square --------------------------------------------------------------------------*/

static bool square_hides(const struct line *line, int32_t column, int32_t row, double t0, double t1)
{
    uint32_t square = gridsquare_index(&line->sight->world->terrain.squares, column, row);
    double lowest = maths_min(height_at(line, t0), height_at(line, t1));
    if (square_bounds_of(&line->sight->skyline, square) <= square_bounds_below_height(lowest) &&
        line->sight->craters->head[square] == 0)
        return false;
    return ground_hides(line, square, t0, t1) || objects_hide(line, square);
}

/* The t at which the line leaves this column or row of squares. */
static double border(const struct gridsquares *squares, double start, double delta, int32_t axis)
{
    if (delta == 0.0)
        return INFINITY;
    return ((double)(delta > 0.0 ? axis + 1 : axis) * squares->side_m - start) / delta;
}

bool line_of_sight_clear(const struct line_of_sight *sight, struct vec3 from, struct vec3 to)
{
    struct line line = {.sight = sight, .from = from, .delta = vec3_sub(to, from)};
    const struct gridsquares *squares = &sight->world->terrain.squares;
    int32_t column = gridsquare_axis(squares, from.x), row = gridsquare_axis(squares, from.z);
    double t = 0.0;
    line.level = sqrt(line.delta.x * line.delta.x + line.delta.z * line.delta.z);
    if (line.level < LEAST_M)
        return true;
    for (int n = 1; n <= FIRST_LOOKS; n++) {
        /* 1/2, 1/4, 3/4, 1/8 ...: bits reversed. */
        int reversed = (n & 1) << 2 | (n & 2) | (n & 4) >> 2;
        if (ground_above(&line, (double)reversed / (FIRST_LOOKS + 1)))
            return false;
    }
    while (column >= 0 && row >= 0 && column < squares->per_side && row < squares->per_side) {
        double tx = border(squares, from.x, line.delta.x, column),
               tz = border(squares, from.z, line.delta.z, row);
        double end = maths_clamp(maths_min(tx, tz), t, 1.0);
        if (square_hides(&line, column, row, t, end))
            return false;
        if (!(end < 1.0))
            return true;
        if (tx <= tz)
            column += line.delta.x > 0.0 ? 1 : -1;
        else
            row += line.delta.z > 0.0 ? 1 : -1;
        t = end;
    }
    return true;
}
