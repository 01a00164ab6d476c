/* PDUs of events: a shot and its detonation, a collision, the rate, and what a gateway that starts
 * anew sends again. A receiver on the loopback reads them. */
#include "gateway/event_output.h"

#include "gateway/pdu/pdu_read.h"
#include "gateway/udp/udp_socket.h"
#include "tests/support/remotes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#define RECEIVED_MAX 256
#define PERIOD_NS    50000000u

static struct fixture world;
static struct entity_output entities;
static struct event_output events;
static struct pdu_output output;
static struct type_table types;
static struct error_text error;
static struct pdu received[RECEIVED_MAX];
static int listener, count;
static uint64_t now_ns = 1000000000000u;

static void open_world(const char *text)
{
    struct udp_address at;
    socklen_t length = sizeof at;
    char path[512];
    fixture_open(&world, text);
    memset(&entities, 0, sizeof entities);
    memset(&events, 0, sizeof events);
    output = (struct pdu_output){.version = 6, .exercise = 1};
    assert_int_equal(udp_address_parse(&at, "127.0.0.1", 3000, &error), 0);
    at.v4.sin_port = 0;
    listener = udp_socket_listener(&at, 0, &error);
    assert_int_equal(getsockname(listener, &at.any, &length), 0);
    assert_int_equal(
        pdu_output_open(&output, "127.0.0.1", udp_address_port(&at), 0, 100000, &error), 0);
    snprintf(path, sizeof path, "%s/dis/types.txt", fixture_shipped_dir());
    assert_int_equal(type_table_read(&types, path, world.view.world.kinds,
                                     world.view.world.counts.kinds, &error),
                     0);
    entities.output = events.output = &output;
    entities.types = &types;
    entities.ids = (struct entity_ids){1991, 36, 2};
    events.entities = &entities;
    local_frame_make(&entities.frame, 35.95, -121.25, -33.7, 25000.0, 25000.0);
    assert_int_equal(entity_output_open(&entities, &world.view, &error), 0);
    event_output_open(&events, &world.view, 0);
}

static int close_world(void **state)
{
    (void)state;
    entity_output_close(&entities);
    close(output.udp.socket);
    close(listener);
    fixture_close(&world);
    return 0;
}

/* Sends entities and events, and keeps what is of the type. */
static void pass(uint8_t type)
{
    static uint8_t bytes[2048];
    struct udp_address from;
    int size;
    now_ns += PERIOD_NS;
    assert_true(entity_output_look(&entities, &world.view, now_ns));
    entity_output_send(&entities, &world.view, now_ns);
    event_output_send(&events, &world.view, now_ns);
    count = 0;
    while ((size = udp_socket_receive(listener, bytes, sizeof bytes, &from)) >= 0) {
        struct pdu_cursor cursor = {bytes, (size_t)size, 0};
        assert_true(count < RECEIVED_MAX);
        assert_int_equal(pdu_read(&cursor, &received[count]), PDU_GOOD);
        count += received[count].header.type == type;
    }
}

/* Runs frames until a PDU of the type comes. */
static void run_until(uint8_t type)
{
    for (int i = 0; i < 600; i++) {
        fixture_run(&world, 3);
        pass(type);
        if (count > 0)
            return;
    }
    fail_msg("no PDU of type %u came", type);
}

static struct vec3 world_of(const double location[3])
{
    return local_frame_world(&entities.frame, (struct vec3){location[0], location[1], location[2]});
}

static struct vec3 direction_of(const float velocity[3])
{
    return rotation_back(
        &entities.frame.axes,
        (struct vec3){(double)velocity[0], (double)velocity[1], (double)velocity[2]});
}

static const char duel[] =
    "vehicles = ({ kind = \"tank\"; name = \"T1\"; at = [25000.0, 25000.0]; heading_deg = 90.0;"
    "  behaviour = \"hold\"; force = \"blue\"; },"
    "  { kind = \"tank\"; name = \"T2\"; at = [25600.0, 25000.0]; heading_deg = 270.0;"
    "  behaviour = \"hold\"; force = \"red\"; });"
    "fires = ({ at_s = 0.5; shooter = \"T1\"; target = \"T2\"; });";

