/* Where a scenario's vehicles start in formation, whom they follow, and where their base is. */
#include "world/entity/formation.h"
#include "world/enum_names.h"
#include "world/making/vehicle_placement.h"
#include "world/making/world_build.h"

#include "tests/support/fixture.h"
#include "world/params.h"
#include "world/vehicle_shell.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f;

static void check_near(double value, double wanted)
{
    if (!(fabs(value - wanted) < 1e-6))
        fail_msg("%.9f is not %.9f", value, wanted);
}

static void test_every_shape_has_a_place_of_its_own_for_each(void **state)
{
    (void)state;
    for (int shape = 0; shape < FORMATION_SHAPE_COUNT; shape++) {
        double ahead[40], right[40];
        for (uint32_t i = 0; i < 40; i++) {
            formation_place((enum formation_shape)shape, 30.0, i, &ahead[i], &right[i]);
            assert_true(ahead[i] <= 0.0);
            for (uint32_t j = 0; j < i; j++) {
                double dx = ahead[i] - ahead[j], dz = right[i] - right[j];
                if (!(dx * dx + dz * dz > 30.0 * 30.0 - 1e-6))
                    fail_msg("%s: %u and %u are too near", formation_shape_name(shape), i, j);
            }
        }
        check_near(ahead[0], 0.0);
        check_near(right[0], 0.0);
    }
}

/* A leader that heads east: ahead is +x, right is +z. */
static void test_members_start_in_their_places(void **state)
{
    static const struct {
        const char *shape;
        double x[4], z[4]; /* off the leader */
    } rows[] = {
        {"column", {0, -50, -100, -150}, {0, 0, 0, 0}},
        {"line", {0, 0, 0, 0}, {0, 50, -50, 100}},
        {"wedge", {0, -35.355339, -35.355339, -70.710678}, {0, 35.355339, -35.355339, 70.710678}},
        {"echelon-left",
         {0, -35.355339, -70.710678, -106.066017},
         {0, -35.355339, -70.710678, -106.066017}},
        {"echelon-right",
         {0, -35.355339, -70.710678, -106.066017},
         {0, 35.355339, 70.710678, 106.066017}},
    };
    (void)state;
    for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
        char text[256];
        snprintf(text, sizeof text,
                 "vehicles = ( { kind = \"tank\"; count = 4; name = \"T\"; formation = \"%s\"; "
                 "at = [25000.0, 24000.0]; heading_deg = 90.0; behaviour = \"patrol\"; "
                 "area = [1.0, 2.0, 3.0, 4.0]; } );",
                 rows[r].shape);
        fixture_open(&f, text);
        struct state now = fixture_state(&f);
        const struct entities *e = &now.entities;
        assert_int_equal(f.view.world.counts.formations, 1);
        const struct formation *formation = &f.view.world.formations[0];
        assert_string_equal(formation_shape_name(formation->shape), rows[r].shape);
        assert_int_equal(formation->first, 0);
        assert_int_equal(formation->count, 4);
        assert_int_equal(formation->order, BEHAVIOUR_PATROL);
        assert_int_equal(formation->order_arg, 1);
        check_near(formation->spacing_m, 50.0);
        for (uint32_t i = 0; i < 4; i++) {
            check_near(e->row[i].x - 25000.0, rows[r].x[i]);
            check_near(e->row[i].z - 24000.0, rows[r].z[i]);
            check_near(e->row[i].heading, HALF_PI);
            assert_int_equal(e->row[i].order, i == 0 ? BEHAVIOUR_PATROL : BEHAVIOUR_FOLLOW);
            assert_int_equal(e->row[i].behaviour, e->row[i].order);
            assert_int_equal(e->row[i].order_arg, i == 0 ? 1 : 0);
        }
        fixture_close(&f);
    }
}

