/* From PDUs to rows: a small world takes what the gateway has written into its ring. The test has
 * its own clock. */
#include "gateway/remote_input.h"

#include "gateway/remote_notices.h"

#include "gateway/pdu/timestamp.h"
#include "tests/unit/gateway/remote_stage.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void test_an_entity_state_becomes_a_row(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M + 3.0, 24900.0});
    struct vec3 velocity = rotation_apply(&frame.axes, (struct vec3){4.0, 0.0, -3.0});
    (void)state;
    pdu.entity_state.dead_reckoning = DEAD_RECKONING_FPW;
    pdu.entity_state.appearance = PDU_APPEARANCE_DAMAGE(1);
    vec3_to_floats(pdu.entity_state.velocity, velocity);
    pdu.parts = 2;
    pdu.part[0] = (struct pdu_part){.type = PDU_TURRET_AZIMUTH, .value = -1.5f};
    pdu.part[1] = (struct pdu_part){.type = PDU_GUN_ELEVATION, .value = 0.25f};
    take(&pdu, &peer);
    remote_input_tell(&input, &f.view, now_ns);
    fixture_run(&f, 1);
    uint32_t row = row_of(5);
    const struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    assert_int_equal(row, 1);
    assert_int_equal(e->row[row].kind, fixture_kind(&f, "tank"));
    assert_int_equal(e->row[row].force, FORCE_RED);
    assert_int_equal(e->row[row].damage, DAMAGE_LOW);
    assert_true(fabs(e->row[row].x - 25100.0) < 1e-6 && fabs(e->row[row].z - 24900.0) < 1e-6);
    assert_true(fabs(e->row[row].y - FIXTURE_GROUND_M) < 1e-6); /* clamped */
    assert_true(fabs(e->row[row].vx - 4.0) < 1e-5 && fabs(e->row[row].vz + 3.0) < 1e-5);
    assert_true(fabs(e->row[row].heading - 1.0) < 1e-5 && fabs(e->row[row].pitch - 0.1) < 1e-5 &&
                fabs(e->row[row].roll + 0.2) < 1e-5);
    assert_true(fabs((double)e->row[row].turret + 1.5) < 1e-3);
    assert_true(fabs((double)e->row[row].gun - 0.25) < 1e-3);
    struct remote_record record = remote_record_of(&f.view.commands[RING_GATEWAY]->slot[0]);
    assert_string_equal(record.marking, "T72");
}

/* Body axes: what a PDU of models 6 to 9 says is the same motion as in those of the world. */
static void test_body_axes(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, 900.0, 24900.0});
    (void)state;
    pdu.entity_state.type = (struct pdu_entity_type){1, 2, 222, 1, 2, 1, 0};
    pdu.entity_state.dead_reckoning = DEAD_RECKONING_RVB;
    vec3_to_floats(pdu.entity_state.velocity, (struct vec3){60.0, 0.0, 0.0});        /* forward */
    vec3_to_floats(pdu.entity_state.angular_velocity, (struct vec3){0.0, 0.0, 0.5}); /* right */
    take(&pdu, &peer);
    remote_input_tell(&input, &f.view, now_ns);
    fixture_run(&f, 1);
    const struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    struct mat3 turn = rotation_matrix(rotation_of(1.0, 0.1, -0.2));
    struct vec3 forward = rotation_apply(&turn, (struct vec3){60.0, 0.0, 0.0});
    struct vec3 down = rotation_apply(&turn, (struct vec3){0.0, -0.5, 0.0});
    assert_true(vec3_length(vec3_sub(entities_velocity(e, 1), forward)) < 1e-4);
    assert_true(fabs(e->row[1].spin_x - down.x) + fabs(e->row[1].spin_y - down.y) +
                    fabs(e->row[1].spin_z - down.z) <
                1e-5);
    double before = e->row[1].heading;
    fixture_run(&f, 30);
    assert_true(steps_rows(&f).row[1].heading - before > 0.2); /* it turns to the right */
}

