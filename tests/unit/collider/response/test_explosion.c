/* Detonations: what a round strikes, blast around it, craters, chains (thesis row 31). */
#include "collider/response/explosion.h"
#include "tests/support/steps.h"
#include "world/params.h"
#include "world/terrain/fallen.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define REACH_M 8.0 /* of one kilogram's blast */

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 256; };\n"
                     "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; },\n"
                     "            { kind = \"tree\"; at = [30000.0, 30000.0]; } );\n");
    return 0;
}

static uint32_t put(const char *kind, double x, double y, double z, struct vec3 velocity)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {x, y, z}, .velocity = velocity});
}

static const struct event_detonation *detonation(uint32_t n)
{
    const struct event *event = fixture_event(&f, EVENT_DETONATION, n);
    assert_non_null(event);
    return &event->detonation;
}

/* --- row 31 ------------------------------------------------------------------------------------*/

static void test_row_31_artillery_on_ground_leaves_a_crater(void **state)
{
    uint32_t round = put("artillery", 26000.0, 110.0, 26000.0, (struct vec3){60.0, -300.0, 0.0});
    double radius = 1.1 * cbrt(steps_kind(&f, "artillery")->explosive_kg);
    (void)state;
    fixture_run(&f, 3);
    assert_int_equal(detonation(0)->struck, STRUCK_GROUND);
    assert_true(fabs(detonation(0)->point[1] - FIXTURE_GROUND_M) < 1e-6);
    const struct event *event = fixture_event(&f, EVENT_CRATER, 0);
    assert_non_null(event);
    assert_true(event->crater.point[0] == detonation(0)->point[0]);
    assert_true(fabs((double)event->crater.radius_m - radius) < 1e-5);
    struct state now = fixture_state(&f);
    assert_int_equal(now.head->crater_count, 1);
    assert_true(now.craters[0].x == event->crater.point[0]);
    assert_int_equal(now.craters[0].frame, event->frame);
    assert_int_equal(now.entities.row[round].state, ENTITY_FREE);
    assert_int_equal(now.head->munitions, 0);
    /* The next frame drives through it. */
    fixture_run(&f, 1);
    assert_true(steps_ground_at(&f, now.craters[0].x, now.craters[0].z) < 99.5);
}

static void test_row_31_artillery_on_a_tank_destroys_it_and_leaves_no_crater(void **state)
{
    uint32_t tank = put("tank", 26000.0, 100.0, 26000.0, (struct vec3){0.0, 0.0, 0.0});
    (void)state;
    put("artillery", 26000.0, 120.0, 26000.0, (struct vec3){0.0, -500.0, 0.0});
    fixture_run(&f, 4);
    assert_int_equal(detonation(0)->struck, STRUCK_VEHICLE);
    assert_int_equal(detonation(0)->struck_party.id, tank + 1);
    assert_int_equal(detonation(0)->struck_party.damage, DAMAGE_DESTROYED);
    assert_int_equal(steps_rows(&f).row[tank].state, ENTITY_WRECK);
    assert_int_equal(fixture_event_count(&f, EVENT_CRATER), 0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0); /* munitions only explode */
    assert_int_equal(fixture_state(&f).head->crater_count, 0);
    assert_int_equal(fixture_state(&f).head->tally.destroyed, 1);
}

static void test_row_31_water_keeps_no_crater(void **state)
{
    (void)state;
    steps_cover(&f, COVER_LAKE, 25500.0, 25500.0, 26500.0, 26500.0);
    put("bomb", 26000.0, 120.0, 26000.0, (struct vec3){0.0, -200.0, 0.0});
    fixture_run(&f, 10);
    assert_int_equal(detonation(0)->struck, STRUCK_WATER);
    assert_int_equal(fixture_event_count(&f, EVENT_CRATER), 0);
}

static void test_row_31_only_rounds_that_dig_leave_craters(void **state)
{
    (void)state;
    put("shell", 26000.0, 120.0, 26000.0, (struct vec3){0.0, -1500.0, 0.0});
    fixture_run(&f, 2);
    assert_int_equal(detonation(0)->struck, STRUCK_GROUND);
    assert_int_equal(fixture_event_count(&f, EVENT_CRATER), 0);
}

