/* Flies the steepest climb over the ground ahead. */
#include "world/start_height.h"

#include "world/entity/climb_limits.h"
#include "world/entity/kind.h"

#define STEP_S       0.25
#define STEPS        80   /* it looks so far ahead: 20 s */
#define REACT_S      1.0  /* until its pilot has decided */
#define CLEAR_M      20.0 /* over the ground ahead, unless it begins lower */
#define SPEEDS_SHARE 0.5  /* of its thrust, which a climb leaves for its speed */
#define CRUISE_SHARE 0.75 /* of its top speed: it gains no more */
#define STEEP_SHARE  0.35 /* of its speed: its steepest climb */
#define CLIMB_SHARE  0.8  /* and of its kind's rate of climb */

double start_height(const struct terrain *terrain, const struct kind *kind,
                    const struct start_flight *flight)
{
    const double under = terrain_base_height(terrain, flight->x, flight->z);
    const double most = maths_max(CRUISE_SHARE * kind->max_speed_mps, flight->speed_mps);
    double speed = flight->speed_mps, up = 0.0, risen = 0.0, way = 0.0, height = flight->altitude_m;
    double sine, cosine, clear = maths_min(CLEAR_M, flight->altitude_m);
    maths_sincos(flight->heading_rad, &sine, &cosine);
    for (int n = 1; n <= STEPS; n++) {
        double steepest = maths_min(STEEP_SHARE * speed, CLIMB_SHARE * kind->climb_rate_mps);
        speed = maths_min(speed + SPEEDS_SHARE * kind->acceleration_mps2 * STEP_S, most);
        if (n * STEP_S > REACT_S)
            up = maths_min(up + climb_limits_pull(kind, speed) * STEP_S, steepest);
        risen += up * STEP_S;
        way += speed * STEP_S;
        double ground =
            terrain_base_height(terrain, flight->x + way * sine, flight->z - way * cosine);
        height = maths_max(height, ground - under + clear - risen);
    }
    return height;
}
