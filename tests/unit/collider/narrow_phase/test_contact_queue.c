/* Contacts of a frame: order of time, new contacts after a change of path, each pair once. */
#include "collider/narrow_phase/contact_queue.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct response_context context;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 512; };");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    contact_queue_end(&f.stepper.collider.contacts);
    fixture_close(&f);
    return 0;
}

static struct contact_queue *contacts(void)
{
    return &f.stepper.collider.contacts;
}

/* A helicopter (radius 6) at x, going this far along x in the frame. */
static uint32_t put(double x, double z, double along)
{
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "helicopter", .at = {x, 900.0, z}});
    f.stepper.collider.motion.path[row] =
        (struct path){.at = {x, 900.0, z}, .along = {along, 0.0, 0.0}};
    return row;
}

/* Finds the frame's contacts from the paths as they are. */
static void find(void)
{
    struct state now = fixture_state(&f);
    struct path kept[512];
    uint32_t used = now.head->used;
    for (uint32_t i = 0; i < used; i++)
        kept[i] = f.stepper.collider.motion.path[i];
    steps_respond(&f, &context);
    steps_respond_end(&context);
    for (uint32_t i = 0; i < used; i++)
        f.stepper.collider.motion.path[i] = kept[i];
    broad_phase_pairs(&f.stepper.collider.broad, &context.input.detect);
    contact_queue_begin(contacts(), f.stepper.collider.broad.list, THREAD_POOL_MAX);
    contact_queue_find(contacts(), &context.input);
}

static void stop(uint32_t row, double time)
{
    struct path *path = &f.stepper.collider.motion.path[row];
    *path = (struct path){.at = path_at(path, time), .since = time};
    contact_queue_change(contacts(), &context.input, &row, 1, time);
}

/* --- order -------------------------------------------------------------------------------------*/

static void test_row_36_contacts_come_in_the_order_of_time(void **state)
{
    uint64_t random = fixture_seed(36);
    struct contact contact;
    double before = 0.0;
    uint32_t count = 0;
    (void)state;
    for (int n = 0; n < 200; n++) {
        double z = 1000.0 + 200.0 * n, gap = fixture_uniform(&random, 0.0, 50.0);
        put(25000.0, z, 25.0);
        put(25012.0 + gap, z, -25.0);
    }
    find();
    while (contact_queue_next(contacts(), &context.input, &contact)) {
        assert_true(contact.impact.toi >= before && contact.impact.toi <= 1.0);
        assert_int_equal(contact.b, contact.a + 1);
        before = contact.impact.toi;
        count++;
    }
    assert_int_equal(count, 200);
}

static void test_ties_go_by_the_numbers_of_the_bodies(void **state)
{
    struct contact contact;
    (void)state;
    for (int n = 19; n >= 0; n--) {
        put(25000.0, 1000.0 + 200.0 * n, 25.0);
        put(25030.0, 1000.0 + 200.0 * n, 0.0);
    }
    find();
    contact_queue_add_end(contacts(), 4, CONTACT_GROUND, 18.0 / 25.0);
    contact_queue_add_end(contacts(), 4, CONTACT_AIR, 18.0 / 25.0);
    for (uint32_t n = 0; n < 20; n++) {
        assert_true(contact_queue_next(contacts(), &context.input, &contact));
        assert_int_equal(contact.a, 2 * n);
        assert_int_equal(contact.b, 2 * n + 1);
        if (n == 2) { /* bodies before air before ground, by their numbers */
            assert_true(contact_queue_next(contacts(), &context.input, &contact) &&
                        contact.b == CONTACT_AIR);
            assert_true(contact_queue_next(contacts(), &context.input, &contact) &&
                        contact.b == CONTACT_GROUND);
        }
    }
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
}

/* --- renewal -----------------------------------------------------------------------------------*/

static void test_a_changed_path_voids_its_contacts(void **state)
{
    struct contact contact;
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 100.0); /* meets b at 0.18, c at 0.58 */
    uint32_t b = put(25030.0, 25000.0, 0.0), c = put(25070.0, 25000.0, 0.0);
    find();
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_int_equal(contact.a, a);
    assert_int_equal(contact.b, b);
    stop(a, contact.impact.toi);
    assert_false(contact_queue_next(contacts(), &context.input, &contact)); /* it never came to c */
    (void)c;
}

static void test_a_changed_path_is_swept_against_all_it_could_meet(void **state)
{
    struct contact contact;
    (void)state;
    /* b runs into a, which stops in c's path. */
    uint32_t a = put(25000.0, 25000.0, 40.0), b = put(25030.0, 25000.0, 0.0);
    uint32_t c = put(24950.0, 25000.0, 100.0);
    find();
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_int_equal(contact.b, b);
    assert_true(fabs(contact.impact.toi - 0.45) < 1e-12);
    stop(a, contact.impact.toi); /* at 25018: c, 12 behind it, comes at 25006 at 0.56 */
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_int_equal(contact.a, a);
    assert_int_equal(contact.b, c);
    assert_true(fabs(contact.impact.toi - 0.56) < 1e-12);
    stop(c, contact.impact.toi); /* else it would go on to b */
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
}

