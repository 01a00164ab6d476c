/* The mover's step as a whole: pure, repeatable, and on time with the scenario's shots. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const char battle[] =
    "world = { seed = 9; capacity = 512; };\n"
    "vehicles = (\n"
    "  { kind = \"tank\"; count = 60; force = \"blue\"; fire_at_will = true;\n"
    "    area = [24000.0, 24000.0, 26000.0, 26000.0]; },\n"
    "  { kind = \"tank\"; count = 60; force = \"red\"; fire_at_will = true;\n"
    "    area = [24000.0, 24000.0, 26000.0, 26000.0]; },\n"
    "  { kind = \"jet\"; count = 8; force = \"red\"; fire_at_will = true;\n"
    "    area = [22000.0, 22000.0, 28000.0, 28000.0]; },\n"
    "  { kind = \"helicopter\"; count = 8; force = \"blue\"; fire_at_will = true;\n"
    "    area = [24000.0, 24000.0, 26000.0, 26000.0]; } );\n";

/* What a process that died left in the table. */
static void soil(struct fixture *f)
{
    struct moved *m = &f->view.m;
    memset(m->head, 0x5a, sizeof *m->head);
    memset(m->intents, 0x5a, f->view.world.params->intents_per_frame * sizeof *m->intents);
    memset(m->entities.row, 0x5a, m->entities.capacity * sizeof *m->entities.row);
}

static void test_moving_again_over_anything_gives_the_same_bytes(void **state)
{
    struct fixture f;
    uint32_t shots = 0;
    (void)state;
    fixture_open(&f, battle);
    for (int frame = 0; frame < 300; frame++) {
        if (frame % 10 == 0)
            steps_send(&f, RING_CLIENTS,
                       (struct command){.type = COMMAND_SPAWN,
                                        .kind = fixture_kind(&f, "jeep"),
                                        .value = {24500.0 + frame, 25000.0}});
        steps_move(&f);
        uint64_t first = steps_moved_hash(&f);
        shots += (uint32_t)(f.view.m.head->tally.fires != fixture_state(&f).head->tally.fires);
        soil(&f);
        steps_move(&f);
        assert_true(steps_moved_hash(&f) == first);
        fixture_run(&f, 1);
    }
    assert_true(shots > 10); /* a quiet world would prove nothing */
    fixture_close(&f);
}

static void test_a_new_movers_first_step_is_the_old_ones_next(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, battle);
    struct state now = fixture_state(&f);
    now.craters[0] = (struct crater){25000.0, 25000.0, 30.0f, 5.0f, 0};
    now.head->crater_count = 1;
    fixture_run(&f, 60);
    steps_move(&f);
    uint64_t first = steps_moved_hash(&f);
    fixture_threads(&f, 2); /* a restart: its index of craters is empty */
    steps_move(&f);
    assert_true(steps_moved_hash(&f) == first);
    fixture_close(&f);
}

static void test_the_committed_world_is_only_read(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, battle);
    for (int frame = 0; frame < 60; frame++) {
        struct state now = fixture_state(&f);
        uint64_t before = steps_state_hash(&f, &now);
        steps_move(&f);
        assert_true(steps_state_hash(&f, &now) == before);
        fixture_run(&f, 1);
    }
    fixture_close(&f);
}

static void test_no_trigger_outlives_its_frame(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, battle);
    for (int frame = 0; frame < 60; frame++) {
        fixture_run(&f, 1);
        struct state now = fixture_state(&f);
        for (uint32_t i = 0; i < now.head->used; i++)
            assert_int_equal(now.entities.row[i].trigger, 0);
    }
    fixture_close(&f);
}

static void test_a_round_moves_from_the_frame_after_its_shot(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000.0, 100.0, 25000.0}});
    steps_command(&f, (struct command){.type = COMMAND_FIRE, .entity = 1});
    struct entities e = steps_rows(&f);
    struct vec3 muzzle = entities_position(&e, 1), v = entities_velocity(&e, 1);
    const struct event *event = fixture_event(&f, EVENT_FIRE, 0);
    assert_true(event->fire.point[0] == muzzle.x && event->fire.point[2] == muzzle.z);
    fixture_run(&f, 1);
    e = steps_rows(&f);
    double least = 1.0 - 0.001, z = e.row[1].z - muzzle.z; /* drag takes 0.2 % of its speed */
    assert_true(fabs(e.row[1].x - (muzzle.x + v.x / 60.0)) < 1e-3);
    assert_true(z / (v.z / 60.0) < 1.0 && z / (v.z / 60.0) > least);
    fixture_close(&f);
}

/* --- the scenario's shots ----------------------------------------------------------------------*/

