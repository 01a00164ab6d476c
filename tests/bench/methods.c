/* Measures what each method of collision detection finds, misses and costs on the same bodies:
 * spheres of 3 m on level ground, in platoons all over the 50 km square, ten frames a second as in
 * the thesis. Most have a ground vehicle's speed, one in ten an aircraft's. */
#include "tests/bench/bench.h"

#include "collider/broad_phase/broad_phase.h"
#include "collider/method/method_npsnet2.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/entity/kind.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FEWEST      1000u
#define TIMES       10u /* factor of bodies between rows of the table */
#define DT_S        0.1
#define RADIUS_M    3.0
#define PLATOON     10u
#define PLATOON_M   200.0
#define GROUND_MPS  16.6 /* Table 2 */
#define AIR_MPS     277.7
#define FAST        10u /* one aircraft among this many bodies */
#define MPS_NEAR_M  10.0
#define REPEATS_MAX 9
#define ENOUGH_MS   2000.0
#define TOO_LONG_MS 20000.0

struct field {
    struct params params;
    struct kind kind;
    float posts[4];
    uint8_t cover[4];
    uint32_t *reach_start; /* no fixed objects */
    void *memory;
    struct entities entities;
    struct path *path;
    struct world world;
    struct method_input input;
};

static void make_field(struct field *field, uint32_t bodies)
{
    *field = (struct field){.kind = {.domain = DOMAIN_LAND, .radius_m = RADIUS_M}};
    field->params.capacity = bodies;
    field->params.dt_s = DT_S;
    field->params.collision = (struct collision_params){
        .shape = SHAPE_SPHERE, .nearness = NEARNESS_AND, .mps_near_m = MPS_NEAR_M};
    field->reach_start = calloc(GRIDSQUARES_DEFAULT.count + 1, sizeof *field->reach_start);
    field->path = calloc(bodies, sizeof *field->path);
    field->memory = calloc(1, entities_bytes(bodies) + TABLE_ALIGN);
    if (!field->reach_start || !field->path || !field->memory)
        die_refused("out of memory");
    uintptr_t past = (uintptr_t)field->memory % TABLE_ALIGN;
    entities_bind(&field->entities, bodies, (char *)field->memory + (TABLE_ALIGN - past));
    field->world = (struct world){.params = &field->params,
                                  .counts = {.kinds = 1},
                                  .terrain = {field->posts, field->cover, 2, WORLD_SIDE_DEFAULT_M,
                                              .squares = GRIDSQUARES_DEFAULT_INIT},
                                  .kinds = &field->kind,
                                  .reach_start = field->reach_start};
    field->input = (struct method_input){
        .world = &field->world, .entities = &field->entities, .path = field->path, .rows = bodies};
}

static void free_field(struct field *field)
{
    free(field->reach_start);
    free(field->path);
    free(field->memory);
}

static double draw(uint32_t body, enum random_purpose purpose, double low, double high)
{
    return random_between(1991, 0, body, purpose, low, high);
}

static void place_bodies(struct field *field)
{
    const struct entities *e = &field->entities;
    for (uint32_t i = 0; i < field->input.rows; i++) {
        uint32_t platoon = i / PLATOON;
        double speed = i % FAST == 0 ? AIR_MPS : draw(i, RANDOM_NOISE, 0.0, GROUND_MPS);
        double sine, cosine;
        maths_sincos(draw(i, RANDOM_HEADING, 0.0, TWO_PI), &sine, &cosine);
        field->path[i] = (struct path){
            .at = {draw(platoon, RANDOM_GOAL_X, 0.0, WORLD_SIDE_DEFAULT_M - PLATOON_M) +
                       draw(i, RANDOM_PLACE_X, 0.0, PLATOON_M),
                   0.0,
                   draw(platoon, RANDOM_GOAL_Z, 0.0, WORLD_SIDE_DEFAULT_M - PLATOON_M) +
                       draw(i, RANDOM_PLACE_Z, 0.0, PLATOON_M)},
            .along = {speed * DT_S * sine, 0.0, speed * DT_S * cosine}};
        e->row[i].id = i + 1;
        e->row[i].state = ENTITY_ACTIVE;
        e->row[i].behaviour = BEHAVIOUR_HOLD;
        entities_set_position(e, i, path_at(&field->path[i], 1.0));
    }
}

/* Returns true if the spheres touch at any time of the frame. */
static bool touch(const struct field *field, struct pair pair)
{
    const struct path *a = &field->path[pair.a], *b = &field->path[pair.b];
    struct vec3 gap = vec3_sub(b->at, a->at);
    double toi;
    return vec3_length(gap) <= 2.0 * RADIUS_M ||
           analytic_impact_spheres(a, b, 2.0 * RADIUS_M, 0.0, &toi);
}

static uint32_t count_touching(const struct field *field, const struct pair_list *pairs)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < pairs->count; n++)
        count += touch(field, pairs->pair[n]);
    return count;
}

/* --- one method --------------------------------------------------------------------------------*/

