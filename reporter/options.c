/* jolon-reporter's arguments. */
#include "reporter/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

static const char usage[] =
    "usage: jolon-reporter [options]\n"
    "  -w, --world NAME     (default \"default\")\n"
    "  --parent PID         end when this process does\n"
    "  --no-sandbox         give up no privileges\n"
    "  --dds-config FILE    a Cyclone DDS configuration instead of the built-in one\n"
    "  --interface ADDRESS  publish on this interface (address or name) instead of loopback\n"
    "  --domain N           DDS domain, 0 to 230 (default 0)\n"
    "  --remote-commands    take commands over DDS too; without DDS Security, which only a\n"
    "                       configuration file turns on, anybody who reaches the interface\n"
    "                       commands the world\n";

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                          {"parent", required_argument, NULL, 'p'},
                                          {"no-sandbox", no_argument, NULL, 'n'},
                                          DDS_LINK_LONG_OPTIONS,
                                          {"help", no_argument, NULL, 'h'},
                                          {"remote-commands", no_argument, NULL, 'r'},
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
        case 'p':
            options->parent = (int)process_whole("parent", optarg, 1, INT32_MAX);
            break;
        case 'n':
            options->sandbox_off = true;
            break;
        case 'r':
            options->remote_commands = true;
            break;
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; jolon-reporter --help lists "
                      "them",
                      argv[optind - 1]);
        }
    }
    if (optind < argc)
        die_usage("'%s': no such argument; jolon-reporter --help lists the options", argv[optind]);
}
