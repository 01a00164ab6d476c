/* Four minutes of a battle with aircraft of both sides, air defence and tanks. Each side loses
 * aircraft and keeps some, and its aircraft do not collide. SEED=n runs other battles. */
#include "tests/support/fixture.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ      20
#define BATTLES 12
#define SECONDS 240

static const char battle[] =
    "world = { seed = %llu; hz = 20.0; capacity = 512; };\n"
    "bases = ( { force = \"blue\"; at = [20000.0, 25000.0]; },\n"
    "          { force = \"red\"; at = [30000.0, 25000.0]; } );\n"
    "vehicles = (\n"
    "  { kind = \"jet\"; count = 7; force = \"blue\"; fire_at_will = true;\n"
    "    area = [20000.0, 22000.0, 28000.0, 28000.0]; },\n"
    "  { kind = \"jet\"; count = 7; force = \"red\"; fire_at_will = true;\n"
    "    area = [22000.0, 22000.0, 30000.0, 28000.0]; },\n"
    "  { kind = \"helicopter\"; count = 10; force = \"blue\"; fire_at_will = true;\n"
    "    area = [22500.0, 24000.0, 25000.0, 26000.0]; },\n"
    "  { kind = \"helicopter\"; count = 10; force = \"red\"; fire_at_will = true;\n"
    "    area = [25000.0, 24000.0, 27500.0, 26000.0]; },\n"
    "  { kind = \"flak\"; count = 2; force = \"blue\"; fire_at_will = true; behaviour = \"idle\";\n"
    "    area = [23000.0, 24500.0, 24000.0, 25500.0]; },\n"
    "  { kind = \"flak\"; count = 2; force = \"red\"; fire_at_will = true; behaviour = \"idle\";\n"
    "    area = [26000.0, 24500.0, 27000.0, 25500.0]; },\n"
    "  { kind = \"tank\"; count = 10; force = \"blue\"; behaviour = \"idle\";\n"
    "    area = [23000.0, 24000.0, 24000.0, 26000.0]; },\n"
    "  { kind = \"tank\"; count = 10; force = \"red\"; behaviour = \"idle\";\n"
    "    area = [26000.0, 24000.0, 27000.0, 26000.0]; } );\n";

static struct fixture f;

struct losses {
    uint32_t of, lost;
};

static struct losses losses_of(enum force force, uint32_t rows)
{
    struct entities e = steps_rows(&f);
    struct losses losses = {0, 0};
    for (uint32_t row = 0; row < rows; row++) {
        if (e.row[row].force != force || f.view.world.kinds[e.row[row].kind].domain != DOMAIN_AIR)
            continue;
        losses.of++;
        losses.lost += e.row[row].state != ENTITY_ACTIVE;
    }
    return losses;
}

/* Returns the collisions of two intact aircraft so far. */
static uint32_t meetings(void)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < fixture_event_count(&f, EVENT_COLLISION); n++) {
        const struct event_collision *c = &fixture_event(&f, EVENT_COLLISION, n)->collision;
        const struct kind *kinds = f.view.world.kinds;
        count += !c->a.fixed && !c->b.fixed && c->a.id && c->b.id && c->begins &&
                 kinds[c->a.kind].domain == DOMAIN_AIR && kinds[c->b.kind].domain == DOMAIN_AIR;
    }
    return count;
}

static void test_each_side_loses_aircraft_and_keeps_some(void **state)
{
    uint64_t seed = fixture_seed(1);
    struct losses all = {0, 0};
    uint32_t all_met = 0;
    (void)state;
    for (uint32_t n = 0; n < BATTLES; n++) {
        char text[sizeof battle + 32];
        (void)snprintf(text, sizeof text, battle, (unsigned long long)(seed + n));
        fixture_open(&f, text);
        uint32_t rows = fixture_state(&f).head->used;
        fixture_run(&f, SECONDS * HZ);
        struct losses blue = losses_of(FORCE_BLUE, rows), red = losses_of(FORCE_RED, rows);
        uint32_t met = meetings();
        print_message("battle %u: blue lost %u of %u aircraft, red %u of %u; %u met in the air\n",
                      n, blue.lost, blue.of, red.lost, red.of, met);
        assert_true(blue.lost > 0 && blue.lost < blue.of && red.lost > 0 && red.lost < red.of);
        all_met += met;
        all.of += blue.of + red.of;
        all.lost += blue.lost + red.lost;
        fixture_close(&f);
    }
    assert_true(all_met <= BATTLES); /* in the mean one in five battles */
    print_message("lost %u of %u\n", all.lost, all.of);
    assert_true(all.lost * 5 >= all.of && all.lost * 5 <= 3 * all.of); /* 20 to 60 % */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_side_loses_aircraft_and_keeps_some),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
