/* Every crash point of every role: a process dies there and is started again. The run must reach
 * the digests and the event log of an undisturbed run, and leave nothing behind. Of the stores
 * within the steps and of the pages of a new world only a part is tried, chosen by SEED;
 * JOLON_CRASH_ALL=1 tries all of them. */
#include "tests/crash/command_writer.h"
#include "tests/crash/point_counts.h"
#include "tests/crash/runs.h"
#include "tests/support/fixture.h"
#include "tests/support/named_world.h"

#include "ipc/process/clock.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define FRAMES       3  /* of free_plan */
#define TRIES        20 /* for a point that a run may not reach */
#define FAILURES_MAX 10
#define STORE_STRIDE 19
#define PAGE_STRIDE  29

/* Within three frames: two shots, a collision with a tree, one of two tanks, detonations of both
 * rounds, and a crater. */
#define BATTLE                                                                                     \
    "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 125.0; };"                       \
    "collision = { shape = \"sphere\"; };"                                                         \
    "vehicles = ( { name = \"A\"; kind = \"tank\"; force = \"blue\"; behaviour = \"hold\";"        \
    " at = [25000.0, 25000.0]; heading_deg = 90.0; speed_mps = 15.0; },"                           \
    " { name = \"B\"; kind = \"tank\"; force = \"red\"; behaviour = \"hold\";"                     \
    " at = [25030.0, 25000.0]; heading_deg = 270.0; speed_mps = 15.0; },"                          \
    " { name = \"C\"; kind = \"jeep\"; force = \"red\"; behaviour = \"hold\";"                     \
    " at = [25060.0, 25000.0]; heading_deg = 90.0; speed_mps = 20.0; } );"                         \
    "objects = ( { kind = \"tree\"; at = [25075.0, 25000.0]; } );"
#define SHOTS                                                                                      \
    "fires = ( { munition = \"artillery\"; point = [25012.0, 25006.0]; },"                         \
    " { shooter = \"B\"; target = \"C\"; } );"
#define BARRAGE                                                                                    \
    "fires = ( { munition = \"artillery\"; point = [25012.0, 25006.0]; },"                         \
    " { at_s = 0.6; munition = \"artillery\"; point = [25112.0, 25006.0]; },"                      \
    " { at_s = 1.2; munition = \"artillery\"; point = [25212.0, 25006.0]; },"                      \
    " { at_s = 1.8; munition = \"artillery\"; point = [25312.0, 25006.0]; } );"

static const char free_text[] =
    "world = { seed = 1; hz = 1.8; capacity = 64; frames = 3; pace = \"max\"; };" BATTLE SHOTS;
static const char commanded_text[] =
    "world = { seed = 1; hz = 1000.0; capacity = 64; pace = \"real\"; };" BATTLE;
static const char late_text[] =
    "world = { seed = 1; hz = 1.8; capacity = 64; frames = 6; pace = \"max\"; };" BATTLE BARRAGE;

static struct plan free_plan;      /* runs without pauses at the highest pace */
static struct plan commanded_plan; /* runs in real time, paused and stepped by commands */
static struct plan late_plan;      /* the event ring overflows before the recorder starts */
static struct point_counts died;   /* deaths of all tests here */
static uint64_t seed, points_tried, runs;

/* --- trying points --------------------------------------------------------------------------*/

/* Returns true if it depends on timing how often a run reaches the point. Only the first few times
 * are then tried, and the first must be a death. A recorder that starts late finds everything to
 * write at once. */
static bool depends_on_timing(const struct plan *plan, const char *point)
{
    static const char *const names[] = {
        "beat",          "doorbell waited for", "doorbell silenced", "first due time",
        "next due time", "no due time",         "late frame",        "gaps"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(names[i], point) == 0)
            return true;
    }
    return !plan->late_recorder && strstr(point, "write to a log");
}

static uint64_t stride_of(const char *point)
{
    if (getenv("JOLON_CRASH_ALL"))
        return 1;
    if (strcmp(point, "store in a step") == 0)
        return STORE_STRIDE;
    return strcmp(point, "page of a new world") == 0 ? PAGE_STRIDE : 1;
}

static void print_output(void)
{
    char path[128], line[512];
    trial_path(path, sizeof path, "said");
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        print_message("#     %s", line);
    if (file)
        fclose(file);
}

/* Returns what is wrong after a death at the point, or NULL. */
static const char *try_point(run_function *run, const struct plan *plan,
                             const struct run_outcome *reference, const struct death *death)
{
    static struct run_outcome outcome;
    char path[128];
    bool clock = depends_on_timing(plan, death->point);
    for (int tries = 0; tries < (clock ? TRIES : 1); tries++) {
        trial_path(path, sizeof path, "said");
        unlink(path);
        run(&outcome, plan, death, NULL);
        runs++;
        const char *wrong = run_outcome_differs(&outcome, reference);
        if (wrong) {
            named_world_clear();
            return wrong;
        }
        if (outcome.died) {
            point_counts_find(&died, death->role, death->point)->deaths++;
            return NULL;
        }
        if (clock && death->crossing > 1)
            return NULL;
    }
    return "the process never reached the point";
}

/* Tries all points that the role reaches in an undisturbed run. Points at which it has died in
 * another kind of run are repeated only if again is true. */
