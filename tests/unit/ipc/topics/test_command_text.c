/* Orders: the arguments that a verb takes and needs, and errors that say what would be right. */
#include "ipc/topics/command_json.h"

#include "world/terrain/gridsquare.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct error_text error;

static int read_order(struct command_text *order, const char *text)
{
    cJSON *object = cJSON_Parse(text);
    int result = command_from_json(order, object, &error);
    cJSON_Delete(object);
    return result;
}

static void refused(const char *text, const char *words)
{
    struct command_text order;
    assert_int_equal(read_order(&order, text), -1);
    if (!strstr(error.text, words))
        fail_msg("%s: \"%s\" is not in \"%s\"", text, words, error.text);
}

static void test_all_controls(void **state)
{
    struct command_text order;
    (void)state;
    assert_int_equal(read_order(&order,
                                "{\"do\":\"drive\",\"id\":[1],\"vehicle\":7,\"throttle\":0.5,"
                                "\"steer\":-1,\"climb\":0.25,\"traverse\":1,\"elevate\":-0.5,"
                                "\"brake\":1,\"gear\":\"reverse\",\"lease_s\":1.5}"),
                     0);
    const jolon_Command *c = &order.command;
    assert_int_equal(c->type, jolon_COMMAND_DRIVE);
    assert_int_equal(c->entity, 7);
    assert_true(c->throttle == 0.5F && c->steer == -1.0F && c->climb == 0.25F);
    assert_true(c->traverse == 1.0F && c->elevate == -0.5F && c->brake == 1.0F);
    assert_int_equal(c->gear, jolon_GEAR_REVERSE);
    assert_true(command_text_needs_hz(&order) && !command_text_needs_names(&order));
    assert_int_equal(command_text_resolve(&order, &(struct name_table){0}, 60.0, &error), 0);
    assert_int_equal(order.command.lease_frames, 90);
}

static void test_a_lease_is_at_least_a_frame_and_at_most_what_a_command_holds(void **state)
{
    struct command_text order = {.lease_s = 0.1};
    (void)state;
    assert_int_equal(command_text_resolve(&order, &(struct name_table){0}, 1.0, &error), 0);
    assert_int_equal(order.command.lease_frames, 1);
    order.lease_s = 3600.0;
    assert_int_equal(command_text_resolve(&order, &(struct name_table){0}, 1000.0, &error), 0);
    assert_int_equal(order.command.lease_frames, 1000000);
}

static void test_names_become_ids(void **state)
{
    struct command_text order;
    jolon_EntityName entry[] = {{2, "West"}, {5, "East-1"}, {9, "12"}};
    struct name_table names = {.known = true, .count = 3, .entry = entry};
    (void)state;
    assert_int_equal(read_order(&order, "{\"do\":\"fire\",\"vehicle\":\"West\",\"target\":"
                                        "\"East-1\"}"),
                     0);
    assert_int_equal(command_text_resolve(&order, &names, 60.0, &error), 0);
    assert_int_equal(order.command.entity, 2);
    assert_int_equal(order.command.target, 5);
    assert_int_equal(read_order(&order, "{\"do\":\"remove\",\"vehicle\":\"12\"}"), 0);
    assert_int_equal(command_text_resolve(&order, &names, 60.0, &error), 0);
    assert_int_equal(order.command.entity, 9);
    assert_int_equal(read_order(&order, "{\"do\":\"remove\",\"vehicle\":\"Est-1\"}"), 0);
    assert_int_equal(command_text_resolve(&order, &names, 60.0, &error), -1);
    assert_non_null(strstr(error.text, "the nearest is East-1"));
    names.count = 0;
    assert_int_equal(command_text_resolve(&order, &names, 60.0, &error), -1);
    assert_non_null(strstr(error.text, "say its id"));
}

static void test_a_command_line_gives_numbers_as_text(void **state)
{
    struct command_text order;
    struct command_text_value value = {.text = "12", .loose = true};
    (void)state;
    assert_int_equal(command_text_begin(&order, "drive", &error), 0);
    assert_int_equal(command_text_give(&order, COMMAND_TEXT_VEHICLE, &value, &error), 0);
    assert_int_equal(order.command.entity, 12);
    assert_int_equal(command_text_give(&order, COMMAND_TEXT_VEHICLE, &value, &error), -1);
    value.text = "-0.5";
    assert_int_equal(command_text_give(&order, COMMAND_TEXT_STEER, &value, &error), 0);
    assert_true(order.command.steer == -0.5F);
    value.text = "0x";
    assert_int_equal(command_text_give(&order, COMMAND_TEXT_CLIMB, &value, &error), -1);
    value = (struct command_text_value){.text = "0.5"};
    assert_int_equal(command_text_give(&order, COMMAND_TEXT_CLIMB, &value, &error), -1);
}

