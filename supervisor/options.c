/* Reading the keeper's command line. */
#include "supervisor/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

static const char usage[] =
    "usage: jolon-keeper --out DIR --log FILE --commands FILE --hang-ms N [options]\n"
    "The keeper of a world's processes; jolon run and jolon start turn into it.\n";

#define PASSED 1000 /* with the role added: an option of that role's */

static const struct option known[] = {
    {"world", required_argument, NULL, 'w'},
    {"out", required_argument, NULL, 'o'},
    {"log", required_argument, NULL, 'l'},
    {"ready", required_argument, NULL, 'r'},
    {"commands", required_argument, NULL, 'm'},
    {"events", required_argument, NULL, 'e'},
    {"checkpoint", required_argument, NULL, 'c'},
    {"every", required_argument, NULL, 'n'},
    {"threads", required_argument, NULL, 't'},
    {"without", required_argument, NULL, 'x'},
    {"hang-ms", required_argument, NULL, 'H'},
    {"fps", required_argument, NULL, PASSED + ROLE_RENDERER},
    {"video", required_argument, NULL, PASSED + ROLE_RENDERER},
    {"video-view", required_argument, NULL, PASSED + ROLE_RENDERER},
    {"video-fps", required_argument, NULL, PASSED + ROLE_RENDERER},
    {"stream", required_argument, NULL, PASSED + ROLE_RENDERER},
    {"stream-address", required_argument, NULL, PASSED + ROLE_RENDERER},
    {"interface", required_argument, NULL, PASSED + ROLE_REPORTER},
    {"domain", required_argument, NULL, PASSED + ROLE_REPORTER},
    {"dds-config", required_argument, NULL, PASSED + ROLE_REPORTER},
    {"remote-commands", no_argument, NULL, PASSED + ROLE_REPORTER},
    {"console", required_argument, NULL, 'C'},
    {"console-address", required_argument, NULL, 'A'},
    {"console-token", required_argument, NULL, 'K'},
    {"background", no_argument, NULL, 'b'},
    {"json", no_argument, NULL, 'j'},
    {"no-sandbox", no_argument, NULL, 's'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0}};

static void leave_out(struct plan *plan, const char *name)
{
    enum role role = role_find(name);
    if (role == ROLE_NONE || role == ROLE_INTAKE || restart_policy_makes_frames(role))
        die_usage("--without %s: there are renderer, reporter, recorder", name);
    plan->left_out[role] = true;
}

/* The role reads it itself, and says what is wrong with it. value NULL: it has none. */
static void pass_on(struct passed *passed, const char *option, const char *value)
{
    if (passed->count + 2 > PLAN_PASSED_MAX)
        die_usage("%s: too many options of one role", option);
    passed->argument[passed->count++] = option;
    if (value)
        passed->argument[passed->count++] = value;
}

/* The console's own options, by their names there; --console is what asks for one at all. */
static bool console_option(struct plan *plan, int option, const char *value)
{
    const char *name = option == 'C'   ? "--port"
                       : option == 'A' ? "--address"
                       : option == 'K' ? "--token-file"
                                       : NULL;
    if (!name)
        return false;
    plan->console |= option == 'C';
    pass_on(&plan->passed[ROLE_CONSOLE], name, value);
    return true;
}

struct plan options_plan(int argc, char **argv)
{
    struct plan plan = {.world = "default", .threads = "1"};
    int option;
    opterr = 0; /* we say it, in one line */
    while ((option = getopt_long(argc, argv, "w:h", known, NULL)) != -1) {
        const char **text = option == 'w'   ? &plan.world
                            : option == 'o' ? &plan.out
                            : option == 'l' ? &plan.log
                            : option == 'r' ? &plan.ready
                            : option == 'm' ? &plan.commands
                            : option == 'e' ? &plan.events
                            : option == 'c' ? &plan.checkpoint
                            : option == 'n' ? &plan.every
                            : option == 't' ? &plan.threads
                                            : NULL;
        if (console_option(&plan, option, optarg))
            continue;
        if (text)
            *text = optarg;
        else if (option == 'x')
            leave_out(&plan, optarg);
        else if (option >= PASSED)
            pass_on(&plan.passed[option - PASSED], argv[optind - (optarg ? 2 : 1)], optarg);
        else if (option == 'H')
            plan.hang_ms = process_whole("hang-ms", optarg, 20, 3600000);
        else if (option == 'b')
            plan.background = true;
        else if (option == 'j')
            plan.json = true;
        else if (option == 's')
            plan.sandbox_off = true;
        else if (option == 'h') {
            (void)fputs(usage, stdout);
            exit(EXIT_OK);
        } else
            die_usage("%s: no such option; jolon-keeper is started by jolon", argv[optind - 1]);
    }
    if (!plan.out || !plan.log || !plan.commands || plan.hang_ms == 0 || optind < argc)
        die_usage("jolon-keeper is started by jolon, with --out, --log, --commands and --hang-ms");
    return plan;
}
