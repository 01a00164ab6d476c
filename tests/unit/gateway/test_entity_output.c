/* Entity States: what a receiver on the loopback gets of a small world, and where its dead
 * reckoning has the vehicles. The test has its own clock: a frame is a sixtieth of a second. */
#include "gateway/entity_output.h"

#include "gateway/pdu/pdu_read.h"
#include "gateway/pdu/timestamp.h"
#include "gateway/udp/udp_socket.h"
#include "tests/support/fixture.h"
#include "world/checksum.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#define RECEIVED_MAX 512
#define FRAME_NS     (1000000000u / 60u)

static struct fixture world;
static struct entity_output entities;
static struct pdu_output output;
static struct type_table types;
static struct error_text error;
static struct pdu received[RECEIVED_MAX];
static int listener, count;
static uint64_t now_ns;

static void open_output(uint32_t rate_ps)
{
    char path[512], address[] = "127.0.0.1";
    struct udp_address at;
    socklen_t length = sizeof at;
    const struct world *w = &world.view.world;
    memset(&entities, 0, sizeof entities);
    output = (struct pdu_output){.version = 7, .exercise = 3};
    assert_int_equal(udp_address_parse(&at, address, 3000, &error), 0);
    at.v4.sin_port = 0;
    listener = udp_socket_listener(&at, 0, &error);
    assert_true(listener >= 0);
    assert_int_equal(getsockname(listener, &at.any, &length), 0);
    assert_int_equal(pdu_output_open(&output, address, udp_address_port(&at), 0, rate_ps, &error),
                     0);
    snprintf(path, sizeof path, "%s/dis/types.txt", fixture_shipped_dir());
    assert_int_equal(type_table_read(&types, path, w->kinds, w->counts.kinds, &error), 0);
    entities.output = &output;
    entities.types = &types;
    entities.ids = (struct entity_ids){1991, 36, 2};
    local_frame_make(&entities.frame, 35.95, -121.25, -33.7, 25000.0, 25000.0);
    assert_int_equal(entity_output_open(&entities, &world.view, &error), 0);
}

static void close_output(void)
{
    entity_output_close(&entities);
    close(output.udp.socket);
    close(listener);
}

static int set_up(void **state)
{
    (void)state;
    fixture_open(&world, "vehicles = ();");
    now_ns = 1000000000000u;
    open_output(100000);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    close_output();
    fixture_close(&world);
    return 0;
}

/* Reads what came into received. */
static void receive(void)
{
    static uint8_t bytes[2048];
    struct udp_address from;
    int size;
    count = 0;
    while ((size = udp_socket_receive(listener, bytes, sizeof bytes, &from)) >= 0) {
        struct pdu_cursor cursor = {bytes, (size_t)size, 0};
        assert_true(count < RECEIVED_MAX);
        assert_int_equal(pdu_read(&cursor, &received[count++]), PDU_GOOD);
        assert_int_equal(pdu_read(&cursor, &received[count]), PDU_END); /* one in a datagram */
    }
}

static void pass(void)
{
    assert_true(entity_output_look(&entities, &world.view, now_ns));
    entity_output_send(&entities, &world.view, now_ns);
    receive();
}

/* Runs frames of the world, with a pass after each third, and counts the PDUs. */
static int run(uint32_t frames)
{
    int total = 0;
    for (uint32_t i = 0; i < frames; i++) {
        if (i == 0)
            fixture_run(&world, 1);
        else
            fixture_continue(&world, 1);
        now_ns += FRAME_NS;
        if (i % 3 == 2) {
            pass();
            total += count;
        }
    }
    return total;
}

static uint32_t put(const char *kind, double x, double z, double speed_mps, enum force force)
{
    return fixture_put(&world, (struct fixture_entity){.kind = kind,
                                                       .at = {x, 101.0, z},
                                                       .velocity = {speed_mps, 0.0, 0.0},
                                                       .force = force});
}

