/* Looks at the way of a stretch: its turn and gain of speed, and the ground between its ends. */
#include "mover/motion/ground_stretch.h"

#include "mover/motion/chassis.h"
#include "mover/motion/drivetrain.h"
#include "mover/query/ground_marks.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/rest_pose.h"
#include "world/vehicle_shell.h"
#include "world/world.h"

#define TURN_RAD   0.6  /* it turns by no more: the arc is within 8 % of its chord */
#define GAIN_MPS   1.5  /* and gains or loses no more speed, */
#define PULL_MPS   6.0  /* if it does so all the time no more than this */
#define LINE_OFF_M 0.5  /* the ground is no further off the line through its ends */
#define LOOK_M     0.25 /* between the places at which it looks for a hollow */
#define SLOWER     0.75 /* of its speed, at least, the engine keeps on each slope of the way */

/* A place on the way, and the heading there. */
struct place {
    double x, z, heading;
};

/* Returns the speed of the row along its heading at the end of its stretch. */
static double forward_of(const struct ground_vehicle *batch, int l)
{
    const struct ground_pose *pose = &batch->pose;
    return batch->vx.lane[l] * pose->sine.lane[l] - batch->vz.lane[l] * pose->cosine.lane[l];
}

/* Returns where the row is at a share of the way back from the end of its stretch. */
static struct place place_of(const struct step_context *context, const struct ground_vehicle *batch,
                             int l, double share)
{
    const struct ground_pose *pose = &batch->pose;
    const struct vec3 end = {pose->x.lane[l], pose->y.lane[l], pose->z.lane[l]};
    const double turned = share * batch->turned.lane[l];
    const double way_s = share * ground_vehicle_time_s(context, batch);
    const double heading = batch->heading.lane[l];
    const double arc_m = (forward_of(batch, l) - 0.5 * batch->gain_mps2.lane[l] * way_s) * way_s;
    const struct vec3 at = cruise_end(end, heading, -turned, -arc_m);
    return (struct place){at.x, at.z, heading - turned};
}

/* Returns how the row stands at a place. */
static struct rest_pose stands_at(const struct step_context *context,
                                  const struct ground_vehicle *batch, int l,
                                  const struct place *place)
{
    const struct kind *kind = &context->world->kinds[context->m->row[batch->row[l]].kind];
    return rest_pose_of(&context->world->terrain, context->craters, kind, place->x, place->z,
                        place->heading);
}

/* Returns true if a corner of the row's shell is in the ground of a hollow at this share of the way
 * back. *patch: a cache. */
static bool is_in_hollow(const struct step_context *context, const struct ground_vehicle *batch,
                         int l, double share, struct terrain_cache_entry *patch)
{
    const struct terrain *terrain = &context->world->terrain;
    const struct kind *kind = &context->world->kinds[context->m->row[batch->row[l]].kind];
    const struct place place = place_of(context, batch, l, share);
    if (terrain_cache_bend(terrain, patch, place.x, place.z) <= batch->bend.lane[l])
        return false;
    const struct rest_pose pose = stands_at(context, batch, l, &place);
    const struct vec3 at = {place.x, pose.y_m, place.z};
    const struct mat3 turn =
        rotation_matrix(rotation_of(place.heading, pose.pitch_rad, pose.roll_rad));
    return vehicle_shell_depth(terrain, NULL, kind, VEHICLE_SHELL_SIDES, at, &turn) > 0.0;
}

/* Returns true if the ground bends so much somewhere on the way that a shell may get into it. The
 * patch of a place holds the ground half a post's spacing away. bend: at the end. */
static bool bends(const struct step_context *context, const struct ground_vehicle *batch, int l,
                  double bend)
{
    const struct entities *m = context->m;
    const struct terrain *terrain = &context->world->terrain;
    const double x = batch->pose.x.lane[l], back_x = m->row[batch->row[l]].x - x;
    const double z = batch->pose.z.lane[l], back_z = m->row[batch->row[l]].z - z;
    const double way_m = sqrt(back_x * back_x + back_z * back_z);
    const int looks = (int)ceil(way_m / (0.5 * terrain->spacing_m));
    struct terrain_cache_entry patch = {0};
    for (int n = 1; n < looks && bend <= batch->bend.lane[l]; n++)
        bend = terrain_cache_bend(terrain, &patch, x + back_x * n / looks, z + back_z * n / looks);
    return bend > batch->bend.lane[l];
}

/* Returns true if the row gets into the ground of a hollow on its way, or would within two frames
 * after it: it has to take to its springs before. */