static void test_scenario_fires_come_at_their_tick_in_the_files_order(void **state)
{
    static const uint64_t ticks[] = {1, 30, 30, 61};
    struct fixture f;
    (void)state;
    fixture_open(
        &f,
        "vehicles = (\n"
        "  { kind = \"tank\"; name = \"A\"; at = [25000.0, 25000.0]; behaviour = \"hold\"; },\n"
        "  { kind = \"tank\"; name = \"B\"; at = [25000.0, 26000.0]; behaviour = \"hold\"; } );\n"
        "fires = ( { at_s = 1.01; munition = \"bomb\"; point = [30000.0, 30000.0]; },\n"
        "          { at_s = 0.5; shooter = \"A\"; target = \"B\"; },\n"
        "          { at_s = 0.5; munition = \"rocket\"; point = [31000.0, 30000.0]; },\n"
        "          { at_s = 0.0; shooter = \"B\"; target = \"A\"; } );\n");
    fixture_run(&f, 90);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 4);
    for (uint32_t n = 0; n < 4; n++)
        assert_int_equal(fixture_event(&f, EVENT_FIRE, n)->tick, ticks[n]);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 0)->fire.shooter.id, 2);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 1)->fire.shooter.id, 1);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 1)->fire.target.id, 2);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 2)->fire.munition.kind,
                     fixture_kind(&f, "rocket"));
    assert_true(fixture_event(&f, EVENT_FIRE, 3)->fire.point[0] == 30000.0);
    fixture_close(&f);
}

static void test_a_paused_world_holds_its_fires_back(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "fires = ( { at_s = 0.1; munition = \"bomb\"; point = [100.0, 100.0]; } );");
    fixture_run(&f, 5);
    steps_command(&f, (struct command){.type = COMMAND_PAUSE});
    fixture_run(&f, 20);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
    steps_command(&f, (struct command){.type = COMMAND_RESUME});
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 1);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 0)->tick, 6);
    fixture_close(&f);
}

static void test_the_dead_do_not_fire(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; name = \"A\"; at = [25000.0, 25000.0]; },\n"
                     "             { kind = \"tank\"; name = \"B\"; at = [25000.0, 26000.0]; } );\n"
                     "fires = ( { at_s = 0.5; shooter = \"A\"; target = \"B\"; } );\n");
    steps_rows(&f).row[0].state = ENTITY_WRECK;
    fixture_run(&f, 60);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
    assert_int_equal(fixture_state(&f).head->fire_cursor, 1);
    fixture_close(&f);
}

/* --- pieces in which there is nothing of a sort ------------------------------------------------*/

#define SECOND_BLOCK_ROW 1500u /* a row of the second block; the third block is short */

/* In a table of unknown content the mover hashes every block. */
static void assert_sure_or_not_the_same(struct fixture *f)
{
    steps_move(f);
    uint64_t sure = steps_moved_hash(f);
    assert_true(moved_whole(&f->view.m));
    soil(f);
    steps_move(f);
    assert_true(steps_moved_hash(f) == sure);
    assert_true(moved_whole(&f->view.m));
}

static void go_on(struct fixture *f)
{
    for (int frame = 0; frame < 3; frame++) {
        assert_sure_or_not_the_same(f);
        fixture_run(f, 1);
    }
}

static void open_crowd(struct fixture *f, const char *behaviour)
{
    char text[512];
    snprintf(text, sizeof text,
             "world = { seed = 4; capacity = 4096; cruise = false; };\n"
             "vehicles = ( { kind = \"tank\"; count = 2100; behaviour = \"%s\";\n"
             "    area = [10000.0, 10000.0, 40000.0, 40000.0]; },\n"
             "  { kind = \"truck\"; route = ( [1000.0, 2000.0], [2000.0, 2000.0] ); } );\n",
             behaviour);
    fixture_open(f, text);
    fixture_run(f, 2);
    struct state now = fixture_state(f);
    for (uint32_t i = 0; i < 2048; i++) /* or else nothing is left out */
        assert_true(now.entities.row[i].spin_y == 0.0 && now.entities.row[i].target_id == 0 &&
                    now.entities.row[i].turret == 0.0f && now.entities.row[i].traverse == 0.0f);
}

/* As the collider would leave it, or a mover before. */
enum news { SPIN, TURRET, GUN, TARGET, BUMP, SHOT, EDGE, HURT, TUMBLE, NEWS_COUNT };