/* The entries behind continue the formation; the next that does not follow ends it. */
static void test_who_follows_stands_behind(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"jeep\"; },\n"
                     "{ kind = \"tank\"; count = 2; formation = \"column\"; spacing_m = 20.0; "
                     "at = [25000.0, 24000.0]; heading_deg = 0.0; engage = \"hold\"; },\n"
                     "{ kind = \"truck\"; count = 3; behaviour = \"follow\"; stand = true; },\n"
                     "{ kind = \"jeep\"; formation = \"wedge\"; at = [20000.0, 20000.0]; } );");
    struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    assert_int_equal(f.view.world.counts.formations, 2);
    assert_int_equal(f.view.world.formations[0].first, 1);
    assert_int_equal(f.view.world.formations[0].count, 5);
    assert_int_equal(f.view.world.formations[1].first, 6);
    assert_int_equal(f.view.world.formations[1].count, 1);
    for (uint32_t i = 0; i < 5; i++) {
        check_near(e->row[1 + i].x, 25000.0);
        check_near(e->row[1 + i].z, 24000.0 + 20.0 * i);
        assert_int_equal(e->row[1 + i].flags, i < 2 ? ENTITY_FLAG_HOLD_FIRE : ENTITY_FLAG_STAND);
    }
    assert_int_equal(e->row[1].order, BEHAVIOUR_IDLE);
    assert_int_equal(e->row[5].order, BEHAVIOUR_FOLLOW);
    assert_int_equal(e->row[5].order_arg, 0);
    assert_int_equal(e->row[6].order, BEHAVIOUR_IDLE);
    fixture_close(&f);
}

/* A watertower stands where the second of a column would: it starts beside its place. */
static void test_a_taken_place_gives_one_near_it(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"watertower\"; at = [25000.0, 24050.0]; } );\n"
                     "vehicles = ( { kind = \"tank\"; count = 3; formation = \"column\"; "
                     "at = [25000.0, 24000.0]; heading_deg = 0.0; } );");
    struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    double dx = e->row[1].x - 25000.0, dz = e->row[1].z - 24050.0, off = sqrt(dx * dx + dz * dz);
    assert_true(off > 3.0 && off < 60.0);
    check_near(e->row[2].z, 24100.0);
    fixture_close(&f);
}

static void test_a_base_is_amid_its_force(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; force = \"blue\"; at = [1000.0, 2000.0]; }, "
                     "{ kind = \"tank\"; force = \"blue\"; at = [3000.0, 2600.0]; }, "
                     "{ kind = \"jet\"; force = \"blue\"; at = [1850.0, 2500.0]; }, "
                     "{ kind = \"truck\"; force = \"blue\"; at = [2150.0, 2100.0]; }, "
                     "{ kind = \"jet\"; force = \"red\"; at = [7000.0, 8000.0]; }, "
                     "{ kind = \"jet\"; force = \"red\"; at = [9000.0, 8000.0]; } );");
    const struct params *params = f.view.world.params;
    check_near(params->base[FORCE_BLUE].x, 2150.0); /* the truck's: aircraft need no road */
    check_near(params->base[FORCE_BLUE].z, 2100.0);
    check_near(params->base[FORCE_RED].x, 8000.0);
    check_near(params->base[FORCE_RED].z, 8000.0);
    check_near(params->base[FORCE_NEUTRAL].x, 25000.0);
    check_near(params->base[FORCE_NEUTRAL].z, 25000.0);
    fixture_close(&f);
}

/* At frame 0 they have the pose that later frames give them; the generated ground is uneven. */
static void test_vehicles_stand_on_slopes(void **state)
{
    double steepest = 0.0;
    (void)state;
    fixture_open(&f, "terrain = { source = \"generated\"; };"
                     "vehicles = ( { kind = \"tank\"; count = 20; behaviour = \"idle\"; } );");
    struct state now = fixture_state(&f);
    for (uint32_t i = 0; i < 20; i++)
        steepest =
            maths_max(steepest, fabs(now.entities.row[i].pitch) + fabs(now.entities.row[i].roll));
    assert_true(steepest > 0.05);
    struct entity before[20];
    memcpy(before, now.entities.row, sizeof before);
    fixture_run(&f, 2);
    now = fixture_state(&f);
    for (uint32_t i = 0; i < 20; i++) {
        check_near(now.entities.row[i].pitch, before[i].pitch);
        check_near(now.entities.row[i].roll, before[i].roll);
        check_near(now.entities.row[i].y, before[i].y);
    }
    fixture_close(&f);
}

/* Returns how deep the shell of a row is in the ground [m]. */
static double shell_depth_of(const struct entities *e, uint32_t row)
{
    const struct mat3 turn =
        rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
    return vehicle_shell_depth(&f.view.world.terrain, NULL, &f.view.world.kinds[e->row[row].kind],
                               VEHICLE_SHELL_POINTS, entities_position(e, row), &turn);
}

/* A scenario may put a vehicle on the edge of a bank, on it, or beside it. On an edge it leans as
 * the ground does and is on its springs, with its shell just out of the edge, and else it stands on
 * the ground. */
