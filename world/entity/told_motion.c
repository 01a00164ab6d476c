/* Dead reckoning of what cruises. */
#include "world/entity/told_motion.h"

#include "world/entity/cruise.h"

/* Moves the body along its arc. A part of the velocity that is not along the heading turns with
 * it. */
static void turn(struct told_motion *motion, double s)
{
    double turned_rad = (double)motion->turn_rps * s, sine, cosine;
    maths_sincos(motion->heading_rad, &sine, &cosine);
    double forward_mps = motion->velocity.x * sine - motion->velocity.z * cosine;
    double right_mps = motion->velocity.x * cosine + motion->velocity.z * sine;
    double gained_mps = (double)motion->gain_mps2 * s;
    double forward_m = cruise_chord((forward_mps + 0.5 * gained_mps) * s, 0.5 * turned_rad);
    double right_m = cruise_chord(right_mps * s, 0.5 * turned_rad);
    maths_sincos(motion->heading_rad + 0.5 * turned_rad, &sine, &cosine);
    motion->at.x += forward_m * sine + right_m * cosine;
    motion->at.z += right_m * sine - forward_m * cosine;
    motion->heading_rad = maths_wrap_turn(motion->heading_rad + turned_rad);
    maths_sincos(motion->heading_rad, &sine, &cosine);
    forward_mps += gained_mps;
    motion->velocity.x = forward_mps * sine + right_mps * cosine;
    motion->velocity.z = right_mps * sine - forward_mps * cosine;
}

struct told_motion told_motion_at(const struct told_motion *motion, double after_s)
{
    struct told_motion to = *motion;
    double s = maths_min(after_s, (double)motion->lasts_s);
    if (s > 0.0) {
        turn(&to, s);
        to.at.y += (to.velocity.y + 0.5 * (double)motion->climb_mps2 * s) * s;
        to.velocity.y += (double)motion->climb_mps2 * s;
        to.pitch_rad += (double)motion->pitch_rps * s;
        to.roll_rad += (double)motion->roll_rps * s;
        to.lasts_s = (float)((double)motion->lasts_s - s);
        after_s -= s;
    }
    to.at = vec3_add(to.at, vec3_scale(to.velocity, after_s));
    return to;
}
