/* Runs commands, one at a time. */
#include "clients/ctl/command_run.h"

#include "clients/ctl/result_text.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <stdio.h>

static uint64_t limit(const struct ctl *ctl)
{
    return clock_now_ns() + (uint64_t)(ctl->request.timeout_s * NS_PER_S);
}

static void print_no_reply(const struct ctl *ctl, const struct command_text *order)
{
    const struct ctl_request *request = &ctl->request;
    if (!command_client_reachable(&ctl->client))
        (void)fprintf(stderr,
                      "jolon-ctl: world '%s': no process takes commands for it%s; `jolon status -w "
                      "%s` shows whether it runs\n",
                      request->world,
                      request->remote ? " over DDS; start it with --remote-commands" : "",
                      request->world);
    else
        (void)fprintf(stderr,
                      "jolon-ctl: world '%s': no reply to %s within %g s; `jolon status -w %s` "
                      "shows whether its mover and collider run\n",
                      request->world, order->verb->name, request->timeout_s, request->world);
}

static void print_answer(struct ctl *ctl, struct result_text_context *context,
                         const jolon_CommandReply *reply)
{
    char more[600] = "";
    const struct command_text *order = &ctl->series.order;
    if (ctl->request.json)
        result_text_json(order, context, reply);
    else if (reply->result == jolon_RESULT_DONE)
        result_text_done(order, context, reply);
    if (reply->result == jolon_RESULT_NO_SUCH_KIND &&
        lookup_wait(&ctl->lookup, clock_now_ns() + NS_PER_S / 2))
        (void)snprintf(more, sizeof more, "; there are %s",
                       order->command.type == jolon_COMMAND_FIRE ? ctl->lookup.munitions
                                                                 : ctl->lookup.vehicles);
    if (reply->result != jolon_RESULT_DONE)
        result_text_refusal(order, context, reply, more);
}

/* Sends the command's rounds, each when it is due, until all are answered. Returns false if a reply
 * did not come in time. */
static bool carry_out(struct ctl *ctl, struct result_text_context *context)
{
    struct command_series *series = &ctl->series;
    jolon_CommandReply reply;
    uint64_t until_ns = limit(ctl);
    while (!command_series_over(series)) {
        uint64_t now_ns = clock_now_ns();
        command_series_send(series, &ctl->client, now_ns);
        command_client_poll(&ctl->client);
        while (command_series_answer(series, &ctl->client, &reply, &context->round)) {
            context->round++;
            print_answer(ctl, context, &reply);
            (void)fflush(stdout);
            until_ns = limit(ctl);
        }
        if (!series->waiting)
            until_ns = limit(ctl); /* no reply is due before the next round */
        if (command_series_over(series) || process_stopping() || now_ns >= until_ns)
            break;
        uint64_t due_ns = command_series_due_ns(series);
        uint64_t wake_ns = due_ns < until_ns ? due_ns : until_ns;
        command_client_wait(&ctl->client, wake_ns);
    }
    return command_series_over(series);
}

int command_run(struct ctl *ctl, struct command_text *order, uint32_t line)
{
    struct result_text_context context = {
        .world = ctl->request.world, .line = line, .rounds = order->rounds};
    struct error_text error;
    if (command_text_needs_names(order) || command_text_needs_hz(order) ||
        command_text_needs_place(order)) {
        if (!lookup_wait(&ctl->lookup, limit(ctl))) {
            print_no_reply(ctl, order);
            return EXIT_GAVE_UP;
        }
        if (command_text_resolve(order, &ctl->lookup.names, ctl->lookup.hz, &error) != 0 ||
            command_text_place(order, &ctl->lookup.frame, &error) != 0) {
            (void)fprintf(stderr, "jolon-ctl: %s: %s\n", order->verb->name, error.text);
            return EXIT_REFUSED;
        }
    }
    if (ctl->lookup.view)
        order->side_m = ctl->lookup.view->world.terrain.squares.world_m;
    command_series_begin(&ctl->series, order, clock_now_ns());
    if (carry_out(ctl, &context))
        return ctl->series.done == order->rounds ? EXIT_OK : EXIT_REFUSED;
    command_series_forget(&ctl->series, &ctl->client);
    if (ctl->request.json)
        result_text_json(order, &context, NULL);
    print_no_reply(ctl, order);
    return EXIT_GAVE_UP;
}
