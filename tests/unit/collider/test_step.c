/* The collider's step as a whole: pure, repeatable, nothing missed, everything in order of time. */
#include "tests/support/steps.h"
#include "world/checksum.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/terrain/fallen.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* --- thesis Table 2, three at once -------------------------------------------------------------*/

static void test_row_24_table_2_metres_a_frame_at_10_hz(void **state)
{
    /* 60, 50 and 1,000 km/h; the thesis cuts the second decimal off and drops the third. */
    static const struct {
        const char *kind;
        double kmh, metres;
    } table[] = {{"tank", 60.0, 1.66}, {"ship", 50.0, 1.38}, {"jet", 1000.0, 27.7}};
    struct fixture f;
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 10.0; };");
    steps_cover(&f, COVER_LAKE, 22000.0, 24000.0, 24000.0, 26000.0); /* for the ship */
    for (int n = 0; n < 3; n++)
        fixture_put(&f, (struct fixture_entity){.kind = table[n].kind,
                                                .at = {20000.0 + 3000.0 * n, 600.0, 25000.0},
                                                .velocity = {0.0, 0.0, table[n].kmh / 3.6}});
    fixture_run(&f, 1);
    for (uint32_t n = 0; n < 3; n++) {
        double moved = steps_rows(&f).row[n].z - 25000.0;
        double unit = n == 2 ? 0.1 : 0.01;
        assert_true(fabs(floor(moved / unit) * unit - table[n].metres) < 1e-9);
        assert_true(fabs(moved - table[n].kmh / 36.0) < 1e-9);
    }
    fixture_close(&f);
}

static void test_row_36_three_at_once_are_all_found_in_order_of_time(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 10.0; };");
    steps_kind(&f, "helicopter")->resistance_j = 1e12;
    /* 0 runs into 1; 2 and 3 come into the heap from north and south, later. */
    const struct vec3 at[4] = {
        {25000, 900, 25000}, {25014, 900, 25000}, {25002, 900, 24983}, {25014, 900, 25021}};
    const struct vec3 v[4] = {{100, 0, 0}, {0, 0, 0}, {0, 0, 100}, {0, 0, -140}};
    for (int n = 0; n < 4; n++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "helicopter", .at = at[n], .velocity = v[n]});
    fixture_run(&f, 1);
    static const uint32_t pairs[3][2] = {{1, 2}, {1, 3}, {2, 4}};
    double before = 0.0;
    /* They continue with their new velocities, and may collide again. */
    assert_true(fixture_event_count(&f, EVENT_COLLISION) >= 3);
    for (uint32_t n = 0; n < 3; n++) {
        const struct event *event = fixture_event(&f, EVENT_COLLISION, n);
        assert_int_equal(event->collision.a.id, pairs[n][0]);
        assert_int_equal(event->collision.b.id, pairs[n][1]);
        assert_int_equal(event->index, n);
        assert_true(event->collision.toi > before);
        before = event->collision.toi;
    }
    struct entities e = steps_rows(&f);
    for (uint32_t a = 0; a < 4; a++) {
        for (uint32_t b = a + 1; b < 4; b++)
            assert_true(vec3_length(vec3_sub(entities_position(&e, a), entities_position(&e, b))) >=
                        12.0 - 1e-9);
    }
    fixture_close(&f);
}

/* --- nothing missed ----------------------------------------------------------------------------*/

/* Returns true if a collision is reported for a tank that passes a tree at this speed, `beside` its
 * centre, when the contact is at this share of a frame. */
static bool grazes(const char *response, double speed_mps, double beside, double share)
{
    char text[200];
    struct fixture f;
    snprintf(text, sizeof text,
             "collision = { shape = \"sphere\"; response = \"%s\"; };\n"
             "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; } );\n",
             response);
    fixture_open(&f, text);
    double reach = 3.0 + (double)1.8f, before = sqrt(reach * reach - beside * beside);
    fixture_put(&f,
                (struct fixture_entity){.kind = "tank",
                                        .at = {25000.0 - before - (2.0 + share) * speed_mps / 60.0,
                                               100.0, 25000.0 - beside},
                                        .velocity = {speed_mps, 0.0, 0.0}});
    fixture_run(&f, 30);
    bool told = fixture_event_count(&f, EVENT_COLLISION) > 0;
    fixture_close(&f);
    return told;
}

