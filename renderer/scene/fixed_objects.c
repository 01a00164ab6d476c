/* Fixed objects made of polygons, whole and damaged (thesis rows 27, 32 and 33): poles lean and
 * break, towers lean and fall over, buildings and rocks collapse into a heap, felled trees lie on
 * the ground. */
#include "renderer/scene/fixed_objects.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <string.h>

#define FIXED_RANGE_M   9000.0
#define FELLED_AWAY_M   0.6   /* from the stump to the end of the trunk */
#define FELLED_LIFT_M   0.5   /* above the ground: the branches hold the trunk up */
#define POLE_BREAKS     0.24  /* share of the height at which a pole breaks */
#define LEGS_BUCKLE     0.22  /* share of the height at which a tower's legs buckle */
#define COLLAPSE_SLIGHT 0.35f /* third number of collapse in struct draw_list_body */
#define COLLAPSE_HALF   0.90f
#define COLLAPSE_WHOLE  3.0f

/* Wall colours of objects that belong to no force. */
#define WALL_COLOURS 4u
static const float wall_colours[WALL_COLOURS][3] = {
    {0.80f, 0.74f, 0.62f}, {0.93f, 0.91f, 0.86f}, {0.74f, 0.55f, 0.40f}, {0.70f, 0.66f, 0.50f}};

/* How far a damaged pole leans towards its heading [rad]. */
static double lean_of(enum object_class object_class, enum damage damage)
{
    static const double pole_deg[] = {0.0, 3.0, 15.0};
    if (object_class != OBJECT_POLE || damage >= DAMAGE_HIGH) /* a badly damaged pole has fallen */
        return 0.0;
    return pole_deg[damage] * RAD_PER_DEG;
}

/* Collapses the body from one end. Its noise seed selects the direction. */
static void collapse_body(struct draw_list_body *body, enum damage damage,
                          const struct mesh_skeleton *skeleton)
{
    static const float more[] = {0.0f, COLLAPSE_SLIGHT, COLLAPSE_HALF, COLLAPSE_WHOLE};
    double turn = (double)body->noise_seed * (TWO_PI / 64.0), along, across;
    maths_sincos(turn, &across, &along);
    double reach = fabs(along) * 0.5 * (double)(skeleton->high[0] - skeleton->low[0]) +
                   fabs(across) * 0.5 * (double)(skeleton->high[2] - skeleton->low[2]);
    body->collapse[0] = (float)(along / reach);
    body->collapse[1] = (float)(across / reach);
    body->collapse[2] = more[damage];
}

static void show_damage(struct draw_list_body *body, const struct kind *kind, enum damage damage,
                        const struct mesh_skeleton *skeleton)
{
    static const float tower_rad[] = {0.0f, 0.04f, 0.16f, (float)HALF_PI};
    bool down = damage == DAMAGE_HIGH;
    body->burn = 0.1f * (float)damage;
    switch ((enum object_class)kind->object_class) {
    case OBJECT_POLE: /* the part above the break hangs down so that its top touches the ground */
        if (down) {
            double broken_m = POLE_BREAKS * kind->height_m, rest_m = kind->height_m - broken_m;
            body->broken[1] = (float)broken_m;
            body->broken[2] = (float)(HALF_PI + maths_atan2(broken_m, rest_m));
        }
        break;
    case OBJECT_WATERTOWER: /* the legs buckle; at high damage the tower tips over the edge of its
                               feet */
        body->broken[0] = down ? skeleton->high[0] : 0.0f;
        body->broken[1] = down ? 0.0f : (float)(LEGS_BUCKLE * kind->height_m);
        body->broken[2] = tower_rad[damage];
        break;
    default:
        collapse_body(body, damage, skeleton);
        break;
    }
}

