/* Finds joined walls by their footprints on the map. */
#include "collider/response/joined_walls.h"

#include "collider/response/damage.h"
#include "collider/response/explosion.h"
#include "world/entity/kind.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

/* A footprint: its centre, its two directions and half its sides. */
struct footprint {
    double x, z;
    double along_x, along_z; /* forward; to the right is (-along_z, along_x) */
    double half_length_m, half_width_m;
};

static struct footprint footprint_of(const struct fixed_object *object, const struct kind *kinds)
{
    const struct kind *kind = &kinds[object->kind];
    double heading = fixed_heading(object), half = 0.5 * fixed_scale(object, kind);
    return (struct footprint){object->x,
                              object->z,
                              maths_sin(heading),
                              -maths_cos(heading),
                              half * kind->length_m,
                              half * kind->width_m};
}

/* Half the width of the footprint's shadow on a direction. */
static double reach_along(const struct footprint *f, double x, double z)
{
    return f->half_length_m * fabs(f->along_x * x + f->along_z * z) +
           f->half_width_m * fabs(f->along_x * z - f->along_z * x);
}

static bool apart_along(const struct footprint *p, const struct footprint *q, double x, double z)
{
    double distance = fabs((q->x - p->x) * x + (q->z - p->z) * z);
    return distance > reach_along(p, x, z) + reach_along(q, x, z) + JOINED_WALLS_GAP_M;
}

bool joined_walls_touch(const struct fixed_object *p, const struct fixed_object *q,
                        const struct kind *kinds)
{
    const struct footprint a = footprint_of(p, kinds), b = footprint_of(q, kinds);
    return !apart_along(&a, &b, a.along_x, a.along_z) &&
           !apart_along(&a, &b, -a.along_z, a.along_x) &&
           !apart_along(&a, &b, b.along_x, b.along_z) &&
           !apart_along(&a, &b, -b.along_z, b.along_x);
}

static bool is_wall(const struct world *world, uint32_t object)
{
    return world->kinds[world->fixed[object].kind].object_class == OBJECT_BUILDING;
}

uint32_t joined_walls_find(struct response_context *context, uint32_t object)
{
    const struct world *world = context->world;
    const struct fixed_object *struck = &world->fixed[object];
    struct pair_list *near = &context->charges->near;
    near->count = 0;
    if (!is_wall(world, object))
        return 0;
    const struct path still = {.at = fixed_position(struck)};
    const struct footprint sides = footprint_of(struck, world->kinds);
    double reach = sides.half_length_m + sides.half_width_m + JOINED_WALLS_GAP_M;
    struct path_box box = pair_filter_path_box(&still, reach + pair_filter_slack(world));
    broad_phase_query_fixed(context->broad, &context->input.detect, &box, near);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < near->count; i++) {
        uint32_t other = near->pair[i].b & ~PAIR_FIXED;
        if (other != object && is_wall(world, other) &&
            pair_filter_stands(&context->input.detect, other) &&
            joined_walls_touch(struck, &world->fixed[other], world->kinds))
            near->pair[kept++] = near->pair[i];
    }
    near->count = kept;
    return kept;
}

void joined_walls_damage(struct response_context *context, double joules)
{
    const struct pair_list *near = &context->charges->near;
    for (uint32_t i = 0; i < near->count; i++)
        damage_fixed_object(context, near->pair[i].b & ~PAIR_FIXED, joules / near->count);
}
