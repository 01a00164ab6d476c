/* The command line of jolon-ctl: the program's options, and those of the commands, which are made
 * from the table of their fields. */
#include "clients/ctl/parse.h"

#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/topics/command_route.h"

#include <stdio.h>
#include <string.h>

#define WORDS_MAX   40
#define DOMAIN_NONE UINT32_MAX /* --domain is not given */

static struct ctl_request given;

/* The values of the commands' options, by field; NULL: not given. */
static struct {
    const char *value[COMMAND_TEXT_FIELD_COUNT];
} words;

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, segment_name_option),
    {"json", NULL, "the reply as one JSON object", .flag = &given.json},
    {"timeout", "SECONDS", "how long to wait for a reply (default 5)", .real = &given.timeout_s,
     .low = 0.01, .high = 3600.0},
    COMMAND_ROUTE_OPTION_ROW(given.remote),
    DDS_LINK_READER_OPTION_ROWS(given.link),
    OPTION_ROWS_END};

/* The commands' options, which the usage text describes. */
static const struct option_row *order_rows(void)
{
    static struct option_row row[COMMAND_TEXT_FIELD_COUNT + 1];
    for (int i = 0; i < COMMAND_TEXT_FIELD_COUNT; i++) {
        enum command_text_field field = (enum command_text_field)i;
        row[i] =
            (struct option_row){.name = command_text_field_option(field),
                                .argument = command_text_field_is_truth(field) ? NULL : "VALUE",
                                .text = &words.value[i]};
    }
    return row;
}

static const char usage[] =
    "[options] COMMAND\n"
    "  pause | resume | quit\n"
    "  step N                 advance N frames while paused\n"
    "  scale X                simulated seconds a second of the clock\n"
    "  drive VEHICLE [--throttle T] [--steer S] [--climb C] [--traverse T] [--elevate E]\n"
    "        [--brake B] [--gear automatic|reverse|neutral|low] [--lease SECONDS]\n"
    "                         each -1 to 1, right and up are positive; the brake 0 to 1\n"
    "  release VEHICLE [--anyway]\n"
    "                         back to its agent; --anyway: from any driver\n"
    "  fire VEHICLE [--target VEHICLE]\n"
    "                         without a target: straight ahead\n"
    "  fire --munition KIND --at PLACE [--rounds N] [--every SECONDS] [--radius METRES]\n"
    "        [--seed N]       out of the sky, N rounds about that place\n"
    "  spawn KIND --at PLACE [--force neutral|blue|red] [--behaviour idle|hold|patrol]\n"
    "        [--altitude METRES] [--heading DEGREES] [--speed MPS]\n"
    "  remove VEHICLE\n"
    "  -                      commands from standard input, one a line, one after the other\n"
    "VEHICLE: an id, or a name in the scenario\n"
    "PLACE: X,Z in metres east and south of the north-west corner, degrees as\n"
    "44.2705N,71.3033W, or a reference of the MGRS as 19TCK1617404497\n"
    "options:";

static int give(struct command_text *order, enum command_text_field field, const char *text,
                const char *label, struct error_text *error)
{
    struct error_text detail;
    struct command_text_value value = {.text = text, .loose = true};
    if (command_text_field_is_truth(field))
        value = (struct command_text_value){.truth = true, .is_truth = true};
    if (command_text_give(order, field, &value, &detail) != 0)
        return error_text_set(error, "%s: %s%.400s", order->verb->name, label, detail.text);
    return 0;
}

static int give_options(struct command_text *order, struct error_text *error)
{
    char label[32];
    for (int i = 0; i < COMMAND_TEXT_FIELD_COUNT; i++) {
        enum command_text_field field = (enum command_text_field)i;
        if (!words.value[i])
            continue;
        (void)snprintf(label, sizeof label, "--%s ", command_text_field_option(field));
        if (!(order->verb->allowed & 1u << i))
            return error_text_set(error, "%s: does not take --%s", order->verb->name,
                                  command_text_field_option(field));
        if (give(order, field, words.value[i], label, error) != 0)
            return -1;
    }
    return 0;
}