static void test_a_pair_meets_so_often_and_no_more(void **state)
{
    struct contact contact;
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 100.0), b = put(25030.0, 25000.0, 0.0);
    find();
    assert_int_equal(context.input.meets, CONTACT_MEETS_MAX);
    for (int n = 1; n <= CONTACT_MEETS_MAX; n++) { /* it moves on after each response */
        assert_true(contact_queue_next(contacts(), &context.input, &contact));
        assert_int_equal(contact.last, n == CONTACT_MEETS_MAX);
        contact_queue_change(contacts(), &context.input, &a, 1, contact.impact.toi);
        contact_queue_change(contacts(), &context.input, &b, 1, contact.impact.toi);
    }
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
}

/* A path that leaves the box that the broad phase has meets the bodies there, and bodies that left
 * their own boxes. */
static void test_row_36_a_changed_path_meets_other_bodies(void **state)
{
    struct contact contact;
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 10.0);
    uint32_t b = put(25000.0, 25300.0, 0.0), c = put(25300.0, 25300.0, 0.0);
    find();
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
    f.stepper.collider.motion.path[a].along = (struct vec3){0.0, 0.0, 400.0};
    contact_queue_change(contacts(), &context.input, &a, 1, 0.0);
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_true(contact.a == a && contact.b == b &&
                fabs(contact.impact.toi - 288.0 / 400.0) < 1e-12);
    stop(a, 0.5); /* at 25200 */
    f.stepper.collider.motion.path[c].along = (struct vec3){-600.0, 0.0, -200.0};
    contact_queue_change(contacts(), &context.input, &c, 1, 0.0);
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_true(contact.a == a && contact.b == c);
}

static void test_a_dropped_row_has_no_contacts(void **state)
{
    struct contact contact;
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 100.0);
    put(25030.0, 25000.0, 0.0);
    put(25060.0, 25000.0, 0.0);
    find();
    contact_queue_add_end(contacts(), a, CONTACT_GROUND, 0.9);
    contact_queue_drop(contacts(), a);
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
}

static void test_a_frame_knows_nothing_of_the_one_before(void **state)
{
    struct contact contact;
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 100.0), b = put(25030.0, 25000.0, 0.0);
    for (int frame = 0; frame < 3; frame++) {
        find();
        assert_true(contact_queue_next(contacts(), &context.input, &contact));
        assert_true(contact.a == a && contact.b == b && fabs(contact.impact.toi - 0.18) < 1e-12);
        assert_false(contact_queue_next(contacts(), &context.input, &contact));
        contact_queue_end(contacts());
    }
    f.stepper.collider.motion.path[a].along.x = 0.0;
    find();
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
}

/* --- pairs of other parts ----------------------------------------------------------------------*/

static void test_a_pair_is_added_once(void **state)
{
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 100.0), b = put(25030.0, 25000.0, 0.0);
    uint32_t c = put(25000.0, 26000.0, 0.0);
    find();
    assert_int_equal(contacts()->pair_count, 1);
    assert_int_equal(contact_queue_pair(contacts(), &(struct pair){a, b}), 0);
    contacts()->marks[0] = CONTACT_PRESSED;
    assert_int_equal(contact_queue_pair(contacts(), &(struct pair){a, c}), 1);
    assert_int_equal(contact_queue_pair(contacts(), &(struct pair){a, PAIR_FIXED}), 2);
    assert_int_equal(contact_queue_pair(contacts(), &(struct pair){a, c}), 1);
    assert_int_equal(contacts()->pair_count, 3);
    assert_int_equal(contacts()->marks[0], CONTACT_PRESSED);
    assert_int_equal(contacts()->marks[1], 0);
}

/* Two bodies at rest are a pair only for those who ask for it. */
static void test_looking_around_finds_bodies_at_rest(void **state)
{
    struct contact contact;
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 0.0), b = put(25010.0, 25000.0, 0.0);
    put(25100.0, 25000.0, 0.0);
    find();
    assert_int_equal(contacts()->pair_count, 0);
    contact_queue_look(contacts(), &context.input, b, false);
    assert_int_equal(contacts()->pair_count, 0);
    contact_queue_look(contacts(), &context.input, b, true);
    contact_queue_look(contacts(), &context.input, a, true);
    assert_int_equal(contacts()->pair_count, 1);
    assert_true(contacts()->pair[0].a == a && contacts()->pair[0].b == b);
    assert_false(contact_queue_next(contacts(), &context.input, &contact)); /* nothing is swept */
}

