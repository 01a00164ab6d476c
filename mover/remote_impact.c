/* An impact that another simulator tells of. */
#include "mover/remote_impact.h"

#include "world/entity/event.h"
#include "world/entity/impact_harm.h"
#include "world/maths/rotation.h"
#include "world/state.h"
#include "world/world.h"

#define MASS_MOST_KG   1e9
#define SPEED_MOST_MPS 10000.0
#define LEAST_MPS      0.1 /* slower bodies only touch */
#define LEAST_M        0.01

/* How two bodies meet. */
struct strike {
    struct vec3 point;  /* [m, world] */
    struct vec3 normal; /* from the body that strikes into the one that is struck */
    double closing_mps; /* along it */
    double impulse_ns, lost_j;
};

static bool is_good(const struct remote_record *record)
{
    bool good = (double)record->mass_kg > 0.0 && (double)record->mass_kg <= MASS_MOST_KG &&
                record->restitution >= 0.0f && record->restitution <= 1.0f;
    for (int i = 0; i < 3; i++)
        good = good && fabs((double)record->velocity[i]) <= SPEED_MOST_MPS &&
               fabs(record->position[i]) <= SPEED_MOST_MPS;
    return good;
}

/* Returns the direction from the point to the middle of the vehicle, along the ground for one that
 * stands on it. */
static struct vec3 direction_of(struct vec3 to_middle, struct vec3 approach, bool level)
{
    const struct vec3 none = {0.0, 0.0, 0.0};
    struct vec3 way = vec3_length(to_middle) > LEAST_M ? to_middle : approach;
    if (level)
        way.y = 0.0;
    double length = vec3_length(way);
    return length > LEAST_M ? vec3_scale(way, 1.0 / length) : none;
}

static struct strike strike_of(const struct serial_context *context,
                               const struct remote_record *record, uint32_t target)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kind = &context->step->world->kinds[m->row[target].kind];
    struct mat3 turn = rotation_matrix(
        rotation_of(m->row[target].heading, m->row[target].pitch, m->row[target].roll));
    struct vec3 point = {record->position[0], record->position[1], record->position[2]};
    struct vec3 velocity = {(double)record->velocity[0], (double)record->velocity[1],
                            (double)record->velocity[2]};
    double reach = maths_max(kind->bound_m, kind->radius_m), mass = (double)record->mass_kg;
    if (vec3_length(point) > reach)
        point = vec3_scale(point, reach / vec3_length(point));
    point = rotation_apply(&turn, point);
    struct vec3 approach = vec3_sub(velocity, entities_velocity(m, target));
    struct strike strike = {
        .point = vec3_add(entities_position(m, target), point),
        .normal = direction_of(vec3_scale(point, -1.0), approach, kind->domain != DOMAIN_AIR)};
    double reduced = mass * kind->mass_kg / (mass + kind->mass_kg);
    double back = (double)record->restitution;
    strike.closing_mps = vec3_dot(approach, strike.normal);
    strike.impulse_ns = (1.0 + back) * reduced * strike.closing_mps;
    strike.lost_j = 0.5 * (1.0 - back * back) * reduced * strike.closing_mps * strike.closing_mps;
    return strike;
}

/* A land vehicle that is pushed moves on as a body on its springs, and a wreck is not at rest. */
static void push(struct serial_context *context, uint32_t target, const struct strike *strike)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kind = &context->step->world->kinds[m->row[target].kind];
    struct vec3 gain = vec3_scale(strike->normal, strike->impulse_ns / kind->mass_kg);
    table_set_velocity(&context->writer, target, vec3_add(entities_velocity(m, target), gain));
    if (m->row[target].state == ENTITY_WRECK) {
        table_set_until_tick(&context->writer, target, 0);
        return;
    }
    table_set_harm_j(&context->writer, target,
                     m->row[target].harm_j +
                         impact_harm(kind, m->row[target].harm_j, 0.5 * strike->lost_j));
    if (kind->domain == DOMAIN_LAND && m->row[target].behaviour != BEHAVIOUR_HOLD) {
        table_set_flags(&context->writer, target, m->row[target].flags | ENTITY_FLAG_CHASSIS);
        table_set_jolt_tick(&context->writer, target, (uint32_t)context->step->tick);
    }
}

static void tell(struct serial_context *context, uint32_t target, uint32_t body, struct vec3 before,
                 const struct strike *strike)
{
    struct event *event = serial_context_intent(context, EVENT_COLLISION);
    double speed = vec3_length(before);
    context->moved->head->tally.collisions++;
    if (!event)
        return;
    struct event_collision *hit = &event->collision;
    hit->a = serial_context_party(context, target);
    hit->b = body == SLOT_NONE ? (struct event_party){.kind = KIND_NONE}
                               : serial_context_party(context, body);
    hit->point[0] = strike->point.x;
    hit->point[1] = strike->point.y;
    hit->point[2] = strike->point.z;
    vec3_to_floats(hit->normal, vec3_scale(strike->normal, -1.0));
    if (speed > 0.0)
        vec3_to_floats(hit->direction_a, vec3_scale(before, 1.0 / speed));
    hit->closing_mps = (float)strike->closing_mps;
    hit->impulse_ns = (float)strike->impulse_ns;
    hit->response = RESPONSE_BOUNCE;
    hit->remote = 1;
}

enum remote_refusal remote_impact(struct serial_context *context,
                                  const struct remote_record *record, uint32_t target,
                                  uint32_t body)
{
    if (!is_good(record))
        return REMOTE_UNKNOWN;
    struct vec3 before = entities_velocity(&context->moved->entities, target);
    serial_context_stop(context, target, context->step->tick - 1);
    struct strike strike = strike_of(context, record, target);
    if (strike.closing_mps < LEAST_MPS)
        return REMOTE_TAKEN;
    push(context, target, &strike);
    tell(context, target, body, before, &strike);
    return REMOTE_TAKEN;
}