static void try_points(run_function *run, const struct plan *plan, const char *role, bool again)
{
    static struct run_outcome reference;
    static struct point_counts counted;
    char path[128];
    int failures = 0;
    uint64_t before = points_tried;
    trial_path(path, sizeof path, "count");
    unlink(path);
    run(&reference, plan, NULL, "count");
    if (reference.refused[0] != '\0') {
        named_world_clear();
        fail_msg("undisturbed: %s", reference.refused);
    }
    point_counts_read(&counted, path);
    for (int i = 0; i < counted.count; i++) {
        const struct point_count *point = &counted.point[i];
        struct point_count *dead = point_counts_find(&died, point->role, point->name);
        if (strcmp(point->role, role) != 0 || (dead->deaths > 0 && !again))
            continue;
        uint64_t most = point->crossings, stride = stride_of(point->name);
        if (depends_on_timing(plan, point->name) && most > FRAMES)
            most = FRAMES;
        for (uint64_t n = 1 + seed % stride; n <= most && failures < FAILURES_MAX; n += stride) {
            const struct death death = {role, point->name, n};
            const char *wrong = try_point(run, plan, &reference, &death);
            points_tried++;
            if (!wrong)
                continue;
            failures++;
            print_message("# the %s dies at \"%s\", time %" PRIu64 ": %s\n", role, point->name, n,
                          wrong);
            print_output();
        }
    }
    assert_int_equal(failures, 0);
    assert_true(points_tried > before);
}

/* --- the roles ---------------------------------------------------------------------------------*/

static void test_mover(void **state)
{
    (void)state;
    try_points(run_roles, &free_plan, "mover", true);
    try_points(run_roles, &commanded_plan, "mover", false);
}

static void test_collider(void **state)
{
    (void)state;
    try_points(run_roles, &free_plan, "collider", true);
}

static void test_recorder(void **state)
{
    struct plan late_commands = commanded_plan;
    (void)state;
    late_commands.late_recorder = true;
    try_points(run_roles, &free_plan, "recorder", true);
    try_points(run_roles, &late_plan, "recorder", true);
    try_points(run_roles, &late_commands, "recorder", true);
}

static void test_command_writer(void **state)
{
    (void)state;
    try_points(run_roles, &commanded_plan, "commander", true);
}

/* The stand-by dies too: before it continues from that frame, or later. */
static void test_stand_bys(void **state)
{
    static const struct death firsts[] = {{"mover", "moved", 1}, {"collider", "commit", 1}};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct plan plan = free_plan;
        plan.first_death = &firsts[i];
        try_points(run_roles, &plan, firsts[i].role, true);
    }
}

static void test_creation(void **state)
{
    (void)state;
    try_points(run_created, &free_plan, "world", true);
    try_points(run_refused, &free_plan, "world", true);
}

static void test_images(void **state)
{
    (void)state;
    try_points(run_saved, &free_plan, "world", false);
    try_points(run_from, &free_plan, "world", false);
}

static void test_repair(void **state)
{
    (void)state;
    try_points(run_repaired, &free_plan, "world", false);
}

static void test_removal(void **state)
{
    (void)state;
    try_points(run_removed, &free_plan, "world", true);
}

/* Every point of every program must have killed a process, whether a run reached it or not. */
static void test_all_points(void **state)
{
    int points = 0, reached = 0;
    (void)state;
    for (int i = 0; i < died.count; i++) {
        const char *name = died.point[i].name;
        bool first = true;
        for (int k = 0; k < i; k++)
            first = first && strcmp(died.point[k].name, name) != 0;
        if (!first)
            continue;
        points++;
        if (point_counts_deaths(&died, name) > 0)
            reached++;
        else
            print_message("# no process died at \"%s\"\n", name);
    }
    print_message("# figures: %d of %d named crash points (%.0f %%); %" PRIu64
                  " places to die at, %" PRIu64 " runs\n",
                  reached, points, 100.0 * reached / points, points_tried, runs);
    assert_true(points > 0 && reached == points);
}

/* --- set-up ------------------------------------------------------------------------------------*/

static int open_all(void **state)
{
    (void)state;
    trial_open();
    setenv("JOLON_DATA", fixture_data_dir(), 1);
    runs_open(free_text);
    plan_make(&free_plan, free_text, 64);
    plan_make(&commanded_plan, commanded_text, 64);
    commanded_plan.commands = true;
    plan_make(&late_plan, late_text, 16);
    late_plan.late_recorder = true;
    seed = fixture_seed(clock_now_ns() % 1000);
    return 0;
}

static int close_all(void **state)
{
    plan_free(&free_plan);
    plan_free(&commanded_plan);
    plan_free(&late_plan);
    trial_close();
    return named_world_check_left(state);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mover),     cmocka_unit_test(test_collider),
        cmocka_unit_test(test_recorder),  cmocka_unit_test(test_command_writer),
        cmocka_unit_test(test_stand_bys), cmocka_unit_test(test_creation),
        cmocka_unit_test(test_images),    cmocka_unit_test(test_repair),
        cmocka_unit_test(test_removal),   cmocka_unit_test(test_all_points),
    };
    if (argc == 3 && strcmp(argv[1], "commander") == 0)
        return command_writer_main(argv[2]);
    return cmocka_run_group_tests(tests, open_all, close_all);
}
