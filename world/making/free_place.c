/* Places where vehicles start. */
#include "world/making/free_place.h"

#include "world/maths/random.h"
#include "world/terrain/fixed_index.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>

#define TRIES       1000
#define CLEARANCE_M 1.0
#define EDGE_M      50.0 /* least distance from the world's edge, if the area allows it */
#define SLOPE_SHARE 0.7  /* of the steepest slope that a kind climbs */

int free_place_init(struct free_place *place, const struct terrain *terrain,
                    const struct fixed_object *fixed, const struct kind *kinds,
                    const uint32_t *reach_start, const uint32_t *reach, uint64_t seed)
{
    *place = (struct free_place){.terrain = *terrain,
                                 .fixed = fixed,
                                 .kinds = kinds,
                                 .reach_start = reach_start,
                                 .reach = reach,
                                 .seed = seed};
    place->cell_m = maths_max(FREE_PLACE_CELL_M, terrain->squares.world_m / FREE_PLACE_CELLS_MAX);
    place->cells = (uint32_t)ceil(terrain->squares.world_m / place->cell_m);
    place->head = calloc((size_t)place->cells * place->cells, sizeof *place->head);
    return place->head ? 0 : -1;
}

void free_place_free(struct free_place *place)
{
    free(place->head);
    free(place->taken);
    *place = (struct free_place){0};
}

bool free_place_carries(const struct terrain *terrain, const struct kind *kind, double x, double z)
{
    return kind->domain == DOMAIN_AIR ||
           (kind->domain == DOMAIN_SEA) == cover_is_water(terrain_cover(terrain, x, z));
}

static bool ground_suits(const struct free_place *place, const struct kind *kind, double x,
                         double z)
{
    bool water = cover_is_water(terrain_cover(&place->terrain, x, z));
    switch ((enum domain)kind->domain) {
    case DOMAIN_LAND: {
        struct vec3 normal = terrain_normal(&place->terrain, NULL, x, z);
        return !water && normal.y > maths_cos(kind->max_slope_rad * SLOPE_SHARE);
    }
    case DOMAIN_SEA: /* room to turn */
        for (int i = 0; i < 8; i++) {
            double sine, cosine;
            maths_sincos(i * (PI / 4.0), &sine, &cosine);
            if (!cover_is_water(
                    terrain_cover(&place->terrain, x + 250.0 * sine, z + 250.0 * cosine)))
                return false;
        }
        return water;
    default:
        return true;
    }
}

/* The row or column of cells in which a coordinate is. */
static uint32_t cell_at(const struct free_place *place, double m)
{
    double cell = floor(m / place->cell_m);
    return cell < 0.0 ? 0 : cell < place->cells ? (uint32_t)cell : place->cells - 1;
}

static bool clear_of_vehicles(const struct free_place *place, double x, double z, double reach_m)
{
    double reach = reach_m + place->largest_m + CLEARANCE_M;
    for (uint32_t row = cell_at(place, z - reach); row <= cell_at(place, z + reach); row++) {
        for (uint32_t column = cell_at(place, x - reach); column <= cell_at(place, x + reach);
             column++) {
            uint32_t next = place->head[row * place->cells + column];
            while (next != 0) {
                const struct free_place_taken *other = &place->taken[next - 1];
                double dx = other->x - x, dz = other->z - z;
                double gap = reach_m + other->reach_m + CLEARANCE_M;
                if (dx * dx + dz * dz < gap * gap)
                    return false;
                next = other->next;
            }
        }
    }
    return true;
}

static bool clear_of_objects(const struct free_place *place, double x, double z, double reach_m)
{
    double reach = reach_m + CLEARANCE_M;
    struct gridsquare_box box =
        gridsquare_box_of(&place->terrain.squares, x - reach, z - reach, x + reach, z + reach);
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t square = gridsquare_index(&place->terrain.squares, column, row);
            for (uint32_t i = place->reach_start[square]; i < place->reach_start[square + 1]; i++) {
                const struct fixed_object *object = &place->fixed[place->reach[i]];
                double dx = object->x - x, dz = object->z - z;
                double gap = reach + fixed_index_of_fixed(object, place->kinds);
                if (dx * dx + dz * dz < gap * gap)
                    return false;
            }
        }
    }
    return true;
}

/* The vehicles are tested first: in a crowd they exclude most points. */
static bool free_and_fit(const struct free_place *place, const struct kind *kind, double x,
                         double z, double reach_m)
{
    return clear_of_vehicles(place, x, z, reach_m) && ground_suits(place, kind, x, z) &&
           (kind->domain == DOMAIN_AIR || clear_of_objects(place, x, z, reach_m));
}

/* Narrows a range to keep away from the world's edge, unless nothing would be left of it. */
static void leave_edge(const struct free_place *place, double *low, double *high)
{
    double from = maths_max(*low, EDGE_M),
           to = maths_min(*high, place->terrain.squares.world_m - EDGE_M);
    if (from < to) {
        *low = from;
        *high = to;
    }
}

bool free_place_suits(const struct free_place *place, const struct kind *kind, double x, double z)
{
    double reach = fixed_index_of_kind(kind);
    double last = place->terrain.squares.world_m - EDGE_M;
    return x >= EDGE_M && z >= EDGE_M && x <= last && z <= last &&
           free_and_fit(place, kind, x, z, reach);
}

int free_place_find(struct free_place *place, const struct area *area, const struct kind *kind,
                    uint32_t slot, double *x, double *z)
{
    double x0 = area->x0, x1 = area->x1, z0 = area->z0, z1 = area->z1;
    double reach = fixed_index_of_kind(kind);
    leave_edge(place, &x0, &x1);
    leave_edge(place, &z0, &z1);
    for (uint64_t i = 0; i < TRIES; i++) {
        *x = random_between(place->seed, i, slot, RANDOM_PLACE_X, x0, x1);
        *z = random_between(place->seed, i, slot, RANDOM_PLACE_Z, z0, z1);
        if (free_and_fit(place, kind, *x, *z, reach))
            return 0;
    }
    return -1;
}

int free_place_take(struct free_place *place, double x, double z, double reach_m)
{
    if (place->count == place->capacity) {
        uint32_t capacity = place->capacity * 2 + 256;
        struct free_place_taken *taken = realloc(place->taken, capacity * sizeof *taken);
        if (!taken)
            return -1;
        place->taken = taken;
        place->capacity = capacity;
    }
    uint32_t *head = &place->head[cell_at(place, z) * place->cells + cell_at(place, x)];
    place->taken[place->count] = (struct free_place_taken){x, z, reach_m, *head};
    *head = ++place->count;
    place->largest_m = maths_max(place->largest_m, reach_m);
    return 0;
}
