/* Scenarios made into worlds. */
#include "recorder/replay/scenario_load.h"

#include "config/loader.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void scenario_load_note_seconds(const struct arguments *arguments, struct provenance *recipe)
{
    char text[32];
    snprintf(text, sizeof text, "%.17g", arguments->seconds);
    if (arguments->seconds > 0.0 && provenance_add(recipe, "seconds", text) != 0)
        die_refused("--seconds %s: no room in the provenance of the world: %s", text,
                    strerror(errno));
}

/* Progress of the placement, shown on a terminal ten times a second once it has taken a second. */
static uint64_t placing_begun_ns, placing_shown_ns;

static void show_placing(uint32_t placed, uint32_t of)
{
    uint64_t now_ns = clock_now_ns();
    if (placing_begun_ns == 0)
        placing_begun_ns = now_ns;
    if (now_ns - placing_begun_ns < NS_PER_S || now_ns - placing_shown_ns < NS_PER_S / 10)
        return;
    placing_shown_ns = now_ns;
    (void)fprintf(stderr, "\r%u of %u vehicles have a place", placed, of);
}

void scenario_load(const struct arguments *arguments, struct scenario *scenario)
{
    char data_dir[512];
    struct error_text error;
    if (process_data_dir(data_dir, sizeof data_dir) != 0)
        die_refused("cannot find the data (kinds, models, scenarios) beside the programs; set "
                    "JOLON_DATA to the folder that holds kinds/");
    if (loader_scenario(scenario, data_dir, arguments->path, arguments->set, arguments->sets,
                        &error) != 0)
        die_refused("%s", error.text);
    if (isatty(STDERR_FILENO))
        scenario->placing = show_placing;
    arguments_seconds(arguments, &scenario->settings->params);
    scenario_load_note_seconds(arguments, &scenario->recipe);
}

void scenario_load_generate(const struct scenario *scenario, struct world_build *built)
{
    struct error_text error;
    int result = world_build_make(built, scenario, &error);
    if (placing_shown_ns > 0)
        (void)fputs("\r\033[K", stderr);
    if (result != 0)
        die_refused("%s", error.text);
    if (built->raised > 0)
        (void)fprintf(
            stderr,
            "aeroplanes that begin higher than their altitude_m, because the ground ahead "
            "rises faster than they can climb: %u\n",
            built->raised);
}
