/* jolon-dis: tools for DIS that need no world. jolon dis VERB runs it. */
#include "gateway/tool/dump.h"
#include "gateway/tool/play.h"
#include "gateway/tool/record.h"
#include "gateway/tool/send.h"
#include "gateway/tool/undulation.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/process/program_verbs.h"

#include <stddef.h>

static const struct program_verb verbs[] = {{"dump", dump_run},
                                            {"send", send_run},
                                            {"record", record_run},
                                            {"play", play_run},
                                            {"undulation", undulation_run},
                                            {NULL, NULL}};

static const char usage[] =
    "usage: jolon dis VERB [options]\n"
    "  dump [FILE]                    show the PDUs of a capture, or those that come\n"
    "    --listen ADDRESS[:PORT]  --interface NAME  --port N  --type NAME  --count N\n"
    "    --seconds S  --summary  --json\n"
    "  send TYPE [FIELD=VALUE ...]    send one PDU\n"
    "    --to ADDRESS[:PORT]  --interface NAME  --file FILE  --version 6|7  --exercise N\n"
    "    --status N  --timestamp S  --count N  --every S  --fields\n"
    "  record FILE                    write the datagrams that come into a new capture\n"
    "    --listen ADDRESS[:PORT]  --interface NAME  --count N  --seconds S\n"
    "  play FILE                      send the datagrams of a capture again\n"
    "    --to ADDRESS[:PORT]  --interface NAME  --port N  --speed F|max\n"
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
    return program_verbs_find(verbs, usage, argc, argv)->run(argc - 1, argv + 1);
}
