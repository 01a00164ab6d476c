/* Parts that fly off a destroyed vehicle, fall to the ground and stay there for a while. They are
 * drawn with the vehicle's own model, scaled to plates, bars and lumps. */
#include "renderer/scene/particles/debris.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/world.h"

#include <math.h>

#define GRAVITY    9.81 /* [m/s^2] */
#define PIECES_MAX 9u
#define SETTLE_S   0.5  /* time to tip over and slide after landing */
#define SLIDE      0.12 /* distance of the slide over speed times SETTLE_S */
#define SHRINK_S   5.0  /* time before the end of its life in which a part shrinks */
#define PIXELS_MIN 3.0  /* smaller parts are left out; they grow into the picture */
#define LANDINGS   4    /* iterations to find the place of landing */

struct piece {
    double size[3]; /* [m] length, height, width */
};

static const struct piece shapes[] = {
    {{1.3, 0.10, 0.9}},  /* a plate */
    {{1.6, 0.16, 0.18}}, /* a bar */
    {{0.6, 0.45, 0.55}}, /* a lump */
    {{0.8, 0.07, 0.5}},
};

#define SHAPES (sizeof shapes / sizeof shapes[0])

/* The path of a part. */
struct flight {
    struct vec3 from, velocity; /* [m, world], [m/s] */
    double lands_s;             /* time after the explosion */
    struct vec3 rest;           /* final position */
};

static double debris_random(uint32_t seed, uint32_t n, uint32_t purpose)
{
    return (double)value_noise_unit((int32_t)seed, (int32_t)n, 360u + purpose);
}

static struct vec3 ballistic_position(const struct flight *flight, double t)
{
    struct vec3 at = vec3_add(flight->from, vec3_scale(flight->velocity, t));
    at.y -= 0.5 * GRAVITY * t * t;
    return at;
}

static struct flight flight_of(const struct effect *effect, const struct frame_view *frame_view,
                               uint32_t n)
{
    const struct terrain *terrain = &frame_view->world->terrain;
    double sine, cosine,
        out = (4.0 + 5.0 * debris_random(effect->seed, n, 0)) * sqrt((double)effect->size_m) * 0.6;
    maths_sincos(TWO_PI * debris_random(effect->seed, n, 1), &sine, &cosine);
    struct flight flight = {
        .from = effect->point,
        /* It keeps half the vehicle's velocity. */
        .velocity = {0.5 * (double)effect->direction[0] + cosine * out,
                     0.5 * (double)effect->direction[1] +
                         out * (1.0 + 0.9 * debris_random(effect->seed, n, 2)),
                     0.5 * (double)effect->direction[2] + sine * out},
    };
    flight.from.y += 1.0;
    double ground = terrain_height(terrain, frame_view->craters, flight.from.x, flight.from.z);
    for (uint32_t i = 0; i < LANDINGS; i++) {
        double up = flight.velocity.y, high = flight.from.y - ground;
        flight.lands_s = (up + sqrt(maths_max(0.0, up * up + 2.0 * GRAVITY * high))) / GRAVITY;
        struct vec3 at = ballistic_position(&flight, flight.lands_s);
        ground = terrain_height(terrain, frame_view->craters, at.x, at.z);
    }
    flight.rest = ballistic_position(&flight, flight.lands_s);
    double slide = SLIDE * SETTLE_S;
    flight.rest.x += flight.velocity.x * slide;
    flight.rest.z += flight.velocity.z * slide;
    flight.rest.y = terrain_height(terrain, frame_view->craters, flight.rest.x, flight.rest.z);
    return flight;
}

/* Returns the position at a time after the explosion. */
static struct vec3 place_at(const struct flight *flight, double age)
{
    if (age <= flight->lands_s)
        return ballistic_position(flight, age);
    double t = maths_min(1.0, (age - flight->lands_s) / SETTLE_S);
    struct vec3 landed = ballistic_position(flight, flight->lands_s);
    return vec3_lerp(landed, flight->rest, t * (2.0 - t));
}

