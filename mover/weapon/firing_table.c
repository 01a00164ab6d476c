/* Integrates flat trajectories over the range, and interpolates in the result. */
#include "mover/weapon/firing_table.h"

#include "mover/motion/drag.h"
#include "world/entity/kind.h"
#include "world/entity/mass_properties.h"
#include "world/maths/maths.h"

#include <stdbool.h>

#define STEPS_A_ROW 25u  /* of 2 m: the speed of a bullet is then right to 1e-5 */
#define SLOWEST_MPS 20.0 /* below this a round falls more than it flies */

/* Speed, time, slope below the line of departure and drop, by the range s:
 * dv/ds = -rate, dt/ds = 1 / v, d(slope)/ds = g / v^2, d(drop)/ds = slope. */
struct trajectory {
    double speed_mps, time_s, slope, drop_m;
};

static void fly(struct trajectory *flight, const struct kind *munition, double step_m)
{
    double start = flight->speed_mps;
    double half = start - 0.5 * step_m * drag_rate(munition, start, 0.0);
    double middle = maths_max(half, SLOWEST_MPS);
    double end = start - step_m * drag_rate(munition, middle, 0.0);
    double bend = step_m * GRAVITY_MPS2 / (middle * middle);
    flight->speed_mps = maths_max(end, SLOWEST_MPS);
    flight->time_s += step_m / middle;
    flight->drop_m += step_m * (flight->slope + 0.5 * bend);
    flight->slope += bend;
}

void firing_table_make(struct firing_table *table, const struct kind *munition)
{
    struct trajectory flight = {.speed_mps = maths_max(munition->max_speed_mps, SLOWEST_MPS)};
    table->munition = munition;
    if (munition->drag == DRAG_NONE)
        return; /* its data need no table */
    if (munition->delivery == DELIVERY_ARC)
        firing_arc_make(&table->arc, munition);
    for (unsigned row = 0; row < FIRING_TABLE_ROWS; row++) {
        table->flight_s[row] = flight.time_s;
        table->drop_m[row] = flight.drop_m;
        for (unsigned step = 0; step < STEPS_A_ROW; step++)
            fly(&flight, munition, FIRING_TABLE_STEP_M / STEPS_A_ROW);
    }
}

static double between(const double *column, unsigned row, double share)
{
    return column[row] + (column[row + 1] - column[row]) * share;
}

/* In air of density ratio d a trajectory is that at sea level for d times the range, with the time
 * divided by d and the drop by its square: the drag of a metre is d times as strong. */
static struct firing_data look_up(const struct firing_table *table, double range_m, double height_m)
{
    double density = drag_density_ratio(height_m);
    double place = density * range_m / FIRING_TABLE_STEP_M;
    unsigned row = (unsigned)maths_min(place, (double)(FIRING_TABLE_ROWS - 2));
    double share = place - (double)row;
    return (struct firing_data){between(table->flight_s, row, share) / density,
                                between(table->drop_m, row, share) / (density * density)};
}

struct firing_data firing_table_at(const struct firing_table *table, double range_m,
                                   double height_m)
{
    const struct kind *munition = table->munition;
    bool falls = munition->guidance == GUIDANCE_BALLISTIC;
    if (falls && munition->drag != DRAG_NONE)
        return look_up(table, range_m, height_m);
    double straight_s = range_m / maths_max(munition->max_speed_mps, 1.0);
    double flight_s = maths_min(straight_s, munition->life_s);
    double drop = falls ? 0.5 * GRAVITY_MPS2 : 0.0;
    return (struct firing_data){flight_s, drop * flight_s * flight_s};
}