static void test_edges_of_works_bear_no_vehicle_as_a_plane_does(void **state)
{
    (void)state;
    fixture_open(&f, "earthworks = ( { shape = \"table\"; at = [25000.0, 25000.0]; width_m = 30.0;"
                     " length_m = 30.0; height_m = 1.5; edge_m = 0.3; } );"
                     "vehicles = ( { name = \"edge\"; kind = \"tank\"; at = [25000.0, 25015.0];"
                     " heading_deg = 0.0; behaviour = \"idle\"; },"
                     " { name = \"top\"; kind = \"tank\"; at = [25000.0, 25000.0];"
                     " heading_deg = 0.0; behaviour = \"idle\"; },"
                     " { name = \"beside\"; kind = \"tank\"; at = [25030.0, 25000.0];"
                     " heading_deg = 0.0; behaviour = \"idle\"; } );");
    const struct entities e = fixture_state(&f).entities;
    assert_true(e.row[0].flags & ENTITY_FLAG_CHASSIS);
    assert_true(e.row[0].pitch > 0.1 && fabs(e.row[0].roll) < 1e-9);
    assert_true(e.row[0].y > 100.0 && e.row[0].y < 101.0);
    assert_true(shell_depth_of(&e, 0) < 1e-9);
    const double y[] = {101.5, 100.0};
    for (uint32_t i = 1; i < 3; i++) {
        check_near(e.row[i].y, y[i - 1]);
        check_near(e.row[i].pitch, 0.0);
        assert_false(e.row[i].flags & ENTITY_FLAG_CHASSIS);
    }
    fixture_close(&f);
}

/* A wall that is thinner than the distance of the heights under a vehicle, beside its wheels. */
static void test_no_thin_wall_stands_in_a_vehicle(void **state)
{
    (void)state;
    fixture_open(&f, "earthworks = ( { shape = \"table\"; at = [25000.0, 25000.0]; width_m = 30.0;"
                     " length_m = 1.0; height_m = 2.0; edge_m = 0.45; } );"
                     "vehicles = ( { kind = \"tank\"; at = [25000.0, 25002.3];"
                     " heading_deg = 0.0; behaviour = \"idle\"; } );");
    const struct entities e = fixture_state(&f).entities;
    double deep = shell_depth_of(&e, 0);
    assert_true(e.row[0].flags & ENTITY_FLAG_CHASSIS && deep < 1e-9 && deep > -0.5);
    fixture_close(&f);
}

/* Of 60 aircraft some are before slopes that a jet cannot climb. */
static void test_jets_begin_over_what_is_ahead(void **state)
{
    static const struct {
        const char *kind, *behaviour;
        bool raised;
    } rows[] = {{"jet", "patrol", true}, {"jet", "hold", false}, {"helicopter", "patrol", false}};
    (void)state;
    for (int n = 0; n < 3; n++) {
        char text[500];
        uint32_t raised = 0;
        snprintf(text, sizeof text,
                 "world = { seed = 2; capacity = 64; };"
                 "terrain = { source = \"file\"; file = \"%s/grounds/white-mountains.ground\"; };"
                 "vehicles = ( { kind = \"%s\"; count = 60; altitude_m = 80.0; behaviour = \"%s\";"
                 " area = [17000.0, 17000.0, 33000.0, 33000.0]; } );",
                 fixture_shipped_dir(), rows[n].kind, rows[n].behaviour);
        fixture_open(&f, text);
        const struct entities e = fixture_state(&f).entities;
        for (uint32_t i = 0; i < 60; i++) {
            double over =
                e.row[i].y - terrain_base_height(&f.view.world.terrain, e.row[i].x, e.row[i].z);
            assert_true(over > 79.9);
            raised += over > 80.1;
        }
        assert_int_equal(f.built->raised, raised);
        assert_true(rows[n].raised ? raised > 0 && raised < 30 : raised == 0);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_shape_has_a_place_of_its_own_for_each),
        cmocka_unit_test(test_members_start_in_their_places),
        cmocka_unit_test(test_who_follows_stands_behind),
        cmocka_unit_test(test_a_taken_place_gives_one_near_it),
        cmocka_unit_test(test_a_base_is_amid_its_force),
        cmocka_unit_test(test_vehicles_stand_on_slopes),
        cmocka_unit_test(test_edges_of_works_bear_no_vehicle_as_a_plane_does),
        cmocka_unit_test(test_jets_begin_over_what_is_ahead),
        cmocka_unit_test(test_no_thin_wall_stands_in_a_vehicle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