static void test_a_vehicle_is_sent_once(void **state)
{
    (void)state;
    put("tank", 26000.0, 25000.0, 0.0, FORCE_BLUE);
    put("tank", 25000.0, 24000.0, 0.0, FORCE_RED);
    put("tree", 25100.0, 24000.0, 0.0, FORCE_NEUTRAL); /* no vehicle */
    put("shell", 25000.0, 20000.0, 0.0, FORCE_RED);    /* no entity of DIS */
    pass();
    assert_int_equal(count, 2);
    const struct pdu_entity_state *blue = &received[0].entity_state,
                                  *red = &received[1].entity_state;
    assert_int_equal(received[0].header.exercise, 3);
    assert_int_equal(received[0].header.version, 7);
    assert_int_equal(received[0].header.status, 6);
    assert_true(received[0].header.timestamp & 1);
    assert_int_equal(blue->id.site, 1991);
    assert_int_equal(blue->id.application, 36);
    assert_int_equal(blue->id.entity, 1);
    assert_int_equal(red->id.entity, 2);
    assert_int_equal(blue->force, PDU_FORCE_FRIENDLY);
    assert_int_equal(red->force, PDU_FORCE_OPPOSING);
    assert_int_equal(blue->type.country, 225);
    assert_int_equal(red->type.country, 222);
    assert_string_equal(blue->marking, "tank 1");
    assert_int_equal(blue->dead_reckoning, DEAD_RECKONING_STATIC);
    assert_int_equal(blue->appearance, 0);
    struct vec3 place = local_frame_world(
        &entities.frame, (struct vec3){blue->location[0], blue->location[1], blue->location[2]});
    const struct state committed = fixture_state(&world);
    struct vec3 right = entities_position(&committed.entities, 0);
    assert_true(vec3_length(vec3_sub(place, right)) < 1e-6);
    pass();
    assert_int_equal(count, 0);
}

/* What changes of a vehicle that stands is sent at once. */
static void test_changes_of_what_stands(void **state)
{
    (void)state;
    put("tank", 26000.0, 25000.0, 0.0, FORCE_BLUE);
    run(30);
    for (int change = 0; change < 6; change++) {
        now_ns += 200000000u;
        pass(); /* it may settle */
        now_ns += 200000000u;
        pass();
        assert_int_equal(count, 0);
        struct state committed = fixture_state(&world);
        const struct entities *e = &committed.entities;
        switch (change) {
        case 0:
            e->row[0].heading += 4.0 * RAD_PER_DEG;
            break;
        case 1:
            e->row[0].pitch += 4.0 * RAD_PER_DEG;
            break;
        case 2:
            e->row[0].damage = DAMAGE_MED;
            break;
        case 3:
            e->row[0].y += 1.1;
            break;
        case 4:
            e->row[0].roll += 4.0 * RAD_PER_DEG;
            break;
        default:
            committed.head->paused = 1;
        }
        state_seal(&committed, world.view.world.counts.fixed);
        now_ns += 200000000u;
        pass();
        if (count != 1)
            fail_msg("change %d: %d PDUs", change, count);
    }
}

/* Each part counts its own changes, and another gateway begins at another number. */
static void test_parts_count_their_changes(void **state)
{
    static struct kind kinds[KIND_COUNT_MAX];
    (void)state;
    memcpy(kinds, world.view.world.kinds, world.view.world.counts.kinds * sizeof *kinds);
    kinds[fixture_kind(&world, "tank")].part_count = 3; /* it has a turret */
    world.view.world.kinds = kinds;
    put("tank", 26000.0, 25000.0, 0.0, FORCE_BLUE);
    run(30);
    struct state committed = fixture_state(&world);
    uint8_t turret = 0, gun = 0;
    for (int i = 0; i < 300; i++) {
        committed.entities.row[0].turret = (float)((i + 1) / 2 % 7 + 1) * 0.2f;
        committed.entities.row[0].gun = (float)(i % 2 + 1) * 0.1f;
        state_seal(&committed, world.view.world.counts.fixed);
        now_ns += 200000000u;
        pass();
        assert_int_equal(count, 1);
        assert_int_equal(received[0].parts, 2);
        const struct pdu_part *part = received[0].part;
        assert_true(i == 0 || part[0].change == (uint8_t)(turret + i % 2));
        assert_true(i == 0 || part[1].change == (uint8_t)(gun + 1));
        turret = part[0].change;
        gun = part[1].change;
    }
    close_output();
    committed.head->tick += 77;
    state_seal(&committed, world.view.world.counts.fixed);
    open_output(100000);
    pass();
    assert_int_equal(count, 1);
    assert_int_equal(received[0].part[0].change, (uint8_t)committed.head->tick);
}

static void test_the_heartbeat(void **state)
{
    (void)state;
    put("tank", 26000.0, 25000.0, 0.0, FORCE_BLUE);
    run(3); /* it settles on the ground */
    pass();
    now_ns += 4400000000u;
    int early = 0;
    pass();
    early += count;
    now_ns += 1200000000u;
    pass();
    assert_int_equal(early, 0);
    assert_int_equal(count, 1);
}

