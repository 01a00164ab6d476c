/* Drawing what moves on the map. */
#include "renderer/chart/map.h"

#include "world/entity/kind.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>

#define CRATER_SHARE   0.2   /* least radius of a crater in symbols' lengths */
#define CRATER_LEAST   1.6   /* [pixel] least radius of a crater */
#define WORK_LEAST     0.7   /* [pixel] half a side of an earthwork */
#define WORK_SHOWN     0.2   /* [pixel] smaller works do not show */
#define WORK_EDGED     6.0   /* [pixel] larger works have a line around them */
#define OBJECTIVE_FILL 48    /* opacity of 255 */
#define OBJECTIVE_EDGE 1.4   /* [pixel] */
#define TRACK_DOT      0.14  /* side of a dot in symbols' lengths */
#define DOT_LEAST      1.7   /* [pixel] */
#define BLAST_LIFE_S   3.0   /* for which a detonation shows */
#define FIRE_LIFE_S    150.0 /* for which a wreck burns, as in the other views */
#define LEVEL_LEAST    0.2   /* least horizontal part of the camera's direction */
#define STROKE_LENGTH  75.0  /* [pixel] longer triangles have thicker lines */
#define OUTSIDE_MOST   40.0  /* [pixel] a symbol farther outside does not show */

struct map_view map_whole(double side_m, int32_t left, int32_t top, uint32_t side)
{
    return (struct map_view){0.0, 0.0, side_m / side, left, top, side, side};
}

struct map_view map_around(double x, double z, double metres, int32_t left, int32_t top,
                           uint32_t width, uint32_t height)
{
    return (struct map_view){
        x - 0.5 * metres * width, z - 0.5 * metres * height, metres, left, top, width, height};
}

void map_align(struct map_view *view)
{
    view->x = floor(view->x / view->metres + 0.5) * view->metres;
    view->z = floor(view->z / view->metres + 0.5) * view->metres;
}

struct point map_point(const struct map_view *view, double x, double z)
{
    return (struct point){view->left + (x - view->x) / view->metres,
                          view->top + (z - view->z) / view->metres};
}

bool map_contains(const struct map_view *view, struct point point, double margin)
{
    return point.x >= view->left - margin && point.y >= view->top - margin &&
           point.x < view->left + (double)view->width + margin &&
           point.y < view->top + (double)view->height + margin;
}

double map_round_down(double metres)
{
    double power = 1.0;
    while (power * 10.0 <= metres)
        power *= 10.0;
    return metres >= 5.0 * power ? 5.0 * power : metres >= 2.0 * power ? 2.0 * power : power;
}

void map_grid(struct image *image, const struct map_view *view, double side_m, double step_m)
{
    const struct rgba line = {20, 24, 30, 70};
    double right = fmin(view->x + view->width * view->metres, side_m);
    double bottom = fmin(view->z + view->height * view->metres, side_m);
    for (int32_t n = (int32_t)ceil(fmax(view->x, 0.0) / step_m); n * step_m < right; n++)
        image_rectangle(image, (int32_t)map_point(view, n * step_m, 0.0).x, view->top, 1,
                        (int32_t)view->height, line);
    for (int32_t n = (int32_t)ceil(fmax(view->z, 0.0) / step_m); n * step_m < bottom; n++)
        image_rectangle(image, view->left, (int32_t)map_point(view, 0.0, n * step_m).y,
                        (int32_t)view->width, 1, line);
}

void map_craters(struct image *image, const struct map_view *view,
                 const struct crater_index *craters, double pixels)
{
    double least = fmax(CRATER_SHARE * pixels, CRATER_LEAST);
    for (uint32_t i = 0; i < craters->count; i++) {
        const struct crater *crater = &craters->craters[i];
        struct point at = map_point(view, crater->x, crater->z);
        double radius = fmax(least, (double)crater->radius_m / view->metres);
        if (map_contains(view, at, radius))
            symbol_crater(image, at, radius);
    }
}

/* --- earthworks ------------------------------------------------------------------------------- */