static void test_row_23_a_graze_is_told_of_whenever_in_the_frame_it_falls(void **state)
{
    static const char *const responses[] = {"impulse", "figure8", "none"};
    (void)state;
    for (int n = 0; n < 3; n++) {
        for (double share = 0.01; share < 1.0; share += 0.07)
            assert_true(grazes(responses[n], 10.0, 4.796, share));
    }
}

static void test_slow_first_touches_are_told_of(void **state)
{
    (void)state;
    for (double share = 0.01; share < 1.0; share += 0.07)
        assert_true(grazes("figure8", 0.4, 0.0, share));
}

/* Pushing with the engine never gets a vehicle through, however gently it begins. */
static void test_no_body_is_pushed_through_another(void **state)
{
    static const char *const responses[] = {"impulse", "figure8"};
    (void)state;
    for (int n = 0; n < 2; n++) {
        char text[100];
        struct fixture f;
        snprintf(text, sizeof text, "collision = { shape = \"sphere\"; response = \"%s\"; };\n",
                 responses[n]);
        fixture_open(&f, text);
        steps_kind(&f, "tank")->resistance_j = 1e12;
        uint32_t wreck = fixture_put(
            &f, (struct fixture_entity){.kind = "ship", .at = {25023.5, 100.0, 25000.0}});
        uint32_t tank = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                                .at = {25000.0, 100.0, 25000.0},
                                                                .heading_rad = HALF_PI});
        steps_rows(&f).row[wreck].state = ENTITY_WRECK;
        steps_drive(&f, tank, 0.5, 0.0, 0.0);
        for (int frame = 0; frame < 1200; frame++) {
            fixture_run(&f, 1);
            struct entities e = steps_rows(&f);
            assert_true(e.row[wreck].x - e.row[tank].x > 23.0 - 0.01);
        }
        assert_in_range(fixture_event_count(&f, EVENT_COLLISION), 1, 5);
        fixture_close(&f);
    }
}

static void test_what_is_pushed_moves_as_fast_as_it_says(void **state)
{
    struct fixture f;
    double said = 0.0;
    (void)state;
    fixture_open(&f, "");
    steps_kind(&f, "tank")->resistance_j = 1e12;
    uint32_t wreck =
        fixture_put(&f, (struct fixture_entity){.kind = "jeep", .at = {25005.0, 100.0, 25000.0}});
    uint32_t tank = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                            .at = {25000.0, 100.0, 25000.0},
                                                            .heading_rad = HALF_PI});
    steps_rows(&f).row[wreck].state = ENTITY_WRECK;
    steps_drive(&f, tank, 0.3, 0.0, 0.0);
    for (int frame = 0; frame < 600; frame++) {
        fixture_run(&f, 1);
        said += steps_rows(&f).row[wreck].vx / 60.0;
    }
    double moved = steps_rows(&f).row[wreck].x - 25005.0;
    assert_true(fabs(moved - said) < 0.2 * said + 0.1);
    fixture_close(&f);
}

static void test_a_wreck_is_still_in_the_way(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    uint32_t wreck =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25020.0, 100.0, 25000.0}});
    fixture_put(&f, (struct fixture_entity){
                        .kind = "jeep", .at = {25000.0, 100.0, 25000.0}, .velocity = {20, 0, 0}});
    steps_rows(&f).row[wreck].state = ENTITY_WRECK;
    fixture_run(&f, 60);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    assert_true(steps_rows(&f).row[1].x < 25020.0);
    fixture_close(&f);
}

/* --- aircraft and the ground -------------------------------------------------------------------*/

