/* Orders carried out, one at a time. */
#include "ctl/obey.h"

#include "ctl/say.h"
#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/process.h"

#include <stdio.h>

static uint64_t limit(const struct ctl *ctl)
{
    return clock_now_ns() + (uint64_t)(ctl->request.timeout_s * NS_PER_S);
}

static void say_silence(const struct ctl *ctl, const struct order *order)
{
    const struct ctl_request *request = &ctl->request;
    if (!caller_heard(&ctl->caller))
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

static void say_answer(struct ctl *ctl, struct say_place *place, const jolon_CommandReply *reply)
{
    char more[600] = "";
    const struct order *order = &ctl->mission.order;
    if (ctl->request.json)
        say_json(order, place, reply);
    else if (reply->result == jolon_RESULT_DONE)
        say_done(order, place, reply);
    if (reply->result == jolon_RESULT_NO_SUCH_KIND &&
        lookup_wait(&ctl->lookup, clock_now_ns() + NS_PER_S / 2))
        (void)snprintf(more, sizeof more, "; there are %s",
                       order->command.type == jolon_COMMAND_FIRE ? ctl->lookup.munitions
                                                                 : ctl->lookup.vehicles);
    if (reply->result != jolon_RESULT_DONE)
        say_refusal(order, place, reply, more);
}

/* Sends the order's rounds, each when it is due, until all are answered. False: no reply. */
static bool carry_out(struct ctl *ctl, struct say_place *place)
{
    struct mission *mission = &ctl->mission;
    jolon_CommandReply reply;
    uint64_t until_ns = limit(ctl);
    while (!mission_over(mission)) {
        uint64_t now_ns = clock_now_ns();
        mission_send(mission, &ctl->caller, now_ns);
        caller_turn(&ctl->caller);
        while (mission_answer(mission, &ctl->caller, &reply, &place->round)) {
            place->round++;
            say_answer(ctl, place, &reply);
            (void)fflush(stdout);
            until_ns = limit(ctl);
        }
        if (!mission->waiting)
            until_ns = limit(ctl); /* the time until the next round is nobody's silence */
        if (mission_over(mission) || process_stopping() || now_ns >= until_ns)
            break;
        uint64_t due_ns = mission_due_ns(mission);
        uint64_t wake_ns = due_ns < until_ns ? due_ns : until_ns;
        caller_wait(&ctl->caller, wake_ns);
    }
    return mission_over(mission);
}

int obey(struct ctl *ctl, struct order *order, uint32_t line)
{
    struct say_place place = {.world = ctl->request.world, .line = line, .rounds = order->rounds};
    struct reason reason;
    if (order_needs_names(order) || order_needs_hz(order)) {
        if (!lookup_wait(&ctl->lookup, limit(ctl))) {
            say_silence(ctl, order);
            return EXIT_GAVE_UP;
        }
        if (order_resolve(order, &ctl->lookup.names, ctl->lookup.hz, &reason) != 0) {
            (void)fprintf(stderr, "jolon-ctl: %s: %s\n", order->verb->name, reason.text);
            return EXIT_REFUSED;
        }
    }
    mission_begin(&ctl->mission, order, clock_now_ns());
    if (carry_out(ctl, &place))
        return ctl->mission.done == order->rounds ? EXIT_OK : EXIT_REFUSED;
    mission_forget(&ctl->mission, &ctl->caller);
    if (ctl->request.json)
        say_json(order, &place, NULL);
    say_silence(ctl, order);
    return EXIT_GAVE_UP;
}
