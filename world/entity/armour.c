/* The side that is struck, the path through its armour, and the harm behind it. */
#include "world/entity/armour.h"

#define RAMP_FROM 0.9
#define RAMP_TO   1.1
#define UNFACED   1e-3 /* of a surface that faces no side that the round comes from */
#define COS_LEAST 0.05 /* of the angle: no path is longer than 20 times the armour */

/* The cumulative probabilities of the effects behind armour, and the harm of each as a share of
 * resistance_j: above the least of its level of damage (collider/response/damage.h). */
#define MOBILITY_TO    0.3
#define FIRE_TO        0.6
#define MOBILITY_SHARE 0.35
#define FIRE_SHARE     0.65

/* Returns the side that faces the round and belongs to the struck surface. A sloped bow belongs to
 * the front for a round that comes from ahead, and to the top for one from above. */
static enum aspect aspect_of(struct vec3 flight, struct vec3 outwards, double *cosine)
{
    const double towards[ASPECT_COUNT] = {[ASPECT_FRONT] = -flight.x,
                                          [ASPECT_SIDE] = fabs(flight.z),
                                          [ASPECT_REAR] = flight.x,
                                          [ASPECT_TOP] = fabs(flight.y)};
    const double facing[ASPECT_COUNT] = {
        [ASPECT_FRONT] = outwards.x,
        [ASPECT_SIDE] = flight.z * outwards.z < 0.0 ? fabs(outwards.z) : 0.0,
        [ASPECT_REAR] = -outwards.x,
        [ASPECT_TOP] = flight.y * outwards.y < 0.0 ? fabs(outwards.y) : 0.0};
    enum aspect best = ASPECT_FRONT;
    double most = -1.0;
    for (int a = 0; a < ASPECT_COUNT; a++) {
        double weight = maths_max(towards[a], 0.0) * (maths_max(facing[a], 0.0) + UNFACED);
        if (weight > most) {
            most = weight;
            best = (enum aspect)a;
            *cosine = towards[a];
        }
    }
    return best;
}

struct armour_hit armour_hit_of(const struct kind *vehicle, double penetration_mm,
                                struct vec3 flight, struct vec3 outwards)
{
    struct armour_hit hit = {0};
    hit.aspect = aspect_of(flight, outwards, &hit.cosine);
    hit.path_mm = vehicle->armour_mm[hit.aspect] / maths_max(hit.cosine, COS_LEAST);
    double ratio = penetration_mm / maths_max(hit.path_mm, 1e-3);
    hit.probability = maths_clamp((ratio - RAMP_FROM) / (RAMP_TO - RAMP_FROM), 0.0, 1.0);
    return hit;
}

bool armour_yields(const struct kind *vehicle, const struct kind *round, bool from_above)
{
    double thinnest = maths_min(vehicle->armour_mm[ASPECT_FRONT], vehicle->armour_mm[ASPECT_SIDE]);
    thinnest = maths_min(thinnest, vehicle->armour_mm[ASPECT_REAR]);
    if (from_above)
        thinnest = maths_min(thinnest, vehicle->armour_mm[ASPECT_TOP]);
    return !(round->penetration_mm > 0.0) || thinnest < ARMOUR_LEAST_MM ||
           round->penetration_mm > RAMP_FROM * thinnest;
}

double armour_reach_m(const struct kind *vehicle, const struct kind *round)
{
    double thinner = maths_min(vehicle->armour_mm[ASPECT_FRONT], vehicle->armour_mm[ASPECT_SIDE]);
    double over = round->penetration_mm - RAMP_FROM * thinner;
    if (!(round->penetration_mm > 0.0) || thinner < ARMOUR_LEAST_MM)
        return INFINITY;
    if (!(over > 0.0))
        return 0.0;
    return round->penetration_loss > 0.0 ? 1000.0 * over / round->penetration_loss : INFINITY;
}

double armour_penetration(const struct kind *round, double flown_m)
{
    return maths_max(0.0, round->penetration_mm - 0.001 * flown_m * round->penetration_loss);
}

enum armour_effect armour_effect_of(const struct kind *vehicle, const struct kind *round,
                                    const struct armour_hit *hit, double luck)
{
    if (!(round->penetration_mm > 0.0) || vehicle->armour_mm[hit->aspect] < ARMOUR_LEAST_MM)
        return ARMOUR_NONE;
    if (hit->cosine < ARMOUR_RICOCHET_COSINE && round->penetration_loss > 0.0)
        return ARMOUR_DEFLECTS;
    return luck < hit->probability ? ARMOUR_PENETRATED : ARMOUR_HOLDS;
}

enum armour_loss armour_loss_of(double luck)
{
    return luck < MOBILITY_TO ? ARMOUR_LOSS_MOBILITY
           : luck < FIRE_TO   ? ARMOUR_LOSS_FIRE
                              : ARMOUR_LOSS_ALL;
}

bool armour_disables(const struct kind *vehicle, double joules)
{
    return ARMOUR_INSIDE * joules >= vehicle->resistance_j;
}

double armour_harm(const struct kind *vehicle, double joules, double luck)
{
    static const double shares[] = {[ARMOUR_LOSS_MOBILITY] = MOBILITY_SHARE,
                                    [ARMOUR_LOSS_FIRE] = FIRE_SHARE,
                                    [ARMOUR_LOSS_ALL] = 1.0};
    double share = shares[armour_loss_of(luck)];
    double most = maths_min(1.0, ARMOUR_INSIDE * joules / vehicle->resistance_j);
    return share * most * vehicle->resistance_j;
}
