/* What avoidance knows of kinds and fixed objects. */
#include "mover/agent/avoidance_internal.h"

#include "mover/agent/driving/ground_obstacles.h"
#include "world/entity/hull.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fixed_index.h"
#include "world/world.h"

#include <stdlib.h>

#define REACT_S        0.6  /* time until a look has turned or slowed the vehicle */
#define TURNS_AHEAD    1.5  /* least horizon in turning circles */
#define HORIZON_M      12.0 /* added to the horizon */
#define FARTHEST_M     600.0
#define TALL_M         3.0   /* parts above this height are no obstacle for land vehicles */
#define DISC_M         3.0   /* a fixed object that reaches less far is seen as a disc */
#define GAP_M          1.0   /* gap to obstacles at the sides and ahead */
#define AIR_GAP_M      8.0   /* the same in the air, and above and below */
#define HARMLESS_SHARE 0.005 /* most of its resistance_j that a harmless object costs */
#define YIELDS         0.1   /* fixed kinds with less rigidity bend aside */

/* --- what follows from the kinds ---------------------------------------------------------------*/

/* What a land vehicle meets of a fixed kind's model: the hulls that begin below TALL_M. */
struct low_part {
    double reach_m; /* the sphere's radius where spheres collide */
    double low_x, high_x, low_z, high_z;
};

static struct low_part low_part_of(const struct world *world, const struct kind *kind)
{
    struct low_part part = {
        .low_x = INFINITY, .high_x = -INFINITY, .low_z = INFINITY, .high_z = -INFINITY};
    double farthest = 0.0;
    for (uint32_t h = 0; h < kind->hull_count; h++) {
        const struct hull *hull = &world->hulls[kind->first_hull + h];
        const struct vec3 *vertex = &world->hull_vertices[hull->first_vertex];
        double low = INFINITY;
        for (uint32_t v = 0; v < hull->vertex_count; v++)
            low = maths_min(low, vertex[v].y);
        for (uint32_t v = 0; v < hull->vertex_count && low < TALL_M; v++) {
            farthest = maths_max(farthest, vertex[v].x * vertex[v].x + vertex[v].z * vertex[v].z);
            part.low_x = maths_min(part.low_x, vertex[v].x);
            part.high_x = maths_max(part.high_x, vertex[v].x);
            part.low_z = maths_min(part.low_z, vertex[v].z);
            part.high_z = maths_max(part.high_z, vertex[v].z);
        }
    }
    part.reach_m = sqrt(farthest);
    return part;
}

/* Sets the disc of a fixed kind, and the rectangle of a large one. */
static void find_extent(struct avoidance *avoidance, const struct world *world, uint32_t k)
{
    const struct kind *kind = &world->kinds[k];
    const struct low_part part = low_part_of(world, kind);
    if (world->params->collision.shape != SHAPE_MODEL) {
        avoidance->reach_m[k] = kind->radius_m;
        return;
    }
    avoidance->reach_m[k] = part.reach_m;
    if (part.reach_m > DISC_M)
        avoidance->box[k] = (struct avoidance_box){.x = 0.5 * (part.low_x + part.high_x),
                                                   .z = 0.5 * (part.low_z + part.high_z),
                                                   .half_x = 0.5 * (part.high_x - part.low_x),
                                                   .half_z = 0.5 * (part.high_z - part.low_z)};
}

/* How far the model of a kind reaches ahead of its middle, with its gun straight ahead. */
static double nose_of(const struct world *world, const struct kind *kind)
{
    double farthest = 0.5 * kind->length_m;
    for (uint32_t h = 0; h < kind->hull_count && world->params->collision.shape == SHAPE_MODEL;
         h++) {
        const struct hull *hull = &world->hulls[kind->first_hull + h];
        farthest = maths_max(farthest, hull->centre.x + hull->half.x);
    }
    return farthest;
}

/* By the collider's impulses a bush bends, and an object that breaks costs the vehicle the object's
 * resistance times its rigidity. */
static bool does_no_harm(const struct kind *vehicle, const struct kind *fixed)
{
    if (fixed->rigidity < YIELDS)
        return true;
    double energy = 0.5 * vehicle->mass_kg * vehicle->max_speed_mps * vehicle->max_speed_mps;
    return energy > fixed->resistance_j &&
           fixed->resistance_j * fixed->rigidity < HARMLESS_SHARE * vehicle->resistance_j;
}

double avoidance_gap(const struct kind *kind)
{
    return kind->domain == DOMAIN_AIR ? AIR_GAP_M : GAP_M;
}

