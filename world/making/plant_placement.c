/* Places trees and bushes: chooses squares by suitability, the number in each, the spots, and which
 * are trees. */
#include "world/making/plant_placement.h"

#include "world/making/generate.h"
#include "world/maths/maths.h"
#include "world/maths/noise.h"
#include "world/maths/random.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

#define TRIES 400u

/* Vegetation is densest around the fort, where most vehicles go. */
#define FORT_X_M     28000.0
#define FORT_Z_M     23000.0
#define FORT_REACH_M 15000.0

enum { NOISE_GROVE = 1500, NOISE_THICKET = 1540 };

/* A square and its suitability for trees and bushes. */
struct stand {
    double score;
    uint32_t square;
    uint32_t count; /* of objects in it */
};

/* A place for a tree or bush. */
struct spot {
    double x, z;
    double treeness; /* those with the highest become trees */
    uint32_t number;
};

struct plant_placement {
    struct object_placement *placement;
    uint32_t growing;     /* number of trees and bushes */
    uint32_t built;       /* objects placed before */
    uint8_t *taken;       /* [squares.count] objects were placed there before */
    struct stand *stands; /* [squares.count] best first, then in the order of squares */
    uint32_t stand_count;
    uint32_t *first;    /* [squares.count] first spot */
    uint8_t *held;      /* [squares.count] spots */
    struct spot *spots; /* [growing] */
};

/* Returns the suitability of a cover for trees and bushes. */
static double cover_suits(enum cover cover)
{
    switch (cover) {
    case COVER_FOREST:
        return 1.0;
    case COVER_CHAPARRAL:
        return 0.62;
    case COVER_GRASS:
        return 0.34;
    case COVER_ROCK:
        return 0.12;
    case COVER_SAND:
    case COVER_ROAD:
    case COVER_SEA:
    case COVER_LAKE:
    case COVER_COUNT:
        break;
    }
    return 0.0;
}

/* Returns the mean suitability of a square, sampled as finely as the densest posts; -1 if any of it
 * is water. */
static double square_suits(const struct object_placement *p, uint32_t square)
{
    const struct gridsquares *squares = &p->terrain->squares;
    double x0 = gridsquare_column(squares, square) * squares->side_m, sum = 0.0;
    double z0 = gridsquare_row(squares, square) * squares->side_m;
    for (int i = 0; i < 25; i++) {
        double x = x0 + (i % 5) * (squares->side_m / 4.0),
               z = z0 + (i / 5) * (squares->side_m / 4.0);
        enum cover cover = terrain_cover(p->terrain, x, z);
        if (cover_is_water(cover))
            return -1.0;
        sum += cover_suits(cover);
    }
    return sum / 25.0;
}

static double square_score(const struct object_placement *p, uint32_t square, double suits)
{
    const struct gridsquares *squares = &p->terrain->squares;
    double x = (gridsquare_column(squares, square) + 0.5) * squares->side_m;
    double z = (gridsquare_row(squares, square) + 0.5) * squares->side_m;
    double dx = (x - FORT_X_M) / FORT_REACH_M, dz = (z - FORT_Z_M) / FORT_REACH_M;
    double near = 1.0 / (1.0 + dx * dx + dz * dz);
    double grove = noise_fractal(p->seed + NOISE_GROVE, x / 1900.0, z / 1900.0, 3);
    double chance = random_unit(p->seed, square, 0, RANDOM_FOREST);
    return (0.15 + suits) * (0.35 + near) * (1.0 + 0.9 * grove) + 0.30 * chance;
}

static int by_score(const void *left, const void *right)
{
    const struct stand *a = left, *b = right;
    if (a->score > b->score || a->score < b->score)
        return a->score > b->score ? -1 : 1;
    return (a->square > b->square) - (a->square < b->square);
}

static int by_square(const void *left, const void *right)
{
    const struct stand *a = left, *b = right;
    return (a->square > b->square) - (a->square < b->square);
}

