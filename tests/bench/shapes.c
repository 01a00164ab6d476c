/* Measures the errors of spheres (thesis row 38): how often the spheres of two bodies overlap
 * although their shapes do not touch, and how often the shapes touch outside the spheres. */
#include "tests/bench/bench.h"

#include "collider/motion/body_motion.h"
#include "config/loader.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/maths/random.h"

#include <stdio.h>

static const char *const pairs[][2] = {
    {"tank", "tank"},
    {"tank", "jeep"},
    {"truck", "truck"},
    {"jeep", "jeep"},
    {"tank", "tree"},
    {"jeep", "tree"},
    {"tank", "pine"},
    {"tank", "pole"},
    {"tank", "rock"},
    {"tank", "building"},
    {"helicopter", "helicopter"},
    {"jet", "jet"},
    {"ship", "ship"},
};

#define PAIRS (sizeof pairs / sizeof pairs[0])

static double draw(uint32_t sample, enum random_purpose purpose, double low, double high)
{
    return random_between(1991, 0, sample, purpose, low, high);
}

static struct swept_body body_of(const struct scenario *scenario, const struct kind *kind,
                                 struct vec3 at, double heading)
{
    struct quat turned = rotation_of(heading, 0.0, 0.0);
    return (struct swept_body){.hull = scenario->hulls + kind->first_hull,
                               .hull_count = kind->hull_count,
                               .vertices = scenario->hull_vertices,
                               .planes = scenario->hull_planes,
                               .scale = 1.0,
                               .bound_m = kind->bound_m,
                               .path = {.at = at},
                               .from = turned,
                               .to = turned};
}

struct verdicts {
    uint32_t both, spheres, shapes; /* pairs that touch: with spheres and shapes, with spheres
                                       alone, with shapes alone */
};

/* Places pairs of bodies at random beside each other on level ground, with random headings, and
 * counts touching spheres and shapes. */
static struct verdicts compare(const struct scenario *scenario, const struct kind *a,
                               const struct kind *b, uint32_t samples)
{
    struct verdicts tally = {0, 0, 0};
    double reach = a->radius_m + b->radius_m;
    double most = maths_max(reach, a->level_m + b->level_m);
    for (uint32_t i = 0; i < samples; i++) {
        struct vec3 off = {draw(i, RANDOM_PLACE_X, -most, most), 0.0,
                           draw(i, RANDOM_PLACE_Z, -most, most)};
        struct swept_body p = body_of(scenario, a, (struct vec3){0.0, 0.0, 0.0},
                                      draw(i, RANDOM_HEADING, 0.0, TWO_PI));
        struct swept_body q = body_of(scenario, b, off, draw(i, RANDOM_OBJECT_SHAPE, 0.0, TWO_PI));
        bool spheres = vec3_dot(off, off) <= reach * reach;
        bool shapes = time_of_impact_gap(&p, &q, 0.0) == 0.0;
        tally.both += spheres && shapes;
        tally.spheres += spheres && !shapes;
        tally.shapes += shapes && !spheres;
    }
    return tally;
}

static double percent(uint32_t part, uint32_t rest)
{
    return part + rest > 0 ? 100.0 * part / (part + rest) : 0.0;
}

int bench_shapes(struct bench_options options)
{
    struct scenario scenario;
    struct error_text error;
    char data_dir[512];
    if (process_data_dir(data_dir, sizeof data_dir) != 0)
        die_refused("cannot find the data; set JOLON_DATA");
    if (loader_scenario(&scenario, data_dir, NULL, NULL, 0, &error) != 0)
        die_refused("%s", error.text);
    for (size_t i = 0; i < PAIRS; i++) {
        uint16_t a = kind_find(scenario.kinds, scenario.kind_count, pairs[i][0]);
        uint16_t b = kind_find(scenario.kinds, scenario.kind_count, pairs[i][1]);
        if (a == KIND_NONE || b == KIND_NONE)
            die_refused("kind %s is missing", pairs[i][a == KIND_NONE ? 0 : 1]);
        struct verdicts tally =
            compare(&scenario, &scenario.kinds[a], &scenario.kinds[b], options.frames);
        double false_alarms = percent(tally.spheres, tally.both);
        double missed = percent(tally.shapes, tally.both);
        printf(options.json ? "{\"a\":\"%s\",\"b\":\"%s\",\"sphere_false_percent\":%.1f,"
                              "\"sphere_missed_percent\":%.1f}\n"
                            : "%-10s %-10s %5.1f %% of overlapping spheres are false alarms; %5.1f "
                              "%% of touching shapes are outside the spheres\n",
               pairs[i][0], pairs[i][1], false_alarms, missed);
    }
    scenario_free(&scenario);
    return EXIT_OK;
}
