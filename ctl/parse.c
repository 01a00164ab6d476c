/* jolon-ctl's arguments: one table of verbs, one of options. */
#include "ctl/parse.h"

#include "ipc/log.h"
#include "world/world.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TIMEOUT_S     5.0
#define TIMEOUT_MAX_S 3600.0

static const char usage[] =
    "usage: jolon-ctl [options] COMMAND\n"
    "  pause | resume | quit\n"
    "  step N                 advance N frames while paused\n"
    "  scale X                simulated seconds a second of the clock\n"
    "  drive ID [--throttle T] [--steer S] [--climb C]     each -1 to 1; right and up are "
    "positive\n"
    "  release ID             back to its agent\n"
    "  fire ID [--target ID]  without a target: straight ahead\n"
    "  fire --munition KIND --at X,Z                       out of the sky\n"
    "  spawn KIND --at X,Z [--force neutral|blue|red] [--behaviour idle|hold|patrol]\n"
    "        [--altitude METRES] [--heading DEGREES] [--speed MPS]\n"
    "  remove ID\n"
    "options:\n"
    "  -w, --world NAME       (default \"default\")\n"
    "  --json                 the reply as one JSON object\n"
    "  --timeout SECONDS      how long to wait for the reply (default 5)\n"
    "  --dds-config FILE, --interface ADDRESS, --domain N  as jolon-reporter\n"
    "exit: 0 done, 1 refused or no reply, 2 usage\n";

/* What follows the verb. */
enum operand {
    OPERAND_NONE,
    OPERAND_FRAMES,
    OPERAND_SCALE,
    OPERAND_ENTITY,
    OPERAND_SHOOTER,
    OPERAND_KIND
};

/* Options that only some verbs know, as the bits of a set and as getopt's values. */
enum extra {
    EXTRA_THROTTLE = 1 << 0,
    EXTRA_STEER = 1 << 1,
    EXTRA_CLIMB = 1 << 2,
    EXTRA_TARGET = 1 << 3,
    EXTRA_MUNITION = 1 << 4,
    EXTRA_AT = 1 << 5,
    EXTRA_FORCE = 1 << 6,
    EXTRA_BEHAVIOUR = 1 << 7,
    EXTRA_ALTITUDE = 1 << 8,
    EXTRA_HEADING = 1 << 9,
    EXTRA_SPEED = 1 << 10
};

#define EXTRA_BASE 2000 /* getopt's value of an extra is this and the number of its bit */

static const struct {
    const char *name;
    jolon_CommandType type;
    enum operand operand;
    unsigned allowed;
} verbs[] = {
    {"pause", jolon_COMMAND_PAUSE, OPERAND_NONE, 0},
    {"resume", jolon_COMMAND_RESUME, OPERAND_NONE, 0},
    {"step", jolon_COMMAND_STEP, OPERAND_FRAMES, 0},
    {"scale", jolon_COMMAND_SCALE, OPERAND_SCALE, 0},
    {"drive", jolon_COMMAND_DRIVE, OPERAND_ENTITY, EXTRA_THROTTLE | EXTRA_STEER | EXTRA_CLIMB},
    {"release", jolon_COMMAND_RELEASE, OPERAND_ENTITY, 0},
    {"fire", jolon_COMMAND_FIRE, OPERAND_SHOOTER, EXTRA_TARGET | EXTRA_MUNITION | EXTRA_AT},
    {"spawn", jolon_COMMAND_SPAWN, OPERAND_KIND,
     EXTRA_AT | EXTRA_FORCE | EXTRA_BEHAVIOUR | EXTRA_ALTITUDE | EXTRA_HEADING | EXTRA_SPEED},
    {"remove", jolon_COMMAND_REMOVE, OPERAND_ENTITY, 0},
    {"quit", jolon_COMMAND_QUIT, OPERAND_NONE, 0},
};

#define VERB_COUNT (sizeof verbs / sizeof verbs[0])