static void test_row_31_rounds_that_meet_explode_both(void **state)
{
    (void)state;
    put("missile", 26000.0, 500.0, 26000.0, (struct vec3){300.0, 0.0, 0.0});
    put("missile", 26008.0, 500.0, 26000.0, (struct vec3){-300.0, 0.0, 0.0});
    fixture_run(&f, 2);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 2);
    assert_int_equal(detonation(0)->struck, STRUCK_AIR);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
}

static void test_a_round_into_a_tree_fells_it_and_then_others_pass(void **state)
{
    (void)state;
    put("shell", 24980.0, 100.5, 25000.0, (struct vec3){1500.0, 0.0, 0.0});
    fixture_run(&f, 1);
    assert_int_equal(detonation(0)->struck, STRUCK_FIXED);
    assert_int_equal(detonation(0)->struck_party.id, 1);
    assert_int_equal(detonation(0)->struck_party.fixed, 1);
    assert_int_equal(fallen_damage(fixture_state(&f).fixed_damage[0]), DAMAGE_HIGH);
    assert_true(fallen_heading(fixture_state(&f).fixed_damage[0]) ==
                HALF_PI); /* as the round flew */
    uint32_t jeep = put("jeep", 24990.0, 100.0, 25000.0, (struct vec3){20.0, 0.0, 0.0});
    fixture_run(&f, 60);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    assert_true(fabs(steps_rows(&f).row[jeep].x - 25010.0) < 1e-6);
}

static void test_a_charge_of_nothing_digs_nothing(void **state)
{
    (void)state;
    steps_kind(&f, "bullet")->craters = 1; /* config/ allows it */
    put("bullet", 26000.0, 102.0, 26000.0, (struct vec3){0.0, -300.0, 0.0});
    fixture_run(&f, 2);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 1);
    for (int n = 0; n < 9; n++)
        assert_true(isfinite(steps_ground_at(&f, 26000.0, 25999.0 + 0.25 * n)));
}

static void test_a_full_list_of_craters_is_counted(void **state)
{
    (void)state;
    steps_params(&f)->crater_slots = 2;
    for (int n = 0; n < 5; n++)
        put("artillery", 26000.0 + 300.0 * n, 104.0, 26000.0, (struct vec3){0.0, -300.0, 0.0});
    fixture_run(&f, 2);
    struct state now = fixture_state(&f);
    assert_int_equal(now.head->crater_count, 2);
    assert_int_equal(now.head->tally.craters_refused, 3);
    assert_int_equal(fixture_event_count(&f, EVENT_CRATER), 2);
}

/* --- blast -------------------------------------------------------------------------------------*/

/* A bomb bursts at (26000, 26000); harm of jeeps at these distances from it. */
static void burst(const double *distance, uint32_t count, uint32_t *first)
{
    struct kind *jeep = steps_kind(&f, "jeep");
    uint32_t bomb;
    jeep->resistance_j = 1e12;
    jeep->mass_kg = 1e9; /* it stays where it is */
    *first = fixture_state(&f).head->used;
    for (uint32_t n = 0; n < count; n++) { /* all around, so that squares' borders matter */
        double angle = 2.399963 * n, way = distance[n] + jeep->radius_m;
        put("jeep", 26000.0 + way * cos(angle), 100.0, 26000.0 + way * sin(angle),
            (struct vec3){0.0, 0.0, 0.0});
    }
    bomb = put("bomb", 26000.0, 100.0 + 1e-9, 26000.0, (struct vec3){0.0, 0.0, 0.0});
    steps_rows(&f).row[bomb].until_tick = 0;            /* now, by its time fuse */
    steps_kind(&f, "bomb")->guidance = GUIDANCE_HOMING; /* it does not fall */
    fixture_run(&f, 1);
    assert_int_equal(detonation(0)->struck, STRUCK_AIR);
}

static void test_an_explosion_damages_all_bodies_within_its_radius_only(void **state)
{
    double radius = REACH_M * cbrt(steps_kind(&f, "bomb")->explosive_kg), distance[60];
    uint32_t first;
    (void)state;
    for (uint32_t n = 0; n < 60; n++)
        distance[n] = n % 2 ? radius * (1.0 + 0.002 * (n + 1))
                            : radius * (1.0 - 0.003 * (n + 1) * sqrt(n + 1.0));
    burst(distance, 60, &first);
    for (uint32_t n = 0; n < 60; n++)
        assert_int_equal(steps_rows(&f).row[first + n].harm_j > 0.0, n % 2 == 0);
}