static int by_treeness(const void *left, const void *right)
{
    const struct spot *a = left, *b = right;
    if (a->treeness > b->treeness || a->treeness < b->treeness)
        return a->treeness > b->treeness ? -1 : 1;
    return (a->number > b->number) - (a->number < b->number);
}

/* Chooses the best free squares, as many as must still be occupied. */
static int choose_squares(struct plant_placement *g)
{
    const struct object_placement *p = g->placement;
    uint32_t occupied = 0, dry = 0;
    for (uint32_t i = 0; i < p->used; i++) {
        uint32_t square = gridsquare_of(&p->terrain->squares, p->objects[i].x, p->objects[i].z);
        occupied += g->taken[square] == 0;
        g->taken[square] = 1;
    }
    for (uint32_t square = 0; square < p->terrain->squares.count; square++) {
        double suits = g->taken[square] ? -1.0 : square_suits(p, square);
        if (suits >= 0.0)
            g->stands[dry++] = (struct stand){square_score(p, square, suits), square, 0};
    }
    g->stand_count = PLANT_PLACEMENT_SQUARES - occupied;
    if (dry < g->stand_count) {
        errno = ENOSPC;
        return -1;
    }
    qsort(g->stands, dry, sizeof *g->stands, by_score);
    return 0;
}

/* Sets the number of each square: one, and more in better squares, with few of high numbers; the
 * best gets the maximum. Then adjusts single squares by one until the sum is right. */
static void share_out(struct plant_placement *g)
{
    const struct object_placement *p = g->placement;
    double mean = (double)g->growing / g->stand_count;
    uint32_t sum = 0;
    for (uint32_t i = 0; i < g->stand_count; i++) {
        struct stand *stand = &g->stands[i];
        double u = random_unit(p->seed, stand->square, 0, RANDOM_SQUARE_SIZE);
        double rank = 1.0 - (double)i / g->stand_count;
        double more = floor(2.0 * (mean - 1.0) * rank * 3.0 * u * u + 0.5);
        stand->count = 1 + (uint32_t)maths_min(more, PLANT_PLACEMENT_SQUARE_MAX - 1.0);
        if (i == 0)
            stand->count = PLANT_PLACEMENT_SQUARE_MAX;
        sum += stand->count;
    }
    for (uint32_t i = 0; g->stand_count > 1 && sum != g->growing; i++) {
        uint64_t draw = random_u64(p->seed, 1, i, RANDOM_SQUARE_SIZE);
        struct stand *stand = &g->stands[1 + draw % (g->stand_count - 1)];
        if (sum < g->growing && stand->count < PLANT_PLACEMENT_SQUARE_MAX) {
            stand->count++;
            sum++;
        } else if (sum > g->growing && stand->count > 1) {
            stand->count--;
            sum--;
        }
    }
}

/* Returns true if no spot of the square or its neighbours is so near that the largest objects of
 * the two would touch. */
static int apart(const struct plant_placement *g, double x, double z)
{
    const struct gridsquares *squares = &g->placement->terrain->squares;
    double apart_m = 2.0 * g->placement->grown_m + 0.5;
    struct gridsquare_box box =
        gridsquare_box_of(squares, x - apart_m, z - apart_m, x + apart_m, z + apart_m);
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t square = gridsquare_index(squares, column, row);
            for (uint32_t i = 0; i < g->held[square]; i++) {
                const struct spot *spot = &g->spots[g->first[square] + i];
                double dx = spot->x - x, dz = spot->z - z;
                if (dx * dx + dz * dz < apart_m * apart_m)
                    return 0;
            }
        }
    }
    return 1;
}

