/* The axes of a body from its three angles. */
#include "supervisor/physics/rigid_pose.h"

struct rigid_pose rigid_pose_of(struct vec3 at, double heading, double pitch, double roll)
{
    double sh, ch, sp, cp, sr, cr;
    maths_sincos(heading, &sh, &ch);
    maths_sincos(pitch, &sp, &cp);
    maths_sincos(roll, &sr, &cr);
    const struct vec3 level_right = {ch, 0.0, sh};          /* the side before the roll */
    const struct vec3 pitched_up = {-sh * sp, cp, ch * sp}; /* the roof before the roll */
    return (struct rigid_pose){
        .at = at,
        .forward = {sh * cp, sp, -ch * cp},
        .up = vec3_add(vec3_scale(pitched_up, cr), vec3_scale(level_right, sr)),
        .right = vec3_sub(vec3_scale(level_right, cr), vec3_scale(pitched_up, sr)),
    };
}

/* Moves the part so that the pivot stays where it is. */
static struct rigid_pose about(const struct rigid_pose *before, struct rigid_pose after,
                               struct vec3 pivot)
{
    struct vec3 off = vec3_sub(rigid_pose_out(before, pivot), rigid_pose_out(&after, pivot));
    after.at = vec3_add(before->at, off);
    return after;
}

struct rigid_pose rigid_pose_turned(const struct rigid_pose *pose, struct vec3 pivot,
                                    double right_rad)
{
    double sine, cosine;
    maths_sincos(right_rad, &sine, &cosine);
    const struct rigid_pose after = {
        .forward = vec3_add(vec3_scale(pose->forward, cosine), vec3_scale(pose->right, sine)),
        .up = pose->up,
        .right = vec3_sub(vec3_scale(pose->right, cosine), vec3_scale(pose->forward, sine))};
    return about(pose, after, pivot);
}

struct rigid_pose rigid_pose_raised(const struct rigid_pose *pose, struct vec3 pivot, double up_rad)
{
    double sine, cosine;
    maths_sincos(up_rad, &sine, &cosine);
    const struct rigid_pose after = {
        .forward = vec3_add(vec3_scale(pose->forward, cosine), vec3_scale(pose->up, sine)),
        .up = vec3_sub(vec3_scale(pose->up, cosine), vec3_scale(pose->forward, sine)),
        .right = pose->right};
    return about(pose, after, pivot);
}

double rigid_pose_angle(const struct rigid_pose *from, const struct rigid_pose *to)
{
    /* Half the sum of what each axis turns: its cross product has the sine, the sum of the dot
     * products is 1 + 2 cos. */
    struct vec3 sum =
        vec3_add(vec3_cross(from->forward, to->forward),
                 vec3_add(vec3_cross(from->up, to->up), vec3_cross(from->right, to->right)));
    double cosines = vec3_dot(from->forward, to->forward) + vec3_dot(from->up, to->up) +
                     vec3_dot(from->right, to->right);
    return maths_atan2(0.5 * vec3_length(sum), 0.5 * (cosines - 1.0));
}