static void test_blast_falls_off_with_distance(void **state)
{
    double distance[30], before = 1e300;
    uint32_t first;
    (void)state;
    for (uint32_t n = 0; n < 30; n++)
        distance[n] = 0.5 + 1.2 * n;
    burst(distance, 30, &first);
    for (uint32_t n = 0; n < 30; n++) {
        assert_true(steps_rows(&f).row[first + n].harm_j < before || before == 0.0);
        before = steps_rows(&f).row[first + n].harm_j;
    }
    assert_true(steps_rows(&f).row[first].harm_j > 0.0);
}

static void test_a_burst_is_felt_at_three_times_its_radius(void **state)
{
    double radius = REACH_M * cbrt(steps_kind(&f, "bomb")->explosive_kg);
    double distance[] = {0.5 * radius, 2.0 * radius, 2.9 * radius, 3.1 * radius, 5.0 * radius};
    uint32_t first;
    (void)state;
    burst(distance, 5, &first);
    for (uint32_t n = 0; n < 5; n++) /* jeeps on a held course feel nothing */
        assert_int_equal(steps_rows(&f).row[first + n].flags & ENTITY_FLAG_BURST, 0);
    steps_empty(&f);
    for (uint32_t n = 0; n < 5; n++) {
        uint32_t row = put("jeep", 26000.0 + distance[n], 100.0, 26000.0, (struct vec3){0});
        steps_rows(&f).row[row].behaviour = BEHAVIOUR_IDLE;
    }
    uint32_t bomb = put("bomb", 26000.0, 100.0 + 1e-9, 26000.0, (struct vec3){0});
    steps_rows(&f).row[bomb].until_tick = 0;
    fixture_run(&f, 1);
    for (uint32_t n = 0; n < 5; n++)
        assert_int_equal(steps_rows(&f).row[n].flags & ENTITY_FLAG_BURST,
                         n < 3 ? ENTITY_FLAG_BURST : 0);
}

static void test_a_body_in_several_squares_is_harmed_once(void **state)
{
    static const double corners[4][2] = {
        {26000, 26000}, {26060, 26060}, {26000, 26060}, {26060, 26000}};
    double first = 0.0;
    (void)state;
    steps_kind(&f, "ship")->resistance_j = 1e12;
    steps_kind(&f, "bomb")->guidance = GUIDANCE_HOMING; /* it does not fall */
    /* 25 m from the ship's side, from every side; the ship lies on a corner of four squares, on
     * borders, or within one square, and harm is the same. */
    for (int n = 0; n < 16; n++) {
        double x = corners[n / 4][0], z = corners[n / 4][1], way = n % 2 ? 45.0 : -45.0;
        steps_empty(&f);
        uint32_t ship = put("ship", x, 100.0, z, (struct vec3){0.0, 0.0, 0.0});
        uint32_t bomb = put("bomb", x + (n % 4 < 2 ? way : 0.0), 100.0 + 1e-9,
                            z + (n % 4 < 2 ? 0.0 : way), (struct vec3){0.0, 0.0, 0.0});
        steps_rows(&f).row[bomb].until_tick = 0;
        fixture_run(&f, 1);
        if (n == 0)
            first = steps_rows(&f).row[ship].harm_j;
        assert_true(first > 0.0 && fabs(steps_rows(&f).row[ship].harm_j - first) < 1e-3);
    }
}

static void test_blast_alarms_the_enemy_and_spares_no_friend(void **state)
{
    uint32_t shooter = put("tank", 20000.0, 100.0, 26000.0, (struct vec3){0.0, 0.0, 0.0});
    uint32_t enemy = put("jeep", 26000.0, 100.0, 26000.0, (struct vec3){0.0, 0.0, 0.0});
    uint32_t friend = put("jeep", 26020.0, 100.0, 26000.0, (struct vec3){0.0, 0.0, 0.0});
    (void)state;
    steps_kind(&f, "jeep")->resistance_j = 1e12;
    uint32_t bomb = put("bomb", 26010.0, 100.0 + 1e-9, 26000.0, (struct vec3){0.0, 0.0, 0.0});
    struct entities e = steps_rows(&f);
    e.row[shooter].force = e.row[friend].force = FORCE_BLUE;
    e.row[enemy].force = FORCE_RED;
    e.row[bomb].owner_slot = shooter;
    e.row[bomb].owner_id = e.row[shooter].id;
    e.row[bomb].until_tick = 0;
    steps_kind(&f, "bomb")->guidance = GUIDANCE_HOMING;
    fixture_run(&f, 1);
    e = steps_rows(&f);
    assert_true(e.row[enemy].harm_j > 0.0 && e.row[friend].harm_j > 0.0);
    assert_int_equal(e.row[enemy].threat_id, e.row[shooter].id);
    assert_int_equal(e.row[friend].threat_id, 0); /* a stray round of one's own is no attack */
}

