/* Heights under bodies that have been moved, and depths of those that have been pushed. */
#include "collider/resting/ground_placement.h"

#include "collider/response/path_change.h"
#include "world/body_points.h"
#include "world/course_lift.h"
#include "world/vehicle_shell.h"
#include "world/world.h"

#define SINKS_M       0.02 /* as deep may a wreck at rest be in the ground */
#define PUSHED_M      0.05 /* and one that rolls or slides, as of all that the ground bears */
#define SHELL_SINKS_M 0.01 /* and the shell of a vehicle that another body pushes */
#define EXACT_M       1e-8 /* error of a depth: less is no deepening of a greater depth */

void ground_placement_put(struct response_context *context, uint32_t row, struct vec3 at,
                          double heading_rad)
{
    const struct entities *e = &context->next->entities;
    const struct terrain *terrain = &context->world->terrain;
    const struct crater_index *craters = context->input.detect.craters;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    if (e->row[row].state == ENTITY_ACTIVE && kind->domain == DOMAIN_LAND &&
        !(e->row[row].flags & ENTITY_FLAG_CHASSIS)) {
        const struct rest_pose pose =
            e->row[row].behaviour == BEHAVIOUR_HOLD
                ? course_lift_pose(context->world, craters, e->row[row].kind, at.x, at.z,
                                   heading_rad)
                : rest_pose_of(terrain, craters, kind, at.x, at.z, heading_rad);
        at.y = pose.y_m;
        table_set_pitch(&context->writer, row, pose.pitch_rad);
        table_set_roll(&context->writer, row, pose.roll_rad);
    } else {
        at.y = e->row[row].y + terrain_height(terrain, craters, at.x, at.z) -
               terrain_height(terrain, craters, e->row[row].x, e->row[row].z);
    }
    table_set_position(&context->writer, row, at);
    table_set_heading(&context->writer, row, heading_rad);
}

/* Returns true for a vehicle that holds its course and has no springs. */
static bool holds_course(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return e->row[row].state == ENTITY_ACTIVE && e->row[row].behaviour == BEHAVIOUR_HOLD &&
           context->world->kinds[e->row[row].kind].domain == DOMAIN_LAND &&
           !(e->row[row].flags & ENTITY_FLAG_CHASSIS);
}

/* Returns true if one of these craters or its rim may be under a row. */
static bool is_dug_under(const struct response_context *context, uint32_t first, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    const double bound_m = context->world->kinds[e->row[row].kind].bound_m;
    for (uint32_t i = first; i < context->next->head->crater_count; i++) {
        const struct crater *crater = &context->next->craters[i];
        const double reach_m = (double)crater->radius_m * CRATER_RIM + bound_m;
        if (fabs(crater->x - e->row[row].x) < reach_m && fabs(crater->z - e->row[row].z) < reach_m)
            return true;
    }
    return false;
}

void ground_placement_dug(struct response_context *context, uint32_t first)
{
    const struct entities *e = &context->next->entities;
    for (uint32_t row = 0; row < context->next->head->used; row++) {
        if (holds_course(context, row) && is_dug_under(context, first, row))
            ground_placement_put(context, row, entities_position(e, row), e->row[row].heading);
    }
}

void ground_placement_changed(struct response_context *context)
{
    const struct entities *e = &context->next->entities;
    const struct body_motion *motion = context->motion;
    for (uint32_t i = 0; i < motion->changes; i++) {
        uint32_t row = motion->row[i];
        if (e->row[row].state == ENTITY_ACTIVE && path_change_grounded(context, row))
            ground_placement_put(context, row, entities_position(e, row), e->row[row].heading);
    }
}

static struct exit_slope slope_under(const struct response_context *context, uint32_t row)
{
    const struct entities *w = body_motion_before(context->motion, row);
    if (context->world->kinds[w->row[row].kind].domain == DOMAIN_SEA)
        return (struct exit_slope){0.0, 0.0};
    struct vec3 normal = terrain_normal(&context->world->terrain, context->input.detect.craters,
                                        w->row[row].x, w->row[row].z);
    return (struct exit_slope){-normal.x / normal.y, -normal.z / normal.y};
}

struct exit_slope ground_placement_slope(const struct response_context *context, uint32_t a,
                                         uint32_t b)
{
    struct exit_slope first = slope_under(context, a);
    if (b & PAIR_FIXED)
        return first;
    struct exit_slope second = slope_under(context, b);
    return (struct exit_slope){0.5 * (first.east + second.east),
                               0.5 * (first.south + second.south)};
}

/* Returns how high the lowest point of a row of a table is over the ground [m]. */
static double clearance_of(const struct response_context *context, const struct entities *e,
                           uint32_t row)
{
    struct body_points points;
    body_points_of(context->world, e->row[row].kind, &points);
    return body_points_clearance(
        context->world, context->input.detect.craters, &points, entities_position(e, row),
        rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
}

/* Returns how deep the shell of a vehicle is in the ground [m], below 0 for a height over it. */
static double shell_depth_of(const struct response_context *context, const struct entities *e,
                             uint32_t row)
{
    const struct mat3 turn =
        rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
    return vehicle_shell_depth(&context->world->terrain, context->input.detect.craters,
                               &context->world->kinds[e->row[row].kind], VEHICLE_SHELL_POINTS,
                               entities_position(e, row), &turn);
}

/* Returns true for a vehicle on its springs whose shell ends the frame deeper in a work or a crater
 * than it began it: other bodies have pushed it against a wall. */
static bool shell_sinks(const struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    if (!terrain_uneven_near(&context->world->terrain, context->input.detect.craters, e->row[row].x,
                             e->row[row].z, vehicle_shell_reach(kind)))
        return false;
    double now = shell_depth_of(context, e, row);
    return now > SHELL_SINKS_M && now > shell_depth_of(context, w, row) + EXACT_M;
}

bool ground_placement_sinks(const struct response_context *context, uint32_t row, bool moved)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    if (context->world->kinds[e->row[row].kind].domain == DOMAIN_SEA)
        return false;
    if (e->row[row].state == ENTITY_ACTIVE && e->row[row].flags & ENTITY_FLAG_CHASSIS)
        return shell_sinks(context, row);
    bool struck = context->motion->change[row] != 0;
    if (e->row[row].state != ENTITY_WRECK || !(struck || moved))
        return false;
    double now = clearance_of(context, e, row);
    return now < (struck ? -SINKS_M : -PUSHED_M) && now < clearance_of(context, w, row) - EXACT_M;
}
