/* Random manoeuvres at 10 and at 60 Hz: the same vehicles turn over. Controls change every fifth of
 * a second, so that both get the same at the same times. */
#include "mover/motion/chassis.h"
#include "tests/support/scenario_text.h"
#include "tests/support/steps.h"
#include "world/entity/disabled.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define MANOEUVRES 160
#define SECONDS    8
#define CHANGES    (5 * SECONDS)

/* A ramp that a vehicle may meet with one side, a washboard, a bank and a trench. */
#define WORKS                                                                                      \
    "earthworks = ("                                                                               \
    "{ shape = \"ramp\"; at = [25000.0, 24960.0]; length_m = 10.0; width_m = 3.0; height_m = "     \
    "1.2; },"                                                                                      \
    "{ shape = \"washboard\"; at = [25010.0, 24960.0]; length_m = 30.0; width_m = 8.0;"            \
    " height_m = 0.2; wave_m = 3.0; },"                                                            \
    "{ shape = \"table\"; at = [25022.0, 24960.0]; length_m = 40.0; width_m = 14.0; height_m = "   \
    "3.0;"                                                                                         \
    " edge_m = 4.0; },"                                                                            \
    "{ shape = \"trench\"; at = [24990.0, 24960.0]; length_m = 2.0; width_m = 12.0; depth_m = "    \
    "1.0;"                                                                                         \
    " edge_m = 0.2; } );"

static struct fixture fast, slow; /* 60 and 10 Hz */

struct manoeuvre {
    const char *kind;
    double x, mps, load; /* load: height of the centre of mass over that of the kind */
    enum cover cover;
    float throttle[CHANGES], steer[CHANGES], hand[CHANGES], brake[CHANGES];
};

static struct manoeuvre draw(uint64_t *random)
{
    static const char *const kinds[] = {"truck", "jeep", "hamburger", "carrier", "tank"};
    static const enum cover covers[] = {COVER_ROAD, COVER_ROAD, COVER_GRASS, COVER_ROCK};
    struct manoeuvre drawn = {.kind = kinds[fixture_random(random) % 5],
                              .x = 25000.0 + fixture_uniform(random, -16.0, 24.0),
                              .mps = fixture_uniform(random, 6.0, 22.0),
                              .load = fixture_uniform(random, 1.0, 1.6),
                              .cover = covers[fixture_random(random) % 4]};
    float throttle = 1.0f, steer = 0.0f, hand = 0.0f, brake = 0.0f;
    for (int n = 0; n < CHANGES; n++) {
        if (fixture_random(random) % 5 == 0) {
            steer = (float)fixture_uniform(random, -1.5, 1.5);
            steer = steer > 1.0f ? 1.0f : steer < -1.0f ? -1.0f : steer;
            throttle = fixture_random(random) % 3 ? 1.0f : 0.0f;
            hand = fixture_random(random) % 6 ? 0.0f : 1.0f;
            brake = fixture_random(random) % 8 ? 0.0f : 1.0f;
        }
        drawn.throttle[n] = throttle;
        drawn.steer[n] = steer;
        drawn.hand[n] = hand;
        drawn.brake[n] = brake;
    }
    return drawn;
}

struct ending {
    bool over;
    double x, z;
};

/* Drives it. hz: 10 or 60. */
static struct ending drive(struct fixture *f, uint32_t hz, const struct manoeuvre *drawn)
{
    steps_empty(f);
    steps_cover(f, drawn->cover, 20000.0, 20000.0, 30000.0, 30000.0);
    struct kind *kind = steps_kind(f, drawn->kind);
    double height = kind->centre_height_m, resistance = kind->resistance_j;
    kind->centre_height_m *= drawn->load;
    kind->resistance_j = 1e15; /* it turns over, or it lives */
    uint32_t row = fixture_put(
        f, (struct fixture_entity){.kind = drawn->kind,
                                   .at = {drawn->x, steps_ground_at(f, drawn->x, 25000.0), 25000.0},
                                   .velocity = {0.0, 0.0, -drawn->mps},
                                   .behaviour = BEHAVIOUR_DRIVEN});
    for (int n = 0; n < CHANGES && steps_rows(f).row[row].state == ENTITY_ACTIVE; n++) {
        struct entities e = steps_rows(f);
        e.row[row].throttle = drawn->throttle[n];
        e.row[row].steer = drawn->steer[n];
        e.row[row].climb = drawn->hand[n];
        e.row[row].brake = drawn->brake[n];
        fixture_run(f, hz / 5);
    }
    kind->centre_height_m = height;
    kind->resistance_j = resistance;
    struct entities e = steps_rows(f);
    return (struct ending){e.row[row].state == ENTITY_WRECK, e.row[row].x, e.row[row].z};
}

