/* Finds the crew's eye on the polygons of the model. */
#include "renderer/scene/camera/crew_eye.h"

#include "world/entity/kind.h"
#include "world/model.h"
#include "world/world.h"

#include <stdbool.h>
#include <stdint.h>

#define REACH_M     0.45 /* half side of the ground plan that must lie beneath the eye */
#define SAMPLES     3    /* samples a side of that plan */
#define CAB_SHARE   0.45 /* driver's seat from the nose, as a share of the length */
#define PILOT_SHARE 0.20 /* a pilot sits farther ahead */
#define BACK_SHARE  0.30 /* both may sit this much farther back, to have the nose in view ... */
#define MAST_SHARE  0.10 /* ... but a pilot stays ahead of the rotor's mast */
#define STEP_M      0.25
#define STEPS_MAX   60
#define ASIDE       0.5  /* corners farther aside, over their distance, are out of view */
#define DOWN_MIN    0.10 /* a crew looks slightly down, at the ground ahead */
#define DOWN_MAX    0.21
#define REACH_DOWN  0.21 /* tangent of half the part of the picture above the instruments */

static const struct model_vertex *corner(const struct world *world, const struct model *model,
                                         uint32_t triangle, uint32_t which)
{
    const struct model_triangle *t = &world->model_triangles[model->first_triangle + triangle];
    return &world->model_vertices[model->first_vertex + t->vertex[which]];
}

/* Returns twice the area of a triangle in the ground plan, positive if counter-clockwise. */
static double turn(double ax, double az, double bx, double bz, double cx, double cz)
{
    return (bx - ax) * (cz - az) - (bz - az) * (cx - ax);
}

/* Sets y to the height of a triangle at a place of the ground plan. Returns false if the triangle
 * does not cover the place. */
static bool height_over(const struct world *world, const struct model *model, uint32_t triangle,
                        double x, double z, double *y)
{
    double px[3], py[3], pz[3];
    for (uint32_t i = 0; i < 3; i++) {
        const struct model_vertex *v = corner(world, model, triangle, i);
        px[i] = (double)v->x;
        py[i] = (double)v->y;
        pz[i] = (double)v->z;
    }
    double whole = turn(px[0], pz[0], px[1], pz[1], px[2], pz[2]);
    if (whole == 0.0)
        return false;
    double a = turn(x, z, px[1], pz[1], px[2], pz[2]) / whole;
    double b = turn(px[0], pz[0], x, z, px[2], pz[2]) / whole;
    double c = 1.0 - a - b;
    if (a < 0.0 || b < 0.0 || c < 0.0)
        return false;
    *y = a * py[0] + b * py[1] + c * py[2];
    return true;
}

static enum model_part part_of(const struct world *world, const struct model *model,
                               uint32_t triangle)
{
    return (enum model_part)world->model_triangles[model->first_triangle + triangle].part;
}

/* Returns the height of the highest polygon at a place, or 0 if there is none. */
static double top_over(const struct world *world, const struct model *model, double x, double z)
{
    double top = 0.0, y = 0.0;
    for (uint32_t t = 0; t < model->triangle_count; t++) {
        enum model_part part = part_of(world, model, t);
        if (part != PART_ROTOR && part != PART_TAIL_ROTOR && height_over(world, model, t, x, z, &y))
            top = maths_max(top, y);
    }
    return top;
}

/* Finds the mean of the turret's corners, which lies well inside its body. Returns false if there
 * is no turret. */
static bool turret_middle(const struct world *world, const struct model *model, double *x,
                          double *z)
{
    uint32_t corners = 0;
    double sum_x = 0.0, sum_z = 0.0;
    for (uint32_t t = 0; t < model->triangle_count; t++) {
        if (part_of(world, model, t) != PART_TURRET)
            continue;
        for (uint32_t i = 0; i < 3; i++, corners++) {
            sum_x += (double)corner(world, model, t, i)->x;
            sum_z += (double)corner(world, model, t, i)->z;
        }
    }
    if (corners == 0)
        return false;
    *x = sum_x / corners;
    *z = sum_z / corners;
    return true;
}

/* Returns a height at which all of the ground plan around the eye lies beneath it. */
static double eye_height(const struct world *world, const struct model *model, double x, double z)
{
    double top = 0.0;
    for (int32_t row = 0; row < SAMPLES; row++)
        for (int32_t column = 0; column < SAMPLES; column++)
            top = maths_max(
                top, top_over(world, model, x + (column - 1) * REACH_M, z + (row - 1) * REACH_M));
    return top + CREW_EYE_CLEARANCE_M;
}

/* Returns the highest slope, rise over distance, from the eye to a corner of the vehicle that lies
 * ahead of it and not far to the side. */
static double highest_ahead(const struct world *world, const struct model *model, struct vec3 eye)
{
    double highest = -INFINITY;
    for (uint32_t t = 0; t < model->triangle_count; t++)
        for (uint32_t i = 0; i < 3; i++) {
            const struct model_vertex *v = corner(world, model, t, i);
            enum model_part part = part_of(world, model, t);
            double ahead = (double)v->x - eye.x, aside = fabs((double)v->z - eye.z);
            if (ahead > REACH_M && aside < ASIDE * ahead && part != PART_ROTOR &&
                part != PART_TAIL_ROTOR)
                highest = maths_max(highest, ((double)v->y - eye.y) / ahead);
        }
    return highest;
}

/* Finds both ends of the model without its rotor. */
static void find_ends(const struct world *world, const struct model *model, double *tail,
                      double *nose)
{
    *tail = INFINITY;
    *nose = -INFINITY;
    for (uint32_t t = 0; t < model->triangle_count; t++)
        for (uint32_t i = 0; i < 3 && part_of(world, model, t) != PART_ROTOR; i++) {
            *tail = maths_min(*tail, (double)corner(world, model, t, i)->x);
            *nose = maths_max(*nose, (double)corner(world, model, t, i)->x);
        }
}

struct crew_eye_seat crew_eye_seat(const struct world *world, const struct kind *kind)
{
    struct crew_eye_seat seat = {.eye = {0.0, kind->height_m, 0.0}, .down = DOWN_MIN};
    if (kind->model >= world->counts.models)
        return seat;
    const struct model *model = &world->models[kind->model];
    struct vec3 *eye = &seat.eye;
    bool flies = kind->domain == DOMAIN_AIR || kind->domain == DOMAIN_MUNITION;
    double tail, nose;
    find_ends(world, model, &tail, &nose);
    double length = nose - tail;
    eye->x = nose - (flies ? PILOT_SHARE : CAB_SHARE) * length;
    seat.turns = turret_middle(world, model, &eye->x, &eye->z);
    double least = eye->x - (flies ? MAST_SHARE : BACK_SHARE) * length;
    eye->y = eye_height(world, model, eye->x, eye->z);
    double highest = highest_ahead(world, model, *eye);
    for (uint32_t i = 0; i < STEPS_MAX && eye->x - STEP_M > least; i++) {
        if (highest > -(DOWN_MAX + REACH_DOWN))
            break;
        eye->x -= STEP_M;
        eye->y = eye_height(world, model, eye->x, eye->z);
        highest = highest_ahead(world, model, *eye);
    }
    seat.down = maths_clamp(-highest - REACH_DOWN, DOWN_MIN, DOWN_MAX);
    return seat;
}
