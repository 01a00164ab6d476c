/* Sends the rounds of an order and takes the answers. */
#include "ipc/topics/command_series.h"

#include "ipc/process/clock.h"

#include <string.h>

void command_series_begin(struct command_series *series, const struct command_text *order,
                          uint64_t now_ns)
{
    *series = (struct command_series){.order = *order, .due_ns = now_ns};
    series->seed = order->seed;
    if (order->radius_m > 0.0 && !(order->given & 1u << COMMAND_TEXT_SEED))
        series->seed = (uint32_t)command_client_source();
}

void command_series_send(struct command_series *series, struct command_client *client,
                         uint64_t now_ns)
{
    while (series->sent < series->order.rounds && now_ns >= series->due_ns &&
           series->waiting < COMMAND_SERIES_WAITING_MAX) {
        jolon_Command command = command_text_round(&series->order, series->seed, series->sent);
        uint64_t sequence = command_client_send(client, &command);
        if (!sequence)
            return;
        series->round[series->waiting++] = (struct command_series_round){sequence, series->sent++};
        series->due_ns += (uint64_t)(series->order.every_s * NS_PER_S);
    }
}

bool command_series_answer(struct command_series *series, struct command_client *client,
                           jolon_CommandReply *reply, uint32_t *round)
{
    for (uint32_t i = 0; i < series->waiting; i++) {
        if (!command_client_answered(client, series->round[i].sequence, reply))
            continue;
        *round = series->round[i].round;
        series->waiting--;
        memmove(&series->round[i], &series->round[i + 1],
                (series->waiting - i) * sizeof *series->round);
        series->answered++;
        series->done += reply->result == jolon_RESULT_DONE;
        return true;
    }
    return false;
}

bool command_series_over(const struct command_series *series)
{
    return series->answered == series->order.rounds;
}

uint64_t command_series_due_ns(const struct command_series *series)
{
    bool room = series->waiting < COMMAND_SERIES_WAITING_MAX;
    return room && series->sent < series->order.rounds ? series->due_ns : UINT64_MAX;
}

void command_series_forget(struct command_series *series, struct command_client *client)
{
    while (series->waiting > 0)
        command_client_forget(client, series->round[--series->waiting].sequence);
}
