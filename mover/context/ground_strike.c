/* Tells what the ground strikes. */
#include "mover/context/ground_strike.h"

#include "world/state.h"
#include "world/world.h"

struct event_collision *ground_strike_tell(struct serial_context *context, uint32_t i,
                                           struct vec3 at, struct vec3 normal,
                                           enum response response)
{
    struct vec3 before = entities_velocity(&context->step->committed->entities, i);
    double speed = vec3_length(before);
    struct event *event = serial_context_intent(context, EVENT_COLLISION);
    context->moved->head->tally.collisions++;
    if (event == NULL)
        return NULL;
    struct event_collision *hit = &event->collision;
    hit->a = serial_context_party(context, i);
    hit->b = (struct event_party){0, KIND_NONE, 1, DAMAGE_NONE};
    hit->point[0] = at.x, hit->point[1] = at.y, hit->point[2] = at.z;
    vec3_to_floats(hit->normal, normal);
    if (speed > 0.0)
        vec3_to_floats(hit->direction_a, vec3_scale(before, 1.0 / speed));
    hit->closing_mps = (float)maths_max(0.0, vec3_dot(before, normal));
    hit->response = response;
    return hit;
}

struct event_collision *ground_strike_tell_below(struct serial_context *context, uint32_t i,
                                                 enum response response)
{
    const struct step_context *step = context->step;
    struct vec3 at = entities_position(step->m, i);
    struct vec3 normal = terrain_normal(&step->world->terrain, step->craters, at.x, at.z);
    return ground_strike_tell(context, i, at, vec3_scale(normal, -1.0), response);
}
