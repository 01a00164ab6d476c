/* Orders carried out, one at a time. */
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

static void say_silence(const struct ctl *ctl, const struct command_text *order)
{
    const struct ctl_request *request = &ctl->request;
    if (!command_client_heard(&ctl->client))
        (void)fprintf(stderr,
                      "jolon-ctl: world '%s': nobody takes commands for it%s; `jolon status -w "
                      "%s` shows whether it runs\n",
                      request->world,
                      request->remote ? " over DDS, which a set does that was started with "
                                        "--remote-commands"
                                      : "",
                      request->world);
    else
        (void)fprintf(stderr,
                      "jolon-ctl: world '%s': no reply to %s within %g s; `jolon status -w %s` "
                      "shows whether its mover and collider run\n",
                      request->world, order->verb->name, request->timeout_s, request->world);
}

static void say_answer(struct ctl *ctl, struct result_text_place *place,
                       const jolon_CommandReply *reply)
{
    char more[600] = "";
    const struct command_text *order = &ctl->mission.order;
    if (ctl->request.json)
        result_text_json(order, place, reply);
    else if (reply->result == jolon_RESULT_DONE)
        result_text_done(order, place, reply);
    if (reply->result == jolon_RESULT_NO_SUCH_KIND &&
        lookup_wait(&ctl->lookup, clock_now_ns() + NS_PER_S / 2))
        (void)snprintf(more, sizeof more, "; there are %s",
                       order->command.type == jolon_COMMAND_FIRE ? ctl->lookup.munitions
                                                                 : ctl->lookup.vehicles);
    if (reply->result != jolon_RESULT_DONE)
        result_text_refusal(order, place, reply, more);
}

/* Sends the order's rounds, each when it is due, until all are answered. False: no reply. */
static bool carry_out(struct ctl *ctl, struct result_text_place *place)
{
    struct command_series *mission = &ctl->mission;
    jolon_CommandReply reply;
    uint64_t until_ns = limit(ctl);
    while (!command_series_over(mission)) {
        uint64_t now_ns = clock_now_ns();
        command_series_send(mission, &ctl->client, now_ns);
        command_client_turn(&ctl->client);
        while (command_series_answer(mission, &ctl->client, &reply, &place->round)) {
            place->round++;
            say_answer(ctl, place, &reply);
            (void)fflush(stdout);
            until_ns = limit(ctl);
        }
        if (!mission->waiting)
            until_ns = limit(ctl); /* the time until the next round is nobody's silence */
        if (command_series_over(mission) || process_stopping() || now_ns >= until_ns)
            break;
        uint64_t due_ns = command_series_due_ns(mission);
        uint64_t wake_ns = due_ns < until_ns ? due_ns : until_ns;
        command_client_wait(&ctl->client, wake_ns);
    }
    return command_series_over(mission);
}

int command_run(struct ctl *ctl, struct command_text *order, uint32_t line)
{
    struct result_text_place place = {
        .world = ctl->request.world, .line = line, .rounds = order->rounds};
    struct error_text error;
    if (command_text_needs_names(order) || command_text_needs_hz(order)) {
        if (!lookup_wait(&ctl->lookup, limit(ctl))) {
            say_silence(ctl, order);
            return EXIT_GAVE_UP;
        }
        if (command_text_resolve(order, &ctl->lookup.names, ctl->lookup.hz, &error) != 0) {
            (void)fprintf(stderr, "jolon-ctl: %s: %s\n", order->verb->name, error.text);
            return EXIT_REFUSED;
        }
    }
    command_series_begin(&ctl->mission, order, clock_now_ns());
    if (carry_out(ctl, &place))
        return ctl->mission.done == order->rounds ? EXIT_OK : EXIT_REFUSED;
    command_series_forget(&ctl->mission, &ctl->client);
    if (ctl->request.json)
        result_text_json(order, &place, NULL);
    say_silence(ctl, order);
    return EXIT_GAVE_UP;
}
