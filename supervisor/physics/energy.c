/* A gain of energy that nothing explains. Bodies are boxes of uniform density. */
#include "supervisor/physics/energy.h"

#include "supervisor/physics/body_measures.h"
#include "world/entity/kind.h"

#include <stdlib.h>

#define GRAVITY_MPS2 9.80665
#define ROUNDING     1e-9          /* of the energy of a body */
#define SHORT_S      (1.01 / 60.0) /* a frame in which nothing both rises and falls */

int energy_make(struct energy *energy, uint32_t capacity)
{
    energy->share = calloc(capacity, sizeof *energy->share);
    return energy->share ? 0 : -1;
}

void energy_free(struct energy *energy)
{
    free(energy->share);
    energy->share = NULL;
}

static double square(double value)
{
    return value * value;
}

/* Returns the kinetic energy [J]. Of a held body the vertical speed only follows the ground. */
static double kinetic_j(const struct kind *kind, const struct motion_look *look, bool held)
{
    struct vec3 v = look->velocity;
    if (held)
        return 0.5 * kind->mass_kg *
               (square(v.x) + square(v.z) + motion_look_gyration(kind).y * square(look->spin.y));
    v = motion_look_centre_velocity(look, kind);
    return 0.5 * kind->mass_kg * (vec3_dot(v, v) + square(motion_look_turning(look, kind)));
}

/* Returns how far the centre of mass has come down in a frame [m]. */
static double fall_m(const struct body_look *body)
{
    double arms =
        motion_look_centre(body->was, body->kind).y - motion_look_centre(&body->now, body->kind).y;
    return body->was->pose.at.y - body->now.pose.at.y + arms;
}

/* Returns the work that weight may have done on a body in a frame [J]. Of a wreck it counts in
 * full, whether it falls or rises: kinetic and potential energy together do not grow. Of another
 * body in the air only a fall counts, because its engine lifts it. */
static double weight_j(const struct body_look *body, bool held)
{
    double fall = fall_m(body);
    if (held)
        return 0.0;
    return body->kind->mass_kg * GRAVITY_MPS2 *
           (body->now.wreck && body->was->wreck ? fall : maths_max(0.0, fall));
}

/* Returns the greatest acceleration by an aircraft's engine [m/s2]. An aeroplane speeds up along
 * its nose and upwards, each at most twice as hard as its kind says. One that hovers has its whole
 * lift along its mast, whichever way that points. */
static double thrust_mps2(const struct kind *kind)
{
    double engine = 3.0 * kind->acceleration_mps2;
    return kind->min_speed_mps > 0.0 ? engine : maths_max(engine, kind->max_load * GRAVITY_MPS2);
}

/* Returns the work that engine and weight may have done on a body in a frame [J]. The engine works
 * until the impact that makes a wreck of the body. */
static double work_j(const struct body_look *body, bool held, double dt_s)
{
    const struct kind *kind = body->kind;
    double speed = vec3_length(body->was->velocity), push = 0.0, steering = 0.0;
    if (!body->was->wreck) {
        push = kind->domain == DOMAIN_AIR ? thrust_mps2(kind) : kind->acceleration_mps2;
        if (kind->domain == DOMAIN_LAND) /* out of gear it rolls down the slope */
            push += GRAVITY_MPS2 *
                    maths_max(fabs(body->now.pose.forward.y), fabs(body->was->pose.forward.y));
    }
    if (!body->was->wreck && (body->struck > 0 || body->touches || body->now.grounded))
        steering = 0.5 * kind->mass_kg * motion_look_gyration(kind).y * square(kind->turn_rate_rps);
    return kind->mass_kg * (speed * push * dt_s + 0.5 * square(push * dt_s)) +
           weight_j(body, held) + steering;
}

/* Returns the work by which a wreck may have been pushed out of the ground [J]: at most a rise by
 * the depth of its lowest corner. It is what the rise of its centre of mass took beyond its kinetic
 * energy. In a frame longer than SHORT_S the wreck may have come down again. */
static double pushed_j(const struct body_look *body, double kinetic_before_j, double dt_s)
{
    double weight_n = body->kind->mass_kg * GRAVITY_MPS2;
    double most_j = weight_n * maths_max(0.0, -body->was->lowest_m);
    if (!body->now.wreck || !body->was->wreck)
        return 0.0;
    if (dt_s > SHORT_S)
        return most_j;
    return maths_clamp(-weight_n * fall_m(body) - kinetic_before_j, 0.0, most_j);
}

static void begin_share(struct energy_share *share, uint32_t index, const struct body_look *body,
                        double dt_s)
{
    *share = (struct energy_share){.parent = index, .mass_kg = body->kind->mass_kg};
    share->unexplained =
        body->known && body->finite && !body->commanded && body->blasts == 0 && !body->foreign;
    if (share->unexplained) /* springs give energy back: see sprung_body.h */
        share->unexplained = !body->now.sprung && !body->was->sprung;
    if (!share->unexplained)
        return;
    bool held = body_measures_held(body);
    double now = kinetic_j(body->kind, &body->now, held);
    double before = kinetic_j(body->kind, body->was, held);
    double work = work_j(body, held, dt_s) + pushed_j(body, before, dt_s);
    share->gain_j = now - before - work - ROUNDING * (now + before);
}

static uint32_t root_of(struct energy_share *share, uint32_t index)
{
    while (share[index].parent != index)
        index = share[index].parent = share[share[index].parent].parent;
    return index;
}

static void join(struct energy_share *share, const struct neighbour_pair *pair)
{
    uint32_t a = root_of(share, pair->a), b = root_of(share, pair->b);
    if (a == b)
        return;
    share[b].parent = a;
    share[a].gain_j += share[b].gain_j;
    share[a].mass_kg += share[b].mass_kg;
    share[a].unexplained &= share[b].unexplained;
}

void energy_look(struct energy *energy, struct measures *measures, const struct body_looks *looks,
                 const struct neighbour_pairs *touching, double dt_s)
{
    struct energy_share *share = energy->share;
    for (uint32_t i = 0; i < looks->count; i++)
        begin_share(&share[i], i, &looks->body[i], dt_s);
    for (uint32_t i = 0; i < touching->count; i++)
        join(share, &touching->pair[i]);
    for (uint32_t i = 0; i < looks->count; i++) {
        if (share[i].parent == i && share[i].unexplained && share[i].mass_kg > 0.0)
            measure_take(measures, MEASURE_OF_ENERGY,
                         maths_max(0.0, share[i].gain_j / share[i].mass_kg), &looks->body[i].named,
                         NULL);
    }
}
