/* jolon-drive's arguments. */
#include "clients/drive/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/topics/command_route.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define RATE_MIN_HZ 0.1
#define RATE_MAX_HZ 60.0
#define SCREEN_HZ   10.0
#define LINES_HZ    1.0

static const char usage[] =
    "usage: jolon-drive [options] [ID|NAME|KIND|FORCE]\n"
    "Drives a vehicle: by its id, its name, or the first free one of a kind or force; without\n"
    "any, the first free one. h shows the keys, q gives the vehicle back and quits.\n"
    "  -w, --world NAME       (default \"default\")\n"
    "  --input auto|keys|gamepad|spacemouse   (default auto: keys and what else is there)\n"
    "  --device PATH          the gamepad: /dev/input/event*\n"
    "  --plain                no screen: lines on standard output; keys may come from a pipe\n"
    "  --rate HZ              how often the screen (default 10) or the line (default 1) is made\n"
    "  --dds-config FILE, --interface ADDRESS, --domain N  as jolon-reporter\n"
    "  --remote               commands go over DDS, to a set elsewhere that takes such\n"
    "                         commands; else to your own world on this machine\n"
    "exit: 0 quit, 1 refused: no such vehicle, no such device, 2 usage\n";

static enum inputs_choice parse_input(const char *text)
{
    static const char *const names[] = {"auto", "keys", "gamepad", "spacemouse"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(names[i], text) == 0)
            return (enum inputs_choice)i;
    }
    die_usage("--input %s: not auto, keys, gamepad or spacemouse", text);
}

static void check(struct options *options, int argc, char **argv)
{
    if (optind < argc)
        options->wanted = argv[optind++];
    if (optind < argc)
        die_usage("'%s': one vehicle at a time; jolon-drive --help says how to name it",
                  argv[optind]);
    if (options->device && options->input != INPUTS_AUTO && options->input != INPUTS_GAMEPAD)
        die_usage("--device %s: is a gamepad's; not together with another --input",
                  options->device);
    dds_link_check_world(options->world);
    options->plain = options->plain || !isatty(STDOUT_FILENO) || !isatty(STDIN_FILENO);
    if (options->rate_hz <= 0.0)
        options->rate_hz = options->plain ? LINES_HZ : SCREEN_HZ;
}

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                          {"input", required_argument, NULL, 'i'},
                                          {"device", required_argument, NULL, 'd'},
                                          {"plain", no_argument, NULL, 'p'},
                                          {"rate", required_argument, NULL, 'r'},
                                          DDS_LINK_LONG_OPTIONS,
                                          COMMAND_ROUTE_LONG_OPTION,
                                          {"help", no_argument, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
    int option;
    *options = (struct options){.world = "default"};
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
        if (dds_link_option(&options->link, option, optarg))
            continue;
        switch (option) {
        case 'w':
            options->world = optarg;
            break;
        case 'i':
            options->input = parse_input(optarg);
            break;
        case 'd':
            options->device = optarg;
            break;
        case 'p':
            options->plain = true;
            break;
        case 'r':
            options->rate_hz = process_number("rate", optarg, RATE_MIN_HZ, RATE_MAX_HZ);
            break;
        case COMMAND_ROUTE_OPTION:
            options->remote = true;
            break;
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; jolon-drive --help lists "
                      "them",
                      argv[optind - 1]);
        }
    }
    check(options, argc, argv);
}