static void test_it_is_lost(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    (void)state;
    take(&pdu, &peer);
    for (int i = 0; i < 10; i++) {
        pass(2.0);
        take(&pdu, &peer);
    }
    assert_int_equal(row_of(5), 1);
    assert_int_equal(steps_rows(&f).row[1].id, 2); /* the row of the first one */
    pass(11.0);
    assert_int_equal(row_of(5), 1);
    pass(2.0); /* 13 s after the last */
    assert_int_equal(row_of(5), SLOT_NONE);
    assert_int_equal(input.lost, 1);
    pass(3.0);
    assert_int_equal(input.table.count, 0);
    take(&pdu, &peer);
    pass(1.0);
    assert_int_not_equal(row_of(5), SLOT_NONE);
    pdu.entity_state.appearance = PDU_APPEARANCE_DEACTIVATED;
    take(&pdu, &peer);
    pass(1.0);
    assert_int_equal(row_of(5), SLOT_NONE);
    assert_int_equal(input.lost, 2);
}

static void test_a_gateway_that_starts_anew(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    struct pdu shot = {.header.type = PDU_DETONATION};
    struct vec3 ecef = local_frame_ecef(&frame, (struct vec3){25500.0, 100.0, 25000.0});
    (void)state;
    shot.detonation = (struct pdu_detonation){.firer = {7, 1, 5},
                                              .event = {7, 1, 77},
                                              .munition_type = {2, 9, 225, 2, 14, 2, 0},
                                              .location = {ecef.x, ecef.y, ecef.z},
                                              .result = PDU_RESULT_GROUND_IMPACT};
    take(&pdu, &peer);
    take(&shot, &peer);
    pass(0.1);
    uint32_t row = row_of(5);
    assert_int_not_equal(row, SLOT_NONE);
    remote_input_close(&input);
    open_input();
    pass(0.1);
    assert_int_equal(input.table.count, 1);
    take(&pdu, &other); /* it comes first, and is not the owner by the ring */
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 1);
    take(&pdu, &peer);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 1);
    take(&shot, &peer);
    assert_int_equal(input.repeated, 1); /* from the ring */
    pass(0.1);
    assert_int_equal(row_of(5), row);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 1);
    pdu.entity_state.appearance = PDU_APPEARANCE_DEACTIVATED;
    take(&pdu, &other); /* only the owner says that it is gone */
    pass(0.1);
    assert_int_equal(row_of(5), row);
    remote_input_close(&input);
    open_input();
    pass(0.1);
    take(&pdu, &other);
    pass(0.1);
    assert_int_equal(row_of(5), row);
    take(&pdu, &peer);
    pass(0.1);
    assert_int_equal(row_of(5), SLOT_NONE);
}

/* Other entities do not write the owner of one that stands, or that moves and says so seldom, out
 * of the ring. */
static void test_an_owner_stays_in_the_ring(void **state)
{
    struct pdu still = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    struct pdu moving = state_of(7, (struct vec3){26100.0, FIXTURE_GROUND_M, 24900.0});
    uint64_t slots = layout_ring_slots(f.view.header, RING_GATEWAY);
    (void)state;
    moving.entity_state.dead_reckoning = DEAD_RECKONING_FPW;
    vec3_to_floats(moving.entity_state.velocity,
                   rotation_apply(&frame.axes, (struct vec3){0.1, 0.0, 0.0}));
    input.timeout_ns = 3600 * (uint64_t)NS_PER_S;
    take(&still, &peer);
    take(&moving, &peer);
    for (uint64_t i = 0; i < 3 * slots; i++) {
        double x = 25200.0 + 0.1 * (double)(i % 1000);
        struct pdu pdu = state_of(6, (struct vec3){x, FIXTURE_GROUND_M, 24900.0});
        take(&pdu, &peer);
        now_ns += 25 * (uint64_t)NS_PER_MS;
        pass(0.0);
        if (i % 100 == 0)
            take(&still, &peer);
    }
    assert_int_equal(input.tracks, 3 * slots + 2);
    assert_int_equal(input.refused[REMOTE_INPUT_RING], 0);
    remote_input_close(&input);
    open_input();
    pass(REMOTE_INPUT_GRACE_S); /* after which anybody could have what nobody has */
    take(&still, &other);
    take(&moving, &other);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 2);
    take(&still, &peer);
    take(&moving, &peer);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 2);
}