static bool passes_hollow(const struct step_context *context, const struct ground_vehicle *batch,
                          int l, double bend)
{
    if (!bends(context, batch, l, bend))
        return false;
    const struct entities *m = context->m;
    const double x = m->row[batch->row[l]].x - batch->pose.x.lane[l];
    const double z = m->row[batch->row[l]].z - batch->pose.z.lane[l];
    const double vx = batch->vx.lane[l], vz = batch->vz.lane[l];
    const int looks = 1 + (int)ceil(sqrt(x * x + z * z) / LOOK_M);
    const int beyond = (int)ceil(2.0 * context->dt_s * sqrt(vx * vx + vz * vz) / LOOK_M);
    struct terrain_cache_entry patch = {0};
    for (int n = -beyond; n < looks; n++) {
        if (is_in_hollow(context, batch, l, (double)n / looks, &patch))
            return true;
    }
    return false;
}

/* Returns true if there may be craters, earthworks or debris on the way of a row that has moved by
 * a stretch. */
static bool passes_marks(const struct step_context *context, const struct ground_vehicle *batch,
                         int l)
{
    const struct entities *m = context->m;
    const double x = m->row[batch->row[l]].x, to_x = batch->pose.x.lane[l];
    const double z = m->row[batch->row[l]].z, to_z = batch->pose.z.lane[l];
    if (batch->frames <= context->cruise_short)
        return batch->pose.cratered.lane[l] != 0 || batch->debris.lane[l] != 1.0;
    struct gridsquare_box box =
        gridsquare_box_of(&context->world->terrain.squares, maths_min(x, to_x), maths_min(z, to_z),
                          maths_max(x, to_x), maths_max(z, to_z));
    return ground_marks_within(context->ground_marks, box,
                               GROUND_MARKS_CRATER | GROUND_MARKS_DEBRIS);
}

/* Returns true if the engine cannot keep the row's speed on ground with this pitch. */
static bool is_too_steep(const struct ground_vehicle *batch, int l, double pitch)
{
    const double forward = forward_of(batch, l);
    const double climb = forward < 0.0 ? -pitch : pitch;
    const double sine = climb * (1.0 - climb * climb / 6.0);
    const double back = GRAVITY_MPS2 * (sine + batch->rolling.lane[l]);
    return back * SLOWER * fabs(forward) > batch->power_wpkg.lane[l];
}

/* Returns true if the ground at this share of the way back from the end of a long stretch is not
 * such as that of a short one has to be at its end: it is too steep for a body that follows it or
 * for its speed, or further above or below the line through the ends than the places of others may
 * be off. */
static bool is_uneven(const struct step_context *context, const struct ground_vehicle *batch, int l,
                      double share)
{
    const struct place place = place_of(context, batch, l, share);
    const struct rest_pose pose = stands_at(context, batch, l, &place);
    const double end_y = batch->pose.y.lane[l];
    const double line_y = end_y + share * (context->m->row[batch->row[l]].y - end_y);
    return fabs(pose.pitch_rad) > CHASSIS_TILT_RAD || fabs(pose.roll_rad) > CHASSIS_TILT_RAD ||
           fabs(pose.y_m - line_y) > LINE_OFF_M || is_too_steep(batch, l, pose.pitch_rad) ||
           cover_is_water(terrain_cover(&context->world->terrain, place.x, place.z));
}

/* Returns true if a row that has moved by a long stretch passes ground that a short one refuses, or
 * if its way would be another one if it had to end earlier. */
static bool passes_uneven(const struct step_context *context, const struct ground_vehicle *batch,
                          int l)
{
    const uint32_t pieces = batch->frames / context->cruise_short;
    const double dt_s = ground_vehicle_time_s(context, batch);
    if (pieces > 1 &&
        cruise_off(batch->turned.lane[l] / dt_s, batch->gain_mps2.lane[l], dt_s) > CRUISE_OFF_M)
        return true;
    for (uint32_t n = 1; n < pieces; n++) {
        if (is_uneven(context, batch, l, (double)n / (double)pieces))
            return true;
    }
    return false;
}

void ground_stretch_refuse(const struct step_context *context, struct ground_vehicle *batch,
                           const union simd_lanes *rightward)
{
    const struct entities *m = context->m;
    const double dt_s = ground_vehicle_time_s(context, batch);
    union simd_lanes bend;
    terrain_cache_bends(&batch->pose.ground, &bend);
    for (int l = 0; l < batch->count; l++) {
        uint32_t i = batch->row[l];
        double turned = fabs(batch->turned.lane[l]);
        double gain = fabs(batch->gain_mps2.lane[l]) * dt_s;
        double most = batch->reaches.lane[l] ? GAIN_MPS : PULL_MPS;
        double x = 0.5 * (m->row[i].x + batch->pose.x.lane[l]);
        double z = 0.5 * (m->row[i].z + batch->pose.z.lane[l]);
        bool easy = !batch->rough.lane[l] && !batch->blocked.lane[l] && !batch->tight.lane[l] &&
                    !passes_marks(context, batch, l) && turned <= TURN_RAD && gain <= most &&
                    rightward->lane[l] == 0.0 && !passes_hollow(context, batch, l, bend.lane[l]) &&
                    !cover_is_water(terrain_cover(&context->world->terrain, x, z)) &&
                    !passes_uneven(context, batch, l);
        batch->refused.lane[l] = easy ? 0 : -1;
    }
}