/* A vehicle that keeps course and speed is predicted: only heartbeats are sent, and the receiver
 * has it within the threshold and the way of one pass. */
static void test_a_constant_course(void **state)
{
    (void)state;
    put("jeep", 20000.0, 25000.0, 15.0, FORCE_BLUE);
    run(120);
    int sent = run(60 * 20);
    print_message("20 s at a constant course: %d PDUs\n", sent);
    assert_true(sent >= 3 && sent <= 8);
}

/* Where receivers have a vehicle that turns and brakes is within the threshold and what it moves
 * from one pass to the next. */
static void test_receivers_have_it_within_the_threshold(void **state)
{
    struct dead_reckoning known = {0};
    uint64_t since_ns = 0;
    double worst_m = 0.0, worst_rad = 0.0;
    int sent = 0;
    (void)state;
    fixture_put(&world, (struct fixture_entity){.kind = "jeep",
                                                .at = {20000.0, 101.0, 25000.0},
                                                .velocity = {10.0, 0.0, 0.0},
                                                .behaviour = BEHAVIOUR_PATROL});
    for (int i = 0; i < 1200; i++) {
        sent += run(3);
        for (int k = 0; k < count; k++) {
            const struct pdu_entity_state *s = &received[k].entity_state;
            known = (struct dead_reckoning){
                .model = s->dead_reckoning,
                .position = {s->location[0], s->location[1], s->location[2]},
                .velocity = {(double)s->velocity[0], (double)s->velocity[1],
                             (double)s->velocity[2]},
                .acceleration = {(double)s->acceleration[0], (double)s->acceleration[1],
                                 (double)s->acceleration[2]},
                .rates = {(double)s->angular_velocity[0], (double)s->angular_velocity[1],
                          (double)s->angular_velocity[2]},
                .matrix = euler_matrix((struct euler){(double)s->orientation[0],
                                                      (double)s->orientation[1],
                                                      (double)s->orientation[2]})};
            since_ns = now_ns;
        }
        const struct state committed = fixture_state(&world);
        const struct entities *e = &committed.entities;
        struct vec3 position;
        struct mat3 matrix;
        struct mat3 turn =
            rotation_matrix(rotation_of(e->row[0].heading, e->row[0].pitch, e->row[0].roll));
        struct mat3 right = local_frame_ecef_turn(&entities.frame.axes, &turn);
        dead_reckoning_at(&known, (double)(now_ns - since_ns) / 1e9, &position, &matrix);
        struct vec3 place = local_frame_world(&entities.frame, position);
        worst_m = maths_max(worst_m, vec3_length(vec3_sub(place, entities_position(e, 0))));
        worst_rad = maths_max(worst_rad, euler_angle_between(&matrix, &right));
    }
    print_message("a minute on patrol: %d PDUs, %.3f m and %.2f degrees at most\n", sent, worst_m,
                  worst_rad * DEG_PER_RAD);
    /* A pass sees every third frame. */
    assert_true(worst_m < ENTITY_OUTPUT_POSITION_M + 0.5);
    assert_true(worst_rad < ENTITY_OUTPUT_ANGLE_RAD + 2.0 * RAD_PER_DEG);
    assert_true(sent < 240);
}

static double utc_past_hour_s(void)
{
    struct timespec utc;
    clock_gettime(CLOCK_REALTIME, &utc);
    return (double)(utc.tv_sec % 3600) + (double)utc.tv_nsec / 1e9;
}

/* The time stamp is of the frame, and not of the pass that finds it. */
static void test_the_time_stamp_is_of_the_frame(void **state)
{
    static const double ages_s[] = {0.0, 0.009};
    (void)state;
    put("tank", 26000.0, 25000.0, 0.0, FORCE_BLUE);
    for (int i = 0; i < 2; i++) {
        struct state committed = fixture_state(&world);
        committed.entities.row[0].damage = (uint8_t)(DAMAGE_LOW + 2 * i);
        state_seal(&committed, world.view.world.counts.fixed);
        now_ns += 10000000u * (unsigned)i;
        double before_s = utc_past_hour_s();
        pass(); /* the second finds the frame of the first, and takes a tenth of its age for noise
                 */
        double after_s = utc_past_hour_s();
        assert_int_equal(count, 1);
        double stamp_s = timestamp_seconds(received[0].header.timestamp) + ages_s[i];
        assert_true(after_s < before_s || (stamp_s > before_s - 1e-4 && stamp_s < after_s + 1e-4));
    }
}

