/* Fixed objects made of polygons, whole and damaged (thesis rows 27, 32 and 33): poles lean and
 * break, towers lean and fall over, buildings and rocks collapse into a heap, felled trees lie on
 * the ground. */
#include "renderer/scene/fixed_objects.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/entity/debris.h"
#include "world/terrain/fallen.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <string.h>

#define FIXED_RANGE_M   9000.0
#define FELLED_AWAY_M   0.6   /* from the stump to the end of the trunk */
#define FELLED_LIFT_M   0.5   /* above the ground: the branches hold the trunk up */
#define FALL_S          0.45  /* a trunk falls for so long times the root of its length */
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
    uint8_t stored = frame_view->fixed_damage[index];
    uint8_t damage = stored < DAMAGE_HIGH ? stored : (uint8_t)DAMAGE_HIGH;
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
    double heading = stored >= FALLEN_FIRST ? fallen_heading(stored) : fixed_heading(object);
    struct body_axes axes = body_axes_of(heading, -lean, 0.0);
    draw_list_place_body(list, body, position, &axes, fixed_scale(object, kind));
    memcpy(body->tint, wall_colours[value_noise_hash((int32_t)index, 6, 9) % WALL_COLOURS],
           sizeof body->tint);
    body->noise_seed = (float)(value_noise_hash((int32_t)index, 4, 9) % 64u);
    if (damage != DAMAGE_NONE)
        show_damage(body, kind, (enum damage)damage, &static_scene->skeletons[kind->model]);
    draw_list_add_shadow(list, frame_view, position, pixels);
}

/* Returns where the felled tree lies: where it fell or was pushed to; in a random direction if
 * nothing tells in which it fell. */
static struct debris_area felled_area(const struct frame_view *frame_view, uint32_t index,
                                      const struct debris *moved)
{
    const struct fixed_object *object = &frame_view->world->fixed[index];
    const struct kind *kind = &frame_view->world->kinds[object->kind];
    uint8_t stored = frame_view->fixed_damage[index];
    if (moved)
        return debris_area(moved);
    if (stored >= FALLEN_FIRST)
        return fallen_area(object, kind, stored);
    double heading = TWO_PI * (double)value_noise_unit((int32_t)index, 3, 9), sine, cosine;
    double half = 0.5 * (double)object->height_m;
    maths_sincos(heading, &sine, &cosine);
    return (struct debris_area){.x = object->x + half * sine,
                                .z = object->z - half * cosine,
                                .along_x = sine,
                                .along_z = -cosine,
                                .half_length_m = half};
}

/* Returns the share of a right angle by which the tree has fallen over: all of it after a while. */
static double fallen_share(const struct frame_view *frame_view, const struct debris *moved)
{
    if (moved == NULL)
        return 1.0;
    double fell_s = (double)moved->fell_tick * world_dt_s(frame_view->world);
    double age = maths_max(0.0, frame_view_time_s(frame_view) - fell_s);
    double whole = FALL_S * sqrt(2.0 * (double)moved->half_length_m);
    double share = maths_min(1.0, age / whole);
    return share * share;
}

/* Adds a felled tree beside its stump, or where it was pushed to. It lies along the slope. */
static void add_felled(struct draw_list *list, const struct frame_view *frame_view, uint32_t index)
{
    const struct fixed_object *object = &frame_view->world->fixed[index];
    const struct kind *kind = &frame_view->world->kinds[object->kind];
    const struct terrain *terrain = &frame_view->world->terrain;
    const struct debris *moved =
        debris_find(frame_view->head->debris, frame_view->head->debris_count, index);
    const struct debris_area area = felled_area(frame_view, index, moved);
    double high_m = 2.0 * area.half_length_m;
    double foot_x = area.x - area.half_length_m * area.along_x;
    double foot_z = area.z - area.half_length_m * area.along_z;
    struct vec3 foot = {foot_x, terrain_height(terrain, frame_view->craters, foot_x, foot_z),
                        foot_z};
    double distance = vec3_length(vec3_sub(foot, list->camera.eye));
    double pixels = camera_pixels(&list->camera, high_m, distance);
    if (pixels < BODY_MIN_PIXELS || kind->model >= frame_view->world->counts.models ||
        !camera_sees(&list->camera, foot, 2.0 * high_m))
        return;
    struct draw_list_body *body =
        draw_list_add_body(list, kind->model, draw_list_detail(pixels, false));
    if (body == NULL)
        return;
    double top_x = foot.x + high_m * area.along_x, top_z = foot.z + high_m * area.along_z;
    double rise =
        maths_atan2(terrain_height(terrain, frame_view->craters, top_x, top_z) - foot.y, high_m);
    double share = fallen_share(frame_view, moved);
    struct vec3 butt = {foot.x + share * FELLED_AWAY_M * area.along_x,
                        foot.y + share * FELLED_LIFT_M,
                        foot.z + share * FELLED_AWAY_M * area.along_z};
    struct body_axes axes =
        body_axes_of(maths_heading(area.along_x, area.along_z), share * (rise - HALF_PI), 0.0);
    draw_list_place_body(list, body, butt, &axes, fixed_scale(object, kind));
    draw_list_add_shadow(list, frame_view, butt, pixels);
}

