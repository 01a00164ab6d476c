/* The samples that a reporter could have written, and the cleaning of their texts. */
#include "ipc/topics/samples.h"

#include "world/entity/entity.h"

#include "status.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void test_texts_are_cleaned(void **state)
{
    static const struct {
        const char *text, *left;
    } cases[] = {
        {"tank", "tank"},
        {"b\xc3\xa9t\xc3\xa9", "b\xc3\xa9t\xc3\xa9"},
        {"\xe2\x82\xac \xf0\x9f\x9a\x80", "\xe2\x82\xac \xf0\x9f\x9a\x80"},
        {"a\033[2Jb", "a?[2Jb"},
        {"a\nb\x7f", "a?b?"},
        {"\xc2\x9b"
         "0m",
         "??0m"},                          /* a control character of eight bits */
        {"\xc0\xaf\xe0\x80\xaf", "?????"}, /* overlong */
        {"\xed\xa0\x80", "???"},           /* half of a surrogate pair */
        {"\xf4\x90\x80\x80\xff", "?????"}, /* beyond the last code point */
        {"\xe2\x80\xae"
         "abc",
         "???abc"}, /* changes the direction of writing */
        {"cut \xe2\x82", "cut ??"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        jolon_FireEvent fire = {.header = {.sequence = 1}};
        (void)strncpy(fire.target.kind, cases[i].text, sizeof fire.target.kind - 1);
        assert_true(samples_good(TOPIC_FIRE, &fire));
        assert_string_equal(fire.target.kind, cases[i].left);
    }
}

static void test_frames(void **state)
{
    const jolon_FrameStatus good = {.run = 1, .frame = 9, .sim_time_s = 0.1, .hz = 60.0};
    const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, -1.0};
    (void)state;
    jolon_FrameStatus frame = good;
    assert_true(samples_good(TOPIC_FRAME, &frame));
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        frame = good;
        frame.recent.max_ms = bad[i];
        assert_false(samples_good(TOPIC_FRAME, &frame));
        frame = good;
        frame.sim_time_s = bad[i];
        assert_false(samples_good(TOPIC_FRAME, &frame));
    }
    frame = good;
    frame.state = (jolon_RunState)(jolon_RUN_STALLED + 1);
    assert_false(samples_good(TOPIC_FRAME, &frame));
}

static void test_roles_are_those_there_are(void **state)
{
    jolon_ProcessStatus status = {.role = "renderer-4"};
    (void)state;
    assert_true(samples_good(TOPIC_PROCESS, &status));
    (void)strcpy(status.role, "king");
    assert_false(samples_good(TOPIC_PROCESS, &status));
}

static void test_worlds(void **state)
{
    static jolon_WorldInfo world = {.hz = 60.0, .side_m = 50000.0};
    jolon_KindInfo kind = {.name = "tank"};
    (void)state;
    world.kinds._buffer = &kind;
    world.kinds._length = 1;
    assert_true(samples_good(TOPIC_WORLD, &world));
    world.height_m[jolon_MAP_CELLS - 1] = NAN;
    assert_false(samples_good(TOPIC_WORLD, &world));
    world.height_m[jolon_MAP_CELLS - 1] = 0.0F;
    world.side_m = 1e-320;
    assert_false(samples_good(TOPIC_WORLD, &world));
    world.side_m = 50000.0;
    kind.domain = (jolon_Domain)(jolon_DOMAIN_FIXED + 1);
    assert_false(samples_good(TOPIC_WORLD, &world));
}

static void test_batches_fit_together(void **state)
{
    jolon_Entity entity[2] = {{.id = 1}, {.id = 2}};
    const jolon_EntityBatch good = {
        .parts = 1, .total = 2, .entities = {._length = 2, ._buffer = entity}};
    jolon_EntityBatch batch = good;
    (void)state;
    assert_true(samples_good(TOPIC_ENTITIES, &batch));
    batch.part = 1;
    assert_false(samples_good(TOPIC_ENTITIES, &batch));
    batch = good;
    batch.total = 1;
    assert_false(samples_good(TOPIC_ENTITIES, &batch));
    batch.total = UINT32_MAX;
    assert_false(samples_good(TOPIC_ENTITIES, &batch));
    jolon_Degrees place[2] = {{44.3, -71.3}, {-44.3, 71.3}};
    batch = good;
    batch.places._buffer = place;
    batch.places._length = 1;
    assert_false(samples_good(TOPIC_ENTITIES, &batch));
    batch.places._length = batch.entities._length;
    assert_true(samples_good(TOPIC_ENTITIES, &batch));
    place[1].latitude_deg = 90.1;
    assert_false(samples_good(TOPIC_ENTITIES, &batch));
    batch = good;
    entity[1].heading_rad = NAN;
    assert_false(samples_good(TOPIC_ENTITIES, &batch));
}