/* Makes the command of a verb, its operand and the options. */
static int make_order(struct command_text *order, int count, char **plain, struct error_text *error)
{
    if (count < 1)
        return error_text_set(error, "which command? jolon-ctl --help lists them");
    if (command_text_begin(order, plain[0], error) != 0)
        return -1;
    enum command_text_field operand = order->verb->operand;
    int most = operand == COMMAND_TEXT_FIELD_COUNT ? 1 : 2;
    if (count > most)
        return error_text_set(error,
                              "%s: '%.64s' is too much; jolon-ctl --help shows what it takes",
                              order->verb->name, plain[most]);
    if (count == 2 && give(order, operand, plain[1], "", error) != 0)
        return -1;
    if (count < most && (order->verb->needed & 1u << operand) && !words.value[operand])
        return error_text_set(error, "%s: of what? jolon-ctl --help shows what it takes",
                              order->verb->name);
    if (give_options(order, error) != 0)
        return -1;
    if (order->command.type == jolon_COMMAND_SPAWN && !(order->given & 1u << COMMAND_TEXT_X))
        return error_text_set(
            error, "spawn: where? --at X,Z in metres east and south, as 44.2705N,71.3033W, or a "
                   "reference of the MGRS");
    return command_text_end(order, error);
}

void ctl_parse(struct ctl_request *request, int argc, char **argv)
{
    const struct option_table table = {
        .program = "jolon-ctl",
        .usage = usage,
        .rows = rows,
        .more = order_rows(),
        .ending = "--dds-config, --interface, --domain and --partition go with --remote alone.\n"
                  "exit: 0 done, 1 refused or no reply, 2 usage\n",
        .plain = INT_MAX};
    struct error_text error;
    given = (struct ctl_request){.world = "default", .timeout_s = 5.0, .link.domain = DOMAIN_NONE};
    memset(&words, 0, sizeof words);
    int count = option_table_read(&table, argc, argv);
    char **plain = argv + argc - count;
    struct dds_link_options *link = &given.link;
    if (!given.remote &&
        (link->config || link->interface || link->partition || link->domain != DOMAIN_NONE))
        die_usage("--dds-config, --interface, --domain and --partition are for commands over DDS; "
                  "add --remote, or leave them out");
    link->domain = link->domain == DOMAIN_NONE ? 0 : link->domain;
    given.lines = count == 1 && strcmp(plain[0], "-") == 0;
    bool options = false;
    for (int i = 0; i < COMMAND_TEXT_FIELD_COUNT; i++)
        options |= words.value[i] != NULL;
    if (given.lines && options)
        die_usage("-: the options of a command stand in its line");
    if (!given.lines && make_order(&given.order, count, plain, &error) != 0)
        die_usage("%s", error.text);
    *request = given;
}

int ctl_parse_line(struct command_text *order, char *line, struct error_text *error)
{
    static char program[] = "jolon-ctl";
    const struct option_table table = {.program = program, .rows = order_rows(), .plain = INT_MAX};
    char *argument[WORDS_MAX + 1] = {program}, *rest = NULL;
    int count = 1;
    for (char *word = strtok_r(line, " \t\r\n", &rest); word;
         word = strtok_r(NULL, " \t\r\n", &rest)) {
        if (count == WORDS_MAX)
            return error_text_set(error, "more than %d words; a command has no more",
                                  WORDS_MAX - 1);
        argument[count++] = word;
    }
    if (count == 1 || argument[1][0] == '#')
        return 1;
    memset(&words, 0, sizeof words);
    int plain = option_table_try(&table, count, argument, error);
    return plain < 0 ? -1 : make_order(order, plain, argument + count - plain, error);
}
