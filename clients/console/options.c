/* The command line of jolon-console. */
#include "clients/console/options.h"

#include "ipc/http/listen.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/segment/segment.h"

static struct options given = {
    .world = "default", .address = HTTP_LISTEN_ADDRESS, .port = OPTIONS_PORT};

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, segment_name_option),
    {"port", "N", "port of the server (default 8080; 0: any free one)", .u32 = &given.port,
     .most = UINT16_MAX},
    {"address", "ADDRESS", "(default 127.0.0.1: only this machine reaches it)",
     .text = &given.address},
    {"token-file", "FILE",
     "holds the token, without which the world cannot be changed; made if missing (default: a new "
     "token each time, which is printed)",
     .text = &given.token_file},
    OPTION_ROW_PARENT(given),
    {"role", NULL, "it is the console of the world's set, as jolon run --console starts it",
     .flag = &given.role},
    OPTION_ROW_NO_SANDBOX(given),
    OPTION_ROWS_END};

void options_parse(struct options *options, int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-console",
        .usage = "[options]",
        .rows = rows,
        .ending = "It prints the address to open. Ctrl-C ends it; the world continues.\n"};
    option_table_read(&table, argc, argv);
    *options = given;
}