static void test_wrong_arguments_are_named(void **state)
{
    (void)state;
    refused("[]", "not an object");
    refused("{}", "it has no \"do\"");
    refused("{\"do\":\"drvie\"}", "did you mean drive?");
    refused("{\"do\":\"x\"}", "there are pause, resume");
    refused("{\"do\":\"drive\"}", "drive: vehicle is missing");
    refused("{\"do\":\"drive\",\"vehicle\":0}", "vehicle: 0: not a whole number from 1");
    refused("{\"do\":\"drive\",\"vehicle\":1.5}", "vehicle: 1.5: not a whole number");
    refused("{\"do\":\"drive\",\"vehicle\":true}", "true: not the id or the name of a vehicle");
    refused("{\"do\":\"drive\",\"vehicle\":\"a name of 24 letters, too long\"}", "of 1 to 23");
    refused("{\"do\":\"drive\",\"vehicle\":1,\"throttle\":2}", "not a number from -1 to 1");
    refused("{\"do\":\"drive\",\"vehicle\":1,\"throttle\":\"1\"}", "'1': not a number");
    refused("{\"do\":\"drive\",\"vehicle\":1,\"throttle\":1e999}", "not a number from -1 to 1");
    refused("{\"do\":\"drive\",\"vehicle\":1,\"throttle\":null}", "not a number, a text");
    refused("{\"do\":\"drive\",\"vehicle\":1,\"gear\":\"fast\"}", "automatic, reverse, neutral");
    refused("{\"do\":\"drive\",\"vehicle\":1,\"target\":2}", "it takes vehicle, throttle, steer");
    refused("{\"do\":\"drive\",\"vehicle\":1,\"steer\":0,\"steer\":0}", "given twice");
    refused("{\"do\":\"pause\",\"frames\":2}", "it takes none");
    refused("{\"do\":\"release\",\"vehicle\":1,\"anyway\":1}", "1: not true or false");
    refused("{\"do\":\"spawn\",\"kind\":\"tank\",\"x\":1}", "z is missing");
    refused("{\"do\":\"spawn\",\"kind\":\"tank\",\"x\":1,\"z\":2,\"behaviour\":\"flee\"}",
            "idle, hold, patrol");
    refused("{\"do\":\"fire\"}", "either a vehicle");
    refused("{\"do\":\"fire\",\"vehicle\":1,\"munition\":\"shell\"}", "either a vehicle");
    refused("{\"do\":\"fire\",\"target\":1}", "either a vehicle");
    refused("{\"do\":\"fire\",\"vehicle\":1,\"rounds\":2}", "either a vehicle");
    refused("{\"do\":\"mission\",\"munition\":\"shell\",\"x\":1,\"z\":1,\"rounds\":1001}",
            "whole number from 1 to 1000");
}

static void test_a_mission_falls_about_its_middle(void **state)
{
    struct command_text order;
    uint32_t inner = 0;
    (void)state;
    assert_int_equal(read_order(&order, "{\"do\":\"mission\",\"munition\":\"shell\",\"x\":25000,"
                                        "\"z\":24000,\"rounds\":1000,\"radius_m\":80,\"seed\":11}"),
                     0);
    for (uint32_t i = 0; i < order.rounds; i++) {
        jolon_Command round = command_text_round(&order, order.seed, i);
        double dx = round.x_m - 25000.0, dz = round.z_m - 24000.0;
        assert_true(dx * dx + dz * dz <= 80.0 * 80.0 + 1e-6);
        inner += dx * dx + dz * dz < 80.0 * 80.0 / 2.0;
    }
    assert_in_range(inner, 430, 570); /* half of the area */
    jolon_Command first = command_text_round(&order, 11, 0),
                  second = command_text_round(&order, 11, 1);
    assert_true(first.x_m != second.x_m);
    assert_true(command_text_round(&order, 12, 0).x_m != first.x_m);
    assert_true(!(command_text_round(&order, 11, 0).x_m != first.x_m));
    order.command.x_m = order.command.z_m = 0.0;
    for (uint32_t i = 0; i < order.rounds; i++) {
        jolon_Command round = command_text_round(&order, 11, i);
        assert_true(round.x_m >= 0.0 && round.z_m >= 0.0 && round.x_m <= WORLD_SIDE_DEFAULT_M);
    }
}