static void test_an_aircraft_that_flies_into_the_ground_is_destroyed(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    fixture_put(&f, (struct fixture_entity){
                        .kind = "jet", .at = {25000, 120, 25000}, .velocity = {200, -60, 0}});
    fixture_run(&f, 60);
    const struct event *event = fixture_event(&f, EVENT_COLLISION, 0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 2); /* its wreck breaks up */
    assert_int_equal(event->collision.a.id, 1);
    assert_int_equal(event->collision.b.id, 0);
    assert_int_equal(event->collision.response, RESPONSE_DESTROYED);
    double half_m = 0.5 * steps_kind(&f, "jet")->height_m; /* the corners of its box touch */
    assert_true(fabs(event->collision.point[1] - 100.0 - half_m) < 1e-6);
    assert_true(fabs((double)event->collision.closing_mps - 60.0) < 1e-4);
    assert_int_equal(steps_rows(&f).row[0].state, ENTITY_WRECK);
    assert_true(steps_rows(&f).row[0].y >= 100.0 - 1e-9);
    fixture_close(&f);
}

/* Returns the kinetic and potential energy of row 0 per mass, without its rotation [J/kg]. */
static double energy_jpkg(const struct fixture *f)
{
    struct entities e = steps_rows(f);
    struct vec3 velocity = entities_velocity(&e, 0);
    return 0.5 * vec3_dot(velocity, velocity) + GRAVITY_MPS2 * e.row[0].y;
}

/* It stays where it touches the ground, and does not have the speed of the rest of the frame. */
static void test_an_aircraft_that_crashes_gains_no_energy(void **state)
{
    (void)state;
    for (double height_m = 120.0; height_m < 120.4; height_m += 0.05) {
        struct fixture f;
        double before = 0.0;
        fixture_open(&f, "");
        fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                .behaviour = BEHAVIOUR_PATROL,
                                                .at = {25000, height_m, 25000},
                                                .velocity = {0, -20, 0}});
        steps_rows(&f).row[0].roll = 3.0;
        while (steps_rows(&f).row[0].state == ENTITY_ACTIVE) {
            before = energy_jpkg(&f);
            fixture_run(&f, 1);
        }
        assert_true(energy_jpkg(&f) < before);
        fixture_close(&f);
    }
}

static double step_up(double x, double z, const void *context)
{
    (void)z, (void)context;
    return x > 25124.0 ? 180.0 : 100.0;
}

/* The slope that it struck, not the level ground where it would have come to lie. */
static void test_a_crash_has_the_normal_of_the_ground_where_it_is(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 10.0; };");
    steps_ground(&f, step_up, NULL); /* a slope from x = 25000 to 25125, level on both sides */
    fixture_put(&f, (struct fixture_entity){
                        .kind = "jet", .at = {24990, 120, 25010}, .velocity = {2500, -1, 0}});
    fixture_run(&f, 1);
    const struct event *event = fixture_event(&f, EVENT_COLLISION, 0);
    assert_non_null(event);
    assert_true(event->collision.point[0] > 25000.0 && event->collision.point[0] < 25125.0);
    assert_true(event->collision.normal[0] > 0.3f); /* into the slope, which faces west */
    fixture_close(&f);
}

static void test_an_aircraft_slowed_on_its_path_still_meets_the_ground(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 10.0; };\n"
                     "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; } );\n");
    steps_kind(&f, "tree")->resistance_j = 10.0; /* it gives way at once */
    steps_kind(&f, "jet")->resistance_j = 1e12;
    fixture_put(&f, (struct fixture_entity){
                        .kind = "jet", .at = {24990, 110, 25000}, .velocity = {180, -180, 0}});
    fixture_run(&f, 1);
    assert_int_equal(fallen_damage(fixture_state(&f).fixed_damage[0]), DAMAGE_HIGH);
    assert_true(steps_rows(&f).row[0].y >= 100.0 - 1e-6); /* not under the ground */
    fixture_close(&f);
}

/* --- response none -----------------------------------------------------------------------------*/