/* Adds a heap of rubble that was pushed: the collapsed object, as small as the heap. */
static void add_heap(struct draw_list *list, const struct static_scene *static_scene,
                     const struct frame_view *frame_view, const struct debris *heap)
{
    const struct world *world = frame_view->world;
    const struct kind *kind = &world->kinds[world->fixed[heap->object].kind];
    struct vec3 at = {
        heap->x, terrain_height(&world->terrain, frame_view->craters, heap->x, heap->z), heap->z};
    double distance = vec3_length(vec3_sub(at, list->camera.eye));
    double pixels = camera_pixels(&list->camera, 2.0 * (double)heap->radius_m, distance);
    if (pixels < BODY_MIN_PIXELS || kind->model >= world->counts.models ||
        !camera_sees(&list->camera, at, 2.0 * (double)heap->radius_m))
        return;
    struct draw_list_body *body =
        draw_list_add_body(list, kind->model, draw_list_detail(pixels, true));
    if (body == NULL)
        return;
    struct body_axes axes = body_axes_of((double)heap->heading_rad, 0.0, 0.0);
    double across = sqrt(kind->length_m * kind->width_m);
    draw_list_place_body(list, body, at, &axes, 2.0 * (double)heap->radius_m / across);
    memcpy(body->tint, wall_colours[value_noise_hash((int32_t)heap->object, 6, 9) % WALL_COLOURS],
           sizeof body->tint);
    body->noise_seed = (float)(value_noise_hash((int32_t)heap->object, 4, 9) % 64u);
    collapse_body(body, DAMAGE_HIGH, &static_scene->skeletons[kind->model]);
}

static bool is_felled_tree(const struct frame_view *frame_view, uint32_t index)
{
    uint8_t stored = frame_view->fixed_damage[index];
    return stored >= DAMAGE_HIGH && stored != DAMAGE_DESTROYED &&
           frame_view->world->kinds[frame_view->world->fixed[index].kind].object_class ==
               OBJECT_TREE;
}

void fixed_objects_add(struct draw_list *list, const struct static_scene *static_scene,
                       const struct frame_view *frame_view)
{
    struct vec3 eye = list->camera.eye;
    const struct gridsquares *squares = &static_scene->world->terrain.squares;
    struct gridsquare_box box =
        gridsquare_box_of(squares, eye.x - FIXED_RANGE_M, eye.z - FIXED_RANGE_M,
                          eye.x + FIXED_RANGE_M, eye.z + FIXED_RANGE_M);
    for (int32_t row = box.z0; row <= box.z1; row++) {
        uint32_t first = static_scene->square_start[gridsquare_index(squares, box.x0, row)];
        uint32_t end = static_scene->square_start[gridsquare_index(squares, box.x1, row) + 1];
        for (uint32_t i = first; i < end; i++)
            if (static_scene->look[i] == LOOK_MODEL)
                add_fixed(list, static_scene, frame_view, i);
            else if (is_felled_tree(frame_view, i))
                add_felled(list, frame_view, i);
    }
    for (uint32_t i = 0; i < frame_view->head->debris_count; i++) {
        if (frame_view->head->debris[i].half_length_m == 0.0f)
            add_heap(list, static_scene, frame_view, &frame_view->head->debris[i]);
    }
}
