/* Turning rotors: a faint disc where the blades are too fast for the eye. A disc is one stretched
 * particle with the width and height at which the disc is seen. */
#include "renderer/scene/particles/rotors.h"

#include "renderer/scene/particles/particles.h"

#include "renderer/scene/frame/body_axes.h"
#include "world/world.h"

#define DISC_ALPHA 0.52f
#define FLAT_SHARE 0.03 /* apparent thickness over the radius */
#define MIN_PIXELS 6.0  /* across */

/* Converts from body axes to world axes. */
static struct vec3 turned(const struct body_axes *axes, const float v[4])
{
    return vec3_add(
        vec3_scale(axes->forward, (double)v[0]),
        vec3_add(vec3_scale(axes->up, (double)v[1]), vec3_scale(axes->right, (double)v[2])));
}

static void add_disc(struct draw_list *list, struct vec3 hub, struct vec3 axle, double radius_m)
{
    struct vec3 sight_line = vec3_sub(hub, list->camera.eye), across = vec3_cross(axle, sight_line);
    double distance = vec3_length(sight_line), wide = vec3_length(across);
    if (camera_pixels(&list->camera, 2.0 * radius_m, distance) < MIN_PIXELS || !(wide > 0.0))
        return;
    double open = fabs(vec3_dot(sight_line, axle)) / distance;
    struct particle disc = {.at = hub,
                            .along = vec3_scale(across, radius_m / wide),
                            .size_m = radius_m * maths_max(open, FLAT_SHARE),
                            .shade = {0.12f, 0.12f, 0.13f, DISC_ALPHA},
                            .picture = PARTICLE_DISC};
    particles_add(list, &disc);
}

void rotors_add(struct draw_list *list, const struct static_scene *static_scene,
                const struct frame_view *frame_view)
{
    const struct entities *e = frame_view->entities;
    for (uint32_t slot = 0; slot < frame_view->head->used; slot++) {
        if (e->row[slot].state != ENTITY_ACTIVE ||
            e->row[slot].kind >= frame_view->world->counts.kinds)
            continue;
        const struct kind *kind = &frame_view->world->kinds[e->row[slot].kind];
        if (kind->domain != DOMAIN_AIR || kind->model >= frame_view->world->counts.models)
            continue;
        const struct mesh_skeleton *skeleton = &static_scene->skeletons[kind->model];
        struct body_axes axes =
            body_axes_of(e->row[slot].heading, e->row[slot].pitch, e->row[slot].roll);
        for (uint32_t joint = 1; joint < MODEL_JOINTS_MAX; joint++) {
            const float *pivot = skeleton->pivot[joint];
            struct vec3 hub = vec3_add(entities_position(e, slot), turned(&axes, pivot));
            if (skeleton->part[joint] == PART_ROTOR)
                add_disc(list, hub, axes.up, (double)pivot[3]);
            else if (skeleton->part[joint] == PART_TAIL_ROTOR)
                add_disc(list, hub, axes.right, (double)pivot[3]);
        }
    }
}
