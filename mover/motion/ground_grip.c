/* The table of grips, after Wong, "Theory of Ground Vehicles": asphalt 0.8, firm dirt 0.65, loose
 * earth less; rolling resistance of tyres 0.015 on a road, 0.05 on dirt and 0.15 on sand, of tracks
 * 0.04 to 0.1. */
#include "mover/motion/ground_grip.h"

#include "mover/query/ground_debris.h"
#include "mover/query/ground_marks.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

static const struct ground_grip table[COVER_COUNT] = {
    [COVER_GRASS] = {0.65, 0.05, 0.045}, [COVER_CHAPARRAL] = {0.65, 0.06, 0.05},
    [COVER_FOREST] = {0.6, 0.06, 0.05},  [COVER_ROCK] = {0.75, 0.03, 0.04},
    [COVER_SAND] = {0.55, 0.15, 0.1},    [COVER_ROAD] = {0.8, 0.015, 0.035},
    [COVER_SEA] = {0.4, 0.15, 0.1},      [COVER_LAKE] = {0.4, 0.15, 0.1},
};

static const struct ground_grip crater_mud = {0.5, 0.12, 0.08}, debris = {0.55, 0.1, 0.07};

struct ground_grip ground_grip_of(enum cover cover)
{
    return table[cover];
}

struct ground_grip ground_grip_at(const struct step_context *context, double x, double z)
{
    uint8_t marks = ground_marks_at(context->ground_marks, x, z);
    if (marks & GROUND_MARKS_CRATER && crater_offset(context->craters, x, z) < 0.0)
        return crater_mud;
    if (marks & GROUND_MARKS_DEBRIS && ground_debris_lies(context->world, context->committed, x, z))
        return debris;
    const struct terrain *terrain = &context->world->terrain;
    struct ground_grip grip = table[terrain_cover(terrain, x, z)];
    grip.friction *= earthwork_grip(&terrain->earthworks, x, z);
    return grip;
}