static void draw_work(struct image *image, const struct map_view *view,
                      const struct earthwork *work)
{
    static const struct rgba fills[EARTHWORK_SHAPE_COUNT] = {
        [EARTHWORK_RAMP] = {222, 205, 170, 255}, [EARTHWORK_TABLE] = {205, 185, 148, 255},
        [EARTHWORK_TRENCH] = {92, 70, 48, 255},  [EARTHWORK_WASHBOARD] = {188, 160, 118, 255},
        [EARTHWORK_FORD] = {60, 110, 165, 255},  [EARTHWORK_SKID_PAN] = {120, 126, 134, 255}};
    static const struct rgba edge = {70, 52, 34, 255};
    double length = fmax(work->half_length / view->metres, WORK_LEAST);
    double width = fmax(work->half_width / view->metres, WORK_LEAST);
    struct point at = map_point(view, work->x, work->z), corner[4];
    if (work->half_length + work->half_width < WORK_SHOWN * view->metres ||
        !map_contains(view, at, length + width))
        return;
    for (int i = 0; i < 4; i++) {
        double along = i < 2 ? length : -length, across = i == 0 || i == 3 ? width : -width;
        corner[i].x = at.x + work->sine * along + work->cosine * across;
        corner[i].y = at.y - work->cosine * along + work->sine * across;
    }
    image_polygon(image, corner, 4, fills[work->shape % EARTHWORK_SHAPE_COUNT]);
    for (int i = 0; i < 4 && length + width > WORK_EDGED; i++)
        image_line(image, corner[i], corner[(i + 1) % 4], 0.8, edge);
}

void map_earthworks(struct image *image, const struct map_view *view,
                    const struct earthworks *earthworks)
{
    for (uint32_t i = 0; i < earthworks->count; i++)
        draw_work(image, view, &earthworks->works[i]);
}

/* --- objectives ------------------------------------------------------------------------------- */

void map_objectives(struct image *image, const struct map_view *view,
                    const struct frame_view *frame_view)
{
    const struct world *world = frame_view->world;
    for (uint32_t o = 0; o < world->counts.objectives; o++) {
        const struct objective *objective = &world->objectives[o];
        const struct point low = map_point(view, objective->x0, objective->z0),
                           high = map_point(view, objective->x1, objective->z1),
                           corner[4] = {low, {high.x, low.y}, high, {low.x, high.y}};
        struct rgba colour = symbol_colour((enum force)frame_view->head->battle.objective[o].owner);
        colour.a = OBJECTIVE_FILL;
        image_polygon(image, corner, 4, colour);
        colour.a = UINT8_MAX;
        for (int i = 0; i < 4; i++)
            image_line(image, corner[i], corner[(i + 1) % 4], OBJECTIVE_EDGE, colour);
    }
}

/* --- vehicles --------------------------------------------------------------------------------- */

static enum domain domain_of(const struct frame_view *frame_view, uint32_t slot)
{
    return (enum domain)frame_view->world->kinds[frame_view->entities->row[slot].kind].domain;
}

static bool is_drawn(const struct frame_view *frame_view, uint32_t slot)
{
    return frame_view->entities->row[slot].state != ENTITY_FREE &&
           frame_view->entities->row[slot].kind < frame_view->world->counts.kinds;
}

/* Draws the dots of a track from the newest on, leaving out those too close to the one before. */
static void draw_track(struct image *image, const struct map_view *view, const struct track *track,
                       struct point to, double pixels, struct rgba colour)
{
    uint32_t opacity = colour.a;
    double side = fmax(TRACK_DOT * pixels, DOT_LEAST), step = side + 0.5;
    uint32_t held = track->count < TRACK_POINTS ? track->count : TRACK_POINTS;
    for (uint32_t i = 1; i <= held; i++) {
        uint32_t at = (track->count - i) % TRACK_POINTS;
        struct point from = map_point(view, (double)track->x[at], (double)track->z[at]);
        double dx = from.x - to.x, dy = from.y - to.y;
        if (dx * dx + dy * dy < step * step)
            continue;
        colour.a = (uint8_t)(opacity - opacity * 4 / 5 * i / TRACK_POINTS);
        image_dot(image, from, side, colour);
        to = from;
    }
}

void map_tracks(struct image *image, const struct map_view *view,
                const struct frame_view *frame_view, const struct tracks *tracks, double pixels,
                uint8_t opacity)
{
    const struct entities *e = frame_view->entities;
    for (uint32_t slot = 0; slot < frame_view->head->used; slot++) {
        const struct track *track = tracks_of(tracks, slot, e->row[slot].id);
        if (track == NULL || !is_drawn(frame_view, slot) ||
            domain_of(frame_view, slot) == DOMAIN_MUNITION)
            continue;
        struct rgba colour = symbol_colour((enum force)e->row[slot].force);
        colour.a = opacity;
        draw_track(image, view, track, map_point(view, e->row[slot].x, e->row[slot].z), pixels,
                   colour);
    }
}

static bool burns(const struct frame_view *frame_view, uint32_t slot)
{
    uint64_t ticks = frame_view->head->tick - frame_view->entities->row[slot].changed_tick;
    return (double)ticks * world_dt_s(frame_view->world) < FIRE_LIFE_S;
}

enum rank { RANK_WRECK, RANK_FIRE, RANK_MUNITION, RANK_VEHICLE, RANK_COUNT };

