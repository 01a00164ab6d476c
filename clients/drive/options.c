/* The command line of jolon-drive. */
#include "clients/drive/options.h"

#include "ipc/process/log.h"
#include "ipc/topics/command_route.h"

#include <unistd.h>

#define SCREEN_HZ 10.0
#define LINES_HZ  1.0

static struct options given = {.world = "default"};
static int input = INPUTS_AUTO;

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, segment_name_option),
    {"input", "auto|keys|gamepad|spacemouse", "(default auto: keys and the connected devices)",
     .choice = &input},
    {"device", "PATH", "the gamepad: /dev/input/event*", .text = &given.device},
    {"plain", NULL, "no screen: lines on standard output; keys may come from a pipe",
     .flag = &given.plain},
    {"rate", "HZ", "updates a second of the screen (default 10) or the lines (default 1)",
     .real = &given.rate_hz, .low = 0.1, .high = 60.0},
    DDS_LINK_READER_OPTION_ROWS(given.link),
    COMMAND_ROUTE_OPTION_ROW(given.remote),
    OPTION_ROWS_END};

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-drive",
        .usage = "[options] [ID|NAME|KIND|FORCE]\n"
                 "Drives a vehicle: by its id, its name, or the first free one of a kind or force; "
                 "without\n"
                 "any, the first free one. h shows the keys, q gives the vehicle back and quits.",
        .rows = rows,
        .ending = "exit: 0 quit, 1 refused: no such vehicle, no such device, 2 usage\n",
        .plain = 1};
    if (option_table_read(&table, argc, argv) > 0)
        given.wanted = argv[argc - 1];
    given.input = (enum inputs_choice)input;
    if (given.device && given.input != INPUTS_AUTO && given.input != INPUTS_GAMEPAD)
        die_usage("--device %s: is for a gamepad, and not for another --input", given.device);
    given.plain = given.plain || !isatty(STDOUT_FILENO) || !isatty(STDIN_FILENO);
    if (given.rate_hz <= 0.0)
        given.rate_hz = given.plain ? LINES_HZ : SCREEN_HZ;
    *options = given;
}
