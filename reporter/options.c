/* jolon-reporter's arguments. */
#include "reporter/options.h"

static struct options given = {.world = "default"};

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, NULL),
    OPTION_ROW_PARENT(given),
    OPTION_ROW_NO_SANDBOX(given),
    DDS_LINK_OPTION_ROWS(given.link),
    {"remote-commands", NULL,
     "take commands over DDS too; without DDS Security, which only a configuration file turns on, "
     "every host that reaches the interface commands the world",
     .flag = &given.remote_commands},
    OPTION_ROWS_END};

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-reporter", .usage = "[options]", .rows = rows};
    option_table_read(&table, argc, argv);
    *options = given;
}
