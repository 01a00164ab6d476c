/* Reading the keeper's command line. */
#include "supervisor/options.h"

#include "ipc/process/log.h"
#include "ipc/process/option_table.h"

#include <string.h>

static struct plan plan = {.world = "default", .threads = "1"};

/* Options that are passed on to a role. The role checks their values. */
static const struct passed_option {
    const char *name;
    enum role role;
    const char *argument; /* name of its value; NULL: it takes none */
    const char *as;       /* name of the role's option */
} passed_options[] = {
    {"fps", ROLE_RENDERER, "F", "--fps"},
    {"video", ROLE_RENDERER, "FILE", "--video"},
    {"video-view", ROLE_RENDERER, "V", "--video-view"},
    {"video-fps", ROLE_RENDERER, "F", "--video-fps"},
    {"stream", ROLE_RENDERER, "PORT", "--stream"},
    {"stream-address", ROLE_RENDERER, "A", "--stream-address"},
    {"interface", ROLE_REPORTER, "A", "--interface"},
    {"domain", ROLE_REPORTER, "N", "--domain"},
    {"dds-config", ROLE_REPORTER, "FILE", "--dds-config"},
    {"remote-commands", ROLE_REPORTER, NULL, "--remote-commands"},
    {"console", ROLE_CONSOLE, "PORT", "--port"}, /* only this option starts a console */
    {"console-address", ROLE_CONSOLE, "A", "--address"},
    {"console-token", ROLE_CONSOLE, "FILE", "--token-file"}};
#define PASSED_OPTIONS (sizeof passed_options / sizeof passed_options[0])

static const char *passed_value[PASSED_OPTIONS]; /* NULL: not given */

static int leave_out(const char *name, struct error_text *error)
{
    enum role role = role_find(name);
    if (!role_has(role, ROLE_OPTIONAL))
        return error_text_set(
            error, "there are %s",
            role_names(ROLE_OPTIONAL, (char[ROLE_NAMES_BYTES]){""}, ROLE_NAMES_BYTES));
    plan.left_out[role] = true;
    return 0;
}

static const struct option_row rows[] = {
    {"world", "NAME", NULL, .text = &plan.world, .letter = 'w'},
    {"out", "DIR", NULL, .text = &plan.out},
    {"log", "FILE", NULL, .text = &plan.log},
    {"ready", "FILE", NULL, .text = &plan.ready},
    {"commands", "FILE", NULL, .text = &plan.commands},
    {"events", "FILE", NULL, .text = &plan.events},
    {"checkpoint", "FILE", NULL, .text = &plan.checkpoint},
    {"every", "N", NULL, .text = &plan.every},
    {"threads", "N", NULL, .text = &plan.threads},
    {"without", "ROLE", NULL, .take = leave_out},
    {"hang-ms", "N", NULL, .u64 = &plan.hang_ms, .least = 20, .most = 3600000},
    {"background", NULL, NULL, .flag = &plan.background},
    {"json", NULL, NULL, .flag = &plan.json},
    {"no-sandbox", NULL, NULL, .flag = &plan.sandbox_off},
    OPTION_ROWS_END};

static void pass_on(const struct passed_option *option, const char *value)
{
    struct role_options *role_options = &plan.role_options[option->role];
    plan.console |= strcmp(option->name, "console") == 0;
    role_options->argument[role_options->count++] = option->as;
    if (option->argument)
        role_options->argument[role_options->count++] = value;
}

struct plan options_plan(int argc, char **argv)
{
    static struct option_row passed_rows[PASSED_OPTIONS + 1];
    static const struct option_table table = {
        .program = "jolon-keeper",
        .usage = "--out DIR --log FILE --commands FILE --hang-ms N [options]\n"
                 "The keeper of a world's processes; jolon run and jolon start turn into it.",
        .rows = rows,
        .more = passed_rows};
    for (size_t i = 0; i < PASSED_OPTIONS; i++)
        passed_rows[i] = (struct option_row){.name = passed_options[i].name,
                                             .argument = passed_options[i].argument,
                                             .text = &passed_value[i]};
    option_table_read(&table, argc, argv);
    if (!plan.out || !plan.log || !plan.commands || plan.hang_ms == 0)
        die_usage("jolon-keeper is started by jolon, with --out, --log, --commands and --hang-ms");
    for (size_t i = 0; i < PASSED_OPTIONS; i++) {
        if (passed_value[i])
            pass_on(&passed_options[i], passed_value[i]);
    }
    return plan;
}
