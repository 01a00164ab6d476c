/* jolon-gateway's arguments. */
#include "gateway/options.h"

#include "ipc/process/option_table.h"

#include <stddef.h>

static struct options given = {.world = "default"};

static const struct option_row rows[] = {OPTION_ROW_WORLD(given, NULL), OPTION_ROW_PARENT(given),
                                         OPTION_ROW_NO_SANDBOX(given), OPTION_ROWS_END};

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-gateway", .usage = "[options]", .rows = rows};
    option_table_read(&table, argc, argv);
    *options = given;
}
