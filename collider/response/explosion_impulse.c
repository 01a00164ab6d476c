/* Reflected impulse on a box, in closed form. */
#include "collider/response/explosion_impulse.h"

#include "world/entity/mass_properties.h"

#define FAR_PAS     570.0 /* [Pa s m/kg^(2/3)] of the term that falls with the distance */
#define NEAR_PAS    305.0 /* [Pa s m2/kg] of the term that falls with its square */
#define GAUSS_POINT 0.28867513459481287 /* 1 / sqrt(12): of a side, from its middle */

double explosion_impulse_pas(double explosive_kg, double distance_m)
{
    double root = maths_cbrt(explosive_kg);
    if (!(root > 0.0))
        return 0.0;
    double scaled = maths_max(distance_m / root, EXPLOSION_IMPULSE_LEAST_Z);
    return root * (FAR_PAS / scaled + NEAR_PAS / (scaled * scaled));
}

/* Returns the area of the box's shadow in this direction [m2]; direction: unit, world axes. */
static double area_shown(const struct explosion_impulse_target *target, struct vec3 direction)
{
    const struct kind *kind = target->kind;
    struct vec3 own = rotation_back(&target->turn, direction);
    return fabs(own.x) * kind->width_m * kind->height_m +
           fabs(own.y) * kind->length_m * kind->width_m +
           fabs(own.z) * kind->length_m * kind->height_m;
}

/* Returns one of the box's eight points on world axes, from its centre. */
static struct vec3 gauss_point(const struct explosion_impulse_target *target, unsigned n)
{
    const struct kind *kind = target->kind;
    const struct vec3 own = {(n & 1 ? GAUSS_POINT : -GAUSS_POINT) * kind->length_m,
                             (n & 2 ? GAUSS_POINT : -GAUSS_POINT) * kind->height_m,
                             (n & 4 ? GAUSS_POINT : -GAUSS_POINT) * kind->width_m};
    return rotation_apply(&target->turn, own);
}

struct explosion_impulse explosion_impulse_on(const struct explosion_impulse_target *target,
                                              struct vec3 charge, double explosive_kg)
{
    struct explosion_impulse on_body = {{0.0, 0.0, 0.0}, target->centre};
    struct vec3 line = vec3_sub(target->centre, charge), moment = {0.0, 0.0, 0.0};
    double length = vec3_length(line), sum = 0.0;
    if (!(length > 0.0))
        return on_body;
    for (unsigned n = 0; n < 8; n++) {
        struct vec3 point = gauss_point(target, n);
        double here = explosion_impulse_pas(EXPLOSION_IMPULSE_CASED * explosive_kg,
                                            vec3_length(vec3_add(line, point)));
        sum += here;
        moment = vec3_add(moment, vec3_scale(point, here));
    }
    if (!(sum > 0.0))
        return on_body;
    line = vec3_scale(line, 1.0 / length);
    on_body.impulse_ns = vec3_scale(line, sum / 8.0 * area_shown(target, line));
    on_body.point = vec3_add(target->centre, vec3_scale(moment, 1.0 / sum));
    return on_body;
}

/* moment: of inertia about the centre of mass [kg m2]; edge_m: half the track or half the length;
 * lever_m: height of the push, in the middle of the side that it acts on. */
static bool tips(const struct mass_properties *body, double moment, double edge_m, double lever_m,
                 double push_ns)
{
    double height = body->centre_m, arm2 = height * height + edge_m * edge_m;
    double about_edge = moment + body->mass_kg * arm2;
    double rotation_j = 0.5 * push_ns * push_ns * lever_m * lever_m / about_edge;
    return rotation_j >= body->mass_kg * GRAVITY_MPS2 * (sqrt(arm2) - height);
}

bool explosion_impulse_overturns(const struct kind *kind, double forward_ns, double right_ns)
{
    const struct mass_properties body = mass_properties_of(kind);
    double width = kind->track_m > 0.0 ? kind->track_m : kind->width_m;
    double lever = 0.5 * kind->height_m;
    return kind->domain == DOMAIN_LAND &&
           (tips(&body, body.moment.x, 0.5 * width, lever, right_ns) ||
            tips(&body, body.moment.z, 0.5 * kind->length_m, lever, forward_ns));
}
