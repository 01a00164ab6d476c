/* The fields of the statistics bar. */
#include "renderer/chart/statistics_bar.h"

#include "world/enum_names.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FUEL_WARNING   0.25
#define FUEL_ALARM     0.1
#define ROUNDS_LOW     0.2  /* of a full load */
#define STEEP_DEG      25.0 /* few land vehicles climb slopes of more than 30 */
#define VERY_STEEP_DEG 40.0

static uint32_t tilt_state(double degrees)
{
    double steep = fabs(degrees);
    return steep >= VERY_STEEP_DEG ? STATISTICS_BAR_ALARM
           : steep >= STEEP_DEG    ? STATISTICS_BAR_WARNING
                                   : STATISTICS_BAR_GOOD;
}

static uint32_t fuel_state(double share)
{
    return share < FUEL_ALARM     ? STATISTICS_BAR_ALARM
           : share < FUEL_WARNING ? STATISTICS_BAR_WARNING
                                  : STATISTICS_BAR_GOOD;
}

/* A kind that carries no rounds causes no alarm. */
static uint32_t rounds_state(const struct statistics *s)
{
    if (s->rounds_full == 0)
        return STATISTICS_BAR_GOOD;
    return s->rounds == 0                            ? STATISTICS_BAR_ALARM
           : s->rounds < ROUNDS_LOW * s->rounds_full ? STATISTICS_BAR_WARNING
                                                     : STATISTICS_BAR_GOOD;
}

static uint32_t damage_state(const char *damage)
{
    return strcmp(damage, damage_name(DAMAGE_NONE)) == 0  ? STATISTICS_BAR_GOOD
           : strcmp(damage, damage_name(DAMAGE_LOW)) == 0 ? STATISTICS_BAR_WARNING
                                                          : STATISTICS_BAR_ALARM;
}

/* Avoids "-0.0". */
static double unsigned_zero(double degrees)
{
    return fabs(degrees) < 0.05 ? 0.0 : degrees;
}

uint32_t statistics_bar_of(struct statistics_bar_field fields[STATISTICS_BAR_MAX],
                           const struct statistics *s, double fps)
{
    uint32_t n = 0;
#define FIELD(title, most, importance, how, ...)                                                   \
    do {                                                                                           \
        fields[n] = (struct statistics_bar_field){                                                 \
            .name = (title), .widest = (most), .state = (how), .rank = (importance)};              \
        snprintf(fields[n].value, sizeof fields[n].value, __VA_ARGS__);                            \
        n++;                                                                                       \
    } while (0)
    FIELD("SPEED km/h", "0000.0", 0, STATISTICS_BAR_GOOD, "%.1f", s->speed_kmh);
    FIELD("HEADING", "000.0", 1, STATISTICS_BAR_GOOD, "%05.1f", s->heading_deg);
    FIELD("PITCH", "+00.0", 7, tilt_state(s->pitch_deg), "%+.1f", unsigned_zero(s->pitch_deg));
    FIELD("ROLL", "+00.0", 8, tilt_state(s->roll_deg), "%+.1f", unsigned_zero(s->roll_deg));
    FIELD("ALTITUDE m", "0000", 4, STATISTICS_BAR_GOOD, "%.0f", s->altitude_m);
    FIELD("ROUNDS", "000", 5, rounds_state(s), "%u", s->rounds);
    FIELD("FUEL", "000%", 6, fuel_state(s->fuel_share), "%.0f%%", 100.0 * s->fuel_share);
    FIELD("DAMAGE", "destroyed", 2, damage_state(s->damage), "%s", s->damage);
    FIELD("BEHAVIOUR", "back_off", 9, STATISTICS_BAR_GOOD, "%s", s->behaviour);
    FIELD("TIME s", "0000.00", 3, STATISTICS_BAR_PLAIN, "%.2f", s->time_s);
    FIELD("FRAME", "000000", STATISTICS_BAR_RANK_SPARE, STATISTICS_BAR_PLAIN, "%llu",
          (unsigned long long)s->frame);
    if (fps > 0.0)
        FIELD("FPS", "000.0", 10, STATISTICS_BAR_PLAIN, "%.1f", fps);
#undef FIELD
    return n;
}
