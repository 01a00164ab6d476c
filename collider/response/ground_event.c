/* A collision of which the other party is the ground. */
#include "collider/response/ground_event.h"

void ground_event_write(struct response_context *context, uint32_t row,
                        const struct ground_strike *strike)
{
    const struct entities *e = &context->next->entities;
    struct event *event = event_writer_event(&context->events, EVENT_COLLISION);
    double speed = vec3_length(strike->velocity);
    context->next->head->tally.collisions++;
    if (!event)
        return;
    struct event_collision *collision = &event->collision;
    collision->a = (struct event_party){e->row[row].id, e->row[row].kind, 0, e->row[row].damage};
    collision->b = (struct event_party){0, KIND_NONE, 1, DAMAGE_NONE};
    collision->point[0] = strike->at.x;
    collision->point[1] = strike->at.y;
    collision->point[2] = strike->at.z;
    vec3_to_floats(collision->normal, vec3_scale(strike->normal, -1.0));
    if (speed > 0.0)
        vec3_to_floats(collision->direction_a, vec3_scale(strike->velocity, 1.0 / speed));
    collision->toi = strike->time;
    collision->closing_mps = (float)strike->closing_mps;
    collision->response = strike->response;
}
