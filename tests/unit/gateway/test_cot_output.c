/* Events of Cursor on Target: what a receiver on the loopback gets of a small world beside the
 * Entity States. */
#include "gateway/cot_event.h"
#include "gateway/entity_output.h"

#include "gateway/udp/udp_socket.h"
#include "tests/support/fixture.h"
#include "world/checksum.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#define RECEIVED_MAX 64

static struct fixture world;
static struct entity_output entities;
static struct pdu_output output;
static struct cot_output cot;
static struct type_table types;
static struct error_text error;
static char received[RECEIVED_MAX][COT_EVENT_BYTES + 1];
static int listener, count;
static uint64_t now_ns;

static int set_up(void **state)
{
    char path[512], to[UDP_ADDRESS_TEXT];
    struct udp_address at;
    socklen_t length = sizeof at;
    (void)state;
    fixture_open(&world, "vehicles = ();");
    const struct world *w = &world.view.world;
    memset(&entities, 0, sizeof entities);
    now_ns = 1000000000000u;
    output = (struct pdu_output){.version = 7, .exercise = 3};
    assert_int_equal(udp_address_parse(&at, "127.0.0.1", 3000, &error), 0);
    at.v4.sin_port = 0;
    listener = udp_socket_listener(&at, 0, &error);
    assert_true(listener >= 0);
    assert_int_equal(getsockname(listener, &at.any, &length), 0);
    assert_int_equal(cot_output_open(&cot, udp_address_text(&at, to, sizeof to), 0, 3, &error), 0);
    assert_int_equal(pdu_output_open(&output, "127.0.0.1", 9, 0, 100000, &error), 0);
    snprintf(path, sizeof path, "%s/dis/types.txt", fixture_shipped_dir());
    assert_int_equal(type_table_read(&types, path, w->kinds, w->counts.kinds, &error), 0);
    entities.output = &output;
    entities.cot = &cot;
    entities.types = &types;
    entities.ids = (struct entity_ids){1991, 36, 2};
    local_frame_make(&entities.frame, 35.95, -121.25, -33.7, 25000.0, 25000.0);
    assert_int_equal(entity_output_open(&entities, &world.view, &error), 0);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    entity_output_close(&entities);
    close(output.udp.socket);
    close(cot.udp.socket);
    close(listener);
    fixture_close(&world);
    return 0;
}

static void receive(void)
{
    struct udp_address from;
    int size;
    for (count = 0; count < RECEIVED_MAX; count++) {
        size = udp_socket_receive(listener, received[count], COT_EVENT_BYTES, &from);
        if (size < 0)
            return;
        received[count][size] = '\0';
    }
}

static void pass(void)
{
    assert_true(entity_output_look(&entities, &world.view, now_ns));
    entity_output_send(&entities, &world.view, now_ns);
    receive();
}

static void assert_has(int i, const char *text)
{
    if (!strstr(received[i], text))
        fail_msg("%s has no %s", received[i], text);
}

/* Returns the number behind NAME=" in an event. */
static double number(int i, const char *name)
{
    const char *at = strstr(received[i], name);
    assert_non_null(at);
    return strtod(at + strlen(name), NULL);
}

static uint32_t put(const char *kind, double x, double z, struct vec3 velocity, enum force force)
{
    return fixture_put(
        &world, (struct fixture_entity){
                    .kind = kind, .at = {x, 101.0, z}, .velocity = velocity, .force = force});
}

static void test_places_and_types(void **state)
{
    (void)state;
    put("tank", 25000.0, 25000.0, (struct vec3){10.0, 0.0, -10.0}, FORCE_BLUE);
    put("jet", 45000.0, 25000.0, (struct vec3){0.0, 0.0, -200.0}, FORCE_RED);
    put("shell", 25000.0, 20000.0, (struct vec3){0}, FORCE_RED); /* no entity */
    pass();
    assert_int_equal(count, 2);
    assert_has(0, "uid=\"jolon.3.1991.36.1\" type=\"a-f-G-E-V-A-T\"");
    assert_has(0, "callsign=\"tank 1\"");
    assert_has(1, "type=\"a-h-A-M-F-F\"");
    assert_true(fabs(number(0, "lat=\"") - 35.95) < 2e-7);
    assert_true(fabs(number(0, "lon=\"") + 121.25) < 2e-7);
    assert_true(fabs(number(0, "hae=\"") - (101.0 - 33.7)) < 0.01);
    assert_true(fabs(number(0, "course=\"") - 45.0) < 0.01);
    assert_true(fabs(number(0, "speed=\"") - sqrt(200.0)) < 0.01);
    /* 20 km east of the middle north points 0.13 degrees to the left; the plane is 31 m too high.
     */
    assert_true(fabs(number(1, "course=\"") - 0.13) < 0.01);
    assert_true(fabs(number(1, "hae=\"") - (101.0 - 33.7 + 31.3)) < 0.3);
    pass();
    assert_int_equal(count, 0);
}

/* Sets the damage of the vehicle in row 0. */
static void set_damage(uint8_t damage)
{
    struct state committed = fixture_state(&world);
    committed.entities.row[0].damage = damage;
    committed.head->tick += 3;
    state_seal(&committed, world.view.world.counts.fixed);
    now_ns += 6000000000u; /* the heartbeat at the latest */
}

static void test_the_dead_are_taken_off(void **state)
{
    (void)state;
    put("tank", 25000.0, 25000.0, (struct vec3){0}, FORCE_NEUTRAL);
    pass();
    assert_has(0, "type=\"a-n-G-E-V-A-T\"");
    set_damage(DAMAGE_MED);
    pass();
    assert_int_equal(count, 1);
    assert_has(0, "type=\"a-n-G-E-V-A-T\"");
    set_damage(DAMAGE_DESTROYED);
    pass();
    assert_int_equal(count, 1);
    assert_has(0, "type=\"t-x-d-d\"");
    assert_has(0, "<link uid=\"jolon.3.1991.36.1\" relation=\"none\" type=\"a-n-G-E-V-A-T\"/>");
    assert_has(0, "<__forcedelete/>");
    uint64_t before = output.udp.sent;
    now_ns += 6000000000u;
    pass();
    assert_int_equal(output.udp.sent, before + 1); /* DIS shows the wreck, */
    assert_int_equal(count, 0);                    /* Cursor on Target does not */
    entity_output_deactivate(&entities, &world.view, now_ns);
    receive();
    assert_int_equal(count, 0);
}

static void test_the_end_takes_all_off(void **state)
{
    (void)state;
    put("tank", 25000.0, 25000.0, (struct vec3){0}, FORCE_BLUE);
    put("jeep", 25000.0, 24000.0, (struct vec3){0}, FORCE_RED);
    pass();
    assert_int_equal(count, 2);
    entity_output_deactivate(&entities, &world.view, now_ns);
    receive();
    assert_int_equal(count, 2);
    assert_has(0, "type=\"t-x-d-d\"");
    assert_has(1, "type=\"a-h-G-E-V-U\"/>");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_places_and_types),
        TEST(test_the_dead_are_taken_off),
        TEST(test_the_end_takes_all_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
