/* The report has one table of shots and hits by munition, target and shooter, one of losses by
 * force and kind, and the news of the missions. In the table of hits a round is late if its target
 * was lost before it arrived; the share of hits is that of the other rounds. */
#include "tests/bench/agents/battle_report.h"

#include "world/enum_names.h"
#include "world/world.h"

#include <stdio.h>
#include <string.h>

#define MINUTES     30u
#define SHOTS_LEAST 30u  /* in every three minutes */
#define SHARE_LEAST 0.08 /* of all shots, in every five minutes */
#define SHARE_MOST  0.30
#define PUSH_LONG_S 10.0

/* Shares of rounds that hit, of those whose target was still there, as they are published for real
 * weapons [%]. Tank guns: a target of 2.3 m at 1 to 3 km, from a tank that stands or drives.
 * Bursts: their rounds, at 2.3 m at 0.8 to 2 km and at a jeep's 1.65 m at 0.6 to 1.2 km.
 * Missiles: their reliability, their fuzes and decoys; Pentagon Labyrinth, 2011. */
static const struct {
    const char *munition, *target;
    enum battle_shooter shooter;
    double least, most;
} facts[] = {
    {"shell", "tank", BATTLE_HALTED, 31.0, 96.0},    {"shell", "tank", BATTLE_MOVING, 9.0, 56.0},
    {"heat", "carrier", BATTLE_HALTED, 31.0, 96.0},  {"heat", "carrier", BATTLE_MOVING, 9.0, 56.0},
    {"burst", "carrier", BATTLE_HALTED, 35.0, 90.0}, {"burst", "carrier", BATTLE_MOVING, 9.0, 44.0},
    {"burst", "jeep", BATTLE_HALTED, 45.0, 90.0},    {"burst", "jeep", BATTLE_MOVING, 12.0, 41.0},
    {"missile", "jet", BATTLE_HALTED, 35.0, 60.0},   {"missile", "tank", BATTLE_HALTED, 60.0, 80.0},
};

static uint32_t longest_push(const struct battle_count *count, const struct view *view)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < view->w[0].entities.capacity; i++)
        most = count->longest[i] > count->longest[most] ? i : most;
    return most;
}

static void print_real(const char *munition, const char *target, enum battle_shooter shooter)
{
    for (size_t n = 0; n < sizeof facts / sizeof facts[0]; n++) {
        if (strcmp(facts[n].munition, munition) == 0 && strcmp(facts[n].target, target) == 0 &&
            facts[n].shooter == shooter)
            printf("  %.0f to %.0f %%", facts[n].least, facts[n].most);
    }
    printf("\n");
}

static void print_tally(const struct kind *munition, const char *target,
                        enum battle_shooter shooter, const struct battle_tally *tally)
{
    static const char *const shooters[BATTLE_SHOOTERS] = {"halted", "moving"};
    bool differs = munition->dispersion_moving_rad > munition->dispersion_rad;
    uint32_t in_time = tally->fired - tally->late;
    printf("%-18s%-14s%-8s%6u%6u%6u", munition->name, target, differs ? shooters[shooter] : "any",
           tally->fired, tally->late, tally->hits);
    if (in_time > 0 && strcmp(target, "ground") != 0)
        printf("%5.0f %%", 100.0 * tally->hits / (double)in_time);
    else
        printf("%7s", "-");
    printf("%7u%6u", tally->others, tally->ended);
    print_real(munition->name, target, shooter);
}

static void print_hits(const struct battle_count *count, const struct view *view)
{
    const struct kind *kinds = view->world.kinds;
    uint32_t number = view->world.counts.kinds;
    printf("%-18s%-14s%-8s%6s%6s%6s%7s%7s%6s  %s\n", "munition", "target", "shooter", "shots",
           "late", "hits", "share", "others", "ended", "real");
    for (uint32_t m = 0; m < number; m++) {
        for (uint32_t t = 0; t <= BATTLE_GROUND; t++) {
            const char *target = t == BATTLE_GROUND ? "ground" : t < number ? kinds[t].name : "";
            for (int s = 0; s < BATTLE_SHOOTERS; s++) {
                const struct battle_tally *tally = &count->by[m][t][s];
                if (tally->fired > 0)
                    print_tally(&kinds[m], target, (enum battle_shooter)s, tally);
            }
        }
    }
}