static const struct option known[] = {{"world", required_argument, NULL, 'w'},
                                      {"json", no_argument, NULL, 'j'},
                                      {"timeout", required_argument, NULL, 't'},
                                      {"help", no_argument, NULL, 'h'},
                                      DDS_LINK_LONG_OPTIONS,
                                      {"throttle", required_argument, NULL, EXTRA_BASE + 0},
                                      {"steer", required_argument, NULL, EXTRA_BASE + 1},
                                      {"climb", required_argument, NULL, EXTRA_BASE + 2},
                                      {"target", required_argument, NULL, EXTRA_BASE + 3},
                                      {"munition", required_argument, NULL, EXTRA_BASE + 4},
                                      {"at", required_argument, NULL, EXTRA_BASE + 5},
                                      {"force", required_argument, NULL, EXTRA_BASE + 6},
                                      {"behaviour", required_argument, NULL, EXTRA_BASE + 7},
                                      {"altitude", required_argument, NULL, EXTRA_BASE + 8},
                                      {"heading", required_argument, NULL, EXTRA_BASE + 9},
                                      {"speed", required_argument, NULL, EXTRA_BASE + 10},
                                      {NULL, 0, NULL, 0}};

static const char *option_name(int value)
{
    size_t i = 0;
    while (known[i].name && known[i].val != value)
        i++;
    return known[i].name;
}

/* A finite number of low to high. */
static double parse_number(const char *what, const char *text, double low, double high)
{
    char *end;
    errno = 0;
    double value = strtod(text, &end);
    if (errno || end == text || *end || !(value >= low && value <= high))
        die_usage("%s %s: not a number from %g to %g", what, text, low, high);
    return value;
}

static uint32_t parse_whole(const char *what, const char *text, uint32_t low, uint32_t high)
{
    char *end;
    errno = 0;
    unsigned long value = strtoul(text, &end, 10);
    if (errno || end == text || *end || *text == '-' || value < low || value > high)
        die_usage("%s %s: not a whole number from %u to %u", what, text, low, high);
    return (uint32_t)value;
}

static void parse_at(jolon_Command *command, const char *text)
{
    char x[64];
    const char *comma = strchr(text, ',');
    if (!comma || (size_t)(comma - text) >= sizeof x)
        die_usage("--at %s: not a place like 25000,24000 (metres east, metres south)", text);
    memcpy(x, text, (size_t)(comma - text));
    x[comma - text] = '\0';
    command->x_m = parse_number("--at X", x, 0.0, 50000.0);
    command->z_m = parse_number("--at Z", comma + 1, 0.0, 50000.0);
}

static void parse_kind(jolon_Command *command, const char *what, const char *text)
{
    size_t length = strlen(text);
    if (length == 0 || length >= sizeof command->kind)
        die_usage("%s '%s': the name of a kind has 1 to %zu letters", what, text,
                  sizeof command->kind - 1);
    memcpy(command->kind, text, length + 1);
}

static jolon_Force parse_force(const char *text)
{
    for (int i = 0; i < FORCE_COUNT; i++) {
        if (strcmp(force_name((enum force)i), text) == 0)
            return (jolon_Force)i;
    }
    die_usage("--force %s: not neutral, blue or red", text);
}

static jolon_Behaviour parse_behaviour(const char *text)
{
    for (int i = 0; i <= BEHAVIOUR_PATROL; i++) {
        if (strcmp(behaviour_name((enum behaviour)i), text) == 0)
            return (jolon_Behaviour)i;
    }
    die_usage("--behaviour %s: not idle, hold or patrol", text);
}

static void parse_extra(jolon_Command *command, unsigned extra, const char *text)
{
    switch ((enum extra)extra) {
    case EXTRA_THROTTLE:
        command->throttle = (float)parse_number("--throttle", text, -1.0, 1.0);
        break;
    case EXTRA_STEER:
        command->steer = (float)parse_number("--steer", text, -1.0, 1.0);
        break;
    case EXTRA_CLIMB:
        command->climb = (float)parse_number("--climb", text, -1.0, 1.0);
        break;
    case EXTRA_TARGET:
        command->target = parse_whole("--target", text, 1, UINT32_MAX);
        break;
    case EXTRA_MUNITION:
        parse_kind(command, "--munition", text);
        break;
    case EXTRA_AT:
        parse_at(command, text);
        break;
    case EXTRA_FORCE:
        command->force = parse_force(text);
        break;
    case EXTRA_BEHAVIOUR:
        command->behaviour = parse_behaviour(text);
        break;
    case EXTRA_ALTITUDE:
        command->altitude_m = parse_number("--altitude", text, 0.0, 20000.0);
        break;
    case EXTRA_HEADING:
        command->heading_rad = parse_number("--heading", text, -360.0, 360.0) * RAD_PER_DEG;
        break;
    case EXTRA_SPEED:
        command->speed_mps = parse_number("--speed", text, 0.0, 2000.0);
        break;
    }
}

