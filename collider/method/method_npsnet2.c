/* NPSNET-2's three levels at the frame's end (Osborne 1991, pp. 9-13 and 15-18). How the text is
 * read here:
 *   - every vehicle that has moved is tested; below the threshold height first against the fixed
 *     objects attached to the gridsquare of its centre and no other (so Fig. 9's border object is
 *     found late); then, without a hit, against every other body;
 *   - a pair is found when either of the two finds it;
 *   - every frame in which the two overlap is a detection;
 *   - all bodies are where they are at the frame's end. NPSNET-2 tested each vehicle as soon as it
 * had moved, when those after it had not. */
#include "collider/method/method_npsnet2.h"

#include "collider/geometry/ray_polygon.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

struct body {
    struct vec3 at;
    double radius_m;
};

/* --- levels ------------------------------------------------------------------------------------*/

/* Level 1. */
static bool near(enum nearness nearness, struct vec3 a, struct vec3 b)
{
    bool near_x = fabs(b.x - a.x) <= METHOD_NPSNET2_NEAR_M,
         near_z = fabs(b.z - a.z) <= METHOD_NPSNET2_NEAR_M;
    return nearness == NEARNESS_OR ? near_x || near_z : near_x && near_z;
}

/* Level 2. */
static bool spheres_overlap(const struct body *a, const struct body *b)
{
    struct vec3 gap = vec3_sub(b->at, a->at);
    double reach = a->radius_m + b->radius_m;
    return vec3_dot(gap, gap) < reach * reach;
}

static struct body body_of_row(const struct method_input *input, uint32_t row)
{
    return (struct body){entities_position(input->entities, row),
                         METHOD_NPSNET2_RADIUS_SHARE * pair_filter_row_reach(input, row)};
}

static double scale_of(const struct world *world, const struct fixed_object *object)
{
    return fixed_scale(object, &world->kinds[object->kind]);
}

static struct body body_of_fixed(const struct world *world, const struct fixed_object *object)
{
    double reach = world->params->collision.shape == SHAPE_MODEL
                       ? world->kinds[object->kind].bound_m * scale_of(world, object)
                       : (double)object->radius_m;
    return (struct body){fixed_position(object), METHOD_NPSNET2_RADIUS_SHARE * reach};
}

static struct ray_polygon_model model_of_row(const struct method_input *input, uint32_t row)
{
    const struct entities *e = input->entities;
    return (struct ray_polygon_model){
        .world = input->world,
        .model = input->world->kinds[e->row[row].kind].model,
        .scale = 1.0,
        .turn =
            rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll)),
        .at = entities_position(e, row),
        .middle_m = mass_properties_of(&input->world->kinds[e->row[row].kind]).centre_m};
}

static struct ray_polygon_model model_of_fixed(const struct world *world,
                                               const struct fixed_object *object)
{
    return (struct ray_polygon_model){
        .world = world,
        .model = world->kinds[object->kind].model,
        .scale = scale_of(world, object),
        .turn = rotation_matrix(rotation_of(fixed_heading(object), 0.0, 0.0)),
        .at = fixed_position(object)};
}

/* Level 3: returns true if the row touches the other body by the two rays. */
static bool polygons_touch(const struct method_input *input, uint32_t row, uint32_t other)
{
    const struct world *world = input->world;
    if (world->params->collision.shape != SHAPE_MODEL)
        return true;
    const struct fixed_object *object =
        other & PAIR_FIXED ? &world->fixed[other & ~PAIR_FIXED] : NULL;
    struct ray_polygon_model here = model_of_row(input, row);
    struct ray_polygon_model there =
        object ? model_of_fixed(world, object) : model_of_row(input, other);
    struct body body = object ? body_of_fixed(world, object) : body_of_row(input, other);
    struct ray_polygon_hit hit;
    return ray_polygon_collision(&here, body_of_row(input, row).radius_m, &there, body.radius_m,
                                 &hit);
}

/* --- against fixed objects ---------------------------------------------------------------------*/