/* Moves the row and turns it, and seals the frame, which the test makes the next. */
static void next_frame(uint32_t row, double heading, double x)
{
    struct state committed = fixture_state(&world);
    committed.entities.row[row].heading = heading;
    committed.entities.row[row].x = x;
    state_seal(&committed, world.view.world.counts.fixed);
    fixture_run(&world, 1);
    now_ns += FRAME_NS;
}

/* What turns is sent between two passes, too; what stands and has not been chosen is not. */
static void test_what_turns_is_followed(void **state)
{
    (void)state;
    put("helicopter", 20000.0, 25000.0, 0.0, FORCE_BLUE);
    put("tank", 26000.0, 25000.0, 0.0, FORCE_BLUE);
    run(30);
    assert_int_equal(entities.followed_count, 0);
    struct state committed = fixture_state(&world);
    double heading = committed.entities.row[0].heading, x = committed.entities.row[0].x;
    for (int i = 1; i <= 3; i++)
        next_frame(0, heading + 0.02 * i, x); /* 1.2 rad/s: 3.4 degrees */
    pass();
    assert_int_equal(count, 1);
    assert_int_equal(entities.followed_count, 1);
    assert_int_equal(entities.followed[0], 0);
    /* It turns as receivers extrapolate it: nothing. The other way by four degrees: at once. */
    next_frame(0, heading + 0.08, x);
    entity_output_follow(&entities, &world.view, now_ns);
    receive();
    assert_int_equal(count, 0);
    next_frame(0, heading + 0.08 - 4.0 * RAD_PER_DEG, x);
    committed = fixture_state(&world);
    committed.entities.row[1].damage = DAMAGE_MED;
    state_seal(&committed, world.view.world.counts.fixed);
    entity_output_follow(&entities, &world.view, now_ns);
    receive();
    assert_int_equal(count, 1);
    assert_int_equal(received[0].entity_state.id.entity, 1);
    /* Without a later frame, and in a pause, it says nothing. */
    entity_output_follow(&entities, &world.view, now_ns);
    receive();
    assert_int_equal(count, 0);
    pass();
    assert_int_equal(count, 1);
    assert_int_equal(received[0].entity_state.id.entity, 2);
}

static void test_a_missile_comes_and_goes(void **state)
{
    (void)state;
    uint32_t jet = put("jet", 20000.0, 25000.0, 200.0, FORCE_BLUE);
    fixture_put(&world, (struct fixture_entity){.kind = "missile",
                                                .at = {21000.0, 2000.0, 25000.0},
                                                .velocity = {300.0, 0.0, 0.0},
                                                .owner_slot = jet,
                                                .owner_id = jet + 1});
    pass();
    assert_int_equal(count, 2);
    assert_int_equal(received[1].entity_state.type.kind, 2); /* a munition */
    int last = 0;
    for (int i = 0; i < 60 && last == 0; i++) {
        run(60);
        for (int k = 0; k < count; k++)
            last += received[k].entity_state.id.entity == 2 &&
                    (received[k].entity_state.appearance & PDU_APPEARANCE_DEACTIVATED) != 0;
    }
    assert_int_equal(last, 1);
}

static void test_a_pause_freezes(void **state)
{
    (void)state;
    put("jeep", 20000.0, 25000.0, 15.0, FORCE_BLUE);
    run(30);
    pass();
    struct state committed = fixture_state(&world);
    committed.head->paused = 1;
    state_seal(&committed, world.view.world.counts.fixed);
    now_ns += 200000000u;
    pass();
    assert_int_equal(count, 1);
    assert_true(received[0].entity_state.appearance & PDU_APPEARANCE_FROZEN);
    assert_true(received[0].entity_state.velocity[0] == 0.0f);
    /* A receiver that has lost this one still has the jeep driving. */
    int again = 0;
    for (int i = 0; i < 15; i++) {
        now_ns += 200000000u;
        pass();
        again += count;
    }
    assert_int_equal(again, 1);
}

/* Whoever loses one Entity State has the vehicle within the threshold and what it drives in
 * ENTITY_OUTPUT_LOST_S and two passes, and each that is repeated was due for such a receiver. */
