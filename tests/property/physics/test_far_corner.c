/* Collisions near the far corner of a world of 500 km have the ending that they have in its middle
 * and in a world of 50 km: no position loses millimetres. */
#include "collider/broad_phase/strip_bins.h"
#include "tests/support/steps.h"
#include "world/entity/event.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#define ROWS 48u
#define FRAMES                                                                                     \
    120u /* bodies that press on each other lose the way they came after some seconds              \
          */
#define CROWD_M 60.0
#define PAIR_M  100.0 /* from one pair to the next */
#define NEAR_M  1e-3
#define FAR_M   6e-11 /* the last bit of 500 km */
#define TRIALS  8     /* runs that begin up to FAR_M elsewhere */
#define GROWN_M 1e-6  /* what became of FAR_M where an impact hangs on the last bit */
#define LONG    900u  /* frames of lasting contact */
#define STEP_M  4e-12 /* the last bit of 25 km */
#define LOST_M  1e-6
#define MORE    100.0 /* so many times what a bit does in 50 km may be lost elsewhere */

/* Places that are multiples of the distance of posts, of the strips and of the gridsquares. */
static const struct corner {
    double side_m, x, z;
} places[] = {{50000.0, 24000.0, 24000.0},
              {500000.0, 250000.0, 250000.0},
              {500000.0, 496000.0, 496000.0},
              {500000.0, 496000.0, 4000.0}};

/* How the run ended: positions from the place. */
struct ending {
    struct vec3 at[ROWS];
    double heading[ROWS], damage[ROWS];
    uint64_t collisions, contacts;
};

static void open_world(struct fixture *f, const struct corner *place, const char *method,
                       const char *shape)
{
    char text[640];
    snprintf(
        text, sizeof text,
        "world = { seed = 1; capacity = 64; };\n"
        "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 125.0; side_m = %g; };\n"
        "objects = ( { kind = \"building\"; at = [%g, %g]; }, { kind = \"tree\"; at = [%g, %g]; "
        "} );\n"
        "collision = { shape = \"%s\"; method = \"%s\"; };\n",
        place->side_m, place->x + 30.0, place->z + 30.0, place->x - 20.0, place->z + 10.0, shape,
        method);
    fixture_open(f, text);
}

/* Vehicles and helicopters cross a square of 120 m. */
static void put_crowd(struct fixture *f, const struct corner *place, uint64_t random)
{
    for (uint32_t i = 0; i < ROWS; i++) {
        bool flies = i % 6 == 5;
        double x = fixture_uniform(&random, -CROWD_M, CROWD_M);
        double z = fixture_uniform(&random, -CROWD_M, CROWD_M);
        double speed = fixture_uniform(&random, 3.0, flies ? 30.0 : 15.0);
        fixture_put(f, (struct fixture_entity){
                           .kind = flies   ? "helicopter"
                                   : i % 2 ? "tank"
                                           : "jeep",
                           .at = {place->x + x, flies ? 140.0 : FIXTURE_GROUND_M, place->z + z},
                           .velocity = {-speed * x / CROWD_M, 0.0, -speed * z / CROWD_M}});
    }
}

/* Pairs drive at each other, each pair alone: among many bodies a rounding error grows with every
 * impact. */
static void put_pairs(struct fixture *f, const struct corner *place, uint64_t random)
{
    for (uint32_t i = 0; i < ROWS; i += 2) {
        bool flies = i % 12 == 10;
        double x = place->x + PAIR_M * (i / 2 % 6), z = place->z - PAIR_M * (i / 12 + 1.0);
        double y = flies ? 160.0 : FIXTURE_GROUND_M;
        for (int side = -1; side <= 1; side += 2)
            fixture_put(f,
                        (struct fixture_entity){
                            .kind = flies      ? "helicopter"
                                    : side < 0 ? "tank"
                                               : "jeep",
                            .at = {x + 12.0 * side, y, z + fixture_uniform(&random, -1.5, 1.5)},
                            .velocity = {-side * fixture_uniform(&random, 4.0, 14.0), 0.0, 0.0}});
    }
}

typedef void put(struct fixture *f, const struct corner *place, uint64_t random);

