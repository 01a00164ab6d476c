/* The recorder's options. */
#include "recorder/options.h"

#include "ipc/process/log.h"
#include "ipc/process/option_table.h"

#include <stddef.h>

static struct options given = {.world = "default", .every = 3600};

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, NULL),
    {"commands", "FILE", "log the commands", .text = &given.commands},
    {"events", "FILE", "log the events", .text = &given.events},
    {"checkpoint", "FILE", "write checkpoints of the world to this file",
     .text = &given.checkpoint},
    {"every", "FRAMES", "frames between two checkpoints (default 3600: a minute at 60 Hz)",
     .u64 = &given.every, .least = 1, .most = UINT32_MAX},
    OPTION_ROW_PARENT(given),
    OPTION_ROW_NO_SANDBOX(given),
    OPTION_ROWS_END};

struct options options_read(int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-recorder", .usage = "--commands FILE [options]", .rows = rows};
    option_table_read(&table, argc, argv);
    if (!given.commands)
        die_usage("--commands FILE is missing; try jolon-recorder --help");
    return given;
}