static void test_a_lost_state_is_made_good(void **state)
{
    double worst_m = 0.0;
    (void)state;
    put("jeep", 20000.0, 25000.0, 15.0, FORCE_BLUE);
    run(30);
    struct state committed = fixture_state(&world);
    const struct entities *e = &committed.entities;
    uint64_t lost_ns = now_ns;
    e->row[0].vx = e->row[0].vz =
        0.0; /* it stops in one frame, and the Entity State that says so is lost */
    e->row[0].order = e->row[0].behaviour = BEHAVIOUR_IDLE;
    state_seal(&committed, world.view.world.counts.fixed);
    for (int sent = 0; sent < 2;) {
        sent += run(3);
        double driven_m = 15.0 * (double)(now_ns - lost_ns) / 1e9;
        worst_m = sent < 2 ? driven_m : worst_m;
        assert_true(driven_m < 4.0);
    }
    assert_in_range(worst_m * 1000.0, 900, 3200);
    now_ns += 1000000000u;
    pass();
    assert_int_equal(count, 0);
}

/* A pass finds a frame that is up to 16 ms old, in which a jet flies 3 m. That costs no PDU. */
static void test_the_noise_of_the_clock(void **state)
{
    uint64_t random = fixture_seed(60), base_ns = now_ns;
    int total = 0;
    (void)state;
    fixture_put(&world, (struct fixture_entity){.kind = "jet",
                                                .at = {5000.0, 3000.0, 25000.0},
                                                .velocity = {200.0, 0.0, 0.0}});
    for (int i = 0; i < 600; i++) {
        if (i == 0)
            fixture_run(&world, 3);
        else
            fixture_continue(&world, 3);
        base_ns += 3 * FRAME_NS;
        now_ns = base_ns + fixture_random(&random) % 16000000u;
        pass();
        total += i >= 100 ? count : 0;
    }
    print_message("25 s of a jet's course: %d PDUs\n", total);
    assert_true(total >= 4 && total <= 10);
}

/* A world that falls behind the clock is seen to do so: the receivers' extrapolation is too far. */
static void test_a_world_that_falls_behind(void **state)
{
    int total = 0;
    (void)state;
    fixture_put(&world, (struct fixture_entity){.kind = "jet",
                                                .at = {5000.0, 3000.0, 25000.0},
                                                .velocity = {200.0, 0.0, 0.0}});
    run(60);
    for (int i = 0; i < 100; i++) {
        fixture_continue(&world, 2); /* two frames in the time of three */
        now_ns += 3 * FRAME_NS;
        pass();
        total += count;
    }
    assert_true(total > 20);
}

/* A rate that does not suffice puts states off; each vehicle has its turn. */
static void test_the_rate(void **state)
{
    bool seen[41] = {false};
    int most = 0, total = 0;
    (void)state;
    for (int i = 0; i < 40; i++)
        put("tank", 20000.0 + 50.0 * i, 25000.0, 0.0, FORCE_BLUE);
    output.rate_ps = 40;
    for (int i = 0; i < 20; i++) {
        pass();
        most = count > most ? count : most;
        for (int k = 0; k < count; k++) {
            assert_false(seen[received[k].entity_state.id.entity]);
            seen[received[k].entity_state.id.entity] = true;
        }
        total += count;
        now_ns += 50000000u;
    }
    assert_int_equal(total, 40);
    assert_int_equal(most, 8); /* a quarter of a second at once, less what is kept for events */
    assert_true(entities.postponed > 0);
}

/* A rate that never suffices is shared: no vehicle is left out. */
static void test_a_rate_that_never_suffices(void **state)
{
    bool seen[41] = {false};
    (void)state;
    for (int i = 0; i < 40; i++)
        put("tank", 20000.0 + 50.0 * i, 25000.0, 0.0, FORCE_BLUE);
    output.rate_ps = 4; /* of 8 that the heartbeat needs */
    for (int i = 0; i < 400; i++) {
        pass();
        for (int k = 0; k < count; k++)
            seen[received[k].entity_state.id.entity] = true;
        now_ns += 50000000u;
    }
    for (int i = 1; i <= 40; i++)
        assert_true(seen[i]);
}

/* What turns without end leaves the others their turns: it is not followed when the rate does not
 * suffice. */
