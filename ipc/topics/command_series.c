/* Rounds out, answers in. */
#include "ipc/topics/command_series.h"

#include "ipc/process/clock.h"

#include <string.h>

void command_series_begin(struct command_series *mission, const struct command_text *order,
                          uint64_t now_ns)
{
    *mission = (struct command_series){.order = *order, .due_ns = now_ns};
    mission->seed = order->seed;
    if (order->radius_m > 0.0 && !(order->given & 1u << COMMAND_TEXT_SEED))
        mission->seed = (uint32_t)command_client_source();
}

void command_series_send(struct command_series *mission, struct command_client *client,
                         uint64_t now_ns)
{
    while (mission->sent < mission->order.rounds && now_ns >= mission->due_ns &&
           mission->waiting < COMMAND_SERIES_WAITING_MAX) {
        jolon_Command command = command_text_round(&mission->order, mission->seed, mission->sent);
        uint64_t sequence = command_client_send(client, &command);
        if (!sequence)
            return;
        mission->round[mission->waiting++] =
            (struct command_series_round){sequence, mission->sent++};
        mission->due_ns += (uint64_t)(mission->order.every_s * NS_PER_S);
    }
}

bool command_series_answer(struct command_series *mission, struct command_client *client,
                           jolon_CommandReply *reply, uint32_t *round)
{
    for (uint32_t i = 0; i < mission->waiting; i++) {
        if (!command_client_answered(client, mission->round[i].sequence, reply))
            continue;
        *round = mission->round[i].round;
        mission->waiting--;
        memmove(&mission->round[i], &mission->round[i + 1],
                (mission->waiting - i) * sizeof *mission->round);
        mission->answered++;
        mission->done += reply->result == jolon_RESULT_DONE;
        return true;
    }
    return false;
}

bool command_series_over(const struct command_series *mission)
{
    return mission->answered == mission->order.rounds;
}

uint64_t command_series_due_ns(const struct command_series *mission)
{
    bool room = mission->waiting < COMMAND_SERIES_WAITING_MAX;
    return room && mission->sent < mission->order.rounds ? mission->due_ns : UINT64_MAX;
}

void command_series_forget(struct command_series *mission, struct command_client *client)
{
    while (mission->waiting > 0)
        command_client_forget(client, mission->round[--mission->waiting].sequence);
}
