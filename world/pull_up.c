/* Asks the way ahead of a driven aircraft for the speed that it allows. */
#include "world/pull_up.h"

#include "world/entity/climb_limits.h"
#include "world/entity/grounded.h"
#include "world/entity/kind.h"
#include "world/entity/mass_properties.h"
#include "world/terrain/climb_ahead.h"

#define REACT_S      2.0  /* of the driver */
#define AHEAD_S      10.0 /* so far it looks ahead */
#define AHEAD_M      40.0 /* and so far even when it is slow */
#define GENTLE_MPS   3.7  /* a touch-down with this sink rate does no harm */
#define SLOWEST_MPS  1.0
#define TURN_SLOPE   0.1 /* of a bank that turns it */
#define STEEPEST_RAD 1.4 /* a steeper bank counts as this one */

bool pull_up_of(const struct world *world, const struct entities *entities, uint32_t i)
{
    const struct kind *kind = &world->kinds[entities->row[i].kind];
    if (entities->row[i].behaviour != BEHAVIOUR_DRIVEN || entities->row[i].state != ENTITY_ACTIVE ||
        kind->domain != DOMAIN_AIR || grounded_of(entities, kind, i))
        return false;
    double speed =
        sqrt(entities->row[i].vx * entities->row[i].vx + entities->row[i].vz * entities->row[i].vz);
    double fast = maths_max(speed, SLOWEST_MPS), up = entities->row[i].vy, sine, cosine;
    double roll = maths_clamp(entities->row[i].roll, -STEEPEST_RAD, STEEPEST_RAD);
    maths_sincos(roll, &sine, &cosine);
    double slope = sine / cosine;
    const struct climb_ahead ahead = {
        .at = entities_position(entities, i),
        .up_mps = up > -GENTLE_MPS ? maths_max(up, 0.0) : up,
        .speed_mps = fast,
        .half_length_m = 0.5 * kind->length_m,
        .climb_mps = kind->climb_rate_mps,
        .pull_mps2 = climb_limits_pull(kind, speed),
        .brake_mps2 = climb_limits_brake(kind),
        .late_s = REACT_S,
        .heading_rad = speed > SLOWEST_MPS ? maths_heading(entities->row[i].vx, entities->row[i].vz)
                                           : entities->row[i].heading,
        .off_rad = fabs(slope) < TURN_SLOPE ? 0.0
                   : roll > 0.0             ? PI
                                            : -PI,
        .radius_m = fast * fast / (GRAVITY_MPS2 * maths_max(fabs(slope), TURN_SLOPE)),
        .length_m = AHEAD_S * speed + AHEAD_M,
        .clear_m = -kind->low_m,
        .least_m = -kind->low_m,
    };
    return climb_ahead_need(&world->terrain, &ahead).speed_mps < fast;
}
