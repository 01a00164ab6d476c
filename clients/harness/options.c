/* Options, each with its check. */
#include "clients/harness/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/topics/command_route.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#define TIMEOUT_S     30.0
#define TIMEOUT_MIN_S 0.1
#define TIMEOUT_MAX_S 3600.0

static const char usage[] =
    "usage: jolon-harness [options]\n"
    "Drives vehicles for a program: one JSON object a line on standard input, as\n"
    "  {\"id\":1,\"do\":\"drive\",\"vehicle\":7,\"throttle\":0.5,\"steer\":0.1}\n"
    "  {\"id\":2,\"want\":{\"entities\":[7,8],\"rate_hz\":10,\"events\":[\"fire\"]}}\n"
    "and one a line on standard output: the world, answers, frames, entities, events, errors.\n"
    "It ends when standard input ends and every command is answered. See docs/harness.md.\n"
    "options:\n"
    "  -w, --world NAME       (default \"default\")\n"
    "  --timeout SECONDS      how long to wait for the world, and for a reply (default 30)\n"
    "  --dds-config FILE, --interface ADDRESS, --domain N  as jolon-reporter\n"
    "  --remote               commands go over DDS, to a set elsewhere that takes such\n"
    "                         commands; else to your own world on this machine\n"
    "exit: 0 everything was answered, 1 no world, no reply, or nobody reads, 2 usage\n";

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                          {"timeout", required_argument, NULL, 't'},
                                          {"help", no_argument, NULL, 'h'},
                                          DDS_LINK_LONG_OPTIONS,
                                          COMMAND_ROUTE_LONG_OPTION,
                                          {NULL, 0, NULL, 0}};
    int option;
    *options = (struct options){.world = "default", .timeout_s = TIMEOUT_S};
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
        if (dds_link_option(&options->link, option, optarg))
            continue;
        switch (option) {
        case 'w':
            options->world = optarg;
            break;
        case 't':
            options->timeout_s = process_number("timeout", optarg, TIMEOUT_MIN_S, TIMEOUT_MAX_S);
            break;
        case COMMAND_ROUTE_OPTION:
            options->remote = true;
            break;
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; --help lists them",
                      argv[optind - 1]);
        }
    }
    if (optind < argc)
        die_usage("'%s': takes no argument; commands come on standard input", argv[optind]);
    dds_link_check_world(options->world);
}