static enum rank rank_of(const struct frame_view *frame_view, uint32_t slot)
{
    if (frame_view->entities->row[slot].state == ENTITY_WRECK)
        return burns(frame_view, slot) ? RANK_FIRE : RANK_WRECK;
    return domain_of(frame_view, slot) == DOMAIN_MUNITION ? RANK_MUNITION : RANK_VEHICLE;
}

static void draw_symbol(struct image *image, const struct map_view *view,
                        const struct frame_view *frame_view, uint32_t slot, double pixels)
{
    const struct entities *e = frame_view->entities;
    struct point at = map_point(view, e->row[slot].x, e->row[slot].z);
    if (!map_contains(view, at, OUTSIDE_MOST))
        return;
    switch (rank_of(frame_view, slot)) {
    case RANK_WRECK:
        symbol_wreck(image, at, pixels);
        break;
    case RANK_FIRE:
        symbol_fire(image, at, pixels);
        break;
    case RANK_MUNITION:
        symbol_munition(image, at, e->row[slot].heading, pixels);
        break;
    default:
        symbol_vehicle(
            image, at,
            symbol_shape(frame_view->world, &frame_view->world->kinds[e->row[slot].kind], pixels),
            e->row[slot].heading, pixels, (enum force)e->row[slot].force);
        break;
    }
}

void map_vehicles(struct image *image, const struct map_view *view,
                  const struct frame_view *frame_view, uint32_t slot, double pixels)
{
    for (uint32_t rank = 0; rank < RANK_COUNT; rank++)
        for (uint32_t i = 0; i < frame_view->head->used; i++)
            if (i != slot && is_drawn(frame_view, i) && rank_of(frame_view, i) == rank)
                draw_symbol(image, view, frame_view, i, pixels);
    if (slot != SLOT_NONE && is_drawn(frame_view, slot))
        draw_symbol(image, view, frame_view, slot, pixels);
}

void map_blasts(struct image *image, const struct map_view *view,
                const struct frame_view *frame_view, const struct effects *effects, double pixels)
{
    double now = frame_view_time_s(frame_view);
    for (uint32_t i = 0; i < effects->count; i++) {
        const struct effect *effect = &effects->effect[i];
        double age = (now - effect->time_s) / BLAST_LIFE_S;
        struct point at = map_point(view, effect->point.x, effect->point.z);
        bool blast = effect->type == EFFECT_EXPLOSION || effect->type == EFFECT_BURST ||
                     effect->type == EFFECT_SPLASH;
        if (blast && age >= 0.0 && age < 1.0 && map_contains(view, at, OUTSIDE_MOST))
            symbol_blast(image, at, age, pixels);
    }
}

/* --- the followed vehicle --------------------------------------------------------------------- */

void map_camera(struct image *image, const struct map_view *view, const struct camera *camera,
                double length)
{
    const struct rgba within = {255, 244, 150, 70}, edge = {255, 244, 150, 220};
    double x = camera->forward.x, z = camera->forward.z, level = sqrt(x * x + z * z);
    struct point eye = map_point(view, camera->eye.x, camera->eye.z);
    if (level < LEVEL_LEAST || !map_contains(view, eye, length))
        return;
    x *= length / level;
    z *= length / level;
    struct point corners[3] = {eye,
                               {eye.x + x + z * camera->tan_x, eye.y + z - x * camera->tan_x},
                               {eye.x + x - z * camera->tan_x, eye.y + z + x * camera->tan_x}};
    double stroke = 1.2 * fmax(length / STROKE_LENGTH, 1.0);
    image_polygon(image, corners, 3, within);
    image_line(image, corners[0], corners[1], stroke, edge);
    image_line(image, corners[0], corners[2], stroke, edge);
}

void map_followed(struct image *image, const struct map_view *view,
                  const struct frame_view *frame_view, uint32_t slot, double pixels, double length)
{
    const struct rgba dark = {0, 0, 0, 170}, white = {255, 255, 255, 255};
    const struct entities *e = frame_view->entities;
    struct point at = map_point(view, e->row[slot].x, e->row[slot].z);
    if (!map_contains(view, at, length))
        return;
    double x = maths_sin(e->row[slot].heading), y = -maths_cos(e->row[slot].heading);
    double radius = fmax(0.95 * pixels, 6.0), stroke = fmax(length / STROKE_LENGTH, 1.0);
    struct point edge = {at.x + x * radius, at.y + y * radius};
    struct point ahead = {at.x + x * length, at.y + y * length};
    image_line(image, edge, ahead, 1.4 * stroke + 1.2, dark);
    image_line(image, edge, ahead, 1.4 * stroke, white);
    image_ring(image, at, radius, 1.6 * stroke + 1.4, dark);
    image_ring(image, at, radius, 1.6 * stroke, white);
}
