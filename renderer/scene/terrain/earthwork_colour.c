/* Colours earthworks by their shape, their slope and their water. */
#include "renderer/scene/terrain/earthwork_colour.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/terrain/terrain.h"

#define SLOPE_LEAST_M 0.3  /* slopes are measured over a texel, but no shorter */
#define LIME_FROM_M   0.25 /* the line around a work, from its edge */
#define LIME_WIDTH_M  0.35
#define LIME_TEXEL_M  1.5 /* coarser pictures show no line */
#define JOINT_M       5.0 /* between the joints of concrete */
#define JOINT_WIDTH_M 0.12
#define DEEP_M        1.5 /* the bed of deeper water does not show */

struct colour {
    float r, g, b;
};

static const struct colour packed = {0.640f, 0.560f, 0.440f};
static const struct colour face = {0.470f, 0.370f, 0.255f};
static const struct colour dug = {0.360f, 0.275f, 0.185f};
static const struct colour mud = {0.400f, 0.335f, 0.235f};
static const struct colour shallow = {0.270f, 0.390f, 0.360f};
static const struct colour deep = {0.110f, 0.250f, 0.310f};
static const struct colour concrete = {0.480f, 0.500f, 0.520f};
static const struct colour puddle = {0.340f, 0.385f, 0.430f};
static const struct colour lime = {0.930f, 0.920f, 0.880f};

static struct colour mix(struct colour a, struct colour b, double share)
{
    float t = (float)maths_clamp(share, 0.0, 1.0);
    return (struct colour){a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

/* Rise of the works a metre to the east and to the south. */
struct slope {
    double east, south;
};

static struct slope slope_at(const struct terrain *terrain, const struct earthwork_view *view,
                             double x, double z)
{
    double reach = 0.5 * maths_max(view->step_m, SLOPE_LEAST_M);
    double scale = 0.5 * view->relief / reach;
    const struct earthworks *works = &terrain->earthworks;
    return (struct slope){
        (earthwork_offset(works, x + reach, z) - earthwork_offset(works, x - reach, z)) * scale,
        (earthwork_offset(works, x, z + reach) - earthwork_offset(works, x, z - reach)) * scale};
}

/* The sun's light on the slope, less that on level ground. */
static double light_on(const struct slope *slope, struct vec3 sun)
{
    double length = sqrt(1.0 + slope->east * slope->east + slope->south * slope->south);
    return (sun.y - slope->east * sun.x - slope->south * sun.z) / length - sun.y;
}

/* A point in the work's own axes [m]: from its back end and from its left side. */
struct work_point {
    double along, across;
};

static struct work_point point_of(const struct earthwork *work, double x, double z)
{
    double dx = x - work->x, dz = z - work->z;
    return (struct work_point){work->half_length + dx * work->sine - dz * work->cosine,
                               work->half_width + dx * work->cosine + dz * work->sine};
}

double earthwork_colour_inside(const struct earthwork *work, double x, double z)
{
    struct work_point at = point_of(work, x, z);
    return maths_min(maths_min(at.along, 2.0 * work->half_length - at.along),
                     maths_min(at.across, 2.0 * work->half_width - at.across));
}

static bool on_joint(const struct earthwork *work, double x, double z)
{
    struct work_point at = point_of(work, x, z);
    double along = fabs(at.along - JOINT_M * floor(at.along / JOINT_M + 0.5));
    double across = fabs(at.across - JOINT_M * floor(at.across / JOINT_M + 0.5));
    return maths_min(along, across) < JOINT_WIDTH_M;
}

static struct colour ground_of(const struct earthwork *work, const struct slope *slope, double x,
                               double z)
{
    double steep = sqrt(slope->east * slope->east + slope->south * slope->south);
    double lump = 0.5 + 0.5 * (double)value_noise_value(x / 1.7, z / 1.7, 91);
    if (work->shape == EARTHWORK_SKID_PAN)
        return mix(concrete, puddle,
                   0.35 * lump + 1.6 * (double)value_noise_value(x / 7.0, z / 7.0, 92));
    if (work->shape == EARTHWORK_TRENCH)
        return mix(dug, face, 0.4 * lump);
    if (work->shape == EARTHWORK_FORD)
        return mix(mud, face, 0.5 * lump);
    return mix(mix(packed, face, 0.25 * lump), face, (steep - 0.25) / 0.6);
}

struct earthwork_look earthwork_colour_at(const struct terrain *terrain,
                                          const struct earthwork *work,
                                          const struct earthwork_view *view, double x, double z)
{
    double depth = terrain_water_depth(terrain, x, z);
    struct slope slope = slope_at(terrain, view, x, z);
    struct colour colour = ground_of(work, &slope, x, z);
    bool fine = view->step_m < LIME_TEXEL_M;
    double edge = earthwork_colour_inside(work, x, z);
    if (work->shape == EARTHWORK_SKID_PAN && fine && on_joint(work, x, z))
        colour = mix(colour, puddle, 0.7);
    if (work->shape != EARTHWORK_FORD && fine && edge > LIME_FROM_M &&
        edge < LIME_FROM_M + LIME_WIDTH_M)
        colour = mix(colour, lime, 0.85);
    if (edge < 0.0)
        colour = work->height_m > 0.0 ? face : dug;
    if (depth > 0.0)
        colour = mix(shallow, deep, depth / DEEP_M);
    double light = depth > 0.0 ? 0.0 : light_on(&slope, view->sun);
    return (struct earthwork_look){colour.r, colour.g, colour.b, (float)light, depth > 0.0};
}
