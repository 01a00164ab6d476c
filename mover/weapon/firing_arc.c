/* Finds the elevation by flying the shell. */
#include "mover/weapon/firing_arc.h"

#include "mover/motion/projectile.h"
#include "world/entity/kind.h"

#define STEP_S          0.05
#define TABLE_STEP_S    0.1 /* the table need not be as exact */
#define LONGEST_S       300.0
#define TRIES           14 /* a solution needs 3 or 4 */
#define MISS_M          0.3
#define DEEP_M          2000.0 /* a shell so far below its point will not come to it */
#define STEP_MOST_RAD   (6.0 * RAD_PER_DEG)
#define STEEP_LEAST_RAD (0.5 * RAD_PER_DEG)
#define SPEED_SHARE     0.01  /* the change of speed by which by_speed is found */
#define LEAST_MPRAD     300.0 /* a smaller change of height by elevation: no point is further */
#define HIGHEST_RAD     (85.0 * RAD_PER_DEG)

struct vec3 firing_arc_unit(double azimuth_rad, double elevation_rad)
{
    double sine, cosine, up, level;
    maths_sincos(azimuth_rad, &sine, &cosine);
    maths_sincos(elevation_rad, &up, &level);
    return (struct vec3){sine * level, up, -cosine * level};
}

void firing_arc_follow(const struct kind *munition, struct vec3 wind, unsigned frames, double dt_s,
                       struct vec3 *at, struct vec3 *velocity)
{
    for (unsigned frame = 0; frame < frames; frame++)
        projectile_fall(munition, wind, dt_s, at, velocity);
}

static double fall(const struct kind *munition, struct vec3 wind, double height_m, double step_s,
                   struct vec3 *at, struct vec3 *velocity)
{
    double time_s = 0.0;
    while (time_s < LONGEST_S) {
        const struct vec3 before = *at, speed = *velocity;
        projectile_fall(munition, wind, step_s, at, velocity);
        if (velocity->y < 0.0 && at->y <= height_m) {
            double down = maths_max(before.y - at->y, 1e-9);
            double share = maths_clamp((before.y - height_m) / down, 0.0, 1.0);
            *at = vec3_lerp(before, *at, share);
            *velocity = vec3_lerp(speed, *velocity, share);
            return time_s + share * step_s;
        }
        time_s += step_s;
    }
    return LONGEST_S;
}

double firing_arc_fall(const struct kind *munition, struct vec3 wind, double height_m,
                       struct vec3 *at, struct vec3 *velocity)
{
    return fall(munition, wind, height_m, STEP_S, at, velocity);
}

static double range_of(const struct kind *munition, double elevation_rad, double speed_mps)
{
    struct vec3 at = {0.0, 0.0, 0.0}, still = at;
    struct vec3 velocity = vec3_scale(firing_arc_unit(0.0, elevation_rad), speed_mps);
    fall(munition, still, 0.0, TABLE_STEP_S, &at, &velocity);
    return -at.z;
}

void firing_arc_make(struct firing_arc *arc, const struct kind *munition)
{
    const double speed = munition->max_speed_mps;
    *arc = (struct firing_arc){.munition = munition};
    for (unsigned row = 1; row < FIRING_ARC_ROWS; row++) {
        double elevation = (double)row * FIRING_ARC_ROW_RAD;
        double range = range_of(munition, elevation, speed);
        double more = range_of(munition, elevation, speed * (1.0 + SPEED_SHARE));
        arc->range_m[row] = range;
        arc->by_speed[row] = (more - range) / (SPEED_SHARE * range);
        if (range > arc->range_m[arc->furthest])
            arc->furthest = row;
    }
    arc->by_speed[0] = arc->by_speed[1];
}

/* Returns the row, with a fraction, at which the table has this range. */
static double row_at(const struct firing_arc *arc, double range_m, bool high)
{
    unsigned row = high ? FIRING_ARC_ROWS - 1 : 0, to = arc->furthest;
    int step = high ? -1 : 1;
    while (row != to) {
        unsigned next = (unsigned)((int)row + step);
        double from_m = arc->range_m[row], to_m = arc->range_m[next];
        if (to_m >= range_m)
            return (double)row +
                   (double)step * maths_clamp((range_m - from_m) / (to_m - from_m), 0.0, 1.0);
        row = next;
    }
    return (double)to;
}

static double between(const double *column, double place)
{
    unsigned row = (unsigned)maths_min(place, (double)(FIRING_ARC_ROWS - 2));
    return column[row] + (column[row + 1] - column[row]) * (place - (double)row);
}

