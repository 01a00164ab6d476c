/* jolon-ctl: sends commands to a world, one after the other, and waits for the reply to each. */
#include "clients/ctl/command_run.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"

#include <stdio.h>
#include <string.h>

/* Returns true if the line did not fit, after reading the rest of it. */
static bool too_long(const char *line)
{
    int letter = 0;
    if (strchr(line, '\n') || feof(stdin))
        return false;
    while (letter != '\n' && letter != EOF)
        letter = fgetc(stdin);
    return true;
}

static int run_lines(struct ctl *ctl)
{
    char line[CTL_LINE_MAX];
    struct command_text order;
    struct error_text error;
    int worst = EXIT_OK;
    for (uint32_t number = 1; !process_stopping() && fgets(line, sizeof line, stdin); number++) {
        int result = too_long(line)
                         ? error_text_set(&error, "longer than %u letters", CTL_LINE_MAX - 2)
                         : ctl_parse_line(&order, line, &error);
        if (result < 0)
            (void)fprintf(stderr, "jolon-ctl: line %u: %s\n", number, error.text);
        int code = result == 0  ? command_run(ctl, &order, number)
                   : result < 0 ? EXIT_REFUSED
                                : EXIT_OK;
        worst = code == EXIT_OK ? worst : EXIT_REFUSED;
        if (code == EXIT_GAVE_UP)
            break; /* the next command would wait as long */
    }
    return worst;
}

/* Attaches or links to the world without a lock, so that it may be removed meanwhile. */
static int open_world(struct ctl *ctl, struct error_text *error)
{
    const struct ctl_request *request = &ctl->request;
    if (request->remote) {
        ctl->lookup.link = &ctl->link;
        return dds_link_open(&ctl->link, &request->link, request->world, error);
    }
    ctl->lookup.view = &ctl->view;
    return segment_attach(&ctl->view, request->world, ROLE_NONE, error);
}

int main(int argc, char **argv)
{
    static struct ctl ctl;
    struct error_text error;
    log_open("ctl");
    ctl_parse(&ctl.request, argc, argv);
    process_signals();
    if (open_world(&ctl, &error) != 0 ||
        command_route_open(&ctl.route, &ctl.client, ctl.request.remote, &ctl.link,
                           ctl.request.world, &error) != 0)
        die_refused("%s", error.text);
    int code = ctl.request.lines ? run_lines(&ctl) : command_run(&ctl, &ctl.request.order, 0);
    (void)fflush(stdout);
    lookup_close(&ctl.lookup);
    code = code == EXIT_OK ? EXIT_OK : EXIT_REFUSED;
    if (ctl.request.remote)
        dds_link_close(&ctl.link, code);
    else
        segment_detach(&ctl.view);
    return code;
}