static void test_10_and_60_hz_agree_on_what_turns_over(void **state)
{
    uint64_t random = fixture_seed(14);
    int over = 0, differ = 0, apart = 0;
    (void)state;
    fixture_open(&fast, WORKS);
    fixture_open(&slow, "world = { hz = 10; };" WORKS);
    for (int n = 0; n < MANOEUVRES; n++) {
        struct manoeuvre drawn = draw(&random);
        struct ending a = drive(&fast, 60, &drawn), b = drive(&slow, 10, &drawn);
        over += a.over;
        apart += !a.over && (a.x != b.x || a.z != b.z);
        if (a.over != b.over)
            printf("%d: %s at %.1f m/s: %s at 60 Hz, %s at 10 Hz\n", n, drawn.kind, drawn.mps,
                   a.over ? "over" : "upright", b.over ? "over" : "upright");
        differ += a.over != b.over;
    }
    printf("%d of %d turn over; %d differ; %d of the others end at other places\n", over,
           MANOEUVRES, differ, apart);
    fixture_close(&fast);
    fixture_close(&slow);
    assert_int_equal(differ, 0);
    assert_int_equal(apart, 0);
    assert_true(over > MANOEUVRES / 10 && over < MANOEUVRES * 9 / 10);
}

/* --- scripts -----------------------------------------------------------------------------------*/

#define LANES    60
#define LANE_M   200.0
#define LANE_S   16
#define PER_LANE 6 /* works */

static struct scenario_text text;

static double lane_east(int lane)
{
    return 20000.0 + LANE_M * (lane % 10);
}

static double lane_south(int lane)
{
    return 20000.0 + LANE_M * (double)(lane / 10);
}

/* Ramps, tables, trenches and washboards, many on top of one another, north of where the vehicle of
 * the lane begins. */
static void add_works(uint64_t *random, int lane)
{
    static const char *const shapes[] = {"ramp", "table", "trench", "washboard"};
    for (int n = 0; n < PER_LANE; n++) {
        int shape = (int)(fixture_random(random) % 4);
        double size = fixture_uniform(random, 0.2, 2.0),
               edge = size * fixture_uniform(random, 0.3, 1.0);
        scenario_text_add(
            &text,
            "{ shape = \"%s\"; at = [%.2f, %.2f]; heading_deg = %.1f; length_m = %.2f; width_m = "
            "%.2f; ",
            shapes[shape], lane_east(lane) + fixture_uniform(random, -12.0, 12.0),
            lane_south(lane) - 40.0 + fixture_uniform(random, -20.0, 20.0),
            fixture_uniform(random, 0.0, 360.0), fixture_uniform(random, 3.0, 18.0) + 2.2 * edge,
            fixture_uniform(random, 3.0, 14.0) + 2.2 * edge);
        if (shape == 3)
            scenario_text_add(&text, "height_m = %.2f; wave_m = %.2f; },\n", 0.2 * size,
                              fixture_uniform(random, 1.5, 8.0));
        else
            scenario_text_add(&text, "%s = %.3f; edge_m = %.3f; },\n",
                              shape == 2 ? "depth_m" : "height_m", size, edge);
    }
}

static void add_script(uint64_t *random, int lane)
{
    scenario_text_add(
        &text, "{ name = \"s%d\"; steps = ( { at_s = 0.4; throttle = 1.0; for_s = 4.0; }", lane);
    for (double at_s = 4.4; at_s < LANE_S;) {
        double for_s = 0.2 * (double)(2 + fixture_random(random) % 12);
        scenario_text_add(
            &text, ", { at_s = %.1f; throttle = %.1f; steer = %.1f; climb = %d.0; for_s = %.1f; }",
            at_s, fixture_random(random) % 3 ? 1.0 : fixture_uniform(random, -1.0, 1.0),
            fixture_random(random) % 2 ? 0.0 : fixture_uniform(random, -1.0, 1.0),
            fixture_random(random) % 6 ? 0 : 1, for_s);
        at_s += for_s + 0.2 * (double)(fixture_random(random) % 3); /* it stands, or slides on */
    }
    scenario_text_add(&text, " ); },\n");
}

