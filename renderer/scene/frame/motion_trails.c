/* Keeps recent positions, and interpolates between them. */
#include "renderer/scene/frame/motion_trails.h"

#include "world/entity/kind.h"
#include "world/world.h"

#include <math.h>

#define SEA_INTERVAL_S      1.5 /* long, because wakes are long */
#define LAND_INTERVAL_S     0.4
#define MUNITION_INTERVAL_S 0.35
#define MIN_MPS             0.5 /* slower entities leave no trail */

/* Returns the seconds between two points in this domain. Twelve of them outlast what is left
 * behind. */
static double interval_s(uint8_t domain)
{
    return domain == DOMAIN_SEA    ? SEA_INTERVAL_S
           : domain == DOMAIN_LAND ? LAND_INTERVAL_S
                                   : MUNITION_INTERVAL_S;
}

/* Returns true if entities of this kind leave a trail. */
static bool leaves_trail(const struct kind *kind)
{
    return kind->domain == DOMAIN_LAND || kind->domain == DOMAIN_SEA ||
           (kind->domain == DOMAIN_MUNITION && kind->guidance == GUIDANCE_HOMING);
}

static void add_point(struct motion_trail *trail, const double at[3], const double velocity[3],
                      double time_s)
{
    struct motion_trail_point *point = &trail->point[trail->count++ % MOTION_TRAIL_POINTS];
    for (uint32_t i = 0; i < 3; i++) {
        point->at[i] = (float)at[i];
        point->velocity[i] = (float)velocity[i];
    }
    point->time_s = time_s;
}

static const struct motion_trail_point *newest(const struct motion_trail *trail)
{
    return &trail->point[(trail->count - 1) % MOTION_TRAIL_POINTS];
}

static void note(struct motion_trail *trail, const struct frame_view *frame_view, uint32_t slot,
                 double now_s)
{
    const struct entities *e = frame_view->entities;
    const struct kind *kind = &frame_view->world->kinds[e->row[slot].kind];
    const double at[3] = {e->row[slot].x, e->row[slot].y, e->row[slot].z};
    const double velocity[3] = {e->row[slot].vx, e->row[slot].vy, e->row[slot].vz};
    if (trail->count > 0 && newest(trail)->time_s > now_s)
        trail->count = 0; /* the time was set back */
    if (trail->count > 0 && now_s - newest(trail)->time_s < interval_s(kind->domain))
        return;
    if (trail->count == 0 && vec3_length(entities_velocity(e, slot)) < MIN_MPS)
        return; /* a vehicle at rest leaves no trail */
    add_point(trail, at, velocity, now_s);
}

void motion_trails_note(struct motion_trails *trails, const struct frame_view *frame_view)
{
    const struct entities *e = frame_view->entities;
    double now_s = frame_view_time_s(frame_view);
    uint32_t used =
        frame_view->head->used < MOTION_TRAILS_SLOTS ? frame_view->head->used : MOTION_TRAILS_SLOTS;
    for (uint32_t slot = 0; slot < used; slot++) {
        struct motion_trail *trail = &trails->trail[slot];
        if (e->row[slot].state == ENTITY_FREE ||
            e->row[slot].kind >= frame_view->world->counts.kinds)
            continue; /* its trail is still visible */
        if (trail->id != e->row[slot].id) {
            trail->id = e->row[slot].id;
            trail->kind = e->row[slot].kind;
            trail->count = 0;
            trail->wrecked = trail->broken = false;
            trail->smokes_s = INFINITY;
        }
        if (e->row[slot].state == ENTITY_ACTIVE && e->row[slot].damage >= DAMAGE_MED)
            trail->smokes_s = fmin(trail->smokes_s, (double)e->row[slot].changed_tick *
                                                        world_dt_s(frame_view->world));
        if (e->row[slot].state == ENTITY_ACTIVE &&
            leaves_trail(&frame_view->world->kinds[trail->kind]))
            note(trail, frame_view, slot, now_s);
    }
}