static void test_motions_fit_together(void **state)
{
    jolon_Entity entity[2] = {{.id = 1}, {.id = 2}};
    uint32_t row[2] = {3, 8};
    jolon_Course course[2] = {{.entity = 0, .lasts_s = 0.5F}, {.entity = 1, .turn_rps = 0.1F}};
    const jolon_MotionBatch good = {.parts = 1,
                                    .rows = {._length = 2, ._buffer = row},
                                    .entities = {._length = 2, ._buffer = entity},
                                    .courses = {._length = 2, ._buffer = course}};
    jolon_MotionBatch batch = good;
    (void)state;
    assert_true(samples_good(TOPIC_MOTIONS, &batch));
    batch.part = 1;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    batch = good;
    batch.rows._length = 1;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    batch = good;
    row[1] = 3;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    row[1] = CAPACITY_MAX;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    row[1] = 8;
    course[1].entity = 2;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    course[1].entity = 0;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    course[1].entity = 1;
    course[1].turn_rps = NAN;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    course[1].turn_rps = 0.0F;
    course[1].lasts_s = -1.0F;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
    course[1].lasts_s = 0.0F;
    entity[1].x_m = INFINITY;
    assert_false(samples_good(TOPIC_MOTIONS, &batch));
}

static void test_names_rise(void **state)
{
    jolon_EntityName name[3] = {{.id = 1}, {.id = 4}, {.id = 9}};
    jolon_EntityNames names = {.names = {._length = 3, ._buffer = name}};
    (void)state;
    assert_true(samples_good(TOPIC_NAMES, &names));
    name[2].id = 4;
    assert_false(samples_good(TOPIC_NAMES, &names));
}

static void test_events(void **state)
{
    (void)state;
    jolon_CollisionEvent collision = {.header = {.sequence = 5, .previous = 5}};
    assert_true(samples_good(TOPIC_COLLISION, &collision));
    collision.header.previous = 6;
    assert_false(samples_good(TOPIC_COLLISION, &collision));
    collision.header.previous = 4;
    collision.normal.y = INFINITY;
    assert_false(samples_good(TOPIC_COLLISION, &collision));
    jolon_AgentEvent agent = {.because = (jolon_AgentReason)(jolon_REASON_LEFT_WORLD + 1)};
    assert_false(samples_good(TOPIC_AGENT, &agent));
    jolon_ContactEndEvent end = {.lasted_s = 2.5};
    assert_true(samples_good(TOPIC_CONTACT_END, &end));
    end.lasted_s = -0.5;
    assert_false(samples_good(TOPIC_CONTACT_END, &end));
    end.lasted_s = 0.0;
    end.b.damage = (jolon_Damage)9;
    assert_false(samples_good(TOPIC_CONTACT_END, &end));
    jolon_CraterEvent crater = {.radius_m = -1.0F};
    assert_false(samples_good(TOPIC_CRATER, &crater));
    crater = (jolon_CraterEvent){.degrees = {90.0, -180.0}, .mgrs = "19T\nCK"};
    assert_true(samples_good(TOPIC_CRATER, &crater));
    assert_string_equal(crater.mgrs, "19T?CK");
    crater.degrees.longitude_deg = NAN;
    assert_false(samples_good(TOPIC_CRATER, &crater));
    jolon_DetonationEvent detonation = {.victim = {.damage = (jolon_Damage)9}};
    assert_false(samples_good(TOPIC_DETONATION, &detonation));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texts_are_cleaned),
        cmocka_unit_test(test_frames),
        cmocka_unit_test(test_roles_are_those_there_are),
        cmocka_unit_test(test_worlds),
        cmocka_unit_test(test_batches_fit_together),
        cmocka_unit_test(test_motions_fit_together),
        cmocka_unit_test(test_names_rise),
        cmocka_unit_test(test_events),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
