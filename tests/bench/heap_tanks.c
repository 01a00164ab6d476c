/* Puts tanks in rings around the middle of a level world, all heading inwards. */
#include "tests/bench/heap_tanks.h"

#include "ipc/process/log.h"
#include "tests/bench/world.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"

#include <stdlib.h>

#define SPACING_M 9.0 /* between rings, and about between the tanks of a ring */

static void place(struct heap_tanks *tanks)
{
    uint32_t placed = 0;
    for (uint32_t ring = 1; placed < tanks->count; ring++) {
        uint32_t here = (uint32_t)(TWO_PI * ring);
        for (uint32_t i = 0; i < here && placed < tanks->count; i++, placed++) {
            double sine, cosine;
            maths_sincos(TWO_PI * i / here, &sine, &cosine);
            tanks->place[placed] = (struct heap_place){SPACING_M * ring * sine,
                                                       -SPACING_M * ring * cosine, -sine, cosine};
        }
    }
}

static void take_hulls(struct heap_hulls *hulls, const struct world *world, uint32_t first,
                       uint32_t count)
{
    *hulls = (struct heap_hulls){.shape = calloc(count, sizeof *hulls->shape), .count = count};
    for (uint32_t i = 0; i < count; i++) {
        const struct hull *hull = &world->hulls[first + i];
        if (!hulls->shape || hull_shape_find(&hulls->shape[i], world, hull) != 0)
            die_refused("out of memory");
        for (uint32_t v = 0; v < hull->vertex_count; v++)
            hulls->reach_m = maths_max(hulls->reach_m, vec3_length(hulls->shape[i].vertex[v]));
    }
}

static void take_box(struct heap_scene *scene, const struct kind *kind)
{
    static struct vec3 corner[HEAP_BOX_CORNERS];
    static struct hull box = {.vertex_count = HEAP_BOX_CORNERS};
    const struct world alone = {.hulls = &box, .hull_vertices = corner};
    double *half = scene->tanks.half_m;
    half[0] = 0.5 * kind->length_m;
    half[1] = 0.5 * kind->height_m;
    half[2] = 0.5 * kind->width_m;
    for (uint32_t i = 0; i < HEAP_BOX_CORNERS; i++)
        corner[i] = (struct vec3){i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1],
                                  i & 4 ? half[2] : -half[2]};
    box.radius_m = vec3_length(corner[0]);
    take_hulls(&scene->box, &alone, 0, 1);
}

void heap_tanks_open(struct heap_scene *scene, uint32_t count)
{
    *scene = (struct heap_scene){.tanks = {.count = count}};
    scene->tanks.place = calloc(count, sizeof *scene->tanks.place);
    if (!scene->tanks.place)
        die_refused("out of memory");
    place(&scene->tanks);
    bench_world_tanks(&scene->view, &scene->tanks);
    const struct world *world = &scene->view.world;
    const struct kind *kind = &world->kinds[kind_find(world->kinds, world->counts.kinds, "tank")];
    scene->tanks.mass_kg = kind->mass_kg;
    scene->tanks.acceleration_mps2 = kind->acceleration_mps2;
    scene->tanks.view = &scene->view;
    take_hulls(&scene->model, world, kind->first_hull, kind->hull_count);
    take_box(scene, kind);
}

static void drop_hulls(struct heap_hulls *hulls)
{
    for (uint32_t i = 0; i < hulls->count; i++)
        hull_shape_free(&hulls->shape[i]);
    free(hulls->shape);
}

void heap_tanks_close(struct heap_scene *scene)
{
    drop_hulls(&scene->model);
    drop_hulls(&scene->box);
    segment_abandon(&scene->view);
    free(scene->tanks.place);
}
