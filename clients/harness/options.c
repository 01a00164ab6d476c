/* The command line of jolon-harness. */
#include "clients/harness/options.h"

#include "ipc/topics/command_route.h"

static struct options given = {.world = "default", .timeout_s = 30.0};

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, segment_name_option),
    {"timeout", "SECONDS", "how long to wait for the world, and for a reply (default 30)",
     .real = &given.timeout_s, .low = 0.1, .high = 3600.0},
    DDS_LINK_READER_OPTION_ROWS(given.link),
    COMMAND_ROUTE_OPTION_ROW(given.remote),
    OPTION_ROWS_END};

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-harness",
        .usage =
            "[options]\n"
            "Drives vehicles for a program: one JSON object a line on standard input, as\n"
            "  {\"id\":1,\"do\":\"drive\",\"vehicle\":7,\"throttle\":0.5,\"steer\":0.1}\n"
            "  {\"id\":2,\"want\":{\"entities\":[7,8],\"rate_hz\":10,\"events\":[\"fire\"]}}\n"
            "and one object a line on standard output: the world, answers, frames, entities,\n"
            "events, errors.\n"
            "It ends when standard input ends and every command is answered. See docs/harness.md.\n"
            "options:",
        .rows = rows,
        .ending = "exit: 0 every command was answered, 1 no world, no reply, or no reader, 2 "
                  "usage\n"};
    option_table_read(&table, argc, argv);
    *options = given;
}