void motion_trails_end(struct motion_trails *trails, uint32_t id, const double point[3],
                       double time_s)
{
    for (uint32_t slot = 0; slot < MOTION_TRAILS_SLOTS; slot++) {
        struct motion_trail *trail = &trails->trail[slot];
        if (trail->id != id || trail->count == 0 || newest(trail)->time_s >= time_s)
            continue;
        const struct motion_trail_point *last = newest(trail);
        double since = time_s - last->time_s, velocity[3];
        for (uint32_t i = 0; i < 3; i++)
            velocity[i] = (point[i] - (double)last->at[i]) / since;
        add_point(trail, point, velocity, time_s);
        return;
    }
}

const struct motion_trail *motion_trails_of(const struct motion_trails *trails, uint32_t slot,
                                            uint32_t id)
{
    if (slot >= MOTION_TRAILS_SLOTS || trails->trail[slot].id != id)
        return NULL;
    return &trails->trail[slot];
}

static struct motion_trail_point straight(const struct motion_trail_point *from, double time_s)
{
    struct motion_trail_point point = *from;
    for (uint32_t i = 0; i < 3; i++)
        point.at[i] += (float)((double)from->velocity[i] * (time_s - from->time_s));
    point.time_s = time_s;
    return point;
}

/* Cubic Hermite interpolation. */
static struct motion_trail_point between(const struct motion_trail_point *a,
                                         const struct motion_trail_point *b, double time_s)
{
    struct motion_trail_point point = {.time_s = time_s};
    double span = b->time_s - a->time_s, t = (time_s - a->time_s) / span, u = 1.0 - t;
    double from = u * u * (1.0 + 2.0 * t), to = t * t * (3.0 - 2.0 * t);
    for (uint32_t i = 0; i < 3; i++) {
        double pa = (double)a->at[i], pb = (double)b->at[i];
        double va = (double)a->velocity[i], vb = (double)b->velocity[i];
        point.at[i] = (float)(from * pa + to * pb + span * t * u * (u * va - t * vb));
        point.velocity[i] = (float)(6.0 * t * u * (pb - pa) / span + u * (u - 2.0 * t) * va +
                                    t * (t - 2.0 * u) * vb);
    }
    return point;
}

struct motion_trail_point motion_trail_at(const struct motion_trail *trail,
                                          const struct motion_trail_point *now, double time_s)
{
    const struct motion_trail_point *later = now;
    uint32_t kept = trail == NULL                        ? 0
                    : trail->count < MOTION_TRAIL_POINTS ? trail->count
                                                         : MOTION_TRAIL_POINTS;
    for (uint32_t i = 0; i < kept; i++) {
        const struct motion_trail_point *point =
            &trail->point[(trail->count - 1 - i) % MOTION_TRAIL_POINTS];
        if (point->time_s >= later->time_s)
            continue; /* the point is later than the frame */
        if (point->time_s <= time_s)
            return between(point, later, time_s);
        later = point;
    }
    return straight(later, time_s);
}

static double squared(const struct motion_trail_point *point)
{
    const float *v = point->velocity;
    return (double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double motion_trail_fastest_mps(const struct motion_trail *trail,
                                const struct motion_trail_point *now, double since_s)
{
    double fastest = squared(now);
    uint32_t kept = trail == NULL                        ? 0
                    : trail->count < MOTION_TRAIL_POINTS ? trail->count
                                                         : MOTION_TRAIL_POINTS;
    for (uint32_t i = 0; i < kept; i++) {
        const struct motion_trail_point *point =
            &trail->point[(trail->count - 1 - i) % MOTION_TRAIL_POINTS];
        fastest = maths_max(fastest, squared(point));
        if (point->time_s < since_s)
            break; /* the segment after this point is still visible */
    }
    return sqrt(fastest);
}
