/* The digest and the checksum: what they cover and what they leave out; words and names. */
#include "world/entity/command.h"
#include "world/entity/dent.h"
#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/entity/persistent_contact.h"
#include "world/enum_names.h"
#include "world/event_text.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/crater.h"
#include "world/terrain/fixed.h"
#include "world/terrain/terrain.h"
#include "world/view_mode.h"
#include "world/world.h"

#include "tests/support/fixture.h"
#include "world/checksum.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define SCENARIO                                                                                   \
    "objects = ( { kind = \"tree\"; at = [1000.0, 1000.0]; },"                                     \
    "            { kind = \"bush\"; at = [2000.0, 1000.0]; } );"                                   \
    "vehicles = ( { kind = \"tank\"; name = \"T\"; count = 3; area = [3000.0, 3000.0, 4000.0, "    \
    "4000.0]; }, { kind = \"jeep\"; at = [5000.0, 5000.0]; }, "                                    \
    "{ kind = \"jeep\"; name = \"J\"; at = [6000.0, 5000.0]; } );"

static struct fixture f;
static struct state now;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, SCENARIO);
    now = fixture_state(&f);
    now.craters[0] = (struct crater){1.0, 2.0, 3.0f, 4.0f, 5};
    now.craters[1] = now.craters[0];
    now.head->crater_count = 1;
    now.contacts[0] =
        (struct persistent_contact){1, 2, 0, 1, 3, 4, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    now.contacts[1] = now.contacts[0];
    now.head->contact_count = 1;
    return 0;
}

static uint64_t digest(void)
{
    return state_digest(&f.view.world, &now);
}
static uint64_t checksum(void)
{
    return state_checksum(&now, f.view.world.counts.fixed);
}

/* Flips each bit of a value and back: does every flip change the digest? */
static bool every_bit_counts(void *value, size_t bytes)
{
    unsigned char *at = value;
    uint64_t before = digest();
    for (size_t bit = 0; bit < bytes * 8; bit++) {
        at[bit / 8] ^= (unsigned char)(1u << bit % 8);
        bool same = digest() == before;
        at[bit / 8] ^= (unsigned char)(1u << bit % 8);
        if (same)
            return false;
    }
    return digest() == before;
}

static bool no_bit_counts(void *value, size_t bytes)
{
    unsigned char *at = value;
    uint64_t before = digest();
    for (size_t bit = 0; bit < bytes * 8; bit++) {
        at[bit / 8] ^= (unsigned char)(1u << bit % 8);
        bool same = digest() == before;
        at[bit / 8] ^= (unsigned char)(1u << bit % 8);
        if (!same)
            return false;
    }
    return true;
}