static void test_a_row_that_left_its_box_is_found_by_the_next(void **state)
{
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 10.0), b = put(25300.0, 25000.0, 10.0);
    find();
    f.stepper.collider.motion.path[a].at.x = 25150.0;
    contact_queue_look(contacts(), &context.input, a, false);
    assert_int_equal(contacts()->pair_count, 0);
    f.stepper.collider.motion.path[b].at.x = 25155.0;
    contact_queue_look(contacts(), &context.input, b, false);
    assert_int_equal(contacts()->pair_count, 1);
}

/* --- contacts that last ------------------------------------------------------------------------*/

/* A pair whose contact lasts has no first contact. After a change of path it has one if its bodies
 * close as fast as in an impact. */
static void test_resting_bodies_meet_only_in_an_impact(void **state)
{
    struct contact contact;
    double impact_m = CONTACT_IMPACT_MPS * world_dt_s(&f.view.world);
    (void)state;
    uint32_t a = put(25000.0, 25000.0, 1.0);
    put(25012.0, 25000.0, 0.0);
    find();
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    contacts()->marks[0] = CONTACT_RESTS;
    contact_queue_find(contacts(), &context.input);
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
    f.stepper.collider.motion.path[a].along.x = 0.9 * impact_m;
    contact_queue_change(contacts(), &context.input, &a, 1, 0.0);
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
    f.stepper.collider.motion.path[a].along.x = 1.1 * impact_m;
    contact_queue_change(contacts(), &context.input, &a, 1, 0.0);
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_int_equal(contact.pair, 1);
}

/* Bodies that rest at known points are swept only if they close fast at one of these. */
static void test_resting_points_decide_what_is_swept(void **state)
{
    struct contact contact;
    const struct rest_point aside = {.normal_z = 1.0, .a_x = 2.0, .b_x = -3.0};
    const struct rest_point ahead = {.normal_x = 1.0, .a_x = 2.0, .b_x = -3.0};
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "collision = { shape = \"model\"; };");
    uint32_t a =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000.0, 100.0, 25000.0}});
    fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25005.0, 100.0, 25000.0}});
    f.stepper.collider.motion.path[a] =
        (struct path){.at = {25000.0, 100.0, 25000.0}, .along = {3.0, 0.0, 0.0}};
    f.stepper.collider.motion.path[a + 1] = (struct path){.at = {25005.0, 100.0, 25000.0}};
    find();
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    contact_queue_rest(contacts(), 0, &aside, 1);
    contact_queue_change(contacts(), &context.input, &a, 1, 0.0);
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
    contact_queue_rest(contacts(), 0, &ahead, 1);
    contact_queue_change(contacts(), &context.input, &a, 1, 0.0);
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
}

static void test_marks_last_for_a_frame(void **state)
{
    (void)state;
    put(25000.0, 25000.0, 100.0);
    put(25030.0, 25000.0, 0.0);
    find();
    contacts()->marks[0] = CONTACT_RESTS | CONTACT_PRESSED | CONTACT_OVERLAPS | CONTACT_GATHERED;
    contact_queue_end(contacts());
    find();
    assert_int_equal(contacts()->marks[0], 0);
}

/* --- fixed objects -----------------------------------------------------------------------------*/

static void test_through_fixed_only_entering_is_a_contact(void **state)
{
    struct contact contact;
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; } );");
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {24990.0, 100.0, 25000.0}});
    f.stepper.collider.motion.path[row] =
        (struct path){.at = {24990.0, 100.0, 25000.0}, .along = {8.0, 0, 0}};
    find();
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_true(fabs(contact.impact.toi - (10.0 - 3.0 - (double)1.8f) / 8.0) < 1e-12);
    contact_queue_end(contacts());
    f.stepper.collider.motion.path[row].at.x = 24996.0; /* it stands in it */
    find();
    assert_true(contact_queue_next(contacts(), &context.input, &contact));
    assert_true(contact.impact.toi == 0.0);
    context.input.through_fixed = true;
    contact_queue_end(contacts());
    contact_queue_begin(contacts(), f.stepper.collider.broad.list, THREAD_POOL_MAX);
    contact_queue_find(contacts(), &context.input);
    assert_false(contact_queue_next(contacts(), &context.input, &contact));
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_row_36_contacts_come_in_the_order_of_time),
        TEST(test_ties_go_by_the_numbers_of_the_bodies),
        TEST(test_a_changed_path_voids_its_contacts),
        TEST(test_a_changed_path_is_swept_against_all_it_could_meet),
        TEST(test_a_pair_meets_so_often_and_no_more),
        TEST(test_row_36_a_changed_path_meets_other_bodies),
        TEST(test_a_dropped_row_has_no_contacts),
        TEST(test_a_frame_knows_nothing_of_the_one_before),
        TEST(test_a_pair_is_added_once),
        TEST(test_looking_around_finds_bodies_at_rest),
        TEST(test_a_row_that_left_its_box_is_found_by_the_next),
        TEST(test_resting_points_decide_what_is_swept),
        TEST(test_resting_bodies_meet_only_in_an_impact),
        TEST(test_marks_last_for_a_frame),
        TEST(test_through_fixed_only_entering_is_a_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
