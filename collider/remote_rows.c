/* Remote entities are where their owner has told, or on the way there. */
#include "collider/remote_rows.h"

#include "world/checksum.h"
#include "world/entity/remote.h"
#include "world/maths/maths.h"
#include "world/maths/rotation.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_clamp.h"
#include "world/world.h"

/* Makes the remote rows that responses wrote what they were. */
static void restore(struct response_context *context, const struct entities *moved)
{
    const uint64_t *written = context->writer.written;
    for (uint32_t w = 0; w * 64 < context->next->head->used; w++) {
        for (uint64_t left = written[w]; left != 0; left &= left - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(left);
            if (remote_is(moved, row))
                table_copy_row(&context->writer, moved, row);
        }
    }
}

static void correct(struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    double dt_s = world_dt_s(context->world);
    struct vec3 drift = remote_drift(e, row), turn = remote_turn(e, row);
    if (vec3_dot(drift, drift) > 0.0) {
        struct vec3 at = vec3_add(entities_position(e, row), vec3_scale(drift, dt_s));
        at.x = world_clamp(context->world, at.x);
        at.z = world_clamp(context->world, at.z);
        if (e->row[row].order_arg >> REMOTE_FLAGS_SHIFT & REMOTE_FLAG_CLAMPED)
            (void)ground_clamp(&context->world->terrain, context->input.detect.craters,
                               REMOTE_CLAMP_M, &at);
        table_set_position(&context->writer, row, at);
    }
    if (vec3_dot(turn, turn) > 0.0) {
        double heading, pitch, roll;
        struct quat now = rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll);
        rotation_angles(rotation_spun(now, turn, dt_s), &heading, &pitch, &roll);
        table_set_heading(&context->writer, row, heading);
        table_set_pitch(&context->writer, row, pitch);
        table_set_roll(&context->writer, row, roll);
    }
}

void remote_rows_settle(struct response_context *context, const struct entities *moved)
{
    const struct entities *e = &context->next->entities;
    uint32_t used = context->next->head->used, tick = (uint32_t)context->next->head->tick;
    if (context->world->params->remotes_max == 0)
        return;
    restore(context, moved);
    for (uint32_t row = 0; row < used; row++) {
        if (remote_is_corrected(e, row, tick))
            correct(context, row);
    }
}
