/* Shares of the lift and of the lean that an aircraft has. */
#include "world/entity/climb_limits.h"

#include "world/entity/mass_properties.h"

#define SLOWEST_MPS 1.0  /* a kind with a lower stalling speed counts as this one */
#define WING_SHARE  0.65 /* of the pull-up that an aeroplane's lift allows */
#define LEAST_PULL  0.05 /* [g] of that */
#define HOVER_PULL  0.4  /* [g] of a helicopter */
#define WING_BRAKE  0.1  /* [m/s2] an aeroplane does not stop */
#define HOVER_BRAKE 3.4  /* [m/s2] a helicopter leans back by 20 degrees */

double climb_limits_lift(const struct kind *kind, double speed_mps)
{
    double share = speed_mps / maths_max(kind->min_speed_mps, SLOWEST_MPS);
    return maths_min(share * share, maths_max(kind->max_load, 1.0));
}

double climb_limits_pull(const struct kind *kind, double speed_mps)
{
    if (kind_hovers(kind))
        return HOVER_PULL * GRAVITY_MPS2;
    double spare = climb_limits_lift(kind, speed_mps) - 1.0;
    return GRAVITY_MPS2 * (WING_SHARE * maths_clamp(spare, LEAST_PULL, CLIMB_LIMITS_PULL));
}

double climb_limits_brake(const struct kind *kind)
{
    return kind_hovers(kind) ? HOVER_BRAKE : WING_BRAKE;
}
