/* What receivers compute from the motions that they were told is near what is, in worlds with
 * vehicles that cruise, drive, fight and end. SEED=n chooses another world. */
#include "ipc/frame/motion_table.h"
#include "tests/support/fixture.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define FRAMES 900u
#define EVERY  6u  /* frames between two batches */
#define GROUND 0.5 /* [m] so far is the ground off a straight line within a stretch */

#define GROUP(kind, n, force, more)                                                                \
    "{ kind = \"" kind "\"; count = " #n "; force = \"" force "\"; behaviour = \"patrol\"; "       \
    "area = [24000.0, 24000.0, 26000.0, 26000.0]; " more " },"

static const char text[] =
    "world = { seed = %llu; capacity = 512; cruise = %s; }; terrain = { source = \"generated\"; };"
    "objects = { source = \"none\"; }; vehicles = (" GROUP("tank", 30, "blue", "")
        GROUP("tank", 30, "red", "") GROUP("truck", 40, "neutral", "") GROUP("jeep", 40, "red", "")
            GROUP("helicopter", 20, "blue", "") "{ kind = \"truck\"; count = 40; behaviour = "
                                                "\"idle\"; area = [24000.0, 24000.0, 26000.0, "
                                                "26000.0]; } );";

static struct fixture f;
static struct motion_table table;
static struct snapshot snapshot;

static int free_all(void **state)
{
    (void)state;
    motion_table_free(&table);
    snapshot_free(&snapshot);
    fixture_close(&f);
    return 0;
}

static void open_all(const char *cruise)
{
    char scenario[4096];
    (void)snprintf(scenario, sizeof scenario, text, (unsigned long long)fixture_seed(1), cruise);
    fixture_open(&f, scenario);
    assert_int_equal(motion_table_init(&table, f.view.header->capacity), 0);
    assert_int_equal(snapshot_init(&snapshot, &f.view), 0);
}

/* Compares each row with what receivers have of it. Returns the rows that are in use. */
static uint32_t check_rows(void)
{
    const struct entities *e = &snapshot.entities;
    const struct world *world = &f.view.world;
    uint32_t rows = 0;
    for (uint32_t i = 0; i < snapshot.head.used; i++) {
        const struct motion_told *told = &table.told[i];
        assert_int_equal(told->marks.state, e->row[i].state);
        if (e->row[i].state == ENTITY_FREE)
            continue;
        double after_s = (double)(snapshot.head.tick - told->tick) * world_dt_s(world);
        struct told_motion now = told_motion_at(&told->motion, after_s);
        struct vec3 off = vec3_sub(now.at, entities_position(e, i));
        double rise_m = fabs(off.y);
        off.y = 0.0;
        assert_int_equal(told->id, e->row[i].id);
        assert_int_equal(told->marks.damage, e->row[i].damage);
        assert_true(vec3_length(off) <= MOTION_TABLE_OFF_M + 1e-3); /* floats, and chords */
        assert_true(rise_m <= MOTION_TABLE_OFF_M + GROUND);
        assert_true(fabs(maths_wrap_half(now.heading_rad - e->row[i].heading)) <=
                    MOTION_TABLE_OFF_RAD + 1e-5);
        rows++;
    }
    return rows;
}

/* Returns how many times fewer rows are told than there are. */
static double share_told(void)
{
    double told = 0.0, rows = 0.0;
    for (uint32_t frame = 0; frame < FRAMES; frame += EVERY) {
        fixture_continue(&f, EVERY);
        assert_int_equal(snapshot_take(&snapshot, &f.view), 0);
        motion_table_update(&table, &f.view.world, &snapshot);
        snapshot_settle_poses(&snapshot, &f.view);
        rows += check_rows();
        told += table.count;
    }
    print_message("told %.3f of %.0f rows, %u events\n", told / rows, rows / (FRAMES / EVERY),
                  fixture_event_count(&f, EVENT_NONE));
    return told / rows;
}

static void test_receivers_are_near_when_vehicles_cruise(void **state)
{
    (void)state;
    open_all("true");
    assert_true(share_told() < 0.5);
}

static void test_receivers_are_near_when_each_row_is_moved(void **state)
{
    (void)state;
    open_all("false");
    assert_true(share_told() < 0.7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_receivers_are_near_when_vehicles_cruise, free_all),
        cmocka_unit_test_teardown(test_receivers_are_near_when_each_row_is_moved, free_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