static void test_a_shot_and_its_detonation(void **state)
{
    (void)state;
    open_world(duel);
    run_until(PDU_FIRE);
    assert_int_equal(count, 1);
    const struct pdu_fire fire = received[0].fire;
    assert_int_equal(fire.firer.entity, 1);
    assert_int_equal(fire.target.entity, 2);
    assert_int_equal(fire.munition.entity, 0); /* a round is no entity of DIS */
    assert_int_equal(fire.munition.site, 0);
    assert_int_equal(fire.event.site, 1991);
    assert_int_equal(fire.munition_type.category, 2);
    assert_int_equal(fire.warhead, 5000);
    assert_int_equal(fire.quantity, 1);
    assert_true(fabs((double)fire.range - 600.0) < 15.0);
    assert_true(vec3_length((struct vec3){(double)fire.velocity[0], (double)fire.velocity[1],
                                          (double)fire.velocity[2]}) > 1000.0);
    struct vec3 muzzle = world_of(fire.location);
    const struct event *event = fixture_event(&world, EVENT_FIRE, 0);
    assert_non_null(event);
    assert_true(fabs(muzzle.x - event->fire.point[0]) < 1e-6);
    assert_int_equal(fire.event.entity, event->fire.munition.id);

    run_until(PDU_DETONATION);
    assert_int_equal(count, 1);
    const struct pdu_detonation *detonation = &received[0].detonation;
    assert_memory_equal(&detonation->event, &fire.event, sizeof fire.event);
    assert_int_equal(detonation->firer.entity, 1);
    assert_int_equal(detonation->fuse, 1000);
    struct vec3 speed = direction_of(detonation->velocity);
    assert_true(speed.x > 1000.0 && fabs(speed.z) < 50.0); /* the round itself is gone */
    event = fixture_event(&world, EVENT_DETONATION, 0);
    struct vec3 place = world_of(detonation->location);
    assert_true(fabs(place.x - event->detonation.point[0]) < 1e-6);
    assert_int_equal(event->detonation.struck, STRUCK_VEHICLE);
    assert_int_equal(detonation->result, PDU_RESULT_ENTITY_IMPACT);
    assert_int_equal(detonation->target.entity, 2);
    /* T2 has its front to the west, from where the round came. */
    assert_true(detonation->point[0] > 0.0f && detonation->point[0] < 10.0f);
    pass(PDU_DETONATION);
    assert_int_equal(count, 0);
}

static void test_a_collision_of_two(void **state)
{
    (void)state;
    open_world("vehicles = ({ kind = \"jeep\"; at = [25000.0, 25000.0]; heading_deg = 90.0;"
               "  speed_mps = 12.0; behaviour = \"hold\"; },"
               "  { kind = \"truck\"; at = [25040.0, 25000.0]; heading_deg = 270.0;"
               "  speed_mps = 12.0; behaviour = \"hold\"; });");
    run_until(PDU_COLLISION);
    assert_true(count >= 2 && count % 2 == 0);
    const struct pdu_collision *a = &received[0].collision, *b = &received[1].collision;
    assert_int_equal(a->issuer.entity + b->issuer.entity, 3);
    assert_int_equal(a->issuer.entity, b->other.entity);
    assert_int_equal(a->other.entity, b->issuer.entity);
    assert_int_equal(a->event.entity, b->event.entity);
    const struct kind *kinds = world.view.world.kinds;
    float jeep = (float)kinds[fixture_kind(&world, "jeep")].mass_kg;
    float truck = (float)kinds[fixture_kind(&world, "truck")].mass_kg;
    assert_true(a->mass + b->mass == jeep + truck);
    /* Each has the velocity with which they met, not that by which they parted. */
    for (uint32_t i = 0; i < 2; i++) {
        double east = received[i].collision.mass == jeep ? 12.0 : -12.0;
        struct vec3 velocity = direction_of(received[i].collision.velocity);
        assert_true(fabs(velocity.x - east) < 0.5 && fabs(velocity.z) < 0.1);
    }
    /* The point is at the front of the other one. */
    assert_true(a->point[0] > 0.0f && a->point[0] < 10.0f);
}

/* What a predecessor has sent is not sent again; what it did not come to is. Who fired is found
 * again in the ring. */