static void test_response_none_tells_and_changes_nothing(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "collision = { shape = \"sphere\"; response = \"none\"; };\n"
                     "objects = ( { kind = \"building\"; at = [25030.0, 25000.0]; } );\n");
    fixture_put(&f, (struct fixture_entity){
                        .kind = "tank", .at = {25000, 100, 25000}, .velocity = {16, 0, 0}});
    fixture_put(&f, (struct fixture_entity){
                        .kind = "jeep", .at = {25010, 100, 25000}, .velocity = {-16, 0, 0}});
    fixture_run(&f, 240);
    struct entities e = steps_rows(&f);
    assert_true(fabs(e.row[0].x - 25064.0) < 1e-8 && fabs(e.row[1].x - 24946.0) < 1e-8);
    assert_true(e.row[0].vx == 16.0 && e.row[1].vx == -16.0 && e.row[0].harm_j == 0.0 &&
                e.row[1].harm_j == 0.0);
    assert_int_equal(fixture_state(&f).fixed_damage[0], DAMAGE_NONE);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) >= 2);
    assert_int_equal(fixture_event(&f, EVENT_COLLISION, 0)->collision.response, RESPONSE_NONE);
    fixture_close(&f);
}

/* --- purity ------------------------------------------------------------------------------------*/

static const char battle[] =
    "world = { seed = 9; hz = 20.0; capacity = 1024; };\n"
    "collision = { shape = \"sphere\"; response = \"%s\"; };\n"
    "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; },\n"
    "            { kind = \"building\"; at = [24900.0, 25000.0]; },\n"
    "            { kind = \"tree\"; at = [25100.0, 25050.0]; } );\n"
    "vehicles = ( { kind = \"jeep\"; count = 16; behaviour = \"hold\"; speed_mps = 12.0;"
    " area = [24900.0, 24900.0, 25100.0, 25100.0]; },\n"
    "  { kind = \"tank\"; count = 120; force = \"blue\"; fire_at_will = true;\n"
    "    area = [24800.0, 24800.0, 25200.0, 25200.0]; },\n"
    "  { kind = \"tank\"; count = 120; force = \"red\"; fire_at_will = true;\n"
    "    area = [24800.0, 24800.0, 25200.0, 25200.0]; },\n"
    "  { kind = \"jeep\"; count = 150; area = [24850.0, 24850.0, 25150.0, 25150.0]; },\n"
    "  { kind = \"helicopter\"; count = 12; force = \"blue\"; fire_at_will = true;\n"
    "    area = [24000.0, 24000.0, 26000.0, 26000.0]; } );\n"
    "fires = ( { at_s = 0.1; munition = \"artillery\"; point = [25000.0, 25010.0]; } );\n";

static void collide_again(struct fixture *f)
{
    struct view *view = &f->view;
    const struct event_ring ring = {view->events, view->header->event_slots};
    uint64_t commit = atomic_load(&view->commit->commit);
    collider_step(&f->stepper.collider, &view->w[commit & 1], &view->m, &view->w[(commit + 1) & 1],
                  &ring);
}

/* A contact that every frame must have, whatever its buffer held. */
static void put_contact(struct fixture *f)
{
    struct state now = fixture_state(f);
    now.contacts[0] =
        (struct persistent_contact){1, 2, 0, 1, 0, 0, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    now.head->contact_count = 1;
    state_seal(&now, f->view.world.counts.fixed);
}

/* What a collider that died in mid-frame left: half a buffer, half a frame's events and craters. */
static void soil(struct fixture *f)
{
    struct view *view = &f->view;
    uint64_t commit = atomic_load(&view->commit->commit), end;
    struct state *now = &view->w[commit & 1], *next = &view->w[(commit + 1) & 1];
    memset(next->head, 0x5a, sizeof *next->head);
    memset(next->fixed_damage, 0x5a, view->world.counts.fixed);
    memset(next->contacts, 0x5a, view->header->contact_slots * sizeof *next->contacts);
    memset(next->entities.row, 0x5a, next->entities.capacity * sizeof *next->entities.row);
    end = now->head->event_end;
    for (uint32_t i = 0; i < view->world.params->events_per_frame; i++)
        memset(&view->events[(end + i) & (view->header->event_slots - 1)], 0x5a,
               sizeof(struct event));
    memset(&now->craters[now->head->crater_count], 0x5a, 4 * sizeof(struct crater));
}

static void run_and_repeat(const char *response)
{
    char text[sizeof battle + 16];
    struct fixture f;
    snprintf(text, sizeof text, battle, response);
    fixture_open(&f, text);
    put_contact(&f);
    for (int frame = 0; frame < 150; frame++) {
        const struct state *now = &f.view.w[frame & 1], *next = &f.view.w[(frame + 1) & 1];
        steps_move(&f);
        uint64_t before = steps_state_hash(&f, now), moved = steps_moved_hash(&f);
        soil(&f);
        collide_again(&f);
        uint64_t first = steps_state_hash(&f, next);
        collide_again(&f); /* over its own result */
        assert_true(steps_state_hash(&f, next) == first);
        soil(&f);
        if (frame % 50 == 20)
            fixture_threads(&f, frame % 3 ? 2 : 1); /* a collider that knows nothing yet */
        collide_again(&f);
        assert_true(steps_state_hash(&f, next) == first);
        assert_true(steps_moved_hash(&f) == moved); /* its inputs are only read */
        assert_true(steps_state_hash(&f, now) == before);
        fixture_run(&f, 1);
        assert_true(steps_state_hash(&f, next) == first);
    }
    assert_true(fixture_event_count(&f, EVENT_DETONATION) > 10);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 10);
    fixture_close(&f);
}

