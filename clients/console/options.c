/* jolon-console's arguments. */
#include "clients/console/options.h"

#include "ipc/http/listen.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment.h"

#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

static const char usage[] =
    "usage: jolon-console [options]\n"
    "  -w, --world NAME    (default \"default\")\n"
    "  --port N            where browsers find it (default 8080; 0: any that is free)\n"
    "  --address ADDRESS   (default 127.0.0.1: nobody but this machine reaches it)\n"
    "  --token-file FILE   who knows what it holds may change the world; made when it is not\n"
    "                      there (default: a new token each time, which is printed)\n"
    "  --parent PID        ends when that process does\n"
    "  --role              it is the console of the world's set, as jolon run --console starts it\n"
    "  --no-sandbox        it keeps all that its user may do\n"
    "It prints the address to open. Ctrl-C ends it; the world goes on.\n";

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                          {"port", required_argument, NULL, 'p'},
                                          {"address", required_argument, NULL, 'a'},
                                          {"token-file", required_argument, NULL, 't'},
                                          {"parent", required_argument, NULL, 'P'},
                                          {"role", no_argument, NULL, 'r'},
                                          {"no-sandbox", no_argument, NULL, 'S'},
                                          {"help", no_argument, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
    int option;
    *options =
        (struct options){.world = "default", .address = HTTP_LISTEN_ADDRESS, .port = OPTIONS_PORT};
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
        switch (option) {
        case 'w':
            options->world = optarg;
            break;
        case 'p':
            options->port = (uint16_t)process_whole("port", optarg, 0, UINT16_MAX);
            break;
        case 'a':
            options->address = optarg;
            break;
        case 't':
            options->token_file = optarg;
            break;
        case 'P':
            options->parent = (int)process_whole("parent", optarg, 1, INT_MAX);
            break;
        case 'r':
            options->role = true;
            break;
        case 'S':
            options->sandbox_off = true;
            break;
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; jolon-console --help lists "
                      "them",
                      argv[optind - 1]);
        }
    }
    if (optind < argc)
        die_usage("'%s': no such argument; jolon-console --help lists the options", argv[optind]);
    if (!segment_name_ok(options->world))
        die_usage("--world %s: no name for a world: 1 to %d of a-z A-Z 0-9 _ -", options->world,
                  SEGMENT_NAME_MAX - 1);
}