/* off: 0, or the seed of places that are up to FAR_M off. */
static struct ending run_off(const struct corner *place, const char *method, const char *shape,
                             put *crowd, uint64_t seed, uint64_t off)
{
    struct fixture f;
    struct ending ending = {.collisions = 0};
    open_world(&f, place, method, shape);
    crowd(&f, place, seed);
    struct state now = fixture_state(&f);
    for (uint32_t i = 0; off != 0 && i < ROWS; i++) {
        now.entities.row[i].x += fixture_uniform(&off, -FAR_M, FAR_M);
        now.entities.row[i].z += fixture_uniform(&off, -FAR_M, FAR_M);
    }
    fixture_run(&f, FRAMES);
    now = fixture_state(&f);
    for (uint32_t i = 0; i < ROWS; i++) {
        ending.at[i] =
            vec3_sub(entities_position(&now.entities, i), (struct vec3){place->x, 0.0, place->z});
        ending.heading[i] = now.entities.row[i].heading;
        ending.damage[i] = now.entities.row[i].damage;
    }
    ending.collisions = now.head->tally.collisions;
    ending.contacts = now.head->contact_count;
    fixture_close(&f);
    return ending;
}

static struct ending run(const struct corner *place, const char *method, const char *shape,
                         put *crowd, uint64_t seed)
{
    return run_off(place, method, shape, crowd, seed, 0);
}

/* Marks rows that end elsewhere in 50 km, too, when they begin less than FAR_M off: helicopters
 * that roll along each other's edges, of which the last bit decides which corner meets next.
 * Returns how many. */
static uint32_t find_unstable(const char *shape, put *crowd, uint64_t seed,
                              const struct ending *first, bool unstable[ROWS])
{
    uint32_t count = 0;
    for (uint64_t trial = 1; trial <= TRIALS; trial++) {
        struct ending other = run_off(&places[0], "swept", shape, crowd, seed, trial);
        for (uint32_t i = 0; i < ROWS; i++)
            unstable[i] |= vec3_length(vec3_sub(first->at[i], other.at[i])) > GROWN_M;
    }
    for (uint32_t i = 0; i < ROWS; i++)
        count += unstable[i];
    return count;
}

/* except: rows that are not compared, or NULL. */
static void is_same(const struct ending *a, const struct ending *b, const bool *except)
{
    if (!except) {
        assert_int_equal(a->collisions, b->collisions);
        assert_int_equal(a->contacts, b->contacts);
    }
    for (uint32_t i = 0; i < ROWS; i++) {
        if (except && except[i])
            continue;
        if (!(vec3_length(vec3_sub(a->at[i], b->at[i])) < NEAR_M))
            fail_msg("row %u is %g m off", i, vec3_length(vec3_sub(a->at[i], b->at[i])));
        assert_true(fabs(a->heading[i] - b->heading[i]) < 1e-4);
        assert_true(a->damage[i] == b->damage[i]);
    }
}

static void test_an_impact_ends_the_same_everywhere(void **state)
{
    static const char *const shapes[] = {"sphere", "model"};
    uint64_t seed = fixture_seed(71);
    (void)state;
    for (size_t s = 0; s < COUNT(shapes); s++) {
        struct ending first = run(&places[0], "swept", shapes[s], put_pairs, seed);
        bool unstable[ROWS] = {false};
        uint32_t left_out = find_unstable(shapes[s], put_pairs, seed, &first, unstable);
        print_message("%s: %llu collisions, %u rows hang on the last bit\n", shapes[s],
                      (unsigned long long)first.collisions, left_out);
        assert_true(first.collisions > 10 && left_out <= ROWS / 6);
        for (size_t p = 1; p < COUNT(places); p++) {
            struct ending other = run(&places[p], "swept", shapes[s], put_pairs, seed);
            is_same(&first, &other, unstable);
        }
    }
}