/* Returns lanes of works, each with a vehicle on a script. */
static const char *lanes(uint64_t seed, uint32_t hz)
{
    static const char *const kinds[] = {"tank",      "carrier",       "jeep", "truck",
                                        "hamburger", "attack-tomato", "flak", "howitzer"};
    uint64_t random = seed;
    text.used = 0;
    scenario_text_add(&text, "world = { hz = %u; capacity = 64; };\nearthworks = (\n", hz);
    for (int lane = 0; lane < LANES; lane++)
        add_works(&random, lane);
    text.used -= 2; /* the last comma */
    scenario_text_add(&text, " );\nscripts = (\n");
    for (int lane = 0; lane < LANES; lane++)
        add_script(&random, lane);
    text.used -= 2;
    scenario_text_add(&text, " );\nvehicles = (\n");
    for (int lane = 0; lane < LANES; lane++)
        scenario_text_add(
            &text, "{ kind = \"%s\"; script = \"s%d\"; at = [%.1f, %.1f]; heading_deg = 0; },\n",
            kinds[lane % 8], lane, lane_east(lane), lane_south(lane));
    text.used -= 2;
    scenario_text_add(&text, " );\n");
    return text.at;
}

static bool same(const struct entities *a, const struct entities *b, uint32_t i)
{
    return a->row[i].x == b->row[i].x && a->row[i].y == b->row[i].y && a->row[i].z == b->row[i].z &&
           a->row[i].vx == b->row[i].vx && a->row[i].vy == b->row[i].vy &&
           a->row[i].vz == b->row[i].vz && a->row[i].heading == b->row[i].heading &&
           a->row[i].pitch == b->row[i].pitch && a->row[i].roll == b->row[i].roll &&
           a->row[i].harm_j == b->row[i].harm_j && a->row[i].state == b->row[i].state;
}

/* Returns true if the row is a body on its springs, or stands and waits for its script. One that
 * has been calm goes back to the ground. */
static bool is_exact(const struct entities *e, uint32_t i, uint32_t tick, uint32_t hz)
{
    bool calm = tick - e->row[i].jolt_tick >= (uint32_t)((CHASSIS_CALM_S - 0.1) * hz);
    return ((e->row[i].flags & ENTITY_FLAG_CHASSIS) && !calm) ||
           e->row[i].behaviour == BEHAVIOUR_SCRIPT;
}

/* A script drives a vehicle over works to the same bit, and so does its agent that backs off from
 * what it has run into. That holds until something happens within a tenth of a second which acts
 * from the next frame on, because its engine breaks or it becomes a wreck, or until the agent
 * drives it without springs. */
static void test_scripts_drive_alike_to_the_bit(void **state)
{
    uint64_t seed = fixture_seed(14);
    uint32_t compared = 0, over = 0, broken = 0, backed_off = 0, differ = 0;
    bool done[LANES] = {false};
    (void)state;
    fixture_open(&fast, lanes(seed, 60));
    fixture_open(&slow, lanes(seed, 10));
    for (uint32_t tenth = 1; tenth <= 10 * LANE_S; tenth++) {
        fixture_run(&fast, 6);
        fixture_run(&slow, 1);
        struct entities a = steps_rows(&fast), b = steps_rows(&slow);
        for (uint32_t i = 0; i < LANES; i++) {
            const struct kind *kind = &fast.view.world.kinds[a.row[i].kind];
            bool wreck = a.row[i].state == ENTITY_WRECK || b.row[i].state == ENTITY_WRECK;
            bool breaks = disabled_drive(kind, &a, i) || disabled_drive(kind, &b, i);
            if (done[i])
                continue;
            if (a.row[i].state != b.row[i].state)
                fail_msg("lane %u, a %s, at %.1f s: %s at 60 Hz, %s at 10 Hz", i, kind->name,
                         0.1 * tenth, a.row[i].state == ENTITY_WRECK ? "a wreck" : "upright",
                         b.row[i].state == ENTITY_WRECK ? "a wreck" : "upright");
            over += wreck;
            broken += breaks && !wreck;
            backed_off += a.row[i].behaviour == BEHAVIOUR_BACK_OFF;
            done[i] =
                wreck || breaks || !is_exact(&a, i, 6 * tenth, 60) || !is_exact(&b, i, tenth, 10);
            if (!done[i] && !same(&a, &b, i))
                fail_msg("lane %u, a %s, at %.1f s: %.3g m apart", i, kind->name, 0.1 * tenth,
                         hypot(a.row[i].x - b.row[i].x, a.row[i].z - b.row[i].z));
            compared += !done[i];
        }
    }
    printf("%u rows compared, %u of them back off; %u turn over, %u break down\n", compared,
           backed_off, over, broken);
    assert_true(compared > 10u * LANES * LANE_S / 2u);
    assert_true(backed_off > 100u);
    struct entities a = steps_rows(&fast), b = steps_rows(&slow);
    for (uint32_t i = 0; i < LANES; i++)
        differ += a.row[i].state != b.row[i].state;
    assert_int_equal(differ, 0);
    assert_true(over > 0);
    fixture_close(&fast);
    fixture_close(&slow);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_10_and_60_hz_agree_on_what_turns_over),
        cmocka_unit_test(test_scripts_drive_alike_to_the_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