/* A simulator that starts anew on another port gets what its predecessor no longer sends, before it
 * has timed out. One on another address does not. */
static void test_an_owner_that_starts_anew(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    struct udp_address elsewhere;
    (void)state;
    assert_int_equal(udp_address_parse(&elsewhere, "127.0.0.2:40000", 0, &error), 0);
    take(&pdu, &peer);
    pass(5.9);
    take(&pdu, &other);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 1);
    pass(0.2);
    take(&pdu, &elsewhere);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 2);
    take(&pdu, &other);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 2);
    take(&pdu, &peer);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 3);
    assert_int_equal(row_of(5), 1);
}

/* An owner whom nobody knows is who has the entity where it is, for a while. */
static void test_an_owner_is_told_by_the_place(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    struct pdu far = state_of(5, (struct vec3){27100.0, FIXTURE_GROUND_M, 24900.0});
    (void)state;
    take(&pdu, &peer);
    pass(0.1);
    remote_input_close(&input);
    open_input();
    remote_table_find(&input.table, remote_id(7, 1, 5))->owner = 0;
    pass(0.1);
    take(&far, &other);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 1);
    take(&pdu, &peer);
    take(&far, &other);
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 2);
    remote_input_close(&input);
    open_input();
    remote_table_find(&input.table, remote_id(7, 1, 5))->owner = 0;
    pass(REMOTE_INPUT_GRACE_S);
    take(&far, &other); /* then whoever comes first */
    assert_int_equal(input.refused[REMOTE_INPUT_TWIN], 0);
}

static void test_a_stranger_with_too_many(void **state)
{
    (void)state;
    for (uint16_t i = 1; i <= 1000; i++) {
        struct pdu pdu = state_of(i, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
        take(&pdu, &peer);
    }
    assert_int_equal(input.refused[REMOTE_INPUT_FULL], 996);
    pass(0.1);
    assert_int_equal(fixture_state(&f).head->vehicles, 5);
    assert_int_equal(fixture_event_count(&f, EVENT_INPUT), 1);
    assert_int_equal(fixture_event(&f, EVENT_INPUT, 0)->input.refused, 0);
}

static void test_places_that_are_none(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0}), far = pdu;
    (void)state;
    take(&pdu, &peer);
    pass(0.1);
    far = state_of(5, (struct vec3){1000.0, FIXTURE_GROUND_M, 49000.0});
    take(&far, &peer);
    assert_int_equal(input.refused[REMOTE_INPUT_JUMP], 1);
    far = state_of(6, (struct vec3){-100.0, FIXTURE_GROUND_M, 24900.0});
    take(&far, &peer);
    far.entity_state.location[0] = far.entity_state.location[1] = far.entity_state.location[2] =
        1.0; /* the middle of the earth */
    take(&far, &peer);
    far.entity_state.location[0] = 1e30;
    take(&far, &peer);
    assert_int_equal(input.refused[REMOTE_INPUT_PLACE], 2);
    assert_int_equal(input.refused[REMOTE_INPUT_HEIGHT], 1);
    pass(0.1);
    assert_true(fabs(steps_rows(&f).row[1].x - 25100.0) < 1e-6);
    assert_int_equal(fixture_state(&f).head->used, 2);
}

/* Heights of which there is nothing are counted by themselves. */
static void test_heights_that_are_none(void **state)
{
    static const double heights[] = {-40000.0, -1001.0, 50001.0, 1e5};
    char text[700];
    (void)state;
    assert_false(remote_notices_refusals(&input, now_ns));
    for (unsigned i = 0; i < 4; i++) {
        struct pdu pdu = state_of(5, (struct vec3){25100.0, heights[i], 24900.0});
        take(&pdu, &peer);
        assert_int_equal(input.refused[REMOTE_INPUT_HEIGHT], i + 1);
    }
    assert_int_equal(input.refused[REMOTE_INPUT_PLACE], 0);
    assert_true(remote_notices_text(&input, text, sizeof text));
    assert_string_equal(text, "4 below -1 km or above 50 km");
    assert_true(remote_notices_refusals(&input, now_ns)); /* one line of the four */
    assert_false(remote_notices_refusals(&input, now_ns));
    pass(0.1);
    assert_int_equal(row_of(5), SLOT_NONE);
}

