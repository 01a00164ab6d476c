/* Agents fight in the streets of the shipped town without running into its houses. SEEDS=n runs so
 * many seeds. */
#include "tests/support/fixture.h"
#include "world/entity/kind.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define SECONDS  240u
#define HARD_MPS 2.0 /* a gun that touches a wall while its tank turns does so more slowly */

static struct fixture f;

/* The scenario, with the path of its ground and another seed. */
static void open_town(unsigned seed)
{
    static char file[8192], text[16384];
    char path[512];
    snprintf(path, sizeof path, "%s/scenarios/town.cfg", fixture_shipped_dir());
    FILE *stream = fopen(path, "r");
    assert_non_null(stream);
    file[fread(file, 1, sizeof file - 1, stream)] = '\0';
    fclose(stream);
    char *vehicles = strstr(file, "vehicles = (");
    assert_non_null(vehicles);
    snprintf(text, sizeof text,
             "world = { seed = %u; capacity = 512; };"
             "terrain = { source = \"file\"; file = \"%s/grounds/town.ground\"; };"
             "collision = { shape = \"model\"; }; %s",
             seed, fixture_shipped_dir(), vehicles);
    fixture_open(&f, text);
}

static bool is_house(const struct event_party *party)
{
    return party->fixed && f.view.world.kinds[party->kind].outline;
}

static void test_agents_do_not_run_into_houses(void **state)
{
    const char *more = getenv("SEEDS");
    unsigned seeds = more ? (unsigned)strtoul(more, NULL, 10) : 3, shots = 0, hits = 0, hard = 0;
    (void)state;
    for (unsigned seed = 1; seed <= seeds; seed++) {
        open_town(seed);
        fixture_run(&f, SECONDS * 60);
        shots += fixture_event_count(&f, EVENT_FIRE);
        for (uint32_t n = 0; n < fixture_event_count(&f, EVENT_COLLISION); n++) {
            const struct event_collision *hit = &fixture_event(&f, EVENT_COLLISION, n)->collision;
            bool wreck = hit->a.damage == DAMAGE_DESTROYED;
            if (!hit->begins || wreck || !is_house(&hit->b))
                continue;
            hits++;
            hard += (double)hit->closing_mps > HARD_MPS;
        }
        fixture_close(&f);
    }
    print_message(
        "%u seeds: %u shots, %u times a house was touched, %u times with more than %.0f m/s\n",
        seeds, shots, hits, hard, HARD_MPS);
    assert_true(shots > 0);
    assert_true(hits <= 10 * seeds && hard <= 2 * seeds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_agents_do_not_run_into_houses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