/* Trees prefer forest, and stand alone in grass; bushes prefer chaparral. */
static double treeness(const struct object_placement *p, double x, double z, uint32_t number)
{
    static const double of_cover[COVER_COUNT] = {
        [COVER_GRASS] = 0.62, [COVER_CHAPARRAL] = 0.1, [COVER_FOREST] = 1.0, [COVER_ROCK] = 0.2};
    double thicket = noise_at(p->seed + NOISE_THICKET, x / 420.0, z / 420.0);
    double chance = random_unit(p->seed, 3, number, RANDOM_FOREST);
    return of_cover[terrain_cover(p->terrain, x, z)] + 0.55 * chance + 0.25 * thicket;
}

static int find_spot(struct plant_placement *g, uint32_t square, uint32_t number)
{
    const struct object_placement *p = g->placement;
    const struct gridsquares *squares = &p->terrain->squares;
    double x0 = gridsquare_column(squares, square) * squares->side_m;
    double z0 = gridsquare_row(squares, square) * squares->side_m;
    for (uint32_t try = 0; try < TRIES; try++) {
        uint64_t entity = (uint64_t)number << 16 | try;
        double x =
            x0 + random_between(p->seed, square, entity, RANDOM_OBJECT_X, 0, squares->side_m);
        double z =
            z0 + random_between(p->seed, square, entity, RANDOM_OBJECT_Z, 0, squares->side_m);
        if (gridsquare_of(squares, x, z) != square ||
            !object_placement_allows(p, x, z, p->grown_m) || !apart(g, x, z) ||
            !object_placement_clear(p, g->built, x, z, p->grown_m))
            continue;
        g->spots[number] = (struct spot){x, z, treeness(p, x, z, number), number};
        if (g->held[square]++ == 0)
            g->first[square] = number;
        return 0;
    }
    errno = ENOSPC;
    return -1;
}

static int find_spots(struct plant_placement *g)
{
    uint32_t number = 0;
    qsort(g->stands, g->stand_count, sizeof *g->stands, by_square);
    for (uint32_t i = 0; i < g->stand_count; i++)
        for (uint32_t k = 0; k < g->stands[i].count; k++)
            if (find_spot(g, g->stands[i].square, number++) != 0)
                return -1;
    return 0;
}

static void plant_spots(struct plant_placement *g)
{
    struct object_placement *p = g->placement;
    qsort(g->spots, g->growing, sizeof *g->spots, by_treeness);
    for (uint32_t i = 0; i < g->growing; i++) {
        const struct spot *spot = &g->spots[i];
        enum object_class of = i < generate_table1[OBJECT_TREE] ? OBJECT_TREE : OBJECT_BUSH;
        uint16_t kind = object_placement_mixed_kind(p, of, spot->x, spot->z, spot->number);
        double size =
            random_between(p->seed, 4, spot->number, RANDOM_OBJECT_SHAPE,
                           1.0 - OBJECT_PLACEMENT_SIZE_SPREAD, 1.0 + OBJECT_PLACEMENT_SIZE_SPREAD);
        object_placement_add(p, spot->x, spot->z, kind, size);
    }
}

int plant_placement_plant(struct object_placement *placement)
{
    const uint32_t squares = placement->terrain->squares.count;
    struct plant_placement g = {.placement = placement, .built = placement->used};
    g.growing = generate_table1[OBJECT_TREE] + generate_table1[OBJECT_BUSH];
    g.taken = calloc(squares, sizeof *g.taken);
    g.stands = malloc(squares * sizeof *g.stands);
    g.first = calloc(squares, sizeof *g.first);
    g.held = calloc(squares, sizeof *g.held);
    g.spots = malloc(g.growing * sizeof *g.spots);
    int result = -1;
    if (g.taken && g.stands && g.first && g.held && g.spots && choose_squares(&g) == 0) {
        share_out(&g);
        result = find_spots(&g);
        if (result == 0)
            plant_spots(&g);
    }
    free(g.taken);
    free(g.stands);
    free(g.first);
    free(g.held);
    free(g.spots);
    return result;
}
