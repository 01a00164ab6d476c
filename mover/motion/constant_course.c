/* Moves rows that hold their course, and sets bodies down on the ground. */
#include "mover/motion/constant_course.h"

#include "mover/motion/ground_vehicle.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/ship.h"
#include "mover/query/ground_marks.h"
#include "world/course_lift.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

enum course_result constant_course_row(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    bool aground = kind->domain == DOMAIN_SEA && ship_hold(context, i);
    const double side_m = context->world->terrain.squares.world_m;
    double x = m->row[i].x + m->row[i].vx * context->dt_s,
           z = m->row[i].z + m->row[i].vz * context->dt_s;
    if (x < 0.0 || z < 0.0 || x > side_m || z > side_m)
        return COURSE_LEFT_WORLD;
    m->row[i].x = x;
    m->row[i].z = z;
    if (kind->domain == DOMAIN_LAND)
        return COURSE_GROUND;
    if (kind->domain == DOMAIN_AIR) {
        m->row[i].y += m->row[i].vy * context->dt_s;
        return COURSE_DONE;
    }
    double y = kinematics_ground(context, x, z);
    m->row[i].vy = (y - m->row[i].y) / context->dt_s;
    m->row[i].y = y;
    return aground ? COURSE_AGROUND : COURSE_DONE;
}

void constant_course_begin(struct constant_course *batch)
{
    *batch = (struct constant_course){.count = 0};
    ground_pose_begin(&batch->pose);
}

bool constant_course_take(const struct step_context *context, struct constant_course *batch,
                          uint32_t i)
{
    int l = batch->count++;
    batch->row[l] = i;
    batch->heading.lane[l] = context->m->row[i].heading;
    ground_pose_take(context, &batch->pose, l, i);
    return batch->count == LANE_COUNT;
}

/* Returns by how much row i of a table has to be lifted out of works and craters [m]. */
static double lift_of(const struct step_context *context, const struct entities *e, uint32_t i)
{
    const struct rest_pose pose = {e->row[i].y, e->row[i].pitch, e->row[i].roll};
    return course_lift(context->world, context->craters, e->row[i].kind, e->row[i].x, e->row[i].z,
                       e->row[i].heading, &pose);
}

/* Lifts row i, which comes from its springs, out of works and craters. A place that its springs
 * left in the ground comes out of it bit by bit. */
static void lift_sprung(const struct step_context *context, uint32_t i)
{
    double left_m = lift_of(context, &context->committed->entities, i) -
                    GROUND_VEHICLE_EASE_MPS * context->dt_s;
    context->m->row[i].y +=
        maths_max(0.0, lift_of(context, context->m, i) - maths_max(0.0, left_m));
}

/* Writes height, pitch and roll of lane l, row i. A row that comes from its springs eases to them.
 */
static void set_down(const struct step_context *context, const struct ground_pose *pose, int l,
                     uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    struct entities *m = context->m;
    m->row[i].y = pose->y.lane[l];
    m->row[i].pitch = pose->pitch.lane[l];
    m->row[i].roll = pose->roll.lane[l];
    if (pose->cratered.lane[l])
        m->row[i].y += lift_of(context, m, i);
    if (!(m->row[i].flags & ENTITY_FLAG_CHASSIS))
        return;
    const struct rest_pose now = {m->row[i].y, m->row[i].pitch, m->row[i].roll};
    const struct rest_pose before =
        course_lift_pose(context->world, context->craters, m->row[i].kind, w->row[i].x, w->row[i].z,
                         w->row[i].heading);
    ground_vehicle_ease(context, i, &before, &now);
    if (pose->cratered.lane[l])
        lift_sprung(context, i);
}

void constant_course_set_down(const struct step_context *context, struct constant_course *batch)
{
    struct entities *m = context->m;
    struct ground_pose *pose = &batch->pose;
    union lane_masks debris; /* not used: it slows no row that holds its course */
    maths_sincos_lanes(&batch->heading, &pose->sine, &pose->cosine);
    ground_marks_find(context->ground_marks, &pose->x, &pose->z, &pose->cratered, &debris);
    for (int h = 0; h < LANE_FOURS; h++)
        pose->cratered.f64x4[h] |=
            pose->half_length.f64x4[h] + pose->half_width.f64x4[h] > GROUND_MARKS_NEAR_M;
    terrain_cache_find(&context->world->terrain, &pose->ground, &pose->x, &pose->z);
    ground_pose_find(context, pose);
    for (int l = 0; l < batch->count; l++) {
        uint32_t i = batch->row[l];
        double before = m->row[i].y;
        set_down(context, pose, l, i);
        m->row[i].vy = (m->row[i].y - before) / context->dt_s;
    }
}
