/* Figure 8 of the thesis (p. 22), with the gaps that it leaves closed: a fixed object's damage goes
 * by the impact's energy against its resistance, since the text asks for speed as well as mass, and
 * what lies between its last two constants counts as none. */
#include "collider/respond.h"

#define SEVERE_RAD  (5.0 * RAD_PER_DEG) /* around each quarter turn, both ends included */
#define BOUNCE_KEEP 0.6 /* of a bouncing vehicle's speed: "diminish speed of both" */

/* Angles come from headings, which are never exact to the last bit: a ten-thousandth of a degree
 * keeps 5 and 85 degrees on the severe side. */
#define ANGLE_SLACK_RAD (1e-4 * RAD_PER_DEG)

static bool severe(double angle_rad)
{
    double off = maths_wrap_half(4.0 * angle_rad) * 0.25;
    return fabs(off) <= SEVERE_RAD + ANGLE_SLACK_RAD;
}

static double speed_of(const struct respond *respond, uint32_t row)
{
    return vec3_length(entities_velocity(&respond->next->entities, row));
}

static double mass_of(const struct respond *respond, uint32_t row)
{
    return respond->world->kinds[respond->next->entities.kind[row]].mass_kg;
}

/* Mirrored off the plane of contact when it was going into it, and slower. */
static struct vec3 bounced(struct vec3 velocity, struct vec3 normal)
{
    double into = vec3_dot(velocity, normal);
    if (into > 0.0)
        velocity = vec3_sub(velocity, vec3_scale(normal, 2.0 * into));
    return vec3_scale(velocity, BOUNCE_KEEP);
}

static int kill_both(struct respond *respond, const struct impact *impact)
{
    const struct vec3 still = {0.0, 0.0, 0.0};
    if (respond_stay(respond, impact->a, impact->time, still) != 0 ||
        respond_stay(respond, impact->b, impact->time, still) != 0 ||
        harm_destroy(respond, impact->a, impact->time) != 0)
        return -1;
    return harm_destroy(respond, impact->b, impact->time);
}

int figure8_moving(struct respond *respond, const struct impact *impact, struct outcome *outcome)
{
    const struct entities *e = &respond->next->entities;
    struct vec3 va = entities_velocity(e, impact->a), vb = entities_velocity(e, impact->b);
    double ma = mass_of(respond, impact->a), mb = mass_of(respond, impact->b);
    double before = 0.5 * ma * vec3_dot(va, va) + 0.5 * mb * vec3_dot(vb, vb);
    if (severe(impact->angle_rad)) {
        double speed = maths_max(speed_of(respond, impact->a), speed_of(respond, impact->b));
        if (speed > respond->world->params->collision.fast_vehicle_mps) {
            outcome->response = RESPONSE_DESTROYED;
            return kill_both(respond, impact);
        }
        outcome->response = RESPONSE_STOP;
        va = vb = (struct vec3){0.0, 0.0, 0.0};
    } else {
        outcome->response = RESPONSE_BOUNCE;
        va = bounced(va, impact->normal);
        vb = bounced(vb, vec3_scale(impact->normal, -1.0));
    }
    double lost = before - 0.5 * ma * vec3_dot(va, va) - 0.5 * mb * vec3_dot(vb, vb);
    if (respond_stay(respond, impact->a, impact->time, va) != 0 ||
        respond_stay(respond, impact->b, impact->time, vb) != 0)
        return -1;
    /* The larger mass hurts the smaller more (row 30). */
    if (harm_row(respond, impact->a, lost * mb / (ma + mb), impact->time) != 0)
        return -1;
    return harm_row(respond, impact->b, lost * ma / (ma + mb), impact->time);
}

int figure8_fixed(struct respond *respond, const struct impact *impact, struct outcome *outcome)
{
    const struct world *world = respond->world;
    const struct collision_params *limits = &world->params->collision;
    uint32_t object = impact->b & ~PAIR_FIXED;
    double fixed_kg = world->kinds[world->fixed[object].kind].mass_kg;
    double mass_kg = mass_of(respond, impact->a);
    double energy = 0.5 * mass_kg * impact->closing_mps * impact->closing_mps;
    harm_fixed(respond, object, energy);
    if (fixed_kg >= limits->large_fixed_kg &&
        speed_of(respond, impact->a) > limits->fast_fixed_mps) {
        outcome->response = RESPONSE_DESTROYED;
        if (respond_stay(respond, impact->a, impact->time, (struct vec3){0.0, 0.0, 0.0}) != 0)
            return -1;
        return harm_destroy(respond, impact->a, impact->time);
    }
    outcome->response = RESPONSE_SLOW;
    if (respond_slow(respond, impact->a, impact->time, mass_kg / (mass_kg + fixed_kg)) != 0)
        return -1;
    return harm_row(respond, impact->a, energy * fixed_kg / (mass_kg + fixed_kg), impact->time);
}
