/* Parts by the triangles, pivots by the corners, reach by the vertices of the hulls. */
#include "config/mesh/model_parts.h"

#include "config/mesh/hulls.h"
#include "world/entity/hull.h"
#include "world/making/scenario.h"

#include <stdbool.h>

#define END_M   0.02f               /* corners this near to the end of a part belong to the end */
#define STEP    (0.5 * RAD_PER_DEG) /* of the gun's elevation, when its reach is measured [rad] */
#define CORNERS 3u

/* --- parts -------------------------------------------------------------------------------------*/

static enum hull_part part_of(const struct model_triangle *triangle)
{
    if (triangle->part == PART_TURRET)
        return HULL_PART_TURRET;
    return triangle->part == PART_GUN ? HULL_PART_GUN : HULL_PART_BODY;
}

void model_parts_of_vertices(uint8_t *part, const struct scenario *scenario,
                             const struct model *model)
{
    const struct model_triangle *triangle = &scenario->triangles[model->first_triangle];
    uint32_t count = model_solid_triangles(model);
    uint32_t seen = 0;
    for (uint32_t t = 0; t < count; t++)
        seen |= 1u << part_of(&triangle[t]);
    bool splits = seen >> HULL_PART_TURRET & 1u && seen >> HULL_PART_BODY & 1u;
    for (uint32_t t = 0; splits && t < count; t++) {
        for (uint32_t c = 0; c < CORNERS; c++)
            part[triangle[t].vertex[c]] = (uint8_t)part_of(&triangle[t]);
    }
}

/* --- pivots ------------------------------------------------------------------------------------*/

/* A box around corners. */
struct corner_box {
    float low[3], high[3];
};

/* Returns the box around the corners of a part of the visible model that are not beyond `until`
 * along an axis. Of several joints the first counts. */
static struct corner_box box_of(const struct scenario *scenario, const struct model *model,
                                enum model_part part, int axis, float until)
{
    struct corner_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    const struct model_vertex *vertex = &scenario->vertices[model->first_vertex];
    uint16_t joint = UINT16_MAX;
    for (uint32_t t = model->solid_triangles; t < model->triangle_count; t++) {
        const struct model_triangle *triangle = &scenario->triangles[model->first_triangle + t];
        if (triangle->part != part || (joint != UINT16_MAX && triangle->joint != joint))
            continue;
        joint = triangle->joint;
        for (uint32_t c = 0; c < CORNERS; c++) {
            const struct model_vertex *v = &vertex[triangle->vertex[c]];
            const float at[3] = {v->x, v->y, v->z};
            for (int i = 0; at[axis] <= until && i < 3; i++) {
                box.low[i] = fminf(box.low[i], at[i]);
                box.high[i] = fmaxf(box.high[i], at[i]);
            }
        }
    }
    return box;
}

struct vec3 model_parts_pivot(const struct scenario *scenario, const struct model *model,
                              enum model_part part)
{
    int axis = part == PART_TURRET ? 1 : 0;
    struct corner_box box = box_of(scenario, model, part, axis, INFINITY);
    if (!(box.low[0] <= box.high[0]))
        return (struct vec3){0.0, 0.0, 0.0};
    box = box_of(scenario, model, part, axis, box.low[axis] + END_M);
    return (struct vec3){(double)(0.5f * (box.low[0] + box.high[0])),
                         (double)(0.5f * (box.low[1] + box.high[1])),
                         (double)(0.5f * (box.low[2] + box.high[2]))};
}

/* --- reach -------------------------------------------------------------------------------------*/

/* Returns how far a point reaches from the position when the turret turns. */
static double turned_reach(const struct hulls *hulls, struct vec3 point)
{
    double px = hulls->turret_pivot.x, pz = hulls->turret_pivot.z;
    double dx = point.x - px, dz = point.z - pz;
    double level = sqrt(px * px + pz * pz) + sqrt(dx * dx + dz * dz);
    return sqrt(level * level + point.y * point.y);
}

/* The same when the gun is raised and lowered too. Between two steps the point moves by less than
 * its distance from the gun's pivot times the step. */
static double raised_reach(const struct hulls *hulls, struct vec3 point, double low, double high)
{
    double dx = point.x - hulls->gun_pivot.x, dy = point.y - hulls->gun_pivot.y, most = 0.0;
    uint32_t steps = (uint32_t)((high - low) / STEP) + 1;
    for (uint32_t i = 0; i <= steps; i++) {
        double sine, cosine;
        maths_sincos(maths_min(low + i * STEP, high), &sine, &cosine);
        struct vec3 raised = {hulls->gun_pivot.x + cosine * dx - sine * dy,
                              hulls->gun_pivot.y + sine * dx + cosine * dy, point.z};
        most = maths_max(most, turned_reach(hulls, raised));
    }
    return most + STEP * sqrt(dx * dx + dy * dy);
}

double model_parts_reach(const struct hulls *hulls, const struct scenario *scenario,
                         double gun_low_rad, double gun_high_rad)
{
    double reach = hulls->bound_m;
    for (uint32_t h = hulls->first; hulls->parts > 0 && h < hulls->first + hulls->count; h++) {
        const struct hull *hull = &scenario->hulls[h];
        const struct vec3 *vertex = &scenario->hull_vertices[hull->first_vertex];
        for (uint32_t v = 0; hull->part != HULL_PART_BODY && v < hull->vertex_count; v++) {
            double far = hull->part == HULL_PART_TURRET
                             ? turned_reach(hulls, vertex[v])
                             : raised_reach(hulls, vertex[v], gun_low_rad, gun_high_rad);
            reach = maths_max(reach, far);
        }
    }
    return reach;
}
