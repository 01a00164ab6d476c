/* The recorder's options. */
#include "recorder/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <getopt.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define EVERY_FRAMES 3600 /* a minute at 60 Hz */

static const char usage[] =
    "usage: jolon-recorder --commands FILE [--events FILE] [--checkpoint FILE [--every FRAMES]]\n"
    "       [--world NAME] [--parent PID] [--no-sandbox]\n";

struct options options_read(int argc, char **argv)
{
    static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                          {"commands", required_argument, NULL, 'c'},
                                          {"events", required_argument, NULL, 'e'},
                                          {"parent", required_argument, NULL, 'p'},
                                          {"checkpoint", required_argument, NULL, 'k'},
                                          {"every", required_argument, NULL, 'n'},
                                          {"no-sandbox", no_argument, NULL, 'S'},
                                          {"help", no_argument, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
    struct options options = {.world = "default", .every = EVERY_FRAMES};
    int option;
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
        switch (option) {
        case 'w':
            options.world = optarg;
            break;
        case 'c':
            options.commands = optarg;
            break;
        case 'e':
            options.events = optarg;
            break;
        case 'k':
            options.checkpoint = optarg;
            break;
        case 'n':
            options.every = process_whole("every", optarg, 1, UINT32_MAX);
            break;
        case 'p':
            options.parent = (int)process_whole("parent", optarg, 1, INT32_MAX);
            break;
        case 'S':
            options.sandbox_off = true;
            break;
        case 'h':
            fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; try jolon-recorder --help",
                      argv[optind - 1]);
        }
    }
    if (optind < argc)
        die_usage("%s: takes no arguments; try jolon-recorder --help", argv[optind]);
    if (!options.commands)
        die_usage("--commands FILE is missing; try jolon-recorder --help");
    return options;
}
