/* jolon-ctl's arguments: its own options here, those of orders from their table. */
#include "clients/ctl/parse.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/topics/command_route.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TIMEOUT_S     5.0
#define TIMEOUT_MIN_S 0.01
#define TIMEOUT_MAX_S 3600.0
#define WORDS_MAX     40

static const char usage[] =
    "usage: jolon-ctl [options] COMMAND\n"
    "  pause | resume | quit\n"
    "  step N                 advance N frames while paused\n"
    "  scale X                simulated seconds a second of the clock\n"
    "  drive WHO [--throttle T] [--steer S] [--climb C] [--traverse T] [--elevate E]\n"
    "        [--brake B] [--gear automatic|reverse|neutral|low] [--lease SECONDS]\n"
    "                         each -1 to 1, right and up are positive; the brake 0 to 1\n"
    "  release WHO [--anyway] back to its agent; anyway: whoever drives it\n"
    "  fire WHO [--target WHO]  without a target: straight ahead\n"
    "  fire --munition KIND --at X,Z [--rounds N] [--every SECONDS] [--radius METRES]\n"
    "        [--seed N]       out of the sky, N rounds about that place\n"
    "  spawn KIND --at X,Z [--force neutral|blue|red] [--behaviour idle|hold|patrol]\n"
    "        [--altitude METRES] [--heading DEGREES] [--speed MPS]\n"
    "  remove WHO\n"
    "  -                      commands from standard input, one a line, one after the other\n"
    "WHO: an id, or the name that the scenario gave it\n"
    "options:\n"
    "  -w, --world NAME       (default \"default\")\n"
    "  --json                 the reply as one JSON object\n"
    "  --timeout SECONDS      how long to wait for a reply (default 5)\n"
    "  --remote               over DDS, to a set elsewhere that takes such commands; else to your\n"
    "                         own world on this machine\n"
    "  --dds-config FILE, --interface ADDRESS, --domain N  with --remote: as jolon-reporter\n"
    "exit: 0 done, 1 refused or no reply, 2 usage\n";

static const struct option own[] = {{"world", required_argument, NULL, 'w'},
                                    {"json", no_argument, NULL, 'j'},
                                    {"timeout", required_argument, NULL, 't'},
                                    {"help", no_argument, NULL, 'h'},
                                    {"at", required_argument, NULL, 'a'},
                                    DDS_LINK_LONG_OPTIONS,
                                    COMMAND_ROUTE_LONG_OPTION};

#define OWN_COUNT  (sizeof own / sizeof own[0])
#define FIELD_BASE 2000 /* getopt's value of an order's argument is this and its number */

/* What getopt found, until the verb is known. */
struct words {
    const char *value[COMMAND_TEXT_FIELD_COUNT];
    const char *at;
    uint32_t given;
};

static const struct option *known_options(void)
{
    static struct option known[OWN_COUNT + COMMAND_TEXT_FIELD_COUNT + 1];
    memcpy(known, own, sizeof own);
    for (int i = 0; i < COMMAND_TEXT_FIELD_COUNT; i++) {
        enum command_text_field field = (enum command_text_field)i;
        known[OWN_COUNT + (size_t)i] = (struct option){
            .name = command_text_field_option(field),
            .has_arg = command_text_field_is_truth(field) ? no_argument : required_argument,
            .val = FIELD_BASE + i};
    }
    return known;
}

/* True when the option was an order's argument. */
static bool take_word(struct words *words, int option, const char *text)
{
    if (option == 'a')
        words->at = text;
    if (option < FIELD_BASE)
        return option == 'a';
    words->value[option - FIELD_BASE] = text;
    words->given |= 1u << (option - FIELD_BASE);
    return true;
}

static int give(struct command_text *order, enum command_text_field field, const char *text,
                const char *label, struct reason *reason)
{
    struct reason why;
    struct command_text_value value = {.text = text, .loose = true};
    if (command_text_field_is_truth(field))
        value = (struct command_text_value){.truth = true, .is_truth = true};
    if (command_text_give(order, field, &value, &why) != 0)
        return reason_set(reason, "%s: %s%.400s", order->verb->name, label, why.text);
    return 0;
}

static int give_at(struct command_text *order, const char *text, struct reason *reason)
{
    char x[64];
    const char *comma = strchr(text, ',');
    if (!comma || (size_t)(comma - text) >= sizeof x)
        return reason_set(
            reason, "--at %.64s: not a place like 25000,24000 (metres east, metres south)", text);
    memcpy(x, text, (size_t)(comma - text));
    x[comma - text] = '\0';
    return give(order, COMMAND_TEXT_X, x, "--at X ", reason) != 0
               ? -1
               : give(order, COMMAND_TEXT_Z, comma + 1, "--at Z ", reason);
}

