/* Words of replies. */
#include "console/reply.h"

#include "world/world.h"

#include <stdio.h>

/* The kinds there are, for whoever named another. */
static void list_kinds(const struct watch *watch, bool munitions, char *text, size_t bytes)
{
    size_t used = (size_t)snprintf(text, bytes, "there are");
    const struct world *world = &watch->view.world;
    for (uint32_t i = 0; watch->there && i < world->counts.kinds && used < bytes; i++) {
        const struct kind *kind = &world->kinds[i];
        if (kind->domain == DOMAIN_FIXED || (kind->domain == DOMAIN_MUNITION) != munitions)
            continue;
        int length = snprintf(text + used, bytes - used, " %s", kind->name);
        used += length > 0 ? (size_t)length : 0;
    }
}

static void explain_cannot(struct answer *answer, const struct order *order)
{
    const jolon_Command *command = &order->command;
    if (command->type == jolon_COMMAND_STEP)
        answer_error(answer, ANSWER_CONFLICT, "pause the world first", "it runs: no step to make");
    else if (command->type == jolon_COMMAND_FIRE)
        answer_error(answer, ANSWER_CONFLICT,
                     "wait until it is loaded; its rounds are in its "
                     "state",
                     "vehicle %u cannot fire now: destroyed, loading or out of rounds",
                     command->entity);
    else
        answer_error(answer, ANSWER_CONFLICT, "take another one",
                     "%u cannot do that: it is destroyed, or no vehicle", command->entity);
}

static void explain(struct answer *answer, const struct order *order, enum command_result result,
                    const struct watch *watch, const struct players *players)
{
    const jolon_Command *command = &order->command;
    const struct player *driver = players_driver(players, command->entity);
    char kinds[512];
    switch (result) {
    case COMMAND_NO_SUCH_ENTITY:
        answer_error(answer, ANSWER_CONFLICT, "choose one on the map or in the list",
                     "there is no %u any more, or never was", command->entity);
        break;
    case COMMAND_NO_SUCH_KIND:
        list_kinds(watch, command->type == jolon_COMMAND_FIRE, kinds, sizeof kinds);
        answer_error(answer, ANSWER_CONFLICT, kinds, "\"%s\": no such kind", command->kind);
        break;
    case COMMAND_TABLE_FULL:
        answer_error(answer, ANSWER_CONFLICT,
                     "remove something first, or make the world with a larger world.capacity",
                     "the world has no room for more");
        break;
    case COMMAND_TAKEN:
        answer_error(answer, ANSWER_CONFLICT, "wait until it is released, or take another one",
                     "%s drives %u", driver ? driver->name : "somebody else", command->entity);
        break;
    case COMMAND_CANNOT:
        explain_cannot(answer, order);
        break;
    default:
        answer_error(answer, ANSWER_CONFLICT, "docs/console.md says what an order looks like",
                     "%s: %s", order->verb->name, command_result_name(result));
        break;
    }
}

void reply_put(struct answer *answer, const struct order *order, const jolon_CommandReply *reply,
               const struct watch *watch, const struct players *players)
{
    struct text *text = &answer->text;
    if (reply->result != jolon_RESULT_DONE) {
        explain(answer, order, (enum command_result)reply->result, watch, players);
        return;
    }
    answer->status = ANSWER_OK;
    text_begin(text, '{');
    text_key_word(text, "result", "done");
    text_key_whole(text, "frame", reply->frame);
    text_key_whole(text, "entity", reply->entity);
    text_end(text, '}');
}

void reply_none(struct answer *answer, const struct order *order, bool heard)
{
    answer_error(answer, ANSWER_NO_REPLY,
                 heard ? "look whether it was done before you order it again"
                       : "is the reporter running? The process table shows it",
                 heard ? "%s: no reply came in time" : "%s: nobody takes commands for the world",
                 order->verb->name);
}
