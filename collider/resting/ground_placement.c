/* Heights under bodies that have been moved. */
#include "collider/resting/ground_placement.h"

#include "world/terrain/rest_pose.h"
#include "world/world.h"

void ground_placement_put(struct response_context *context, uint32_t row, struct vec3 at,
                          double heading_rad)
{
    const struct entities *e = &context->next->entities;
    const struct terrain *terrain = &context->world->terrain;
    const struct crater_index *craters = context->input.detect.craters;
    const struct kind *kind = &context->world->kinds[e->kind[row]];
    if (e->state[row] == ENTITY_ACTIVE && kind->domain == DOMAIN_LAND &&
        !(e->flags[row] & ENTITY_FLAG_CHASSIS)) {
        struct rest_pose pose = rest_pose_of(terrain, craters, kind, at.x, at.z, heading_rad);
        at.y = pose.y_m;
        table_set_pitch(&context->writer, row, pose.pitch_rad);
        table_set_roll(&context->writer, row, pose.roll_rad);
    } else {
        at.y = e->y[row] + terrain_height(terrain, craters, at.x, at.z) -
               terrain_height(terrain, craters, e->x[row], e->z[row]);
    }
    table_set_position(&context->writer, row, at);
    table_set_heading(&context->writer, row, heading_rad);
}
