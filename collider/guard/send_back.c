/* Poses between those at the frame's beginning and its end. */
#include "collider/guard/send_back.h"

#include "collider/resting/contact_groups.h"
#include "collider/guard/drift_guard.h"
#include "collider/resting/ground_placement.h"
#include "collider/resting/held_rest.h"
#include "world/entity/mass_properties.h"

/* A body that tyres, tracks or its weight hold to the ground keeps only the speed of the motion
 * that it kept. One that rolls freely keeps its momentum. */
static void slow_down(struct response_context *context, uint32_t row, double keep)
{
    const struct entities *e = &context->next->entities;
    if (e->row[row].state == ENTITY_ACTIVE && e->row[row].behaviour == BEHAVIOUR_HOLD)
        return;
    table_set_vx(&context->writer, row, e->row[row].vx * keep);
    table_set_vz(&context->writer, row, e->row[row].vz * keep);
    table_set_spin_y(&context->writer, row, e->row[row].spin_y * keep);
}

/* A wreck that goes together with others keeps its velocity, but for what it has gained by a fall
 * that it then has not made. */
static void take_fall(struct response_context *context, uint32_t row, double raised_m)
{
    struct vec3 velocity = entities_velocity(&context->next->entities, row);
    double square = vec3_dot(velocity, velocity), fall = 2.0 * GRAVITY_MPS2 * raised_m;
    if (context->next->entities.row[row].state == ENTITY_WRECK && fall > 0.0 && square > 0.0)
        table_set_velocity(&context->writer, row,
                           vec3_scale(velocity, sqrt(maths_max(0.0, 1.0 - fall / square))));
}

/* A wreck, and a vehicle on its springs, are rigid bodies: they go back in their whole pose. The
 * body that a wreck fell on stops it, unless it goes together with others. */
static void send_body_back(struct response_context *context, uint32_t row, struct vec3 drift,
                           bool drifts, double keep)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    double heading = w->row[row].heading, pitch = w->row[row].pitch, roll = w->row[row].roll;
    if (keep > 0.0) {
        struct quat to = rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll);
        rotation_angles(rotation_between(rotation_of(heading, pitch, roll), to, keep), &heading,
                        &pitch, &roll);
    }
    struct vec3 at =
        vec3_lerp(vec3_add(entities_position(w, row), drift), entities_position(e, row), keep);
    if (drifts)
        take_fall(context, row, at.y - e->row[row].y);
    table_set_position(&context->writer, row, at);
    table_set_heading(&context->writer, row, heading);
    table_set_pitch(&context->writer, row, pitch);
    table_set_roll(&context->writer, row, roll);
    if (drifts || contact_groups_is_piloted(context, row))
        return;
    table_set_velocity(&context->writer, row, vec3_scale(entities_velocity(e, row), keep));
    table_set_spin(&context->writer, row,
                   (struct vec3){e->row[row].spin_x * keep, e->row[row].spin_y * keep,
                                 e->row[row].spin_z * keep});
}

uint8_t send_back_go(struct response_context *context, uint32_t row, struct vec3 drift,
                     uint32_t times)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    double keep = times <= SEND_BACK_HALF ? 0.5 : 0.0;
    bool drifts = vec3_dot(drift, drift) > 0.0;
    if (drift_guard_drifts(context, row) && !drifts) {
        drift_guard_send_back(context, row,
                              times == SEND_BACK_MOST   ? -1.0
                              : times <= SEND_BACK_HALF ? 1.0 / (1u << times)
                                                        : 0.0);
        return (uint8_t)times;
    }
    if (times == SEND_BACK_TURN && !drifts && held_rest_turn_back(context, row))
        return (uint8_t)times;
    if (keep == 0.0 && (!drifts || times == SEND_BACK_MOST)) {
        drift = (struct vec3){0.0, 0.0, 0.0};
        times = SEND_BACK_MOST;
    }
    held_rest_keep_springs(context, row);
    if (e->row[row].state == ENTITY_WRECK || e->row[row].flags & ENTITY_FLAG_CHASSIS ||
        contact_groups_flies(context, row)) {
        send_body_back(context, row, drift, drifts, keep);
        return (uint8_t)times;
    }
    double turn = maths_wrap_half(e->row[row].heading - w->row[row].heading);
    ground_placement_put(context, row,
                         vec3_lerp(entities_position(w, row), entities_position(e, row), keep),
                         maths_wrap_turn(w->row[row].heading + turn * keep));
    slow_down(context, row, keep);
    return (uint8_t)times;
}
