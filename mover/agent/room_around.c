/* Gathers fixed objects, vehicles and craters. */
#include "mover/agent/room_around.h"

#include "mover/agent/avoidance.h"
#include "mover/query/neighbour_index.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/crater.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stddef.h>

#define CIRCLES     2.0 /* radii of its tightest circle: so far it gets when it turns about */
#define BESIDE_M    2.0 /* and its gaps */
#define LEAST_M     0.5 /* radius of the tightest circle, at least */
#define GUN_HALF_M  0.2 /* half the width of a gun */
#define VEHICLES_M  6.0 /* how far others reach from their places, at most */
#define UPRIGHT_GAP 1.0 /* above and below it others do not matter */

static bool has_models(const struct step_context *context)
{
    return context->world->params->collision.shape == SHAPE_MODEL;
}

/* Its own rectangle, with its gun where it points; where spheres collide, the square around its
 * sphere. */
static void find_footprint(const struct step_context *context, uint32_t i,
                           struct shunting_room *room)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const double gun_m = context->avoidance->nose_m[m->row[i].kind];
    double sine = 0.0, cosine = 1.0;
    if (!has_models(context)) {
        room->front_m = room->rear_m = room->right_m = room->left_m = kind->radius_m;
        return;
    }
    if (kind->part_count > 0)
        maths_sincos((double)m->row[i].turret, &sine, &cosine);
    room->front_m = maths_max(0.5 * kind->length_m, gun_m * cosine);
    room->rear_m = maths_max(0.5 * kind->length_m, -gun_m * cosine);
    room->right_m = maths_max(0.5 * kind->width_m, gun_m * sine);
    room->left_m = maths_max(0.5 * kind->width_m, -gun_m * sine);
}

/* --- fixed objects -----------------------------------------------------------------------------*/

static void add_disc(struct shunting_room *room, double x, double z, double radius_m)
{
    shunting_room_add(room,
                      &(struct shunting_obstacle){.x = x, .z = z, .ux = 1.0, .border_m = radius_m});
}

static void add_object(const struct step_context *context, const struct fixed_object *object,
                       struct shunting_room *room)
{
    const uint32_t boxes = avoidance_boxes(context, object);
    if (boxes == 0)
        add_disc(room, object->x, object->z, avoidance_disc(context, object));
    for (uint32_t n = 0; n < boxes; n++) {
        const struct avoidance_box_placed box = avoidance_box_of(context, object, n);
        shunting_room_add(room, &(struct shunting_obstacle){.x = box.x,
                                                            .z = box.z,
                                                            .ux = box.ux,
                                                            .uz = box.uz,
                                                            .half_m = box.half_m,
                                                            .half_width = box.half_width});
    }
}

static void add_square(const struct step_context *context, uint32_t i, double reach_m,
                       uint32_t square, struct shunting_room *room)
{
    const struct world *world = context->world;
    const struct entities *m = context->m;
    const uint32_t *objects;
    const uint32_t count = world_reach(world, square, &objects);
    for (uint32_t n = 0; n < count; n++) {
        const struct fixed_object *object = &world->fixed[objects[n]];
        const double dx = object->x - m->row[i].x, dz = object->z - m->row[i].z;
        const double most = reach_m + (double)object->radius_m;
        if (dx * dx + dz * dz > most * most || !avoidance_harms(context, i, objects[n]))
            continue;
        add_object(context, object, room);
    }
}

static void add_fixed(const struct step_context *context, uint32_t i, double reach_m,
                      struct shunting_room *room)
{
    const struct entities *m = context->m;
    const struct gridsquares *squares = &context->world->terrain.squares;
    const struct gridsquare_box box =
        gridsquare_box_of(squares, m->row[i].x - reach_m, m->row[i].z - reach_m,
                          m->row[i].x + reach_m, m->row[i].z + reach_m);
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++)
            add_square(context, i, reach_m, gridsquare_index(squares, column, row), room);
    }
}

/* --- vehicles ----------------------------------------------------------------------------------*/

static void add_vehicle(const struct step_context *context, uint32_t j, struct shunting_room *room)
{
    const struct entities *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[w->row[j].kind];
    const struct vec3 at = step_context_position(context, w, j);
    const double gun_m = context->avoidance->nose_m[w->row[j].kind];
    const double heading = step_context_heading(context, w, j);
    double sine, cosine;
    if (!has_models(context)) {
        add_disc(room, at.x, at.z, kind->radius_m);
        return;
    }
    maths_sincos(heading, &sine, &cosine);
    shunting_room_add(room, &(struct shunting_obstacle){.x = at.x,
                                                        .z = at.z,
                                                        .ux = sine,
                                                        .uz = -cosine,
                                                        .half_m = 0.5 * kind->length_m,
                                                        .half_width = 0.5 * kind->width_m});
    if (gun_m <= 0.5 * kind->length_m)
        return;
    maths_sincos(heading + (kind->part_count > 0 ? (double)w->row[j].turret : 0.0), &sine, &cosine);
    shunting_room_add(room, &(struct shunting_obstacle){.x = at.x + 0.5 * gun_m * sine,
                                                        .z = at.z - 0.5 * gun_m * cosine,
                                                        .ux = sine,
                                                        .uz = -cosine,
                                                        .half_m = 0.5 * gun_m,
                                                        .half_width = GUN_HALF_M});
}

static void add_vehicles(const struct step_context *context, uint32_t i, double reach_m,
                         struct shunting_room *room)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    struct neighbour_query query =
        neighbour_query_begin(context->neighbours, NEIGHBOUR_INDEX_ALL, m->row[i].x, m->row[i].z,
                              reach_m + VEHICLES_M + avoidance_ahead(context));
    for (const struct neighbour_index_entry *entry = neighbour_query_next(&query); entry != NULL;
         entry = neighbour_query_next(&query)) {
        const uint32_t j = entry->row;
        const struct vec3 at = step_context_position(context, w, j);
        const struct vec3 v = step_context_velocity(context, w, j);
        const double high = 0.5 * (kind->height_m + context->world->kinds[w->row[j].kind].height_m);
        if (j != i && fabs(at.y - m->row[i].y) <= high + UPRIGHT_GAP &&
            v.x * v.x + v.z * v.z < ROOM_AROUND_STANDS_MPS * ROOM_AROUND_STANDS_MPS)
            add_vehicle(context, j, room);
    }
}

/* --- craters -----------------------------------------------------------------------------------*/

static void add_craters(const struct step_context *context, uint32_t i, double reach_m,
                        struct shunting_room *room)
{
    const struct entity *m = &context->m->row[i];
    struct crater_walk walk = crater_walk_begin(context->craters, m->x, m->z, reach_m);
    const struct crater *crater;
    while ((crater = crater_walk_next(&walk)) != NULL) {
        const double dx = crater->x - m->x, dz = crater->z - m->z;
        if (dx * dx + dz * dz < reach_m * reach_m && avoidance_goes_around(context, i, crater))
            add_disc(room, crater->x, crater->z, (double)crater->radius_m);
    }
}

struct shunting_room room_around(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    struct shunting_room room = {
        .x = m->row[i].x, .z = m->row[i].z, .circle_m = maths_max(kind->least_turn_m, LEAST_M)};
    const double reach_m = CIRCLES * room.circle_m + kind->length_m + BESIDE_M;
    find_footprint(context, i, &room);
    add_fixed(context, i, reach_m, &room);
    add_vehicles(context, i, reach_m, &room);
    add_craters(context, i, reach_m, &room);
    return room;
}