/* --- push --------------------------------------------------------------------------------------*/

/* A charge like artillery's explodes at the end of the next frame; no ground and nothing else is
 * struck. */
static void burst_at(double x, double y, double z)
{
    steps_kind(&f, "artillery")->guidance = GUIDANCE_HOMING; /* it does not fall */
    uint32_t round = put("artillery", x, y, z, (struct vec3){0.0, 0.0, 0.0});
    steps_rows(&f).row[round].until_tick = 0;
    fixture_run(&f, 1);
    assert_int_equal(fixture_state(&f).head->tally.detonations, 1);
}

static uint32_t put_east(const char *kind, double x, double y, double z)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {x, y, z}, .heading_rad = HALF_PI});
}

static void test_a_blast_throws_light_bodies_and_nudges_heavy_ones(void **state)
{
    static const char *const kinds[] = {"jeep", "truck", "tank"};
    double before = 1e9;
    (void)state;
    for (size_t n = 0; n < 3; n++) {
        steps_empty(&f);
        steps_kind(&f, kinds[n])->resistance_j = 1e12;
        uint32_t row = put_east(kinds[n], 26006.0, 100.0, 26000.0); /* it turns its rear to it */
        burst_at(26000.0, 100.5, 26000.0);
        struct entities e = steps_rows(&f);
        assert_true(e.row[row].vx > 0.0 && e.row[row].vx < before);
        assert_true(fabs(e.row[row].vz) < 1e-9 * e.row[row].vx && e.row[row].vy == 0.0);
        assert_true(fabs(e.row[row].spin_x) + fabs(e.row[row].spin_y) + fabs(e.row[row].spin_z) <
                    1e-9);
        before = e.row[row].vx;
    }
    assert_true(before < 0.2); /* the tank */
}

static void test_a_blast_throws_further_from_near_by(void **state)
{
    double before = 1e9;
    (void)state;
    steps_kind(&f, "jeep")->resistance_j = 1e12;
    for (double distance = 4.0; distance < 15.0; distance += 1.0) {
        steps_empty(&f);
        uint32_t row = put_east("jeep", 26000.0 + distance, 100.0, 26000.0);
        burst_at(26000.0, 100.5, 26000.0);
        assert_true(steps_rows(&f).row[row].vx > 0.0 && steps_rows(&f).row[row].vx < before);
        before = steps_rows(&f).row[row].vx;
    }
}

static void test_an_aircraft_takes_all_of_a_blast(void **state)
{
    (void)state;
    steps_kind(&f, "helicopter")->resistance_j = 1e12;
    for (int n = 0; n < 2; n++) {
        steps_empty(&f);
        uint32_t row = put_east("helicopter", 26000.0, 900.0, 26000.0);
        uint32_t far = put_east("helicopter", 26000.0, 900.0, 20000.0);
        burst_at(26000.0 + 6.0 * n, 895.0, 26000.0); /* below it; below its nose */
        struct entities e = steps_rows(&f);
        assert_true(e.row[row].vy > e.row[far].vy + 0.1);
        assert_true(n == 0 ? fabs(e.row[row].vx) < 1e-6 : e.row[row].vx < 0.0);
        assert_true(n == 0 ? fabs(e.row[row].spin_z) < 1e-9
                           : e.row[row].spin_z > 1e-4); /* nose up */
    }
}