static void test_absurd_motion(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, 500.0, 24900.0});
    (void)state;
    for (int i = 0; i < 3; i++) {
        pdu.entity_state.velocity[i] = 1e30f;
        pdu.entity_state.acceleration[i] = -1e30f;
        pdu.entity_state.angular_velocity[i] = 1e20f;
        pdu.entity_state.orientation[i] = 1e25f;
    }
    pdu.entity_state.dead_reckoning = 77; /* static */
    pdu.parts = 1;
    pdu.part[0] = (struct pdu_part){.type = PDU_TURRET_AZIMUTH, .value = 1e29f};
    take(&pdu, &peer);
    pass(0.1);
    assert_int_equal(row_of(5), 1);
    assert_true(steps_speed(&f, 1) == 0.0);
    pdu.entity_state.dead_reckoning = DEAD_RECKONING_RVW;
    take(&pdu, &peer);
    pass(0.1);
    assert_int_equal(fixture_event(&f, EVENT_INPUT, 1)->input.refused, 0);
}

/* A turret turns all the way round, and a gun no further than straight up and down. */
static void test_absurd_parts(void **state)
{
    static const struct {
        float told;
        double turret, gun;
    } cases[] = {{0.5f, 0.5, 0.5},
                 {2.5f, 2.5, 0.5 * PI},
                 {-2.5f, -2.5, -0.5 * PI},
                 {6.0f, -0.2832, -0.2832},
                 {1e29f, 0.0, 0.0}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct pdu pdu = state_of(5, (struct vec3){25100.0, 500.0, 24900.0});
        pdu.parts = 2;
        pdu.part[0] = (struct pdu_part){.type = PDU_TURRET_AZIMUTH, .value = cases[i].told};
        pdu.part[1] = (struct pdu_part){.type = PDU_GUN_ELEVATION, .value = cases[i].told};
        take(&pdu, &peer);
        pass(0.2);
        assert_true(fabs((double)steps_rows(&f).row[1].turret - cases[i].turret) < 1e-3);
        assert_true(fabs((double)steps_rows(&f).row[1].gun - cases[i].gun) < 1e-3);
    }
}

static void test_types(void **state)
{
    static const struct {
        struct pdu_entity_type type;
        const char *kind; /* NULL: left out */
    } cases[] = {
        {{1, 1, 225, 1, 1, 3, 0}, "tank"}, /* M1A2, which the table does not have */
        {{1, 1, 222, 2, 9, 9, 0}, "carrier"}, {{1, 1, 71, 7, 0, 0, 0}, "truck"},
        {{1, 1, 222, 28, 12, 1, 0}, "flak"},  {{1, 2, 225, 20, 0, 0, 0}, "helicopter"},
        {{1, 3, 225, 5, 0, 0, 0}, "ship"},    {{3, 1, 225, 1, 3, 0, 0}, NULL}, /* a soldier */
        {{2, 7, 225, 9, 9, 9, 0}, NULL}, /* a munition whose domain the table does not have */
        {{5, 1, 0, 2, 0, 0, 0}, NULL},   /* a building */
        {{1, 5, 225, 1, 0, 0, 0}, NULL}, /* a satellite */
    };
    (void)state;
    for (uint16_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct pdu pdu = state_of(5, (struct vec3){25100.0, 500.0, 24900.0});
        uint64_t left_out = input.refused[REMOTE_INPUT_TYPE];
        pdu.entity_state.type = cases[i].type;
        take(&pdu, &peer);
        take(&pdu, &peer);
        assert_int_equal(input.refused[REMOTE_INPUT_TYPE] - left_out, cases[i].kind ? 0 : 2);
        if (!cases[i].kind)
            continue;
        pass(0.1);
        if (steps_rows(&f).row[1].kind != fixture_kind(&f, cases[i].kind))
            fail_msg("case %u is a %s", i, f.view.world.kinds[steps_rows(&f).row[1].kind].name);
    }
    assert_in_range(input.unknown.count, 5, 10); /* each type once */
}