static bool below_threshold(const struct method_input *input, struct vec3 at)
{
    return at.y < terrain_height(&input->world->terrain, input->craters, at.x, at.z) +
                      input->world->params->collision.threshold_height_m;
}

/* Adds the objects of the row's gridsquare that it hits, and returns their number. */
static uint32_t hit_fixed(const struct method_input *input, uint32_t row, struct pair_list *pairs)
{
    const struct world *world = input->world;
    struct body body = body_of_row(input, row);
    uint32_t square = gridsquare_of(&world->terrain.squares, body.at.x, body.at.z);
    const uint32_t *objects;
    uint32_t hits = 0;
    if (world->counts.fixed == 0 || !below_threshold(input, body.at))
        return 0;
    uint32_t count = world_reach(world, square, &objects);
    for (uint32_t n = 0; n < count; n++) {
        const struct fixed_object *object = &world->fixed[objects[n]];
        struct body other = body_of_fixed(world, object);
        if (gridsquare_of(&world->terrain.squares, object->x, object->z) != square ||
            !pair_filter_stands(input, objects[n]) || !spheres_overlap(&body, &other) ||
            !polygons_touch(input, row, objects[n] | PAIR_FIXED))
            continue;
        pair_list_add(pairs, row, objects[n] | PAIR_FIXED);
        hits++;
    }
    return hits;
}

/* --- against moving objects --------------------------------------------------------------------*/

struct vehicle {
    struct body body;
    uint32_t row;
    bool looks; /* it has moved and hit no fixed object, so it is tested against all others */
};

/* Lists every used row and adds its pairs with fixed objects. */
static size_t list_vehicles(const struct method_input *input, struct vehicle *vehicle,
                            struct pair_list *pairs)
{
    size_t count = 0;
    for (uint32_t i = 0; i < input->rows; i++) {
        bool moves = !pair_filter_rests(&input->path[i]);
        if (!pair_filter_there(input, i))
            continue;
        uint32_t hits = moves ? hit_fixed(input, i, pairs) : 0;
        vehicle[count++] = (struct vehicle){body_of_row(input, i), i, moves && hits == 0};
    }
    return count;
}

static bool found(const struct method_input *input, const struct vehicle *a,
                  const struct vehicle *b)
{
    return spheres_overlap(&a->body, &b->body) && !pair_excluded(input, a->row, b->row) &&
           ((a->looks && polygons_touch(input, a->row, b->row)) ||
            (b->looks && polygons_touch(input, b->row, a->row)));
}

void method_npsnet2_pairs(const struct method_input *input, struct method_workspace *workspace,
                          struct pair_list *pairs)
{
    enum nearness nearness = (enum nearness)input->world->params->collision.nearness;
    struct vehicle *vehicle = method_block(workspace, 0, input->rows, sizeof *vehicle);
    size_t count = list_vehicles(input, vehicle, pairs);
    for (size_t a = 0; a < count; a++) {
        work_done();
        for (size_t b = a + 1; b < count; b++) {
            if (near(nearness, vehicle[a].body.at, vehicle[b].body.at) &&
                found(input, &vehicle[a], &vehicle[b]))
                pair_list_add(pairs, vehicle[a].row, vehicle[b].row);
        }
    }
}

struct method_npsnet2_level1 method_npsnet2_level1(const struct method_input *input)
{
    struct method_npsnet2_level1 level1 = {0};
    for (uint32_t a = 0; a < input->rows; a++) {
        for (uint32_t b = a + 1; pair_filter_there(input, a) && b < input->rows; b++) {
            struct vec3 p = entities_position(input->entities, a),
                        q = entities_position(input->entities, b);
            if (!pair_filter_there(input, b))
                continue;
            level1.pairs++;
            level1.kept[NEARNESS_OR] += near(NEARNESS_OR, p, q);
            level1.kept[NEARNESS_AND] += near(NEARNESS_AND, p, q);
        }
    }
    return level1;
}
