/* Rounds out, answers in. */
#include "topics/mission.h"

#include "ipc/clock.h"

#include <string.h>

void mission_begin(struct mission *mission, const struct order *order, uint64_t now_ns)
{
    *mission = (struct mission){.order = *order, .due_ns = now_ns};
    mission->seed = order->seed;
    if (order->radius_m > 0.0 && !(order->given & 1u << ORDER_SEED))
        mission->seed = (uint32_t)caller_source();
}

void mission_send(struct mission *mission, struct caller *caller, uint64_t now_ns)
{
    while (mission->sent < mission->order.rounds && now_ns >= mission->due_ns &&
           mission->waiting < MISSION_WAITING_MAX) {
        jolon_Command command = order_round(&mission->order, mission->seed, mission->sent);
        uint64_t sequence = caller_send(caller, &command);
        if (!sequence)
            return;
        mission->round[mission->waiting++] = (struct mission_round){sequence, mission->sent++};
        mission->due_ns += (uint64_t)(mission->order.every_s * NS_PER_S);
    }
}

bool mission_answer(struct mission *mission, struct caller *caller, jolon_CommandReply *reply,
                    uint32_t *round)
{
    for (uint32_t i = 0; i < mission->waiting; i++) {
        if (!caller_answered(caller, mission->round[i].sequence, reply))
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

bool mission_over(const struct mission *mission)
{
    return mission->answered == mission->order.rounds;
}

uint64_t mission_due_ns(const struct mission *mission)
{
    bool room = mission->waiting < MISSION_WAITING_MAX;
    return room && mission->sent < mission->order.rounds ? mission->due_ns : UINT64_MAX;
}

void mission_forget(struct mission *mission, struct caller *caller)
{
    while (mission->waiting > 0)
        caller_forget(caller, mission->round[--mission->waiting].sequence);
}
