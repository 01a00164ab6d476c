/* jolon-monitor's arguments. */
#include "clients/monitor/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#define RATE_MIN_HZ 0.01
#define RATE_MAX_HZ 20.0

static const char usage[] =
    "usage: jolon-monitor [options]\n"
    "  -w, --world NAME   (default \"default\")\n"
    "  --once             print the status and exit; 1 when none comes within 3 s\n"
    "  --json             the status as JSON, one object a line\n"
    "  --events           every event as a JSON line, the latest 4096 of each type first\n"
    "  --vehicles         with --json: the vehicles too, one object each under \"list\"\n"
    "  --filter WORDS     only those that suit, as 'red tank speed>10'; means --vehicles\n"
    "  --lines            one status line a second, also on a terminal\n"
    "  --rate HZ          how often the screen (default 5) or the line (default 1) is made anew\n"
    "  --dds-config FILE, --interface ADDRESS, --domain N  as jolon-reporter\n"
    "On a terminal it shows a screen; q quits.\n";

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                          {"once", no_argument, NULL, 'o'},
                                          {"json", no_argument, NULL, 'j'},
                                          {"events", no_argument, NULL, 'e'},
                                          {"lines", no_argument, NULL, 'l'},
                                          {"vehicles", no_argument, NULL, 'v'},
                                          {"filter", required_argument, NULL, 'f'},
                                          {"rate", required_argument, NULL, 'r'},
                                          DDS_LINK_LONG_OPTIONS,
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
        case 'o':
            options->once = true;
            break;
        case 'j':
            options->json = true;
            break;
        case 'e':
            options->events = true;
            break;
        case 'l':
            options->lines = true;
            break;
        case 'v':
            options->filter = options->filter ? options->filter : "";
            break;
        case 'f':
            options->filter = optarg;
            break;
        case 'r':
            options->rate_hz = process_number("rate", optarg, RATE_MIN_HZ, RATE_MAX_HZ);
            break;
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; jolon-monitor --help lists "
                      "them",
                      argv[optind - 1]);
        }
    }
    if (optind < argc)
        die_usage("'%s': no such argument; jolon-monitor --help lists the options", argv[optind]);
    dds_link_check_world(options->world);
    if (options->filter && (!options->json || options->events))
        die_usage("--vehicles and --filter: only with --json");
    if (options->events && (options->once || options->lines))
        die_usage("--events: not together with --once or --lines");
}
