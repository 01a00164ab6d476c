/* The command line of a role without options of its own. */
#include "ipc/process/role_options.h"

#include "ipc/process/option_table.h"

#include <stddef.h>

struct role_options role_options_read(const char *program, int argc, char **argv)
{
    static struct role_options given;
    given = (struct role_options){.world = "default"};
    const struct option_row rows[] = {OPTION_ROW_WORLD(given, NULL), OPTION_ROW_PARENT(given),
                                      OPTION_ROW_NO_SANDBOX(given), OPTION_ROWS_END};
    const struct option_table table = {.program = program, .usage = "[options]", .rows = rows};
    option_table_read(&table, argc, argv);
    return given;
}