static void add_fixed(struct draw_list *list, const struct static_scene *static_scene,
                      const struct frame_view *frame_view, uint32_t index)
{
    const struct fixed_object *object = &frame_view->world->fixed[index];
    const struct kind *kind = &frame_view->world->kinds[object->kind];
    uint8_t damage = frame_view->fixed_damage[index] < DAMAGE_HIGH ? frame_view->fixed_damage[index]
                                                                   : (uint8_t)DAMAGE_HIGH;
    struct vec3 position = fixed_position(object);
    double size = maths_max((double)object->radius_m, (double)object->height_m);
    double distance = vec3_length(vec3_sub(position, list->camera.eye));
    double pixels = camera_pixels(&list->camera, 2.0 * size, distance);
    if (pixels < BODY_MIN_PIXELS || kind->model >= frame_view->world->counts.models ||
        !camera_sees(&list->camera, position, 3.0 * size))
        return;
    struct draw_list_body *body =
        draw_list_add_body(list, kind->model, draw_list_detail(pixels, damage != DAMAGE_NONE));
    if (body == NULL)
        return;
    double lean = lean_of((enum object_class)kind->object_class, (enum damage)damage);
    struct body_axes axes = body_axes_of(fixed_heading(object), -lean, 0.0);
    draw_list_place_body(list, body, position, &axes, fixed_scale(object, kind));
    memcpy(body->tint, wall_colours[value_noise_hash((int32_t)index, 6, 9) % WALL_COLOURS],
           sizeof body->tint);
    body->noise_seed = (float)(value_noise_hash((int32_t)index, 4, 9) % 64u);
    if (damage != DAMAGE_NONE)
        show_damage(body, kind, (enum damage)damage, &static_scene->skeletons[kind->model]);
    draw_list_add_shadow(list, frame_view, position, pixels);
}

/* Adds a felled tree beside its stump. It lies along the slope, in a random direction. */
static void add_felled(struct draw_list *list, const struct frame_view *frame_view, uint32_t index)
{
    const struct fixed_object *object = &frame_view->world->fixed[index];
    const struct kind *kind = &frame_view->world->kinds[object->kind];
    const struct terrain *terrain = &frame_view->world->terrain;
    struct vec3 foot = fixed_position(object);
    double high_m = (double)object->height_m;
    double distance = vec3_length(vec3_sub(foot, list->camera.eye));
    double pixels = camera_pixels(&list->camera, high_m, distance);
    if (pixels < BODY_MIN_PIXELS || kind->model >= frame_view->world->counts.models ||
        !camera_sees(&list->camera, foot, 2.0 * high_m))
        return;
    struct draw_list_body *body =
        draw_list_add_body(list, kind->model, draw_list_detail(pixels, false));
    if (body == NULL)
        return;
    double heading = TWO_PI * (double)value_noise_unit((int32_t)index, 3, 9), x, z;
    maths_sincos(heading, &x, &z);
    double top_x = foot.x + high_m * x, top_z = foot.z - high_m * z;
    double rise =
        maths_atan2(terrain_height(terrain, frame_view->craters, top_x, top_z) - foot.y, high_m);
    struct vec3 butt = {foot.x + FELLED_AWAY_M * x, foot.y + FELLED_LIFT_M,
                        foot.z - FELLED_AWAY_M * z};
    struct body_axes axes = body_axes_of(heading, rise - HALF_PI, 0.0);
    draw_list_place_body(list, body, butt, &axes, fixed_scale(object, kind));
    draw_list_add_shadow(list, frame_view, butt, pixels);
}

void fixed_objects_add(struct draw_list *list, const struct static_scene *static_scene,
                       const struct frame_view *frame_view)
{
    struct vec3 eye = list->camera.eye;
    struct gridsquare_box box = gridsquare_box_of(eye.x - FIXED_RANGE_M, eye.z - FIXED_RANGE_M,
                                                  eye.x + FIXED_RANGE_M, eye.z + FIXED_RANGE_M);
    for (int32_t row = box.z0; row <= box.z1; row++) {
        uint32_t first = static_scene->square_start[gridsquare_index(box.x0, row)];
        uint32_t end = static_scene->square_start[gridsquare_index(box.x1, row) + 1];
        for (uint32_t i = first; i < end; i++)
            if (static_scene->look[i] == LOOK_MODEL)
                add_fixed(list, static_scene, frame_view, i);
            else if (frame_view->fixed_damage[i] >= DAMAGE_HIGH &&
                     frame_view->world->kinds[frame_view->world->fixed[i].kind].object_class ==
                         OBJECT_TREE)
                add_felled(list, frame_view, i);
    }
}
