/* Readiness, a warning, and the summary. */
#include "supervisor/run_report.h"

#include "ipc/process/log.h"
#include "world/gateway_idle.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

int run_report_open_ready(const char *path)
{
    return path ? open(path, O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC) : -1;
}

void run_report_ready(int fd)
{
    if (fd < 0)
        return;
    (void)!write(fd, "ready\n", 6);
    close(fd);
}

void run_report_warn_unguarded(const struct process_set *set)
{
    if (atomic_load(&set->view.slot[ROLE_REPORTER]->unguarded) != 0)
        process_set_log(
            set, "WARNING: the reporter takes commands from every host that reaches its network "
                 "(--remote-commands without DDS Security; docs/topics.md, \"Security\")");
}

void run_report_warn_no_gateway(const struct process_set *set)
{
    char names[GATEWAY_IDLE_TEXT];
    if (gateway_idle_settings(set->view.world.params, names))
        process_set_log(set, "WARNING: " GATEWAY_IDLE_WARNING, names);
}

static void print_pictures(const struct plan *plan)
{
    static const char *const names[] = {"chase", "map"};
    char path[4096];
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        int length = snprintf(path, sizeof path, "%s/%s.png", plan->out, names[i]);
        if (length < (int)sizeof path && access(path, R_OK) == 0)
            printf("  picture: %s\n", path);
    }
}

int run_report_summary(const struct process_set *set, uint64_t wall_ns)
{
    const struct plan *plan = set->plan;
    char wall_s[32];
    snprintf(wall_s, sizeof wall_s, "%.3f", (double)wall_ns / 1e9);
    const char *const arguments[] = {"jolon-world",
                                     "summary",
                                     "--world",
                                     plan->world,
                                     "--wall",
                                     wall_s,
                                     plan->json ? "--json" : NULL,
                                     NULL};
    int status = process_set_run(set, "jolon-world", arguments, plan->background);
    if (!plan->json && !plan->background)
        print_pictures(plan);
    return status == EXIT_OK ? EXIT_OK : EXIT_REFUSED;
}
