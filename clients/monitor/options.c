/* The command line of jolon-monitor. */
#include "clients/monitor/options.h"

#include "ipc/process/log.h"

static struct options given = {.world = "default"};
static bool vehicles;

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, segment_name_option),
    {"once", NULL, "print the status and exit; 1 when none comes within 3 s", .flag = &given.once},
    {"json", NULL, "the status as JSON, one object a line", .flag = &given.json},
    {"events", NULL, "every event as a JSON line, the latest 4096 of each type first",
     .flag = &given.events},
    {"vehicles", NULL, "with --json: the vehicles too, one object each under \"list\"",
     .flag = &vehicles},
    {"filter", "WORDS", "only vehicles that match, as 'red tank speed>10'; implies --vehicles",
     .text = &given.filter},
    {"lines", NULL, "one status line a second, also on a terminal", .flag = &given.lines},
    {"rate", "HZ", "updates a second of the screen (default 5) or the lines (default 1)",
     .real = &given.rate_hz, .low = 0.01, .high = 20.0},
    DDS_LINK_READER_OPTION_ROWS(given.link),
    OPTION_ROWS_END};

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option_table table = {.program = "jolon-monitor",
                                              .usage = "[options]",
                                              .rows = rows,
                                              .ending =
                                                  "On a terminal it shows a screen; q quits.\n"};
    option_table_read(&table, argc, argv);
    if (vehicles && !given.filter)
        given.filter = "";
    if (given.filter && (!given.json || given.events))
        die_usage("--vehicles and --filter: only with --json");
    if (given.events && (given.once || given.lines))
        die_usage("--events: not together with --once or --lines");
    *options = given;
}