static void test_a_new_gateway(void **state)
{
    (void)state;
    open_world(duel);
    run_until(PDU_FIRE);
    uint64_t sent_to = events.frame;
    assert_int_equal(sent_to, fixture_state(&world).head->frame);
    event_output_open(&events, &world.view, sent_to);
    pass(PDU_FIRE);
    assert_int_equal(count, 0);
    event_output_open(&events, &world.view, sent_to - 10);
    pass(PDU_FIRE);
    assert_int_equal(count, 1);
    memset(&events.shot, 0, sizeof events.shot);
    event_output_open(&events, &world.view, sent_to);
    run_until(PDU_DETONATION);
    assert_int_equal(received[0].detonation.firer.entity, 1);
}

/* A rate that does not suffice puts events off, and loses none. */
static void test_the_rate(void **state)
{
    int total = 0;
    (void)state;
    open_world(duel);
    run_until(PDU_FIRE);
    output.rate_ps = 1;
    uint64_t before = events.frame;
    for (int i = 0; i < 3; i++) { /* uses the rate up */
        now_ns += PERIOD_NS;
        while (pdu_output_take(&output, PDU_OUTPUT_EVENT, now_ns))
            continue;
    }
    for (int i = 0; i < 40; i++) {
        fixture_run(&world, 3);
        while (pdu_output_take(&output, PDU_OUTPUT_EVENT, now_ns + PERIOD_NS))
            continue;
        pass(PDU_DETONATION);
        total += count;
    }
    assert_int_equal(total, 0);
    assert_true(events.postponed > 30 && events.waiting > 0); /* which the log tells */
    assert_true(events.frame >= before);
    assert_true(events.frame < fixture_state(&world).head->frame);
    output.rate_ps = 1000;
    output.rate = (struct rate){0};
    pass(PDU_DETONATION);
    assert_int_equal(count, 1);
    assert_int_equal(events.frame, fixture_state(&world).head->frame);
}

/* Entity States that have used their share up leave some for events, and those for answers. */
static void test_what_is_sent_first(void **state)
{
    static const uint32_t rates[] = {1, 60, 5000};
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        struct pdu_output one = {.rate_ps = rates[i]};
        unsigned count_of[3] = {0, 0, 0};
        for (int weight = PDU_OUTPUT_STATE; weight <= PDU_OUTPUT_ANSWER; weight++) {
            while (pdu_output_take(&one, (enum pdu_output_weight)weight, now_ns))
                count_of[weight]++;
        }
        assert_true(count_of[PDU_OUTPUT_STATE] > 0 && count_of[PDU_OUTPUT_ANSWER] > 0);
        assert_true(rates[i] == 1 || count_of[PDU_OUTPUT_EVENT] > 0);
        assert_in_range(count_of[0] + count_of[1] + count_of[2], 1, rates[i] / 3 + 2);
    }
}

#define REMOTE_ID remote_id(7, 1, 9)

static int count_of(uint8_t type)
{
    int found = 0;
    for (int i = 0; i < count; i++)
        found += received[i].header.type == type;
    return found;
}

/* Of another simulator's tank we tell what our shell does to it, by its own identifier. */
static void test_a_hit_on_a_remote_entity(void **state)
{
    static const char text[] =
        "world = { seed = 1; capacity = 64; remotes_max = 4; };"
        "vehicles = ({ kind = \"tank\"; at = [25000.0, 25000.0]; heading_deg = 90.0;"
        "  behaviour = \"hold\"; force = \"blue\"; });";
    (void)state;
    open_world(text);
    remotes_send(&world, remotes_track(&world, REMOTE_ID, (struct vec3){25300.0, 100.0, 25000.0}));
    fixture_run(&world, 1);
    pass(PDU_ENTITY_STATE);
    assert_int_equal(count, 1); /* of ours alone */
    steps_aim(&world, 0, remotes_row(&world, REMOTE_ID));
    steps_send(&world, RING_CLIENTS,
               (struct command){.type = COMMAND_FIRE, .entity = 1, .target = 2});
    run_until(PDU_FIRE);
    assert_int_equal(received[0].fire.target.site, 7);
    assert_int_equal(received[0].fire.target.application, 1);
    assert_int_equal(received[0].fire.target.entity, 9);
    run_until(PDU_DETONATION);
    if (received[0].detonation.result == PDU_RESULT_ENTITY_IMPACT)
        assert_int_equal(received[0].detonation.target.entity, 9);
}