static void test_a_blast_beside_the_front_turns_it_away(void **state)
{
    (void)state;
    steps_kind(&f, "truck")->resistance_j = 1e12;
    uint32_t row = put_east("truck", 26000.0, 100.0, 26000.0);
    burst_at(26003.0, 100.5, 26008.0); /* to the south of its front, which turns north: left */
    struct entities e = steps_rows(&f);
    assert_true(e.row[row].vz < 0.0 && e.row[row].spin_y > 0.0);
    assert_true(e.row[row].spin_x == 0.0 && e.row[row].spin_z == 0.0);
}

static void test_what_a_blast_pushes_collides(void **state)
{
    (void)state;
    steps_kind(&f, "jeep")->resistance_j = 1e12;
    uint32_t jeep = put_east("jeep", 26005.0, 100.0, 26000.0);
    uint32_t other = put_east("jeep", 26005.0 + 3.3, 100.0, 26000.0); /* 10 cm ahead */
    burst_at(26000.0, 100.5, 26000.0);
    assert_true(steps_rows(&f).row[jeep].vx > steps_rows(&f).row[other].vx + 0.3);
    fixture_run(&f, 30);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 0);
    assert_true(steps_rows(&f).row[other].x - steps_rows(&f).row[jeep].x > 3.2 - 1e-3);
}

static void test_a_pushed_body_is_swept_in_the_same_frame(void **state)
{
    (void)state;
    steps_kind(&f, "jeep")->resistance_j = steps_kind(&f, "tank")->resistance_j = 1e12;
    uint32_t jeep = put_east("jeep", 26004.0, 100.0, 26000.0);
    uint32_t tank = put_east("tank", 26004.0 + 4.6 + 0.01, 100.0, 26000.0); /* 1 cm ahead */
    put("artillery", 26000.0, 101.0, 26000.0, (struct vec3){0.0, -300.0, 0.0});
    fixture_run(&f, 1);
    assert_int_equal(detonation(0)->struck, STRUCK_GROUND);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    assert_true(steps_rows(&f).row[tank].x - steps_rows(&f).row[jeep].x > 4.6 - 1e-6);
}

static void test_an_overturned_jeep_is_a_wreck(void **state)
{
    (void)state;
    steps_kind(&f, "jeep")->resistance_j = 1e12; /* the energy alone does not destroy it */
    steps_kind(&f, "tank")->resistance_j = 1e12;
    uint32_t beside =
        fixture_put(&f, (struct fixture_entity){.kind = "jeep", .at = {26003.0, 100.0, 26000.0}});
    uint32_t behind = put_east("jeep", 25992.0, 100.0, 26000.0);
    uint32_t tank = put("tank", 26000.0, 100.0, 26005.0, (struct vec3){0.0, 0.0, 0.0});
    burst_at(26000.0, 100.5, 26000.0);
    assert_int_equal(steps_rows(&f).row[beside].state, ENTITY_WRECK); /* it shows its side */
    assert_int_equal(steps_rows(&f).row[beside].damage, DAMAGE_DESTROYED);
    assert_int_equal(steps_rows(&f).row[behind].state, ENTITY_ACTIVE); /* too far */
    assert_int_equal(steps_rows(&f).row[tank].state, ENTITY_ACTIVE);
    assert_true(steps_rows(&f).row[beside].vx > 1.0);
    assert_int_equal(fixture_state(&f).head->tally.destroyed, 1);
}

static void test_no_blast_pushes_under_figure_8(void **state)
{
    static const enum response_model models[] = {MODEL_FIGURE8, MODEL_MPS, MODEL_NONE};
    (void)state;
    steps_kind(&f, "jeep")->resistance_j = 1e12;
    for (size_t n = 0; n < 3; n++) {
        steps_empty(&f);
        steps_params(&f)->collision.response = models[n];
        uint32_t row = put_east("jeep", 26004.0, 100.0, 26000.0);
        burst_at(26000.0, 100.5, 26000.0);
        assert_true(steps_rows(&f).row[row].vx == 0.0 && steps_rows(&f).row[row].harm_j > 0.0);
    }
}