static int by_size(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Lets pairs press on each other, which begin off_m further apart. Gives where they are in the end.
 */
static void press(const struct corner *place, double off_m, uint64_t seed, struct vec3 at[ROWS])
{
    struct fixture f;
    open_world(&f, place, "swept", "model");
    put_pairs(&f, place, seed);
    struct state now = fixture_state(&f);
    for (uint32_t i = 0; i < ROWS; i++)
        now.entities.row[i].x += i % 2 ? off_m : -off_m;
    fixture_run(&f, LONG);
    now = fixture_state(&f);
    for (uint32_t i = 0; i < ROWS; i++)
        at[i] =
            vec3_sub(entities_position(&now.entities, i), (struct vec3){place->x, 0.0, place->z});
    fixture_close(&f);
}

/* Prints by how much rows ended elsewhere. Returns how much three of four stay below [m]. */
static double most_differ(const char *what, const struct vec3 a[ROWS], const struct vec3 b[ROWS])
{
    double off[ROWS];
    for (uint32_t i = 0; i < ROWS; i++)
        off[i] = vec3_length(vec3_sub(a[i], b[i]));
    qsort(off, ROWS, sizeof *off, by_size);
    print_message("%s: half are less than %.1e m off, three of four %.1e, one %.1e\n", what,
                  off[ROWS / 2], off[ROWS * 3 / 4], off[ROWS - 1]);
    return off[ROWS * 3 / 4];
}

/* A few pairs that lean on each other lose the way they came within seconds, wherever they are: a
 * start that differs by the last bit does the same in the middle of 50 km. The others do not. */
static void test_lasting_contacts_lose_nothing(void **state)
{
    static struct vec3 first[ROWS], other[ROWS];
    uint64_t seed = fixture_seed(71);
    (void)state;
    press(&places[0], 0.0, seed, first);
    press(&places[0], STEP_M, seed, other);
    double most_m = LOST_M + MORE * most_differ("one bit apart in 50 km", first, other);
    for (size_t p = 1; p < COUNT(places); p++) {
        press(&places[p], 0.0, seed, other);
        assert_true(most_differ(p == 1 ? "in the middle of 500 km" : "at its corner", first,
                                other) < most_m);
    }
}

/* Boxes are floats: none may be narrower than its body where floats are 31 mm apart. */
static void test_the_broad_phase_misses_nothing_at_the_far_corner(void **state)
{
    uint64_t seed = fixture_seed(72);
    (void)state;
    for (int trial = 0; trial < 4; trial++) {
        struct ending swept = run(&places[2], "swept", "model", put_crowd, seed + (uint64_t)trial);
        struct ending brute = run(&places[2], "brute", "model", put_crowd, seed + (uint64_t)trial);
        is_same(&swept, &brute, NULL);
    }
}

static void test_a_box_holds_its_body_at_any_place(void **state)
{
    struct fixture f;
    uint64_t random = fixture_seed(73);
    (void)state;
    open_world(&f, &places[2], "swept", "model");
    const struct world *world = &f.view.world;
    const struct kind *tank = steps_kind(&f, "tank");
    for (int i = 0; i < 100000; i++) {
        struct path path = {.at = {fixture_uniform(&random, 0.0, 500000.0), 100.0,
                                   fixture_uniform(&random, 0.0, 500000.0)}};
        struct path_box box = pair_filter_path_box(&path, pair_filter_margin(world, tank));
        assert_true((double)box.min_x <= path.at.x - tank->reach_m &&
                    (double)box.max_x >= path.at.x + tank->reach_m);
        assert_true((double)box.min_z <= path.at.z - tank->reach_m &&
                    (double)box.max_z >= path.at.z + tank->reach_m);
    }
    fixture_close(&f);
}

static void test_a_large_world_has_all_its_strips(void **state)
{
    (void)state;
    for (double side_m = 1000.0; side_m <= 500000.0; side_m += 125.0) {
        float steps = bin_steps_per_m(side_m);
        uint32_t last = bin_strip(steps, (float)side_m), before = 0;
        double deep = BIN_STRIP_STEPS / (double)steps;
        assert_true(last < STRIP_COUNT && (side_m <= 50000.0 || last >= STRIP_COUNT / 2 - 1));
        for (uint32_t i = 1; deep * i < side_m; i++, before++)
            assert_int_equal(bin_strip(steps, (float)(deep * i + 1.0)), before + 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_impact_ends_the_same_everywhere),
        cmocka_unit_test(test_lasting_contacts_lose_nothing),
        cmocka_unit_test(test_the_broad_phase_misses_nothing_at_the_far_corner),
        cmocka_unit_test(test_a_box_holds_its_body_at_any_place),
        cmocka_unit_test(test_a_large_world_has_all_its_strips),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