static void test_a_collision_with_a_remote_entity(void **state)
{
    static const char text[] =
        "world = { seed = 1; capacity = 64; remotes_max = 4; };"
        "vehicles = ({ kind = \"tank\"; at = [25000.0, 25000.0]; heading_deg = 90.0;"
        "  speed_mps = 15.0; behaviour = \"hold\"; force = \"blue\"; });";
    (void)state;
    open_world(text);
    remotes_send(&world, remotes_track(&world, REMOTE_ID, (struct vec3){25020.0, 100.0, 25000.0}));
    static struct remote_input remotes;
    memset(&remotes, 0, sizeof remotes);
    events.remotes = &remotes;
    run_until(PDU_COLLISION);
    assert_true(remotes.met_count > 0); /* the way in knows of it */
    assert_true(remotes.met[0].remote == REMOTE_ID && remotes.met[0].entity == 1);
    assert_int_equal(count, 1); /* theirs is told by its owner */
    assert_int_equal(received[0].collision.issuer.site, 1991);
    assert_int_equal(received[0].collision.other.site, 7);
    assert_int_equal(received[0].collision.other.entity, 9);
    assert_true(fabs(direction_of(received[0].collision.velocity).x - 15.0) < 0.5);
}

static double speed_of_shot(double time_scale)
{
    open_world(duel);
    for (int w = 0; w < 2; w++) {
        struct state_head *head = world.view.w[w].head;
        head->time_scale = time_scale;
        head->checksum = state_checksum(&world.view.w[w], world.view.header->counts.fixed);
    }
    run_until(PDU_FIRE);
    double speed = vec3_length(direction_of(received[0].fire.velocity));
    close_world(NULL);
    return speed;
}

/* At four times the rate of time a round flies four times as fast by the clock. */
static void test_velocities_are_by_the_clock(void **state)
{
    (void)state;
    double usual = speed_of_shot(1.0);
    assert_true(fabs(speed_of_shot(4.0) - 4.0 * usual) < 1e-3 * usual);
}

static void test_what_others_told_is_not_told_again(void **state)
{
    (void)state;
    open_world("world = { seed = 1; capacity = 64; remotes_max = 4; };"
               "vehicles = ({ kind = \"tank\"; at = [26000.0, 25000.0]; heading_deg = 90.0; });");
    struct remote_record record =
        remotes_track(&world, REMOTE_ID, (struct vec3){25020.0, 100.0, 25000.0});
    remotes_send(&world, record);
    record.type = REMOTE_FIRE;
    record.kind = fixture_kind(&world, "artillery");
    remotes_send(&world, record);
    record.type = REMOTE_STRUCK;
    remotes_send(&world, record);
    struct remote_record body = {.remote = REMOTE_ID,
                                 .type = REMOTE_STRUCK,
                                 .slot = SLOT_NONE,
                                 .entity = 1,
                                 .kind = KIND_NONE,
                                 .velocity = {-20.0f, 0.0f, 0.0f},
                                 .position = {2.0, 0.0, 0.0},
                                 .mass_kg = 1000.0f};
    remotes_send(&world, body);
    fixture_run(&world, 5);
    assert_true(fixture_event_count(&world, EVENT_COLLISION) > 0);
    assert_int_equal(fixture_event_count(&world, EVENT_FIRE), 1);
    assert_int_equal(fixture_event_count(&world, EVENT_DETONATION), 1);
    pass(PDU_FIRE);
    assert_int_equal(
        count_of(PDU_FIRE) + count_of(PDU_DETONATION) + count_of(PDU_COLLISION) + count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_a_shot_and_its_detonation, close_world),
        cmocka_unit_test_teardown(test_a_collision_of_two, close_world),
        cmocka_unit_test_teardown(test_a_new_gateway, close_world),
        cmocka_unit_test_teardown(test_the_rate, close_world),
        cmocka_unit_test(test_what_is_sent_first),
        cmocka_unit_test_teardown(test_a_hit_on_a_remote_entity, close_world),
        cmocka_unit_test_teardown(test_a_collision_with_a_remote_entity, close_world),
        cmocka_unit_test(test_velocities_are_by_the_clock),
        cmocka_unit_test_teardown(test_what_others_told_is_not_told_again, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