static void test_often_told_is_told_seldom(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) { /* an entity that sends 1,000 a second */
        struct pdu pdu = state_of(5, (struct vec3){25100.0 + i, FIXTURE_GROUND_M, 24900.0});
        take(&pdu, &peer);
        now_ns += NS_PER_MS;
        remote_input_tell(&input, &f.view, now_ns);
    }
    assert_in_range(input.tracks, 45, 51);
}

/* What the network has delayed or repeated is known by its time stamp, and no clock is trusted
 * further than that. */
static void test_late_and_twice(void **state)
{
    static const struct {
        double stamp_s, after_s; /* of the second, and how long after the first it comes */
        bool absolute, same, taken;
    } cases[] = {
        {1000.06, 0.05, true, false, true}, /* the next */
        {999.95, 0.05, true, false, false}, /* it has been overtaken */
        {1000.0, 0.05, true, true, false},  /* a copy */
        {1000.0, 0.05, true, false, true},  /* a clock that stands */
        {999.95, 2.0, true, false, true},   /* nothing is so long on its way */
        {990.0, 0.05, true, false, true},   /* a clock that was set back */
        {3400.0, 0.05, true, false, true},  /* one that is wrong */
        {999.95, 0.05, false, false, true}, /* another clock */
    };
    (void)state;
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint16_t entity = (uint16_t)(20 + i);
        struct vec3 at = {25100.0, FIXTURE_GROUND_M, 24000.0 + 20.0 * i};
        struct pdu pdu = state_of(entity, at);
        pdu.header.timestamp = timestamp_of(1000.0, true);
        take(&pdu, &peer);
        pass(0.5);
        pdu = state_of(entity, at);
        pdu.header.timestamp = timestamp_of(1000.0, true);
        take(&pdu, &peer);
        at.x += cases[i].same ? 0.0 : 1.0;
        pdu = state_of(entity, at);
        pdu.header.timestamp = timestamp_of(cases[i].stamp_s, cases[i].absolute);
        now_ns += (uint64_t)(cases[i].after_s * 1e9);
        uint64_t late = input.late;
        take(&pdu, &peer);
        if ((input.late == late) != cases[i].taken)
            fail_msg("case %u: %" PRIu64 " late", i, input.late - late);
        pdu.entity_state.appearance = PDU_APPEARANCE_DEACTIVATED; /* it makes room */
        take(&pdu, &peer);
        pass(0.5);
    }
    /* What comes after its last state does not bring it back. */
    struct pdu pdu = state_of(60, (struct vec3){26000.0, FIXTURE_GROUND_M, 24000.0});
    pdu.header.timestamp = timestamp_of(3599.99, true);
    take(&pdu, &peer);
    pdu.entity_state.appearance = PDU_APPEARANCE_DEACTIVATED;
    pdu.header.timestamp = timestamp_of(0.05, true); /* the hour has ended */
    take(&pdu, &peer);
    pdu.entity_state.appearance = 0;
    pdu.header.timestamp = timestamp_of(0.0, true);
    uint32_t known = input.table.count;
    take(&pdu, &peer);
    assert_int_equal(input.table.count, known);
    pdu.header.timestamp = timestamp_of(0.1, true); /* it comes again */
    take(&pdu, &peer);
    assert_int_equal(input.table.count, known + 1);
}

/* Heartbeats of what stands cost the world and its log nothing, and keep it there. */
static void test_what_stands_is_told_once(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    (void)state;
    for (int i = 0; i < 30; i++) {
        pdu.header.timestamp = timestamp_of(100.0 + i, true);
        take(&pdu, &peer);
        pass(1.0);
    }
    assert_int_equal(input.tracks, 1);
    assert_int_equal(input.lost, 0);
    assert_int_equal(row_of(5), 1);
    pdu.entity_state.appearance = PDU_APPEARANCE_DAMAGE(1);
    pdu.header.timestamp = timestamp_of(131.0, true);
    take(&pdu, &peer);
    pass(1.0);
    assert_int_equal(input.tracks, 2);
    assert_int_equal(steps_rows(&f).row[1].damage, DAMAGE_LOW);
}

