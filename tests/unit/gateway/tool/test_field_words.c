/* Words of fields: each kind of value, what follows from a place, and each refusal. */
#include "gateway/tool/field_words.h"

#include "gateway/earth/euler.h"
#include "gateway/pdu/pdu_layout.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>

#include <cmocka.h>

static struct pdu pdu;
static struct error_text error;

static void begin(uint8_t type)
{
    memset(&pdu, 0, sizeof pdu);
    pdu.header.type = type;
}

static void set(const char *word)
{
    if (field_words_set(&pdu, word, &error) != 0)
        fail_msg("%s", error.text);
}

static void assert_refused(const char *word, const char *why)
{
    assert_int_equal(field_words_set(&pdu, word, &error), -1);
    if (!strstr(error.text, why))
        fail_msg("%s: \"%s\" has no \"%s\"", word, error.text, why);
}

static void test_each_kind_of_value(void **state)
{
    (void)state;
    begin(PDU_ENTITY_STATE);
    set("id=1:2:65533");
    set("force=2");
    set("type=1.1.225.1.1.2.255");
    set("velocity=1.5,-2,3e2");
    set("location=-2681672.715469,-4419259.862861,3723701.886410");
    set("appearance=0x800000");
    set("capabilities=7");
    set("marking=T-72 \"A\"");
    const struct pdu_entity_state *entity = &pdu.entity_state;
    assert_int_equal(entity->id.entity, 65533);
    assert_int_equal(entity->force, 2);
    assert_int_equal(entity->type.country, 225);
    assert_int_equal(entity->type.extra, 255);
    assert_true(entity->velocity[1] == -2.0f && entity->velocity[2] == 300.0f);
    assert_true(entity->location[2] == 3723701.886410);
    assert_int_equal(entity->appearance, PDU_APPEARANCE_DEACTIVATED);
    assert_string_equal(entity->marking, "T-72 \"A\"");
    begin(PDU_STOP_FREEZE);
    set("real_time=494000:4294967295");
    set("request=4294967295");
    assert_int_equal(pdu.management.real_time.hours, 494000);
    assert_int_equal(pdu.management.real_time.past_hour, UINT32_MAX);
    begin(PDU_FIRE);
    set("range=2150.5");
    set("warhead=65535");
    assert_true(pdu.fire.range == 2150.5f && pdu.fire.warhead == 65535);
}

/* A place and an attitude give the numbers of ECEF: the worked case A, and a level heading. */
static void test_places_and_attitudes(void **state)
{
    (void)state;
    begin(PDU_ENTITY_STATE);
    set("place=35.95,-121.25,0");
    set("attitude=0,0,0");
    assert_true(fabs(pdu.entity_state.location[0] + 2681672.715469) < 1e-5);
    assert_true(fabs(pdu.entity_state.location[1] + 4419259.862861) < 1e-5);
    struct euler angles = {(double)pdu.entity_state.orientation[0],
                           (double)pdu.entity_state.orientation[1],
                           (double)pdu.entity_state.orientation[2]};
    struct mat3 is = euler_matrix(angles),
                right = euler_matrix((struct euler){1.025380936, -0.943350461, 3.141592654});
    assert_true(euler_angle_between(&is, &right) < 1e-6);
    set("turret=90");
    set("gun=-5");
    set("turret=180");
    assert_int_equal(pdu.parts, 2);
    assert_int_equal(pdu.part[0].type, PDU_TURRET_AZIMUTH);
    assert_true(fabs((double)pdu.part[0].value - M_PI) < 1e-6);
    assert_int_equal(pdu.part[1].attached_to, 1);
    begin(PDU_DETONATION);
    set("place=0,0,100");
    assert_true(pdu.detonation.location[0] == 6378237.0);
}

static void test_refusals(void **state)
{
    (void)state;
    begin(PDU_ENTITY_STATE);
    assert_refused("force", "must be FIELD=VALUE");
    assert_refused("=1", "must be FIELD=VALUE");
    assert_refused("colour=red", "no such field");
    assert_refused("force=256", "0..255");
    assert_refused("force=-1", "0..255");
    assert_refused("force=0x", "0..255");
    assert_refused("id=1:2", "SITE:APPLICATION:ENTITY");
    assert_refused("id=1:2:3:4", "SITE:APPLICATION:ENTITY");
    assert_refused("id=1:2:65536", "SITE:APPLICATION:ENTITY");
    assert_refused("type=1.1.225.1.1.2", "KIND.DOMAIN");
    assert_refused("type=1.1.225.1.1.2.256", "KIND.DOMAIN");
    assert_refused("velocity=1,2", "X,Y,Z");
    assert_refused("velocity=1,2,nan", "X,Y,Z");
    assert_refused("velocity=1,2,1e31", "X,Y,Z");
    assert_refused("marking=twelve lette", "at most 11");
    assert_refused("marking=a\nb", "at most 11");
    assert_refused("place=91,0,0", "LATITUDE");
    assert_refused("attitude=0,0,0", "after place");
    begin(PDU_FIRE);
    assert_refused("attitude=0,0,0", "no such field");
    assert_refused("turret=1", "no such field");
    begin(PDU_COLLISION);
    assert_refused("place=1,2,3", "no such field");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_kind_of_value),
        cmocka_unit_test(test_places_and_attitudes),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