static void give(const struct fixture *f, enum news news)
{
    struct state now = fixture_state(f);
    struct entities *e = &now.entities;
    switch (news) {
    case SPIN:
        e->row[SECOND_BLOCK_ROW].spin_y = 0.5;
        break;
    case TUMBLE: /* about one axis, and soon about all */
        e->row[SECOND_BLOCK_ROW].kind = fixture_kind(f, "helicopter");
        e->row[SECOND_BLOCK_ROW].y = 3000.0;
        e->row[SECOND_BLOCK_ROW].pitch = 0.4;
        e->row[SECOND_BLOCK_ROW].spin_y = 1.5;
        break;
    case TURRET:
        e->row[SECOND_BLOCK_ROW].turret = 0.3f;
        break;
    case GUN:
        e->row[SECOND_BLOCK_ROW].gun = 0.1f;
        break;
    case TARGET:
        e->row[SECOND_BLOCK_ROW].target_slot = 7;
        e->row[SECOND_BLOCK_ROW].target_id = e->row[7].id;
        e->row[SECOND_BLOCK_ROW].traverse = 0.5f;
        break;
    case BUMP:
        e->row[SECOND_BLOCK_ROW].bumped = 1;
        break;
    case SHOT:
        e->row[SECOND_BLOCK_ROW].threat_slot = 7;
        e->row[SECOND_BLOCK_ROW].threat_id = e->row[7].id;
        break;
    case EDGE: /* it goes over to its route's next point at once */
        if (e->row[SECOND_BLOCK_ROW].behaviour == BEHAVIOUR_HOLD)
            break;
        e->row[SECOND_BLOCK_ROW].behaviour = e->row[SECOND_BLOCK_ROW].order = BEHAVIOUR_ROUTE;
        e->row[SECOND_BLOCK_ROW].order_arg = e->row[2100].order_arg; /* the truck's */
        e->row[SECOND_BLOCK_ROW].x = 0.0;
        e->row[SECOND_BLOCK_ROW].heading = 1.5 * PI;
        e->row[SECOND_BLOCK_ROW].throttle = 1.0f;
        break;
    default:
        e->row[SECOND_BLOCK_ROW].damage = DAMAGE_MED;
        e->row[SECOND_BLOCK_ROW].changed_tick = (uint32_t)now.head->tick;
        break;
    }
    state_seal(&now, f->view.world.counts.fixed);
}

static void test_one_row_has_values_that_its_block_lacked(void **state)
{
    static const char *const behaviours[] = {"patrol", "hold"};
    (void)state;
    for (int b = 0; b < 2; b++) {
        struct fixture f;
        open_crowd(&f, behaviours[b]);
        for (enum news news = SPIN; news < NEWS_COUNT; news++) {
            give(&f, news);
            assert_sure_or_not_the_same(&f);
            const struct entities *m = &f.view.m.entities;
            if (news == SPIN)
                assert_true(m->row[SECOND_BLOCK_ROW].spin_y < 0.5);
            if (news == TURRET)
                assert_true(m->row[SECOND_BLOCK_ROW].turret < 0.3f);
            fixture_run(&f, 1);
            go_on(&f);
        }
        fixture_close(&f);
    }
}

static void test_commands_reach_a_block_of_zeros(void **state)
{
    struct fixture f;
    (void)state;
    open_crowd(&f, "patrol");
    uint32_t id = fixture_state(&f).entities.row[SECOND_BLOCK_ROW].id;
    steps_send(&f, RING_CLIENTS,
               (struct command){.type = COMMAND_DRIVE,
                                .source = 7,
                                .entity = id,
                                .value = {0.5, 0.0, 0.0, 1.0, 1.0, 0.0}});
    go_on(&f);
    assert_true(steps_rows(&f).row[SECOND_BLOCK_ROW].turret > 0.0f);
    steps_send(&f, RING_CLIENTS,
               (struct command){.type = COMMAND_RELEASE, .source = 7, .entity = id});
    go_on(&f);
    steps_aim(&f, 2099, SECOND_BLOCK_ROW);
    struct state now = fixture_state(&f);
    state_seal(&now, f.view.world.counts.fixed);
    steps_send(
        &f, RING_CLIENTS,
        (struct command){.type = COMMAND_FIRE, .entity = now.entities.row[2099].id, .target = id});
    assert_sure_or_not_the_same(&f);
    assert_int_equal(f.view.m.head->tally.fires, 1);
    assert_int_equal(f.view.m.entities.row[SECOND_BLOCK_ROW].threat_id, 0); /* it has noticed */
    go_on(&f);
    steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_REMOVE, .entity = id});
    go_on(&f);
    now = fixture_state(&f);
    assert_int_equal(now.entities.row[SECOND_BLOCK_ROW].state, ENTITY_FREE);
    now.head->alloc_next = SECOND_BLOCK_ROW;
    state_seal(&now, f.view.world.counts.fixed);
    fixture_run(&f, 1);
    steps_send(&f, RING_CLIENTS,
               (struct command){.type = COMMAND_SPAWN,
                                .kind = fixture_kind(&f, "jeep"),
                                .amount = BEHAVIOUR_HOLD,
                                .value = {25000.0, 25000.0, 0.0, 0.0, 10.0}});
    assert_sure_or_not_the_same(&f);
    assert_true(f.view.m.entities.row[SECOND_BLOCK_ROW].z ==
                25000.0); /* it moves from the next frame */
    go_on(&f);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moving_again_over_anything_gives_the_same_bytes),
        cmocka_unit_test(test_a_new_movers_first_step_is_the_old_ones_next),
        cmocka_unit_test(test_the_committed_world_is_only_read),
        cmocka_unit_test(test_no_trigger_outlives_its_frame),
        cmocka_unit_test(test_a_round_moves_from_the_frame_after_its_shot),
        cmocka_unit_test(test_scenario_fires_come_at_their_tick_in_the_files_order),
        cmocka_unit_test(test_a_paused_world_holds_its_fires_back),
        cmocka_unit_test(test_the_dead_do_not_fire),
        cmocka_unit_test(test_one_row_has_values_that_its_block_lacked),
        cmocka_unit_test(test_commands_reach_a_block_of_zeros),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