static void test_a_full_ring(void **state)
{
    (void)state;
    uint64_t slots = layout_ring_slots(f.view.header, RING_GATEWAY);
    for (uint64_t i = 0; i < slots + 10; i++) {
        struct pdu pdu =
            state_of(5, (struct vec3){25100.0 + 0.01 * (double)i, FIXTURE_GROUND_M, 24900.0});
        take(&pdu, &peer);
        now_ns += NS_PER_S;
        remote_input_tell(&input, &f.view, now_ns);
    }
    assert_int_equal(input.tracks, slots); /* the world has not taken one */
    assert_int_equal(input.refused[REMOTE_INPUT_RING], 10);
    pass(0.1);
    assert_int_equal(row_of(5), 1);
}

static void test_shots(void **state)
{
    struct pdu fire = {.header.type = PDU_FIRE}, hit = {.header.type = PDU_DETONATION};
    struct vec3 ecef = local_frame_ecef(&frame, (struct vec3){25001.0, 101.0, 25000.0});
    struct vec3 velocity = rotation_apply(&frame.axes, (struct vec3){-1200.0, 0.0, 0.0});
    (void)state;
    fire.fire = (struct pdu_fire){.firer = {7, 1, 5},
                                  .target = {1991, 10, 1},
                                  .event = {7, 1, 3},
                                  .munition_type = {2, 2, 225, 2, 13, 1, 0},
                                  .location = {ecef.x, ecef.y, ecef.z}};
    hit.detonation = (struct pdu_detonation){.firer = {7, 1, 5},
                                             .target = {1991, 10, 1},
                                             .event = {7, 1, 3},
                                             .munition_type = {2, 2, 225, 2, 13, 1, 0},
                                             .location = {ecef.x, ecef.y, ecef.z},
                                             .point = {1.0f, 0.0f, -1.0f},
                                             .result = PDU_RESULT_ENTITY_IMPACT};
    vec3_to_floats(hit.detonation.velocity, velocity);
    take(&fire, &peer);
    take(&fire, &peer);
    take(&hit, &peer);
    take(&hit, &peer);
    assert_int_equal(input.fires, 1);
    assert_int_equal(input.struck, 1);
    assert_int_equal(input.repeated, 2);
    fixture_run(&f, 3);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 0)->fire.target.id, 1);
    assert_int_equal(fixture_event(&f, EVENT_DETONATION, 0)->detonation.struck_party.id, 1);
    assert_true(steps_rows(&f).row[0].harm_j > 0.0);
    static const uint8_t none[] = {PDU_RESULT_DUD, PDU_RESULT_MISS, PDU_RESULT_MISS + 1,
                                   PDU_RESULT_MISS_LAST};
    for (uint16_t i = 0; i < sizeof none; i++) {
        hit.detonation.result = none[i];
        hit.detonation.event.entity = 4 + i;
        take(&hit, &peer);
        assert_int_equal(input.struck, 1);
    }
    hit.detonation.result = PDU_RESULT_MISS_LAST + 1; /* of no known meaning: it detonates */
    take(&hit, &peer);
    assert_int_equal(input.struck, 2);
    assert_int_equal(last_record().model, 0);
    hit.detonation.result = PDU_RESULT_AIR_BURST;
    hit.detonation.event.entity = 99;
    take(&hit, &peer);
    assert_int_equal(last_record().model, REMOTE_BURST_IN_AIR);
    assert_int_equal(last_record().entity, 0);
}

/* Version 7 has ten of each side. */
static void test_sides(void **state)
{
    static const struct {
        uint8_t told, force;
    } sides[] = {{0, FORCE_NEUTRAL},  {1, FORCE_BLUE},     {2, FORCE_RED},
                 {3, FORCE_NEUTRAL},  {4, FORCE_BLUE},     {5, FORCE_RED},
                 {6, FORCE_NEUTRAL},  {28, FORCE_BLUE},    {29, FORCE_RED},
                 {30, FORCE_NEUTRAL}, {31, FORCE_NEUTRAL}, {255, FORCE_NEUTRAL}};
    (void)state;
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
        pdu.entity_state.force = sides[i].told;
        take(&pdu, &peer);
        pass(0.2);
        assert_int_equal(steps_rows(&f).row[row_of(5)].force, sides[i].force);
    }
}

