/* Queues and budgets of the sources of commands. */
#include "reporter/intake/admission.h"

void admission_enter(struct admission *admission, uint32_t i, uint64_t client)
{
    admission->source[i] = (struct admission_source){.client = client};
}

void admission_leave(struct admission *admission, uint32_t i)
{
    admission->source[i].client = 0;
    admission->source[i].count = 0;
}

bool admission_room(const struct admission *admission, uint32_t i)
{
    return admission->source[i].count < ADMISSION_QUEUE;
}

void admission_put(struct admission *admission, uint32_t i, const jolon_Command *command)
{
    struct admission_source *source = &admission->source[i];
    source->queue[(source->first + source->count++) % ADMISSION_QUEUE] = *command;
}

bool admission_is_operators(const jolon_Command *command)
{
    switch (command->type) {
    case jolon_COMMAND_PAUSE:
    case jolon_COMMAND_RESUME:
    case jolon_COMMAND_STEP:
    case jolon_COMMAND_SCALE:
    case jolon_COMMAND_REMOVE:
    case jolon_COMMAND_QUIT:
        return true;
    default:
        return false;
    }
}

bool admission_is_costly(const jolon_Command *command)
{
    return command->type == jolon_COMMAND_SPAWN ||
           (command->type == jolon_COMMAND_FIRE && command->entity == 0);
}

/* Takes the command from the budgets. Returns false, and takes nothing, when one is empty. */
static bool pay(struct admission *admission, struct admission_source *source,
                const jolon_Command *command, bool strained, uint64_t now_ns)
{
    struct rate commands = source->commands, costly = source->costly, all = admission->costly;
    struct rate few = admission->strained;
    if (!rate_take(&commands, ADMISSION_COMMANDS_PER_S, ADMISSION_COMMANDS_BURST, now_ns))
        return false;
    if (admission_is_costly(command) &&
        (!rate_take(&costly, ADMISSION_COSTLY_PER_S, ADMISSION_COSTLY_BURST, now_ns) ||
         !rate_take(&all, ADMISSION_ALL_COSTLY_PER_S, ADMISSION_ALL_COSTLY_BURST, now_ns) ||
         (strained &&
          !rate_take(&few, ADMISSION_STRAINED_PER_S, ADMISSION_STRAINED_BURST, now_ns))))
        return false;
    source->commands = commands;
    source->costly = costly;
    admission->costly = all;
    admission->strained = few;
    return true;
}

/* Goes round the sources once, beginning with admission->next. */
static bool take_of(struct admission *admission, bool operators, bool strained, uint64_t now_ns,
                    jolon_Command *command, uint64_t *client)
{
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        uint32_t at = (admission->next + i) % ADMISSION_SOURCES;
        struct admission_source *source = &admission->source[at];
        const jolon_Command *head = &source->queue[source->first];
        if (!source->count || (operators && !admission_is_operators(head)) ||
            !pay(admission, source, head, strained, now_ns))
            continue;
        *command = *head;
        *client = source->client;
        source->first = (source->first + 1) % ADMISSION_QUEUE;
        source->count--;
        admission->next = (at + 1) % ADMISSION_SOURCES;
        return true;
    }
    return false;
}

bool admission_take(struct admission *admission, const struct admission_world *world,
                    uint64_t now_ns, jolon_Command *command, uint64_t *client)
{
    uint64_t untaken = world->untaken;
    bool strained = world->strained;
    if (untaken < ADMISSION_RING_ROOM_OPERATOR &&
        take_of(admission, true, strained, now_ns, command, client))
        return true;
    return untaken < ADMISSION_RING_ROOM &&
           take_of(admission, false, strained, now_ns, command, client);
}

bool admission_waiting(const struct admission *admission)
{
    for (uint32_t i = 0; i < ADMISSION_SOURCES; i++) {
        if (admission->source[i].count)
            return true;
    }
    return false;
}
