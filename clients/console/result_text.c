/* Describes replies. */
#include "clients/console/result_text.h"

#include "world/entity/command.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/world.h"

#include <stdio.h>

/* Lists the kinds, for the error about an unknown kind. */
static void list_kinds(const struct world_reader *reader, bool munitions, char *text, size_t bytes)
{
    size_t used = (size_t)snprintf(text, bytes, "there are");
    const struct world *world = &reader->view.world;
    for (uint32_t i = 0; reader->attached && i < world->counts.kinds && used < bytes; i++) {
        const struct kind *kind = &world->kinds[i];
        if (kind->domain == DOMAIN_FIXED || (kind->domain == DOMAIN_MUNITION) != munitions)
            continue;
        int length = snprintf(text + used, bytes - used, " %s", kind->name);
        used += length > 0 ? (size_t)length : 0;
    }
}

static void explain_cannot(struct http_answer *answer, const struct command_text *order)
{
    const jolon_Command *command = &order->command;
    if (command->type == jolon_COMMAND_STEP)
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, "pause the world first",
                          "it runs: no step to make");
    else if (command->type == jolon_COMMAND_FIRE)
        http_answer_error(answer, HTTP_ANSWER_CONFLICT,
                          "wait until it is loaded; its rounds are in its "
                          "state",
                          "vehicle %u cannot fire now: destroyed, loading or out of rounds",
                          command->entity);
    else
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, "take another one",
                          "%u cannot do that: it is destroyed, or not a vehicle", command->entity);
}

static void explain(struct http_answer *answer, const struct command_text *order,
                    enum command_result result, const struct world_reader *reader,
                    const struct players *players)
{
    const jolon_Command *command = &order->command;
    const struct player *driver = players_driver_of(players, command->entity);
    char kinds[512];
    switch (result) {
    case COMMAND_NO_SUCH_ENTITY:
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, "choose one on the map or in the list",
                          "there is no entity %u", command->entity);
        break;
    case COMMAND_NO_SUCH_KIND:
        list_kinds(reader, command->type == jolon_COMMAND_FIRE, kinds, sizeof kinds);
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, kinds, "\"%s\": no such kind",
                          command->kind);
        break;
    case COMMAND_TABLE_FULL:
        http_answer_error(answer, HTTP_ANSWER_CONFLICT,
                          "remove something first, or make the world with a larger world.capacity",
                          "the world has no room for more");
        break;
    case COMMAND_TAKEN:
        http_answer_error(answer, HTTP_ANSWER_CONFLICT,
                          "wait until it is released, or take another one", "%s drives %u",
                          driver ? driver->name : "another client", command->entity);
        break;
    case COMMAND_REMOTE:
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, "take a vehicle of this world",
                          "another simulator owns %u", command->entity);
        break;
    case COMMAND_CANNOT:
        explain_cannot(answer, order);
        break;
    default:
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, "docs/console.md describes the commands",
                          "%s: %s", order->verb->name, command_result_name(result));
        break;
    }
}

void result_text_put(struct http_answer *answer, const struct command_text *order,
                     const jolon_CommandReply *reply, const struct world_reader *reader,
                     const struct players *players)
{
    struct json_writer *json = &answer->json;
    if (reply->result != jolon_RESULT_DONE) {
        explain(answer, order, (enum command_result)reply->result, reader, players);
        return;
    }
    answer->status = HTTP_ANSWER_OK;
    json_writer_begin(json, '{');
    json_writer_key_word(json, "result", "done");
    json_writer_key_whole(json, "frame", reply->frame);
    json_writer_key_whole(json, "entity", reply->entity);
    json_writer_end(json, '}');
}

void result_text_none(struct http_answer *answer, const struct command_text *order, bool heard)
{
    http_answer_error(answer, HTTP_ANSWER_NO_REPLY,
                      heard ? "check whether it was done before you send it again"
                            : "is the reporter running? The process table shows it",
                      heard ? "%s: no reply came in time"
                            : "%s: no process takes commands for the world",
                      order->verb->name);
}