/* What the world refuses is counted and told, too. */
static void test_a_world_that_is_full(void **state)
{
    (void)state;
    assert_false(remote_notices_world(&input, now_ns));
    remote_input_world_refused(&input, remote_id(7, 1, 5), 3, REMOTE_NO_ROW);
    remote_input_world_refused(&input, remote_id(7, 1, 6), 1, REMOTE_JUMPS);
    remote_input_world_refused(&input, remote_id(7, 1, 6), 1, 12345);
    assert_int_equal(input.world_refused[REMOTE_NO_ROW], 3);
    assert_true(remote_notices_world(&input, now_ns));
    assert_false(remote_notices_world(&input, now_ns));
}

/* How far a round has flown goes by its Fire, or by who fired it. */
static void test_how_far_a_round_has_flown(void **state)
{
    struct vec3 at = {25000.0, FIXTURE_GROUND_M, 25000.0};
    struct vec3 muzzle = {23000.0, FIXTURE_GROUND_M, 25000.0};
    struct pdu pdu = state_of(5, (struct vec3){25000.0, FIXTURE_GROUND_M, 24000.0});
    struct vec3 from = local_frame_ecef(&frame, muzzle), to = local_frame_ecef(&frame, at);
    (void)state;
    take(&pdu, &peer);
    pass(0.1);
    for (int known = 0; known < 2; known++) {
        memset(&pdu, 0, sizeof pdu);
        pdu.header.type = PDU_FIRE;
        pdu.fire = (struct pdu_fire){.firer = {7, 1, 5},
                                     .event = {7, 1, 3},
                                     .munition_type = {2, 2, 225, 2, 13, 1, 0},
                                     .location = {from.x, from.y, from.z}};
        if (known)
            take(&pdu, &peer);
        memset(&pdu, 0, sizeof pdu);
        pdu.header.type = PDU_DETONATION;
        pdu.detonation = (struct pdu_detonation){.firer = {7, 1, 5},
                                                 .event = {7, 1, (uint16_t)(known ? 3 : 2)},
                                                 .munition_type = {2, 2, 225, 2, 13, 1, 0},
                                                 .location = {to.x, to.y, to.z},
                                                 .result = PDU_RESULT_GROUND_IMPACT};
        take(&pdu, &peer);
        assert_true(fabs((double)last_record().flown_m - (known ? 2000.0 : 1000.0)) < 1.0);
    }
}

static struct pdu collision_of(uint16_t event, float mass_kg)
{
    struct pdu pdu;
    memset(&pdu, 0, sizeof pdu);
    pdu.header.type = PDU_COLLISION;
    pdu.collision = (struct pdu_collision){.issuer = {7, 1, 5},
                                           .other = {1991, 10, 1},
                                           .event = {7, 1, event},
                                           .mass = mass_kg,
                                           .point = {2.0f, 1.0f, 0.5f}};
    vec3_to_floats(pdu.collision.velocity,
                   rotation_apply(&frame.axes, (struct vec3){0.0, 0.0, 15.0}));
    return pdu;
}

