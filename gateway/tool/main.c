/* jolon-dis: tools for DIS that need no world. jolon dis VERB runs it. */
#include "gateway/tool/dump.h"
#include "gateway/tool/play.h"
#include "gateway/tool/record.h"
#include "gateway/tool/send.h"
#include "gateway/tool/undulation.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
} verbs[] = {{"dump", dump_run},
             {"send", send_run},
             {"record", record_run},
             {"play", play_run},
             {"undulation", undulation_run}};

static const char usage[] =
    "usage: jolon dis VERB [options]\n"
    "  dump [FILE]                    show the PDUs of a capture, or those that come\n"
    "    --listen ADDRESS[:PORT]  --interface ADDRESS  --port N  --type NAME  --count N\n"
    "    --seconds S  --summary  --json\n"
    "  send TYPE [FIELD=VALUE ...]    send one PDU\n"
    "    --to ADDRESS[:PORT]  --interface ADDRESS  --file FILE  --version 6|7  --exercise N\n"
    "    --status N  --timestamp S  --count N  --every S  --fields\n"
    "  record FILE                    write the datagrams that come into a new capture\n"
    "    --listen ADDRESS[:PORT]  --interface ADDRESS  --count N  --seconds S\n"
    "  play FILE                      send the datagrams of a capture again\n"
    "    --to ADDRESS[:PORT]  --interface ADDRESS  --port N  --speed F|max\n"
    "  undulation LATITUDE LONGITUDE  print gateway.undulation_m, the height of the sea there\n"
    "    --grid FILE\n"
    "jolon dis VERB --help explains the options of a verb.\n"
    "DIS is Distributed Interactive Simulation, IEEE 1278.1. Addresses are those of this "
    "machine's\n"
    "loopback unless you name another one. No verb needs a world.\n";

int main(int argc, char **argv)
{
    log_open("dis");
    process_guard();
    process_signals();
    if (argc < 2) {
        fputs(usage, stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0 ||
        strcmp(argv[1], "-h") == 0) {
        fputs(usage, stdout);
        return EXIT_OK;
    }
    for (unsigned i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        if (strcmp(argv[1], verbs[i].name) == 0)
            return verbs[i].run(argc - 1, argv + 1);
    }
    die_usage("%s: no such verb; there are dump, send, record, play, undulation", argv[1]);
}
