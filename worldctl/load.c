/* Scenarios into worlds. */
#include "worldctl/load.h"

#include "config/loader.h"
#include "ipc/log.h"
#include "ipc/process.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

void load_recipe_seconds(const struct arguments *arguments, struct recipe *recipe)
{
    char text[32];
    snprintf(text, sizeof text, "%.17g", arguments->seconds);
    if (arguments->seconds > 0.0 && recipe_add(recipe, "seconds", text) != 0)
        die_refused("--seconds %s: no room in the recipe: %s", text, strerror(errno));
}

void load_scenario(const struct arguments *arguments, struct scenario *scenario)
{
    char data_dir[512];
    struct loader_message message;
    if (process_data_dir(data_dir, sizeof data_dir) != 0)
        die_refused("cannot find the data (kinds, models, scenarios) beside the programs; set "
                    "JOLON_DATA to the folder that holds kinds/");
    if (loader_scenario(scenario, data_dir, arguments->path, arguments->set, arguments->sets,
                        &message) != 0)
        die_refused("%s", message.text);
    arguments_seconds(arguments, &scenario->params);
    load_recipe_seconds(arguments, &scenario->recipe);
}

void load_generate(const struct scenario *scenario, struct genesis *genesis)
{
    char text[512];
    if (genesis_build(genesis, scenario, text, sizeof text) != 0)
        die_refused("%s: %s", scenario->params.scenario, text);
}
