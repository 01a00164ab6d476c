/* A frame that needs more than the collider has set aside: its arrays grow, and the world is the
 * same to the bit. Here each array begins with one item. */
#include "tests/support/child.h"
#include "tests/support/steps.h"
#include "world/runtime/reserve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#define FRAMES     6u
#define TEXT_BYTES 60000u

/* --- arrays of one item ------------------------------------------------------------------------*/

#define SHRINK(array)                                                                              \
    do {                                                                                           \
        reserve_free(array);                                                                       \
        (array) = reserve_take(1, sizeof *(array));                                                \
        assert_non_null(array);                                                                    \
    } while (0)

static void shrink_list(struct pair_list *list)
{
    pair_list_free(list);
    assert_int_equal(pair_list_init(list, 1), 0);
}

static void shrink_contacts(struct contact_queue *contacts)
{
    SHRINK(contacts->heap.contact);
    SHRINK(contacts->pair);
    SHRINK(contacts->met);
    SHRINK(contacts->swept);
    reserve_free(contacts->link);
    contacts->link = reserve_take(2, sizeof *contacts->link);
    assert_non_null(contacts->link);
    contacts->heap.capacity = contacts->pair_capacity = 1;
}

static void shrink_island(struct island *island)
{
    SHRINK(island->met);
    SHRINK(island->contact);
    island->met_capacity = 1;
}

static void shrink(struct collider *collider)
{
    for (uint32_t i = 0; i < collider->broad.sweepers; i++) {
        struct sweep_worker *sweeper = &collider->broad.sweeper[i];
        shrink_list(&sweeper->pairs);
        shrink_list(&sweeper->fliers);
        SHRINK(sweeper->bins.slab[0]);
        sweeper->bins.first = 1;
    }
    shrink_contacts(&collider->contacts);
    shrink_island(&collider->island);
    shrink_list(&collider->pairs);
}

/* What has grown. Of several threads one may have had nothing to do. */
static void assert_grown(const struct collider *collider, bool swept)
{
    uint32_t pairs = 0, fliers = 0, slabs = 0;
    for (uint32_t i = 0; i < collider->broad.sweepers; i++) {
        const struct sweep_worker *sweeper = &collider->broad.sweeper[i];
        pairs += sweeper->pairs.capacity > 1;
        fliers += sweeper->fliers.capacity > 1;
        slabs += sweeper->bins.slab[1] != NULL;
    }
    assert_true(pairs > 0 && fliers > 0 && slabs > 0);
    assert_true(collider->contacts.heap.capacity > 1);
    assert_true(collider->contacts.pair_capacity > 100);
    assert_true(collider->island.met_capacity > 1);
    assert_true(swept || collider->pairs.capacity > 100);
}

/* --- worlds ------------------------------------------------------------------------------------*/

static char text[TEXT_BYTES];

/* Appends to the scenario's text. */
__attribute__((format(printf, 1, 2))) static void put(const char *format, ...)
{
    size_t length = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + length, sizeof text - length, format, arguments);
    va_end(arguments);
    assert_true(strlen(text) + 1 < sizeof text);
}

/* Finds where its script begins, with the heading to the script's next point. */
static void write_world(const char *method, uint32_t trucks)
{
    text[0] = '\0';
    put("world = { seed = 3; capacity = %u; hz = 10.0; };\n"
        "collision = { shape = \"sphere\"; method = \"%s\"; };\nobjects = (\n",
        trucks + 256, method);
    for (int i = 0; i < 100; i++)
        put("%s{ kind = \"tree\"; at = [%d.0, %d.0]; }\n", i > 0 ? "," : "", 25000 + 4 * (i % 10),
            25000 + 4 * (i / 10));
    put(");\nvehicles = ( { kind = \"truck\"; count = %u; behaviour = \"hold\"; speed_mps = 22.0; "
        "area = [24000.0, 24000.0, 26000.0, 26000.0]; }\n",
        trucks);
    for (int i = 0; i < 30; i++)
        put(", { kind = \"tank\"; at = [%.1f, %.1f]; heading_deg = %d.0; speed_mps = 12.0; "
            "behaviour = \"hold\"; }\n",
            25010.0 + 0.1 * (i % 6), 25010.0 + 0.1 * (i / 6), i * 12);
    put(");\nfires = (\n");
    for (int i = 0; i < 20; i++)
        put("%s{ at_s = 0.1; munition = \"bomb\"; point = [%d.0, 25010.0]; }\n", i > 0 ? "," : "",
            25000 + 2 * i);
    put(");\n");
}

static void run(uint32_t threads, bool shrunk, bool swept, uint64_t digest[FRAMES])
{
    struct fixture f;
    fixture_open(&f, text);
    fixture_threads(&f, threads);
    if (shrunk)
        shrink(&f.stepper.collider);
    uint64_t before = reserve_growths();
    for (uint32_t i = 0; i < FRAMES; i++) {
        fixture_run(&f, 1);
        digest[i] = fixture_digest(&f);
    }
    assert_true(fixture_state(&f).head->tally.collisions > 100);
    if (shrunk)
        assert_grown(&f.stepper.collider, swept);
    else
        assert_int_equal(reserve_growths(), before);
    fixture_close(&f);
}

static void compare(const char *method, uint32_t trucks)
{
    uint64_t wanted[FRAMES], found[FRAMES];
    bool swept = strcmp(method, "swept") == 0;
    write_world(method, trucks);
    run(1, false, swept, wanted);
    for (uint32_t threads = 1; threads <= 4; threads += 3) {
        run(threads, true, swept, found);
        assert_memory_equal(found, wanted, sizeof wanted);
    }
}

/* As many rows as are shared out among threads (broad.c). */
static void test_a_crowd_on_threads(void **state)
{
    (void)state;
    compare("swept", 9000);
}

static void test_another_method(void **state)
{
    (void)state;
    compare("occupancy", 100);
}

static void test_a_block_of_a_method_grows(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    struct method_workspace *workspace = method_workspace_create(&f.view.world, NULL);
    assert_non_null(workspace);
    uint64_t before = reserve_growths();
    assert_non_null(method_block(workspace, 2, 1000, 8));
    assert_int_equal(reserve_growths(), before);
    uint64_t *block = method_block(workspace, 2, 1000000, sizeof *block);
    assert_int_equal(reserve_growths(), before + 1);
    block[0] = block[999999] = 7;
    assert_ptr_equal(method_block(workspace, 2, 1000000, sizeof *block), block);
    method_workspace_free(workspace);
    fixture_close(&f);
}

/* More than the process may have: it ends, and no item is lost on the way on. */
static int grow_past_a_limit(void *context)
{
    struct pair_list list;
    const struct rlimit limit = {1 << 28, 1 << 28};
    (void)context;
    if (pair_list_init(&list, 1) != 0 || setrlimit(RLIMIT_AS, &limit) != 0)
        return 1;
    for (uint32_t i = 0; i < PAIRS_MAX; i++)
        pair_list_add(&list, i, i);
    return 2;
}

static void test_a_limit_ends_the_process(void **state)
{
    (void)state;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    skip(); /* their own address space is beyond any limit */
#endif
    assert_int_equal(child_run(grow_past_a_limit, NULL), -SIGABRT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_crowd_on_threads),
        cmocka_unit_test(test_another_method),
        cmocka_unit_test(test_a_limit_ends_the_process),
        cmocka_unit_test(test_a_block_of_a_method_grows),
    };
    return cmocka_run_group_tests_name("step growth", tests, NULL, NULL);
}