static void print_losses(const struct battle_count *count, const struct view *view)
{
    for (int force = 0; force < FORCE_COUNT; force++) {
        printf("%s lost", force_name((uint32_t)force));
        for (uint32_t k = 0; k < view->world.counts.kinds; k++) {
            if (count->first[force][k] > 0)
                printf("  %s %u of %u", view->world.kinds[k].name, count->lost[force][k],
                       count->first[force][k]);
        }
        printf("\n");
    }
}

static void print_news(const struct battle_count *count)
{
    for (uint32_t n = 0; n < count->news_count; n++) {
        const struct event_mission *news = &count->news[n].mission;
        double time_s = (double)count->news[n].tick * count->dt_s;
        if (news->news == MISSION_NEWS_OBJECTIVE)
            printf("%7.1f s  %s takes %s\n", time_s, force_name(news->force), news->name);
        if (news->news == MISSION_NEWS_REACTION)
            printf("%7.1f s  %s of %s: %s\n", time_s, news->name, force_name(news->force),
                   news->phase);
        if (news->news == MISSION_NEWS_RESULT)
            printf("%7.1f s  result: %s; objectives blue %u, red %u; lost blue %u, red %u\n",
                   time_s, news->force == FORCE_NEUTRAL ? "nobody wins" : force_name(news->force),
                   news->held[FORCE_BLUE], news->held[FORCE_RED], news->lost[FORCE_BLUE],
                   news->lost[FORCE_RED]);
    }
}

static void print_thirds(const char *what, const uint32_t by_minute[BATTLE_MINUTES],
                         uint32_t minutes)
{
    printf("%s in every three minutes:", what);
    for (uint32_t n = 0; n < minutes; n += 3)
        printf(" %u", battle_count_sum(by_minute, n, 3));
    printf("\n");
}

/* Shares of all shots. */
static void print_fifths(const struct battle_count *count, uint32_t minutes)
{
    uint32_t all = battle_count_sum(count->shots, 0, minutes);
    printf("percent of the shots in every five minutes:");
    for (uint32_t n = 0; n < minutes; n += 5)
        printf(" %.0f", 100.0 * battle_count_sum(count->shots, n, 5) / (double)(all > 0 ? all : 1));
    printf("\n");
}

/* Lists the collisions of aircraft of one force. */
static void print_met(const struct battle_count *count, const struct view *view)
{
    printf("aircraft that touched: %u pairs of one side, %u others\n", count->met_friends,
           count->met_others);
    for (uint32_t n = 0; n < count->met_friends && n < BATTLE_MET_MAX; n++) {
        const struct event_collision *met = &count->met[n].collision;
        printf("%7.1f s  %s of row %u and %s of row %u at [%.0f, %.0f], closing with %.1f m/s\n",
               (double)count->met[n].tick * count->dt_s, view->world.kinds[met->a.kind].name,
               met->a.id - 1, view->world.kinds[met->b.kind].name, met->b.id - 1, met->point[0],
               met->point[2], (double)met->closing_mps);
    }
}

void battle_report(const struct battle_count *count, const struct view *view, uint32_t frames)
{
    uint32_t minutes = (uint32_t)ceil((double)frames * count->dt_s / 60.0);
    uint32_t row = longest_push(count, view);
    minutes = minutes < BATTLE_MINUTES ? minutes : BATTLE_MINUTES;
    print_thirds("shots", count->shots, minutes);
    print_fifths(count, minutes);
    print_thirds("vehicles lost", count->losses, minutes);
    print_losses(count, view);
    print_hits(count, view);
    print_news(count);
    printf("longest push: %.1f s, %s of row %u; collisions: %u, by which %u vehicles ended\n",
           count->longest[row] * count->dt_s, view->world.kinds[count->kind[row]].name, row,
           count->bumps, count->crashes);
    print_met(count, view);
}

/* --- bounds ------------------------------------------------------------------------------------*/