static size_t find_verb(const char *name)
{
    for (size_t i = 0; i < VERB_COUNT; i++) {
        if (strcmp(verbs[i].name, name) == 0)
            return i;
    }
    die_usage("'%s': no such command; jolon-ctl --help lists them", name);
}

static void parse_operand(jolon_Command *command, const char *verb, enum operand operand,
                          const char *text)
{
    switch (operand) {
    case OPERAND_NONE:
        break;
    case OPERAND_FRAMES:
        command->frames = parse_whole(verb, text, 1, 1000000);
        break;
    case OPERAND_SCALE:
        command->scale = parse_number(verb, text, 0.01, 100.0);
        break;
    case OPERAND_ENTITY:
    case OPERAND_SHOOTER:
        command->entity = parse_whole(verb, text, 1, UINT32_MAX);
        break;
    case OPERAND_KIND:
        parse_kind(command, verb, text);
        break;
    }
}

static void check_fire(unsigned given, bool shooter)
{
    unsigned sky = given & (EXTRA_MUNITION | EXTRA_AT);
    if (shooter ? sky != 0 : sky != (EXTRA_MUNITION | EXTRA_AT) || (given & EXTRA_TARGET))
        die_usage("fire: either an entity's id [--target ID], or --munition KIND --at X,Z");
}

static void parse_verb(struct ctl_request *request, int count, char **words, unsigned given)
{
    if (count < 1)
        die_usage("which command? jolon-ctl --help lists them");
    size_t verb = find_verb(words[0]);
    enum operand operand = verbs[verb].operand;
    unsigned strange = given & ~verbs[verb].allowed;
    request->verb = verbs[verb].name;
    request->command.type = verbs[verb].type;
    if (strange)
        die_usage("%s: does not take --%s", request->verb,
                  option_name(EXTRA_BASE + __builtin_ctz(strange)));
    if (count > (operand == OPERAND_NONE ? 1 : 2))
        die_usage("%s: '%s' is too much; jolon-ctl --help shows what it takes", request->verb,
                  words[count - 1]);
    if (operand == OPERAND_SHOOTER)
        check_fire(given, count == 2);
    else if (operand != OPERAND_NONE && count < 2)
        die_usage("%s: of what? jolon-ctl --help shows what it takes", request->verb);
    if (operand == OPERAND_KIND && !(given & EXTRA_AT))
        die_usage("%s: where? --at X,Z in metres east and south", request->verb);
    if (count == 2)
        parse_operand(&request->command, request->verb, operand, words[1]);
}

void ctl_parse(struct ctl_request *request, int argc, char **argv)
{
    unsigned given = 0;
    int option;
    *request = (struct ctl_request){.world = "default", .timeout_s = TIMEOUT_S};
    request->command.altitude_m = -1.0;
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
        if (dds_link_option(&request->link, option, optarg))
            continue;
        if (option >= EXTRA_BASE) {
            given |= 1u << (option - EXTRA_BASE);
            parse_extra(&request->command, 1u << (option - EXTRA_BASE), optarg);
            continue;
        }
        switch (option) {
        case 'w':
            request->world = optarg;
            break;
        case 'j':
            request->json = true;
            break;
        case 't':
            request->timeout_s = parse_number("--timeout", optarg, 0.01, TIMEOUT_MAX_S);
            break;
        case 'h':
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        default:
            die_usage("%s: no such option, or its value is missing; jolon-ctl --help lists them",
                      argv[optind - 1]);
        }
    }
    if (!segment_name_ok(request->world))
        die_usage("--world %s: no name for a world: 1 to %d of a-z A-Z 0-9 _ -", request->world,
                  SEGMENT_NAME_MAX - 1);
    parse_verb(request, argc - optind, argv + optind, given);
}