static void test_a_rate_for_all_and_what_turns(void **state)
{
    int seen[42] = {0};
    (void)state;
    put("helicopter", 20000.0, 24000.0, 0.0, FORCE_BLUE);
    for (int i = 0; i < 40; i++)
        put("tank", 20000.0 + 50.0 * i, 25000.0, 0.0, FORCE_BLUE);
    output.rate_ps = 20; /* 8 are heartbeats, and the helicopter wants one in each frame */
    for (int i = 0; i < 1200; i++) {
        struct state committed = fixture_state(&world);
        next_frame(0, i % 2 * 10.0 * RAD_PER_DEG, committed.entities.row[0].x);
        if (i % 3 == 0)
            pass();
        else
            entity_output_follow(&entities, &world.view, now_ns);
        if (i % 3 != 0)
            receive();
        for (int k = 0; k < count; k++)
            seen[received[k].entity_state.id.entity]++;
    }
    print_message("of 20 a second for 20 s: %d of what turns\n", seen[1]);
    for (int i = 1; i <= 41; i++)
        assert_true(seen[i] >= 3);
}

/* A turn about each axis of the body has the sign of DIS: roll to the right, nose up, clockwise. */
static void test_angular_velocities(void **state)
{
    (void)state;
    put("jet", 20000.0, 25000.0, 200.0, FORCE_BLUE);
    for (int axis = 0; axis < 3; axis++) {
        struct state committed = fixture_state(&world);
        const struct entities *e = &committed.entities;
        double *angle = axis == 0   ? &e->row[0].roll
                        : axis == 1 ? &e->row[0].pitch
                                    : &e->row[0].heading;
        e->row[0].roll = e->row[0].pitch = e->row[0].heading = 0.0;
        for (int i = 0; i < 6; i++) { /* 0.02 rad in three frames: 0.4 rad/s */
            *angle += 0.02;
            committed.head->tick += 3;
            state_seal(&committed, world.view.world.counts.fixed);
            now_ns += 3 * FRAME_NS;
            pass();
        }
        now_ns += 6000000000u; /* the heartbeat at the latest */
        *angle += 0.02;
        committed.head->tick += 3;
        state_seal(&committed, world.view.world.counts.fixed);
        pass();
        assert_int_equal(count, 1);
        for (int k = 0; k < 3; k++)
            assert_true(fabs((double)received[0].entity_state.angular_velocity[k] -
                             (k == axis ? 0.4 : 0.0)) < 0.01);
    }
}

/* A gateway that starts anew sends the same, and what it left behind can be taken back. */
static void test_a_new_gateway_says_the_same(void **state)
{
    static struct pdu first;
    (void)state;
    put("tank", 26000.0, 25000.0, 0.0, FORCE_RED);
    pass();
    first = received[0];
    close_output();
    open_output(1000);
    pass();
    assert_int_equal(count, 1);
    assert_memory_equal(&first.entity_state, &received[0].entity_state, sizeof first.entity_state);
    entity_output_deactivate(&entities, &world.view, now_ns);
    receive();
    assert_int_equal(count, 1);
    assert_true(received[0].entity_state.appearance & PDU_APPEARANCE_DEACTIVATED);
    assert_string_equal(received[0].entity_state.marking, first.entity_state.marking);
    entity_output_deactivate(&entities, &world.view, now_ns);
    receive();
    assert_int_equal(count, 0);
}

static void test_an_id_beyond_the_range(void **state)
{
    (void)state;
    uint32_t row = put("tank", 26000.0, 25000.0, 0.0, FORCE_RED);
    entities.ids.applications = 0;
    pass();
    assert_int_equal(count, 0);
    assert_true(entities.refused > 0);
    entities.ids.applications = 1;
    pass();
    assert_int_equal(count, 1);
    assert_int_equal(received[0].entity_state.id.entity, row + 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_vehicle_is_sent_once),
        TEST(test_changes_of_what_stands),
        TEST(test_parts_count_their_changes),
        TEST(test_the_heartbeat),
        TEST(test_a_constant_course),
        TEST(test_receivers_have_it_within_the_threshold),
        TEST(test_what_turns_is_followed),
        TEST(test_the_time_stamp_is_of_the_frame),
        TEST(test_a_missile_comes_and_goes),
        TEST(test_a_pause_freezes),
        TEST(test_a_lost_state_is_made_good),
        TEST(test_the_noise_of_the_clock),
        TEST(test_a_world_that_falls_behind),
        TEST(test_the_rate),
        TEST(test_a_rate_for_all_and_what_turns),
        TEST(test_a_rate_that_never_suffices),
        TEST(test_angular_velocities),
        TEST(test_a_new_gateway_says_the_same),
        TEST(test_an_id_beyond_the_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