static uint32_t wrong_shots(const struct battle_count *count)
{
    uint32_t wrong = 0, all = battle_count_sum(count->shots, 0, MINUTES);
    for (uint32_t n = 0; n < MINUTES; n += 3) {
        uint32_t shots = battle_count_sum(count->shots, n, 3);
        if (shots >= SHOTS_LEAST)
            continue;
        printf("OUT OF BOUNDS: minutes %u to %u: %u shots; right would be %u or more\n", n, n + 3,
               shots, SHOTS_LEAST);
        wrong++;
    }
    for (uint32_t n = 0; n < MINUTES; n += 5) {
        double share = (double)battle_count_sum(count->shots, n, 5) / (double)(all > 0 ? all : 1);
        if (share >= SHARE_LEAST && share <= SHARE_MOST)
            continue;
        printf("OUT OF BOUNDS: minutes %u to %u: %.0f %% of all shots; right would be %.0f to %.0f "
               "%%\n",
               n, n + 5, 100.0 * share, 100.0 * SHARE_LEAST, 100.0 * SHARE_MOST);
        wrong++;
    }
    return wrong;
}

/* Each force loses aircraft and keeps some. */
static uint32_t wrong_aircraft(const struct battle_count *count, const struct view *view)
{
    uint32_t wrong = 0;
    for (int force = FORCE_BLUE; force <= FORCE_RED; force++) {
        uint32_t lost = 0, of = 0;
        for (uint32_t k = 0; k < view->world.counts.kinds; k++) {
            const struct kind *kind = &view->world.kinds[k];
            if (kind->domain != DOMAIN_AIR || kind->doctrine == DOCTRINE_BEAST)
                continue;
            lost += count->lost[force][k];
            of += count->first[force][k];
        }
        if (lost > 0 && lost < of)
            continue;
        printf("OUT OF BOUNDS: %s lost %u of %u aircraft; right would be some, and some kept\n",
               force_name((uint32_t)force), lost, of);
        wrong++;
    }
    return wrong;
}

/* No round of a tank's gun is for a jet. */
static uint32_t wrong_rounds(const struct battle_count *count, const struct view *view)
{
    const struct kind *kinds = view->world.kinds;
    uint32_t wrong = 0;
    for (uint32_t k = 0; k < view->world.counts.kinds; k++) {
        uint16_t munition = kinds[k].munition;
        for (uint32_t t = 0; t < view->world.counts.kinds; t++) {
            if (munition == KIND_NONE || kinds[munition].air_targets != AIR_TARGETS_SLOW ||
                kinds[t].min_speed_mps <= 0.0 || count->rounds[k][t] == 0)
                continue;
            printf("OUT OF BOUNDS: %u rounds of kind %s at kind %s; right would be none\n",
                   count->rounds[k][t], kinds[k].name, kinds[t].name);
            wrong++;
        }
    }
    return wrong;
}

static bool has_result(const struct battle_count *count)
{
    for (uint32_t n = 0; n < count->news_count; n++) {
        if (count->news[n].mission.news == MISSION_NEWS_RESULT)
            return true;
    }
    return false;
}

static uint32_t wrong_meetings(const struct battle_count *count)
{
    if (count->met_friends == 0)
        return 0;
    printf("OUT OF BOUNDS: %u pairs of aircraft of one side touched; right would be none\n",
           count->met_friends);
    return 1;
}

uint32_t battle_report_wrong(const struct battle_count *count, const struct view *view)
{
    uint32_t wrong = wrong_shots(count) + wrong_aircraft(count, view) + wrong_rounds(count, view) +
                     wrong_meetings(count);
    double push_s = count->longest[longest_push(count, view)] * count->dt_s;
    if (push_s > PUSH_LONG_S) {
        printf("OUT OF BOUNDS: a vehicle pushed for %.1f s; right would be %g s or less\n", push_s,
               PUSH_LONG_S);
        wrong++;
    }
    if (!has_result(count)) {
        printf("OUT OF BOUNDS: the battle has no result; right would be one after end_s\n");
        wrong++;
    }
    return wrong;
}
