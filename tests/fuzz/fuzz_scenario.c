/* Scenario files and --set: read and checked. A small accepted scenario is made into a world. */
#include "tests/fuzz/support.h"

#include "config/syntax/literals.h"
#include "ipc/segment/segment.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/runtime/check.h"
#include "world/terrain/gridsquare.h"

#include <string.h>

#define OVERRIDES_MAX 8
#define OVERRIDE_MARK "#--set "

/* Comment lines at the beginning are overrides: "#--set KEY=VALUE". */
static int take_overrides(char *text, const char *overrides[OVERRIDES_MAX], const char **rest)
{
    int count = 0;
    while (count < OVERRIDES_MAX && strncmp(text, OVERRIDE_MARK, strlen(OVERRIDE_MARK)) == 0) {
        char *end = text + strcspn(text, "\n");
        overrides[count++] = text + strlen(OVERRIDE_MARK);
        text = *end == '\0' ? end : end + 1;
        *end = '\0';
    }
    *rest = text;
    return count;
}

/* Smaller than the shipped sizes, which would take seconds. */
static bool is_small(const struct scenario *scenario)
{
    return scenario->settings->terrain == TERRAIN_FLAT &&
           scenario->settings->objects != OBJECTS_TABLE1 && scenario->settings->spacing_m > 100.0 &&
           scenario->settings->params.capacity <= 4096 &&
           scenario->settings->params.initial_entities <= 64;
}

static void make_world(const struct scenario *scenario)
{
    struct world_build built;
    struct layout layout;
    struct error_text error = {0};
    if (world_build_make(&built, scenario, &error) != 0) {
        CHECK(error.text[0] != '\0');
        return;
    }
    struct segment_header header = segment_header_for(&scenario->settings->params, &built.counts);
    CHECK(layout_compute(&layout, &header) == 0);
    CHECK(built.used == scenario->settings->params.initial_entities);
    for (uint32_t i = 0; i < built.used; i++) {
        CHECK(built.first.row[i].x >= 0.0 && built.first.row[i].x <= WORLD_SIDE_DEFAULT_M);
        CHECK(built.first.row[i].z >= 0.0 && built.first.row[i].z <= WORLD_SIDE_DEFAULT_M);
        CHECK(built.first.row[i].y >= -1e5 && built.first.row[i].y <= 1e5);
    }
    world_build_free(&built);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char text[65536];
    static const struct scenario empty;
    const char *overrides[OVERRIDES_MAX], *rest;
    struct error_text error;
    struct scenario scenario;
    if (size >= sizeof text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    int count = take_overrides(text, overrides, &rest);
    const char *path = support_file(rest, size - (size_t)(rest - text));
    if (loader_scenario(&scenario, support_data_dir(), path, overrides, count, &error) != 0) {
        support_check_message(&error);
        CHECK(memcmp(&scenario, &empty, sizeof empty) == 0);
        return 0;
    }
    support_check_scenario(&scenario);
    if (is_small(&scenario))
        make_world(&scenario);
    scenario_free(&scenario);
    return 0;
}