/* Returns about the change of height at the point by elevation [m/rad]: that of the range times the
 * slope of the fall. It is positive on the lower arc and negative on the higher one. */
static double slope_at(const struct firing_arc *arc, double place, bool high)
{
    unsigned row = (unsigned)maths_clamp(place, 0.0, (double)(FIRING_ARC_ROWS - 2));
    double sine, cosine, range = arc->range_m[row + 1] - arc->range_m[row];
    maths_sincos(maths_clamp(place * FIRING_ARC_ROW_RAD, STEEP_LEAST_RAD, HIGHEST_RAD), &sine,
                 &cosine);
    double slope = range / FIRING_ARC_ROW_RAD * sine / cosine;
    return high ? maths_min(slope, -LEAST_MPRAD) : maths_max(slope, LEAST_MPRAD);
}

/* The level part of a vector from one point to another, as distance and azimuth. */
static double level_to(struct vec3 from, struct vec3 to, double *azimuth_rad)
{
    double x = to.x - from.x, z = to.z - from.z;
    *azimuth_rad = maths_heading(x, z);
    return sqrt(x * x + z * z);
}

struct vec3 firing_arc_direction(const struct firing_arc *arc, struct vec3 muzzle,
                                 struct vec3 point)
{
    double azimuth, range = level_to(muzzle, point, &azimuth);
    double site = maths_atan2(point.y - muzzle.y, maths_max(range, 1.0));
    return firing_arc_unit(azimuth, row_at(arc, range, false) * FIRING_ARC_ROW_RAD + site);
}

/* Flies until the shell is as far as the point on the map. Returns its time, and where it is. */
static double fly_to(const struct firing_arc *arc, const struct firing_arc_aim *aim, double range_m,
                     struct vec3 *at, struct vec3 *velocity)
{
    const double square = range_m * range_m, deep = aim->point.y - DEEP_M;
    double time_s = 0.0, before = 0.0;
    while (time_s < LONGEST_S && (velocity->y > 0.0 || at->y > deep)) {
        const struct vec3 from = *at, speed = *velocity;
        projectile_fall(arc->munition, aim->wind, STEP_S, at, velocity);
        double x = at->x - aim->muzzle.x, z = at->z - aim->muzzle.z, now = x * x + z * z;
        if (now >= square) {
            double share = (range_m - sqrt(before)) / (sqrt(now) - sqrt(before));
            *at = vec3_lerp(from, *at, share);
            *velocity = vec3_lerp(speed, *velocity, share);
            return time_s + share * STEP_S;
        }
        before = now;
        time_s += STEP_S;
    }
    return time_s;
}

/* The next elevation, by the last change of height: the secant method. */
static double step_of(double slope, double above_m)
{
    return maths_clamp(-above_m / slope, -STEP_MOST_RAD, STEP_MOST_RAD);
}

bool firing_arc_solve(const struct firing_arc *arc, const struct firing_arc_aim *aim,
                      struct firing_arc_solution *solution)
{
    double azimuth, range = level_to(aim->muzzle, aim->point, &azimuth);
    double row = row_at(arc, range, aim->high), departure = azimuth;
    double site = maths_atan2(aim->point.y - aim->muzzle.y, maths_max(range, 1.0));
    double elevation = row * FIRING_ARC_ROW_RAD + (aim->high ? 0.0 : site);
    double slope = slope_at(arc, row, aim->high), last_m = 0.0, last_step = 0.0;
    for (int n = 0; n < TRIES; n++) {
        struct vec3 at = aim->muzzle;
        struct vec3 velocity =
            vec3_scale(firing_arc_unit(departure, elevation), arc->munition->max_speed_mps);
        double flight = fly_to(arc, aim, range, &at, &velocity);
        double bearing, reached = level_to(aim->muzzle, at, &bearing);
        double across = maths_wrap_half(bearing - azimuth), above = at.y - aim->point.y;
        bool arrives = reached > range - MISS_M;
        *solution = (struct firing_arc_solution){departure, elevation, flight,
                                                 between(arc->by_speed, row), velocity};
        if (arrives && fabs(above) < MISS_M && fabs(across) * range < FIRING_ARC_MISS_M)
            return true;
        double seen = last_step != 0.0 ? (above - last_m) / last_step : slope;
        if (arrives && (seen < 0.0) == aim->high && fabs(seen) > LEAST_MPRAD)
            slope = seen;
        last_m = above;
        last_step = step_of(slope, above);
        elevation += last_step;
        departure -= across;
    }
    return false;
}
