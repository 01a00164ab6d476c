/* jolon-intake's arguments. */
#include "reporter/intake/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

static const char usage[] = "usage: jolon-intake [options]\n"
                            "  -w, --world NAME     (default \"default\")\n"
                            "  --parent PID         end when this process does\n"
                            "  --no-sandbox         give up no privileges\n";

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                          {"parent", required_argument, NULL, 'p'},
                                          {"no-sandbox", no_argument, NULL, 'n'},
                                          {"help", no_argument, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
    int option;
    *options = (struct options){.world = "default"};
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
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
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; jolon-intake --help lists them",
                      argv[optind - 1]);
        }
    }
    if (optind < argc)
        die_usage("'%s': no such argument; jolon-intake --help lists the options", argv[optind]);
}