static void test_colliding_again_over_anything_gives_the_same_bytes_with_impulses(void **state)
{
    (void)state;
    run_and_repeat("impulse");
}

static void test_colliding_again_over_anything_gives_the_same_bytes_with_figure_8(void **state)
{
    (void)state;
    run_and_repeat("figure8");
}

static void test_the_checksum_is_that_of_the_state(void **state)
{
    struct fixture f;
    char text[sizeof battle + 16];
    (void)state;
    snprintf(text, sizeof text, battle, "impulse");
    fixture_open(&f, text);
    fixture_run(&f, 30);
    struct state now = fixture_state(&f);
    assert_true(now.head->checksum == state_checksum(&now, f.view.world.counts.fixed));
    now.entities.row[17].x += 1e-9;
    assert_true(now.head->checksum != state_checksum(&now, f.view.world.counts.fixed));
    fixture_close(&f);
}

/* --- counts ------------------------------------------------------------------------------------*/

static void test_the_head_counts_who_is_there(void **state)
{
    struct fixture f;
    char text[sizeof battle + 16];
    (void)state;
    snprintf(text, sizeof text, battle, "figure8");
    fixture_open(&f, text);
    for (int frame = 0; frame < 100; frame++) {
        fixture_run(&f, 1);
        struct state now = fixture_state(&f);
        uint32_t vehicles = 0, munitions = 0;
        for (uint32_t i = 0; i < now.head->used; i++) {
            bool round = now.entities.row[i].behaviour == BEHAVIOUR_FLIGHT;
            vehicles += now.entities.row[i].state != ENTITY_FREE && !round;
            munitions += now.entities.row[i].state != ENTITY_FREE && round;
        }
        assert_int_equal(now.head->vehicles, vehicles);
        assert_int_equal(now.head->munitions, munitions);
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_24_table_2_metres_a_frame_at_10_hz),
        cmocka_unit_test(test_row_36_three_at_once_are_all_found_in_order_of_time),
        cmocka_unit_test(test_row_23_a_graze_is_told_of_whenever_in_the_frame_it_falls),
        cmocka_unit_test(test_slow_first_touches_are_told_of),
        cmocka_unit_test(test_no_body_is_pushed_through_another),
        cmocka_unit_test(test_what_is_pushed_moves_as_fast_as_it_says),
        cmocka_unit_test(test_a_wreck_is_still_in_the_way),
        cmocka_unit_test(test_an_aircraft_that_flies_into_the_ground_is_destroyed),
        cmocka_unit_test(test_an_aircraft_that_crashes_gains_no_energy),
        cmocka_unit_test(test_a_crash_has_the_normal_of_the_ground_where_it_is),
        cmocka_unit_test(test_an_aircraft_slowed_on_its_path_still_meets_the_ground),
        cmocka_unit_test(test_response_none_tells_and_changes_nothing),
        cmocka_unit_test(test_colliding_again_over_anything_gives_the_same_bytes_with_impulses),
        cmocka_unit_test(test_colliding_again_over_anything_gives_the_same_bytes_with_figure_8),
        cmocka_unit_test(test_the_checksum_is_that_of_the_state),
        cmocka_unit_test(test_the_head_counts_who_is_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