double avoidance_horizon(const struct kind *kind, double speed_mps)
{
    double brake = BRAKES * kind->acceleration_mps2;
    double horizon = maths_max(speed_mps * speed_mps / (2.0 * brake),
                               TURNS_AHEAD * speed_mps / kind->turn_rate_rps);
    return maths_min(FARTHEST_M,
                     horizon + speed_mps * REACT_S + HORIZON_M + 2.0 * (0.5 * kind->length_m));
}

double avoidance_around(double horizon_m)
{
    return maths_min(FARTHEST_M, 2.0 * horizon_m);
}

int avoidance_init(struct avoidance *avoidance, const struct world *world)
{
    const uint32_t squares = world->terrain.squares.count;
    *avoidance =
        (struct avoidance){.occupied = calloc((squares + 63) / 64, sizeof *avoidance->occupied)};
    if (!avoidance->occupied)
        return -1;
    uint32_t kinds = kind_of_files(world->kinds, world->counts.kinds);
    for (uint32_t k = 0; k < kinds; k++) {
        const struct kind *kind = &world->kinds[k];
        if (kind->domain == DOMAIN_FIXED)
            find_extent(avoidance, world, k);
        for (uint32_t o = 0; o < kinds && kind->domain != DOMAIN_FIXED; o++) {
            if (world->kinds[o].domain == DOMAIN_FIXED && does_no_harm(kind, &world->kinds[o]))
                avoidance->harmless[k] |= UINT64_C(1) << o;
        }
        if (kind->domain < DOMAIN_MUNITION) {
            avoidance->reach_m[k] =
                0.5 * sqrt(kind->length_m * kind->length_m + kind->width_m * kind->width_m);
            avoidance->nose_m[k] = nose_of(world, kind);
            avoidance->high_m[k] = (float)(0.5 * kind->height_m + AVOIDANCE_ROUNDED_M);
            avoidance->gap_m[k] = kind->domain == DOMAIN_LAND
                                      ? INFINITY
                                      : (float)(avoidance_gap(kind) + AVOIDANCE_ROUNDED_M);
            avoidance->around_m[k] = avoidance_around(avoidance_horizon(kind, kind->max_speed_mps));
            avoidance->slope[k] = ground_obstacles_slope(kind);
            if (kind->domain == DOMAIN_LAND)
                avoidance->fastest_mps = maths_max(avoidance->fastest_mps, kind->max_speed_mps);
        }
    }
    for (uint32_t square = 0; square < squares; square++) {
        if (world->reach_start[square + 1] > world->reach_start[square])
            avoidance->occupied[square / 64] |= UINT64_C(1) << square % 64;
    }
    return 0;
}

void avoidance_free(struct avoidance *avoidance)
{
    free(avoidance->occupied);
    avoidance->occupied = NULL;
}

/* --- fixed objects ---------------------------------------------------------------------------- */

double avoidance_disc(const struct step_context *context, const struct fixed_object *object)
{
    const struct kind *kind = &context->world->kinds[object->kind];
    return kind->outline ? (double)object->radius_m
                         : context->avoidance->reach_m[object->kind] * fixed_scale(object, kind);
}

uint32_t avoidance_boxes(const struct step_context *context, const struct fixed_object *object)
{
    const struct kind *kind = &context->world->kinds[object->kind];
    if (context->world->params->collision.shape != SHAPE_MODEL)
        return 0;
    return kind->outline ? kind->hull_count : context->avoidance->box[object->kind].half_x > 0.0;
}

struct avoidance_box_placed avoidance_box_of(const struct step_context *context,
                                             const struct fixed_object *object, uint32_t n)
{
    const struct kind *kind = &context->world->kinds[object->kind];
    const struct hull *hull = &context->world->hulls[kind->first_hull + n];
    const struct avoidance_box of_hull = {hull->centre.x, hull->centre.z, hull->half.x,
                                          hull->half.z};
    const struct avoidance_box *box =
        kind->outline ? &of_hull : &context->avoidance->box[object->kind];
    const double scale = kind->outline ? 1.0 : fixed_scale(object, kind);
    double sine, cosine;
    maths_sincos(fixed_heading(object), &sine, &cosine);
    return (struct avoidance_box_placed){.x = object->x + scale * (box->x * sine + box->z * cosine),
                                         .z = object->z + scale * (box->z * sine - box->x * cosine),
                                         .ux = sine,
                                         .uz = -cosine,
                                         .half_m = scale * box->half_x,
                                         .half_width = scale * box->half_z};
}

bool avoidance_harms(const struct step_context *context, uint32_t i, uint32_t n)
{
    const struct world *world = context->world;
    const uint16_t kind = world->fixed[n].kind, own = context->m->row[i].kind;
    if (context->committed->fixed_damage[n] >= DAMAGE_HIGH)
        return false;
    return world->kinds[kind].outline ? !does_no_harm(&world->kinds[own], &world->kinds[kind])
                                      : !(context->avoidance->harmless[own] >> kind & 1u);
}