static int give_options(struct command_text *order, const struct words *words,
                        struct reason *reason)
{
    char label[32];
    for (int i = 0; i < COMMAND_TEXT_FIELD_COUNT; i++) {
        enum command_text_field field = (enum command_text_field)i;
        if (!(words->given & 1u << i))
            continue;
        (void)snprintf(label, sizeof label, "--%s ", command_text_field_option(field));
        if (!(order->verb->allowed & 1u << i))
            return reason_set(reason, "%s: does not take --%s", order->verb->name,
                              command_text_field_option(field));
        if (give(order, field, words->value[i], label, reason) != 0)
            return -1;
    }
    if (words->at && !(order->verb->allowed & 1u << COMMAND_TEXT_X))
        return reason_set(reason, "%s: does not take --at", order->verb->name);
    return words->at ? give_at(order, words->at, reason) : 0;
}

/* The order of a verb, what follows it, and the options. */
static int make_order(struct command_text *order, int count, char **plain,
                      const struct words *words, struct reason *reason)
{
    if (count < 1)
        return reason_set(reason, "which command? jolon-ctl --help lists them");
    if (command_text_begin(order, plain[0], reason) != 0)
        return -1;
    enum command_text_field operand = order->verb->operand;
    int most = operand == COMMAND_TEXT_FIELD_COUNT ? 1 : 2;
    if (count > most)
        return reason_set(reason, "%s: '%.64s' is too much; jolon-ctl --help shows what it takes",
                          order->verb->name, plain[most]);
    if (count == 2 && give(order, operand, plain[1], "", reason) != 0)
        return -1;
    if (count < most && (order->verb->needed & 1u << operand) && !(words->given & 1u << operand))
        return reason_set(reason, "%s: of what? jolon-ctl --help shows what it takes",
                          order->verb->name);
    if (give_options(order, words, reason) != 0)
        return -1;
    if (order->command.type == jolon_COMMAND_SPAWN && !(order->given & 1u << COMMAND_TEXT_X))
        return reason_set(reason, "spawn: where? --at X,Z in metres east and south");
    return command_text_end(order, reason);
}

void ctl_parse(struct ctl_request *request, int argc, char **argv)
{
    struct words words = {0};
    struct reason reason;
    const char *linked = NULL;
    int option;
    *request = (struct ctl_request){.world = "default", .timeout_s = TIMEOUT_S};
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known_options(), NULL)) != -1) {
        if (take_word(&words, option, optarg))
            continue;
        if (dds_link_option(&request->link, option, optarg)) {
            linked = argv[optind - 1];
            continue;
        }
        switch (option) {
        case 'w':
            request->world = optarg;
            break;
        case COMMAND_ROUTE_OPTION:
            request->remote = true;
            break;
        case 'j':
            request->json = true;
            break;
        case 't':
            request->timeout_s = process_number("timeout", optarg, TIMEOUT_MIN_S, TIMEOUT_MAX_S);
            break;
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; jolon-ctl --help lists them",
                      argv[optind - 1]);
        }
    }
    dds_link_check_world(request->world);
    if (linked && !request->remote)
        die_usage("%s: --dds-config, --interface and --domain are for commands over DDS; add "
                  "--remote, or leave them out",
                  linked);
    request->lines = argc - optind == 1 && strcmp(argv[optind], "-") == 0;
    if (request->lines && (words.given || words.at))
        die_usage("-: the options of a command stand in its line");
    if (!request->lines &&
        make_order(&request->order, argc - optind, argv + optind, &words, &reason) != 0)
        die_usage("%s", reason.text);
}

int ctl_parse_line(struct command_text *order, char *line, struct reason *reason)
{
    static char program[] = "jolon-ctl";
    char *argument[WORDS_MAX + 1] = {program}, *rest = NULL;
    struct words words = {0};
    int count = 1, option;
    for (char *word = strtok_r(line, " \t\r\n", &rest); word;
         word = strtok_r(NULL, " \t\r\n", &rest)) {
        if (count == WORDS_MAX)
            return reason_set(reason, "more than %d words; a command has no more", WORDS_MAX - 1);
        argument[count++] = word;
    }
    if (count == 1 || argument[1][0] == '#')
        return 1;
    optind = 0; /* getopt begins anew */
    while ((option = getopt_long(count, argument, "", known_options(), NULL)) != -1) {
        if (!take_word(&words, option, optarg))
            return reason_set(reason,
                              "%.64s: no option of a command, or its value is missing; "
                              "jolon-ctl --help lists them",
                              argument[optind - 1]);
    }
    return make_order(order, count - optind, argument + optind, &words, reason);
}
