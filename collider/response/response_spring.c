/* The response "spring": a spring between the two skins, without friction. Contacts are solved one
 * after the other. */
#include "collider/response/contact_impulse.h"
#include "collider/response/response.h"
#include "world/entity/kind.h"
#include "world/maths/rotation.h"

/* Change of the speed along the normal at the contact by a unit impulse [1/kg]. */
static double mobility(const struct solver_body *body, const struct solver_contact *contact)
{
    struct vec3 n = contact->normal, r = vec3_sub(contact->point, body->centre);
    struct vec3 moment = vec3_cross(r, n);
    struct vec3 spin = rotation_apply(&body->inverse_inertia, moment);
    return n.x * n.x * body->inverse_mass.x + n.y * n.y * body->inverse_mass.y +
           n.z * n.z * body->inverse_mass.z + vec3_dot(moment, spin);
}

static void strike(struct solver_body *body, struct vec3 point, struct vec3 impulse)
{
    struct vec3 r = vec3_sub(point, body->centre);
    struct vec3 moment = vec3_cross(r, impulse);
    body->velocity = vec3_add(body->velocity, (struct vec3){body->inverse_mass.x * impulse.x,
                                                            body->inverse_mass.y * impulse.y,
                                                            body->inverse_mass.z * impulse.z});
    body->spin = vec3_add(body->spin, rotation_apply(&body->inverse_inertia, moment));
}

static void by_spring(const struct response_context *context, struct island_contact *met,
                      struct solver_body *bodies, struct solver_contact *contact)
{
    struct solver_body *a = &bodies[contact->a], *b = &bodies[contact->b];
    const struct impact *impact = &met->impact;
    const struct kind *ka = contact_impulse_kind(context, impact->a);
    const struct kind *kb = contact_impulse_kind(context, impact->b);
    struct vec3 relative = vec3_sub(contact_impulse_velocity(a, contact->point),
                                    contact_impulse_velocity(b, contact->point));
    double gives = mobility(a, contact) + mobility(b, contact);
    contact->closing_mps = vec3_dot(relative, contact->normal);
    contact->impulse = (struct vec3){0.0, 0.0, 0.0};
    contact->lost_j = 0.0;
    if (!(contact->closing_mps > 0.0) || !(gives > 0.0))
        return;
    const struct contact_spring spring = {
        .reduced_kg = 1.0 / gives,
        .closing_mps = contact->closing_mps,
        .stiffness_npm = contact_spring_in_series(ka->stiffness_npm, kb->stiffness_npm),
        .restitution = contact->restitution};
    met->spring = contact_spring_impact(&spring);
    double out = contact->closing_mps * contact->restitution;
    contact->lost_j = 0.5 / gives * (contact->closing_mps * contact->closing_mps - out * out);
    contact->impulse = vec3_scale(contact->normal, met->spring.impulse_ns);
    strike(a, contact->point, vec3_scale(contact->impulse, -1.0));
    strike(b, contact->point, contact->impulse);
}

static void solve(struct response_context *context, uint32_t first, uint32_t bodies)
{
    struct island *island = context->island;
    struct solver_contact *contact = island->contact;
    (void)bodies;
    for (uint32_t i = first; i != 0; i = island->met[i - 1].next)
        by_spring(context, &island->met[i - 1], island->solve, contact++);
}

const struct response_functions response_spring = {.joint = solve};