static void test_digest_covers_every_column_of_every_used_row(void **state)
{
    const struct entities *e = &now.entities;
    (void)state;
    assert_int_equal(now.head->used, 5);
    for (uint32_t row = 0; row < now.head->used; row++) {
#define X(type, name)                                                                              \
    if (!every_bit_counts(&e->row[row].name, sizeof(type)))                                        \
        fail_msg("row %u: " #name, row);
        ENTITY_FIELDS(X)
#undef X
    }
}

/* Two columns, or two rows, that exchange their values make another world. */
static void test_digest_depends_on_where_a_value_is(void **state)
{
    const struct entities *e = &now.entities;
    uint64_t before = digest();
    (void)state;
    double x = e->row[0].x, z = e->row[0].z;
    e->row[0].x = z;
    e->row[0].z = x;
    assert_int_not_equal(digest(), before);
    e->row[0].x = e->row[1].x;
    e->row[0].z = z;
    e->row[1].x = x;
    assert_int_not_equal(digest(), before);
    e->row[1].x = e->row[0].x;
    e->row[0].x = x;
    assert_int_equal(digest(), before);
}

static void test_rows_past_used_do_not_count(void **state)
{
    const struct entities *e = &now.entities;
    (void)state;
#define X(type, name) assert_true(no_bit_counts(&e->row[now.head->used].name, sizeof(type)));
    ENTITY_FIELDS(X)
#undef X
}

static void test_digest_covers_the_head(void **state)
{
    struct state_head *h = now.head;
    (void)state;
#define COUNTS(field)                                                                              \
    if (!every_bit_counts(&h->field, sizeof h->field))                                             \
        fail_msg(#field);
    COUNTS(frame)
    COUNTS(tick)
    COUNTS(event_end)
    COUNTS(event_digest)
    COUNTS(command_cursor)
    COUNTS(paused)
    COUNTS(steps_left)
    COUNTS(alloc_next)
    COUNTS(next_id)
    COUNTS(vehicles)
    COUNTS(munitions)
    COUNTS(fire_cursor)
    COUNTS(battery_count)
    COUNTS(battery)
    COUNTS(advanced)
    COUNTS(tally.collisions)
    COUNTS(tally.fires)
    COUNTS(tally.detonations)
    COUNTS(tally.destroyed)
    COUNTS(tally.fixed_damaged)
    COUNTS(tally.agent_changes)
    COUNTS(tally.commands)
    COUNTS(tally.events_dropped)
    COUNTS(tally.craters_refused)
    COUNTS(tally.spawns_refused)
    COUNTS(tally.dents_refused)
    COUNTS(tally.contacts_refused)
    COUNTS(battle)
#undef COUNTS
    uint64_t before = digest();
    h->used--;
    assert_int_not_equal(digest(), before);
    h->used++;
    h->crater_count = 0;
    assert_int_not_equal(digest(), before);
    h->crater_count = 1;
    assert_int_equal(digest(), before);
    h->contact_count = 0;
    assert_int_not_equal(digest(), before);
    h->contact_count = 1;
    assert_int_equal(digest(), before);
}

static void test_pacing_and_times_do_not_count(void **state)
{
    struct state_head *h = now.head;
    (void)state;
    assert_true(no_bit_counts(&h->time_scale, sizeof h->time_scale));
    assert_true(no_bit_counts(&h->mover_ns, sizeof h->mover_ns));
    assert_true(no_bit_counts(&h->quit, sizeof h->quit));
    assert_true(no_bit_counts(&h->checksum, sizeof h->checksum));
}

static void test_digest_covers_damage_contacts_craters_and_seed(void **state)
{
    unsigned char *params = (unsigned char *)f.view.base + f.view.layout.offset[REGION_PARAMS];
    (void)state;
    for (uint32_t i = 0; i < f.view.world.counts.fixed; i++)
        assert_true(every_bit_counts(&now.fixed_damage[i], 1));
    assert_true(every_bit_counts(&now.contacts[0], sizeof now.contacts[0]));
    assert_true(no_bit_counts(&now.contacts[1], sizeof now.contacts[1])); /* past contact_count */
    now.head->debris_count = 1;
    assert_true(every_bit_counts(&now.head->debris[0], sizeof now.head->debris[0]));
    assert_true(no_bit_counts(&now.head->debris[1], sizeof now.head->debris[1])); /* past it */
    now.head->debris_count = 0;
    assert_true(every_bit_counts(&now.craters[0], sizeof now.craters[0]));
    assert_true(no_bit_counts(&now.craters[1], sizeof now.craters[1])); /* past crater_count */
    assert_true(every_bit_counts(params + offsetof(struct params, seed), sizeof(uint64_t)));
}

/* Renderers' settings are no part of the world: fog changes the picture, never the digest (row 5).
 */
static void test_settings_of_the_picture_do_not_count(void **state)
{
    unsigned char *params = (unsigned char *)f.view.base + f.view.layout.offset[REGION_PARAMS];
    (void)state;
    assert_true(
        no_bit_counts(params + offsetof(struct params, renderer), sizeof(struct renderer_params)));
}

static void test_same_bytes_elsewhere_have_the_same_digest(void **state)
{
    struct state other = f.view.w[1];
    (void)state;
    *other.head = *now.head;
    entities_copy(&other.entities, &now.entities, 0, now.head->used);
    other.contacts[0] = now.contacts[0];
    assert_int_equal(state_digest(&f.view.world, &other), digest());
    assert_int_equal(state_checksum(&other, f.view.world.counts.fixed), checksum());
}

static bool within(size_t byte, size_t offset, size_t bytes)
{
    return byte >= offset && byte < offset + bytes;
}

static void test_checksum_covers_all_of_head_and_rows_but_itself(void **state)
{
    uint64_t before = checksum();
    unsigned char *head = (unsigned char *)now.head;
    (void)state;
    for (size_t i = 0; i < offsetof(struct state_head, debris); i++) {
        bool own = within(i, offsetof(struct state_head, checksum), sizeof now.head->checksum);
        if (within(i, offsetof(struct state_head, used), sizeof now.head->used) ||
            within(i, offsetof(struct state_head, crater_count), sizeof now.head->crater_count) ||
            within(i, offsetof(struct state_head, dent_count), sizeof now.head->dent_count) ||
            within(i, offsetof(struct state_head, contact_count), sizeof now.head->contact_count))
            continue; /* say how much is read */
        head[i] ^= 0x10;
        if ((checksum() == before) != own)
            fail_msg("byte %zu of the head", i);
        head[i] ^= 0x10;
    }
#define X(type, name)                                                                              \
    for (uint32_t row = 0; row <= now.head->used; row++) {                                         \
        unsigned char *value = (unsigned char *)&now.entities.row[row].name;                       \
        *value ^= 1;                                                                               \
        assert_int_equal(checksum() == before, row == now.head->used);                             \
        *value ^= 1;                                                                               \
    }
    ENTITY_FIELDS(X)
#undef X
}

static void test_checksum_covers_craters_and_dents_up_to_their_counts(void **state)
{
    (void)state;
    now.head->crater_count = 5;
    now.head->dent_count = 3;
    uint64_t before = checksum();
    for (size_t i = 0; i < 6 * sizeof *now.craters; i++) {
        unsigned char *byte = (unsigned char *)now.craters + i;
        *byte ^= 0x20;
        assert_int_equal(checksum() == before, i >= 5 * sizeof *now.craters);
        *byte ^= 0x20;
    }
    for (size_t i = 0; i < 4 * sizeof *now.dents; i++) {
        unsigned char *byte = (unsigned char *)now.dents + i;
        *byte ^= 0x20;
        assert_int_equal(checksum() == before, i >= 3 * sizeof *now.dents);
        *byte ^= 0x20;
    }
}

/* Each buffer has its own contacts, and the whole list is hashed. */
static void test_checksum_covers_contacts_up_to_their_count(void **state)
{
    (void)state;
    now.head->contact_count = 3;
    uint64_t before = checksum();
    for (size_t i = 0; i < 4 * sizeof *now.contacts; i++) {
        unsigned char *byte = (unsigned char *)now.contacts + i;
        *byte ^= 0x20;
        assert_int_equal(checksum() == before, i >= 3 * sizeof *now.contacts);
        *byte ^= 0x20;
    }
    f.view.w[1].contacts[0].begin_tick++; /* the other buffer's */
    assert_int_equal(checksum(), before);
    state_seal(&now, f.view.world.counts.fixed);
    assert_true(state_whole(&now, f.view.world.counts.fixed));
    now.contacts[2].pressed_tick++;
    assert_false(state_whole(&now, f.view.world.counts.fixed));
}

/* What is hashed as it grows is what is hashed at once, also after a step back. */
static void test_running_hashes_of_lists(void **state)
{
    static const uint32_t counts[] = {0, 1, 4, 4, 9, 3, 5};
    struct list_hashes running = {0};
    (void)state;
    for (uint32_t i = 0; i < 10; i++)
        now.craters[i].x = now.dents[i].id = i + 7;
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        struct list_hashes once = {0};
        now.head->crater_count = counts[i];
        now.head->dent_count = counts[i] / 2;
        list_hashes_extend(&running, &now);
        list_hashes_extend(&once, &now);
        assert_memory_equal(&running, &once, sizeof once);
    }
}

static void test_time_is_ticks_times_the_step(void **state)
{
    (void)state;
    struct state_head head = {.frame = 1000, .tick = 90};
    assert_true(state_time_s(&f.view.world, &head) == 90.0 * (1.0 / 60.0));
}

static void test_names_are_found_by_id(void **state)
{
    (void)state;
    assert_string_equal(world_entity_name(&f.view.world, 1), "T-1");
    assert_string_equal(world_entity_name(&f.view.world, 3), "T-3");
    assert_string_equal(world_entity_name(&f.view.world, 4), ""); /* the scenario gave it none */
    assert_string_equal(world_entity_name(&f.view.world, 0), "");
    assert_string_equal(world_entity_name(&f.view.world, 5), "J");
    assert_string_equal(world_entity_name(&f.view.world, 6), "");
    assert_string_equal(world_entity_name(&f.view.world, UINT32_MAX), "");
}

/* row 3 */
static void test_objects_of_a_square_are_found_from_the_square(void **state)
{
    const uint32_t *objects;
    (void)state;
    assert_int_equal(world_reach(&f.view.world, 8 * 400 + 16, &objects), 1);
    assert_true(f.view.world.fixed[objects[0]].x == 2000.0);
    assert_int_equal(world_reach(&f.view.world, 100 * 400 + 100, &objects), 0);
}

static void check_words(const char *(*word)(int), int count)
{
    for (int i = 0; i < count; i++) {
        assert_string_not_equal(word(i), "?");
        for (int j = 0; j < i; j++)
            assert_string_not_equal(word(i), word(j));
    }
    assert_string_equal(word(count), "?");
    assert_string_equal(word(-1), "?");
}

#define WORD(function, type)                                                                       \
    static const char *word_##function(int i)                                                      \
    {                                                                                              \
        return function((enum type)i);                                                             \
    }
WORD(cover_name, cover)
WORD(domain_name, domain)
WORD(object_class_name, object_class)
WORD(damage_name, damage)
WORD(entity_state_name, entity_state)
WORD(behaviour_name, behaviour)
WORD(force_name, force)
WORD(event_type_name, event_type)
WORD(response_name, response)
WORD(struck_name, struck)
WORD(agent_reason_name, agent_reason)
WORD(mission_order_name, mission_order)
WORD(mission_news_name, mission_news)
WORD(command_type_name, command_type)
WORD(command_result_name, command_result)
WORD(method_name, method)
WORD(shape_name, shape)
WORD(response_model_name, response_model)
WORD(view_mode_name, view_mode)
WORD(back_end_name, back_end)

static void test_every_value_has_a_word_of_its_own(void **state)
{
    (void)state;
    check_words(word_cover_name, COVER_COUNT);
    check_words(word_domain_name, DOMAIN_COUNT);
    check_words(word_object_class_name, OBJECT_CLASS_COUNT);
    check_words(word_damage_name, DAMAGE_COUNT);
    check_words(word_entity_state_name, ENTITY_WRECK + 1);
    check_words(word_behaviour_name, BEHAVIOUR_COUNT);
    check_words(word_force_name, FORCE_COUNT);
    check_words(word_event_type_name, EVENT_TYPE_COUNT);
    check_words(word_response_name, RESPONSE_COUNT);
    check_words(word_struck_name, STRUCK_COUNT);
    check_words(word_agent_reason_name, REASON_COUNT);
    check_words(word_mission_order_name, MISSION_ORDER_COUNT);
    check_words(word_mission_news_name, MISSION_NEWS_COUNT);
    check_words(word_command_type_name, COMMAND_TYPE_COUNT);
    check_words(word_command_result_name, COMMAND_RESULT_COUNT);
    check_words(word_method_name, METHOD_COUNT);
    check_words(word_shape_name, SHAPE_COUNT);
    check_words(word_response_model_name, MODEL_COUNT);
    check_words(word_view_mode_name, VIEW_COUNT);
    check_words(word_back_end_name, BACK_END_COUNT);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_digest_covers_every_column_of_every_used_row),
        TEST(test_digest_depends_on_where_a_value_is),
        TEST(test_rows_past_used_do_not_count),
        TEST(test_digest_covers_the_head),
        TEST(test_pacing_and_times_do_not_count),
        TEST(test_digest_covers_damage_contacts_craters_and_seed),
        TEST(test_settings_of_the_picture_do_not_count),
        TEST(test_same_bytes_elsewhere_have_the_same_digest),
        TEST(test_checksum_covers_all_of_head_and_rows_but_itself),
        TEST(test_checksum_covers_craters_and_dents_up_to_their_counts),
        TEST(test_checksum_covers_contacts_up_to_their_count),
        TEST(test_running_hashes_of_lists),
        TEST(test_time_is_ticks_times_the_step),
        TEST(test_names_are_found_by_id),
        TEST(test_objects_of_a_square_are_found_from_the_square),
        cmocka_unit_test(test_every_value_has_a_word_of_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