/* Thesis p. 8, "direct and indirect hits by ordnance". */
static void test_an_indirect_hit_hurts_by_distance(void **state)
{
    static const double distances[] = {3.0, 5.0, 8.0, 12.0, 30.0};
    double before = 1e300;
    (void)state;
    for (size_t n = 0; n < 5; n++) {
        steps_empty(&f);
        uint32_t tank = put("tank", 26000.0, 100.0, 26000.0, (struct vec3){0.0, 0.0, 0.0});
        put("artillery", 26000.0 + 3.0 + distances[n], 104.0, 26000.0,
            (struct vec3){0.0, -300.0, 0.0});
        fixture_run(&f, 2);
        assert_int_equal(fixture_state(&f).head->tally.detonations, 1);
        double harm = steps_rows(&f).row[tank].harm_j;
        assert_true(n == 4 ? harm == 0.0 : harm > 0.0 && harm < before);
        before = harm;
    }
}

/* --- chains ------------------------------------------------------------------------------------*/

static void test_a_chain_of_explosions_runs_to_its_end(void **state)
{
    uint32_t row[12];
    (void)state;
    steps_kind(&f, "tank")->explosive_kg = 200.0;
    steps_kind(&f, "tank")->resistance_j = 1e5;
    for (uint32_t n = 0; n < 12; n++) /* each within the next one's blast alone */
        row[n] = put("tank", 26000.0 + 35.0 * n, 100.0, 26000.0, (struct vec3){0.0, 0.0, 0.0});
    put("artillery", 26000.0, 110.0, 26000.0, (struct vec3){0.0, -500.0, 0.0});
    fixture_run(&f, 1);
    for (uint32_t n = 0; n < 12; n++)
        assert_int_equal(steps_rows(&f).row[row[n]].state, ENTITY_WRECK);
    assert_int_equal(fixture_state(&f).head->tally.destroyed, 12);
}

static void test_the_shooter_is_not_hit_by_its_own_round_at_the_muzzle(void **state)
{
    static const double headings[] = {0.0, 0.7, HALF_PI, 2.5, PI, 4.0, 5.5};
    (void)state;
    for (size_t n = 0; n < sizeof headings / sizeof headings[0]; n++) {
        steps_empty(&f);
        double sine = maths_sin(headings[n]), cosine = maths_cos(headings[n]);
        /* A jet faster than the missile that it lets go. */
        uint32_t jet =
            put("jet", 25000.0, 900.0, 20000.0, (struct vec3){277.0 * sine, 0.0, -277.0 * cosine});
        uint32_t tank =
            put("tank", 26000.0, 100.0, 26000.0, (struct vec3){16.0 * sine, 0.0, -16.0 * cosine});
        steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_FIRE, .entity = jet + 1});
        steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_FIRE, .entity = tank + 1});
        fixture_run(&f, 60);
        assert_int_equal(fixture_state(&f).head->tally.fires, 2);
        assert_true(steps_rows(&f).row[jet].harm_j == 0.0 &&
                    steps_rows(&f).row[tank].harm_j == 0.0);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    }
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_row_31_artillery_on_ground_leaves_a_crater),
        TEST(test_row_31_artillery_on_a_tank_destroys_it_and_leaves_no_crater),
        TEST(test_row_31_water_keeps_no_crater),
        TEST(test_row_31_only_rounds_that_dig_leave_craters),
        TEST(test_row_31_rounds_that_meet_explode_both),
        TEST(test_a_round_into_a_tree_fells_it_and_then_others_pass),
        TEST(test_a_charge_of_nothing_digs_nothing),
        TEST(test_a_full_list_of_craters_is_counted),
        TEST(test_an_explosion_damages_all_bodies_within_its_radius_only),
        TEST(test_a_burst_is_felt_at_three_times_its_radius),
        TEST(test_blast_falls_off_with_distance),
        TEST(test_a_body_in_several_squares_is_harmed_once),
        TEST(test_blast_alarms_the_enemy_and_spares_no_friend),
        TEST(test_a_blast_throws_light_bodies_and_nudges_heavy_ones),
        TEST(test_a_blast_throws_further_from_near_by),
        TEST(test_an_aircraft_takes_all_of_a_blast),
        TEST(test_a_blast_beside_the_front_turns_it_away),
        TEST(test_what_a_blast_pushes_collides),
        TEST(test_a_pushed_body_is_swept_in_the_same_frame),
        TEST(test_an_overturned_jeep_is_a_wreck),
        TEST(test_no_blast_pushes_under_figure_8),
        TEST(test_an_indirect_hit_hurts_by_distance),
        TEST(test_a_chain_of_explosions_runs_to_its_end),
        TEST(test_the_shooter_is_not_hit_by_its_own_round_at_the_muzzle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