struct finder {
    enum method method;
    struct broad_phase broad; /* used by the swept method */
    struct method_workspace *workspace;
    struct pair_list pairs;
    double last_ms, last_growth; /* at the previous size; 0: none */
};

static const struct pair_list *find(struct finder *finder, const struct field *field)
{
    finder->pairs.count = 0;
    if (finder->method == METHOD_SWEPT)
        broad_phase_pairs(&finder->broad, &field->input);
    method_of(finder->method)->pairs(&field->input, finder->workspace, &finder->pairs);
    return &finder->pairs;
}

/* Returns the median of some runs, or the time of one long run. */
static double time_ms(struct finder *finder, const struct field *field)
{
    double ms[REPEATS_MAX], all_ms = 0.0;
    uint32_t count = 0;
    while (count < REPEATS_MAX && (count == 0 || all_ms < ENOUGH_MS)) {
        uint64_t before = clock_now_ns();
        find(finder, field);
        ms[count] = (double)(clock_now_ns() - before) / 1e6;
        all_ms += ms[count++];
    }
    return bench_quantile(ms, count, 0.5);
}

/* The next size is TIMES as large. In the worst case the work grows with its square. */
static bool too_long(const struct finder *finder)
{
    double growth = finder->last_growth > 0.0 ? finder->last_growth : 2.0;
    return finder->last_ms * pow(TIMES, growth) > TOO_LONG_MS;
}

struct row {
    uint32_t bodies, contacts, found, false_alarms;
    double ms, growth;
    struct method_npsnet2_level1 level1;
};

static void print_row(const struct finder *finder, const struct row *row, bool json)
{
    uint32_t missed = row->contacts - row->found;
    const char *name = method_name(finder->method);
    if (json) {
        printf("{\"method\":\"%s\",\"bodies\":%u,\"found\":%u,\"false_alarms\":%u,\"missed\":%u,"
               "\"ms\":%.4f,\"growth\":%.2f,\"kept_or\":%llu,\"kept_and\":%llu}\n",
               name, row->bodies, row->found, row->false_alarms, missed, row->ms, row->growth,
               (unsigned long long)row->level1.kept[NEARNESS_OR],
               (unsigned long long)row->level1.kept[NEARNESS_AND]);
        return;
    }
    printf("%-10s %8u bodies: %6u found, %6u false alarms, %6u missed, %11.3f ms", name,
           row->bodies, row->found, row->false_alarms, missed, row->ms);
    if (row->growth > 0.0)
        printf(", growth n^%.2f", row->growth);
    if (row->level1.pairs > 0)
        printf("; its 100 m test keeps %llu pairs by or, %llu by and, of %llu",
               (unsigned long long)row->level1.kept[NEARNESS_OR],
               (unsigned long long)row->level1.kept[NEARNESS_AND],
               (unsigned long long)row->level1.pairs);
    printf("\n");
}

static void measure(struct finder *finder, const struct field *field, uint32_t contacts, bool json)
{
    struct row row = {.bodies = field->input.rows, .contacts = contacts};
    row.ms = time_ms(finder, field);
    const struct pair_list *pairs = find(finder, field);
    row.found = count_touching(field, pairs);
    row.false_alarms = pairs->count - row.found;
    if (finder->last_ms > 0.0)
        row.growth = log(row.ms / finder->last_ms) / log(TIMES);
    if (finder->method == METHOD_NPSNET2)
        row.level1 = method_npsnet2_level1(&field->input);
    finder->last_ms = row.ms;
    finder->last_growth = row.growth;
    print_row(finder, &row, json);
}

/* --- all ---------------------------------------------------------------------------------------*/

static void measure_size(struct finder finders[METHOD_COUNT], uint32_t bodies, bool json)
{
    struct field field;
    uint32_t contacts = 0;
    make_field(&field, bodies);
    place_bodies(&field);
    for (int method = 0; method < METHOD_COUNT; method++) {
        struct finder *finder = &finders[method];
        if (too_long(finder))
            continue;
        finder->workspace = method_workspace_create(&field.world, &finder->broad);
        if (!finder->workspace || broad_phase_init(&finder->broad, &field.world, NULL) != 0 ||
            pair_list_init(&finder->pairs, pair_filter_pairs_first(&field.world)) != 0)
            die_refused("out of memory");
        if (method == METHOD_SWEPT)
            contacts = count_touching(&field, find(finder, &field));
        measure(finder, &field, contacts, json);
        broad_phase_free(&finder->broad);
        pair_list_free(&finder->pairs);
        method_workspace_free(finder->workspace);
        fflush(stdout);
    }
    free_field(&field);
}

int bench_methods(struct bench_options options)
{
    struct finder finders[METHOD_COUNT] = {0};
    if (options.vehicles < FEWEST)
        die_usage("--vehicles %u: must be at least %u", options.vehicles, FEWEST);
    for (int method = 0; method < METHOD_COUNT; method++)
        finders[method].method = (enum method)method;
    for (uint32_t bodies = FEWEST; bodies <= options.vehicles; bodies *= TIMES)
        measure_size(finders, bodies, options.json);
    return EXIT_OK;
}
