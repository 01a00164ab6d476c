/* Random places, often on the corners and borders of gridsquares. */
#include "tests/support/spread.h"

#include "tests/support/fixture.h"
#include "world/terrain/gridsquare.h"

struct spread spread_draw(uint64_t *random, double widest)
{
    const double extents[] = {0.0, 3.0, 40.0, 300.0, widest};
    struct spread place = {fixture_uniform(random, 0, WORLD_SIDE_DEFAULT_M),
                           fixture_uniform(random, 0, WORLD_SIDE_DEFAULT_M),
                           extents[fixture_random(random) % 5]};
    switch (fixture_random(random) % 4) {
    case 0: /* on a corner of four squares */
        place.x = GRIDSQUARE_LEAST_M * floor(place.x / GRIDSQUARE_LEAST_M);
        place.z = GRIDSQUARE_LEAST_M * floor(place.z / GRIDSQUARE_LEAST_M);
        break;
    case 1: /* on a border of two squares */
        place.x = GRIDSQUARE_LEAST_M * floor(place.x / GRIDSQUARE_LEAST_M);
        break;
    case 2: /* at a corner of the world, and beyond it */
        place.x = place.z = fixture_random(random) & 1 ? 0.0 : WORLD_SIDE_DEFAULT_M;
        break;
    default:
        break;
    }
    return place;
}

struct vec3 spread_point(const struct spread *place, uint64_t *random)
{
    double half = 0.5 * place->extent;
    struct vec3 p = {place->x + fixture_uniform(random, -half, half),
                     fixture_uniform(random, 0.0, 0.2 * place->extent + 1.0),
                     place->z + fixture_uniform(random, -half, half)};
    if (fixture_random(random) % 8 == 0) /* exactly on a border */
        p.x = GRIDSQUARE_LEAST_M * floor(p.x / GRIDSQUARE_LEAST_M);
    return p;
}