static void test_every_verb_has_all_that_it_needs_among_what_it_takes(void **state)
{
    (void)state;
    for (size_t i = 0; command_text_verb(i); i++) {
        struct command_text order;
        const struct command_text_verb *verb = command_text_verb(i);
        assert_int_equal(verb->needed & ~verb->allowed, 0);
        assert_int_equal(command_text_begin(&order, verb->name, &error), 0);
        assert_int_equal(order.verb->type, verb->type);
    }
    for (int i = 0; i < COMMAND_TEXT_FIELD_COUNT; i++)
        assert_int_equal(command_text_field(command_text_field_name((enum command_text_field)i)),
                         i);
    assert_int_equal(command_text_field("nothing"), COMMAND_TEXT_FIELD_COUNT);
}

static void test_a_place_gives_x_and_z(void **state)
{
    struct command_text order;
    struct location_frame frame;
    (void)state;
    location_frame_make(&frame, 44.2705, -71.3033, WORLD_SIDE_DEFAULT_M);
    assert_int_equal(
        read_order(&order, "{\"do\":\"spawn\",\"kind\":\"jeep\",\"at\":\"100,200.5\"}"), 0);
    assert_false(command_text_needs_place(&order));
    assert_true(order.command.x_m == 100.0 && order.command.z_m == 200.5);
    static const char *const places[] = {"44.2705N,71.3033W", "19TCK1617404497"};
    for (int i = 0; i < 2; i++) {
        char text[120];
        (void)snprintf(text, sizeof text,
                       "{\"do\":\"mission\",\"munition\":\"shell\",\"at\":\"%s\"}", places[i]);
        assert_int_equal(read_order(&order, text), 0);
        assert_true(command_text_needs_place(&order));
        assert_int_equal(command_text_place(&order, &frame, &error), 0);
        assert_false(command_text_needs_place(&order));
        assert_true(fabs(order.command.x_m - 25000.0) < 1.0);
        assert_true(fabs(order.command.z_m - 25000.0) < 1.0);
    }
    location_frame_make(&frame, 35.95, -121.25, WORLD_SIDE_DEFAULT_M);
    assert_int_equal(
        read_order(&order, "{\"do\":\"spawn\",\"kind\":\"jeep\",\"at\":\"19TCK1617404497\"}"), 0);
    assert_int_equal(command_text_place(&order, &frame, &error), -1);
    assert_non_null(strstr(error.text, "at: that place is 42"));
    refused("{\"do\":\"spawn\",\"kind\":\"jeep\",\"at\":\"100,600000\"}",
            "at: 600000: not a number from 0 to 500000");
    refused("{\"do\":\"spawn\",\"kind\":\"jeep\",\"at\":[1,2]}", "at: not a number, a text");
    refused("{\"do\":\"spawn\",\"kind\":\"jeep\",\"at\":5}", "at: 5: not a text, as");
    refused("{\"do\":\"spawn\",\"kind\":\"jeep\",\"x\":5,\"at\":\"1,2\"}",
            "at: x and z are given beside it");
    refused("{\"do\":\"spawn\",\"kind\":\"jeep\",\"at\":\"1,2\",\"z\":5}", "z: it is given twice");
    refused("{\"do\":\"pause\",\"at\":\"1,2\"}", "'at': no such argument");
    refused("{\"do\":\"spawn\",\"kind\":\"jeep\"}", "spawn: x is missing");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_controls),
        cmocka_unit_test(test_a_lease_is_at_least_a_frame_and_at_most_what_a_command_holds),
        cmocka_unit_test(test_names_become_ids),
        cmocka_unit_test(test_a_command_line_gives_numbers_as_text),
        cmocka_unit_test(test_wrong_arguments_are_named),
        cmocka_unit_test(test_a_mission_falls_about_its_middle),
        cmocka_unit_test(test_a_place_gives_x_and_z),
        cmocka_unit_test(test_every_verb_has_all_that_it_needs_among_what_it_takes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