/* Returns the axes: the part tumbles in whole turns until it lies flat on the ground. */
static struct body_axes pose_at(const struct effect *effect, const struct flight *flight,
                                struct vec3 normal, double age, uint32_t n)
{
    double t = maths_min(1.0, age / (flight->lands_s + SETTLE_S));
    double turns = 1.0 + floor(3.0 * debris_random(effect->seed, n, 3));
    double heading = TWO_PI * debris_random(effect->seed, n, 4);
    struct body_axes axes = body_axes_of(heading + 4.0 * t, TWO_PI * turns * t, 0.0);
    /* As it comes to rest, its up axis becomes the ground's normal. */
    double flat = maths_clamp(4.0 * t - 3.0, 0.0, 1.0);
    struct vec3 up = vec3_lerp(axes.up, normal, flat);
    struct vec3 right = vec3_cross(axes.forward, up);
    double wide = vec3_length(right), high = vec3_length(up);
    if (wide < 1e-3 || high < 1e-3)
        return axes;
    axes.up = vec3_scale(up, 1.0 / high);
    axes.right = vec3_scale(right, 1.0 / wide);
    axes.forward = vec3_cross(axes.up, axes.right);
    return axes;
}

static void add_piece(struct draw_list *list, const struct static_scene *static_scene,
                      const struct frame_view *frame_view, const struct effect *effect, double age,
                      uint32_t n)
{
    const struct kind *kind = &frame_view->world->kinds[effect->kind];
    const struct mesh_skeleton *skeleton = &static_scene->skeletons[kind->model];
    const struct piece *shape =
        &shapes[value_noise_hash((int32_t)effect->seed, (int32_t)n, 365) % SHAPES];
    double life = EFFECT_LIFE_S * (0.6 + 0.4 * debris_random(effect->seed, n, 6));
    double size = (0.7 + 0.6 * debris_random(effect->seed, n, 7)) * sqrt(kind->radius_m / 3.0);
    size *= maths_clamp((life - age) / SHRINK_S, 0.0, 1.0);
    struct flight flight = flight_of(effect, frame_view, n);
    struct vec3 at = place_at(&flight, age);
    double distance = vec3_length(vec3_sub(at, list->camera.eye));
    double pixels = camera_pixels(&list->camera, 1.5 * size, distance);
    size *= maths_clamp(pixels - PIXELS_MIN, 0.0, 1.0);
    if (pixels <= PIXELS_MIN || !camera_sees(&list->camera, at, 4.0))
        return;
    if (cover_is_water(terrain_cover(&frame_view->world->terrain, at.x, at.z)) &&
        age > flight.lands_s)
        return; /* it sank */
    struct draw_list_body *body = draw_list_add_body(list, kind->model, MESH_COARSEST);
    if (body == NULL)
        return;
    struct vec3 normal =
        terrain_normal(&frame_view->world->terrain, frame_view->craters, at.x, at.z);
    struct body_axes axes = pose_at(effect, &flight, normal, age, n);
    double scale[3], low = 0.0;
    for (uint32_t i = 0; i < 3; i++) {
        double model = maths_max(0.01, (double)skeleton->high[i] - (double)skeleton->low[i]);
        scale[i] = size * shape->size[i] / model;
        if (i == 1)
            low = -scale[i] * (double)skeleton->low[i];
    }
    at = vec3_add(at, vec3_scale(axes.up, low));
    draw_list_relative(list, at, body->at);
    vec3_to_floats(body->forward, vec3_scale(axes.forward, scale[0]));
    vec3_to_floats(body->up, vec3_scale(axes.up, scale[1]));
    vec3_to_floats(body->right, vec3_scale(axes.right, scale[2]));
    body->tint[0] = body->tint[1] = body->tint[2] = 0.4f;
    body->burn = 1.0f;
    draw_list_add_shadow(list, frame_view, at, pixels);
}

void debris_add(struct draw_list *list, const struct static_scene *static_scene,
                const struct frame_view *frame_view, const struct effects *effects)
{
    for (uint32_t i = 0; i < effects->count; i++) {
        const struct effect *effect = &effects->effect[i];
        double age = list->time_s - effect->time_s;
        if (effect->type != EFFECT_WRECK || age < 0.0 || age > EFFECT_LIFE_S ||
            effect->kind >= frame_view->world->counts.kinds ||
            frame_view->world->kinds[effect->kind].model >= frame_view->world->counts.models)
            continue;
        float at[3];
        draw_list_relative(list, effect->point, at);
        float far = sqrtf(frustum_dot(at, at)), pixels = frustum_pixels(&list->frustum, 2.0f, far);
        if (pixels < (float)PIXELS_MIN || !frustum_ball(&list->frustum, at, 120.0f))
            continue;
        for (uint32_t n = 0; n < PIECES_MAX; n++)
            add_piece(list, static_scene, frame_view, effect, age, n);
    }
}