/* A Collision is told when our own collider has not told of it within REMOTE_INPUT_AFTER_S. */
static void test_collisions(void **state)
{
    struct pdu pdu = collision_of(1, 50000.0f);
    (void)state;
    take(&pdu, &peer);
    take(&pdu, &peer); /* the network repeats it */
    remote_input_tell(&input, &f.view, now_ns);
    assert_int_equal(input.struck, 0);
    now_ns += (uint64_t)(REMOTE_INPUT_AFTER_S * 1e9) + 1;
    remote_input_tell(&input, &f.view, now_ns);
    assert_int_equal(input.struck, 1);
    assert_int_equal(input.repeated, 1);
    struct remote_record record = last_record();
    assert_int_equal(record.type, REMOTE_STRUCK);
    assert_int_equal(record.kind, KIND_NONE);
    assert_int_equal(record.entity, 1);
    assert_true(record.mass_kg == 50000.0f && record.restitution == 0.0f);
    assert_true(fabs(record.position[0] - 2.0) < 1e-6 && fabs(record.position[1] + 0.5) < 1e-6 &&
                fabs(record.position[2] - 1.0) < 1e-6); /* forward, up, right */
    assert_true(fabs((double)record.velocity[2] - 15.0) < 1e-4);
    pdu = collision_of(2, 50000.0f);
    take(&pdu, &peer);
    remote_input_met(&input, 1, remote_id(7, 1, 5), now_ns + 1000); /* ours comes later */
    remote_input_tell(&input, &f.view, now_ns + 2000);
    assert_int_equal(input.collisions, 1);
    pdu = collision_of(3, 50000.0f); /* ours came before */
    take(&pdu, &peer);
    remote_input_tell(&input, &f.view, now_ns + 2000);
    assert_int_equal(input.collisions, 2);
    assert_int_equal(input.struck, 1);
    pdu = collision_of(4, 0.0f);
    take(&pdu, &peer);
    pdu = collision_of(5, NAN);
    take(&pdu, &peer);
    pdu = collision_of(6, -5.0f);
    take(&pdu, &peer);
    assert_int_equal(input.refused[REMOTE_INPUT_BODY], 3);
    for (uint16_t i = 0; i < REMOTE_INPUT_BODIES + 7; i++) {
        pdu = collision_of((uint16_t)(100 + i), 1.0f);
        pdu.collision.issuer.entity = 6;
        take(&pdu, &peer);
    }
    assert_int_equal(input.refused[REMOTE_INPUT_BODY], 10);
}

static void test_a_munition_in_flight(void **state)
{
    struct pdu pdu = state_of(8, (struct vec3){25100.0, FIXTURE_GROUND_M + 50.0, 24900.0});
    (void)state;
    pdu.entity_state.type = (struct pdu_entity_type){2, 2, 225, 1, 3, 1, 0}; /* AGM-114 */
    take(&pdu, &peer);
    pass(0.1);
    uint32_t row = row_of(8);
    assert_true(row != SLOT_NONE);
    assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_FLIGHT);
    assert_int_equal(fixture_state(&f).head->munitions, 1);
    struct vec3 at = local_frame_ecef(&frame, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    memset(&pdu, 0, sizeof pdu);
    pdu.header.type = PDU_DETONATION;
    pdu.detonation = (struct pdu_detonation){.munition = {7, 1, 8},
                                             .event = {7, 1, 9},
                                             .munition_type = {2, 2, 225, 1, 3, 1, 0},
                                             .location = {at.x, at.y, at.z},
                                             .result = PDU_RESULT_GROUND_IMPACT};
    take(&pdu, &peer); /* its flight is over */
    fixture_run(&f, 3);
    assert_int_equal(row_of(8), SLOT_NONE);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 1);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
}

static void test_a_world_without_room_takes_nothing(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, FIXTURE_GROUND_M, 24900.0});
    (void)state;
    remote_input_close(&input);
    assert_int_equal(remote_table_open(&input.table, 0), 0);
    assert_false(remote_input_take(&input, &f.view, &pdu, &peer, now_ns));
    pdu.header.type = PDU_ACKNOWLEDGE;
    assert_false(remote_input_take(&input, &f.view, &pdu, &peer, now_ns));
}

int main(void)
{
#define TEST(test) cmocka_unit_test_prestate_setup_teardown(test, open_world, close_world, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_an_entity_state_becomes_a_row),
        TEST(test_body_axes),
        TEST(test_it_is_lost),
        TEST(test_a_gateway_that_starts_anew),
        TEST(test_a_stranger_with_too_many),
        TEST(test_an_owner_stays_in_the_ring),
        TEST(test_an_owner_that_starts_anew),
        TEST(test_an_owner_is_told_by_the_place),
        TEST(test_places_that_are_none),
        TEST(test_heights_that_are_none),
        TEST(test_absurd_motion),
        TEST(test_absurd_parts),
        TEST(test_types),
        TEST(test_often_told_is_told_seldom),
        TEST(test_late_and_twice),
        TEST(test_what_stands_is_told_once),
        TEST(test_a_full_ring),
        TEST(test_sides),
        TEST(test_shots),
        TEST(test_a_world_that_is_full),
        TEST(test_how_far_a_round_has_flown),
        TEST(test_collisions),
        TEST(test_a_munition_in_flight),
        TEST(test_a_world_without_room_takes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
