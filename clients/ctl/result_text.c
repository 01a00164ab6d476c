/* Prints results. */
#include "clients/ctl/result_text.h"

#include "ipc/json/world_json.h"
#include "world/entity/command.h"
#include "world/enum_names.h"

#include <stdio.h>

void result_text_done(const struct command_text *order, const struct result_text_context *context,
                      const jolon_CommandReply *reply)
{
    const jolon_Command *command = &order->command;
    unsigned long long frame = (unsigned long long)reply->frame;
    switch (command->type) {
    case jolon_COMMAND_PAUSE:
        printf("paused at frame %llu\n", frame);
        break;
    case jolon_COMMAND_RESUME:
        printf("resumed at frame %llu\n", frame);
        break;
    case jolon_COMMAND_STEP:
        printf("stepping %u frames from frame %llu\n", command->frames, frame);
        break;
    case jolon_COMMAND_SCALE:
        printf("time scale %g from frame %llu\n", command->scale, frame);
        break;
    case jolon_COMMAND_DRIVE:
        printf("driving %u from frame %llu", command->entity, frame);
        if (command->lease_frames)
            printf(" for %u frames", command->lease_frames);
        printf("\n");
        break;
    case jolon_COMMAND_RELEASE:
        printf("released %u at frame %llu\n", command->entity, frame);
        break;
    case jolon_COMMAND_FIRE:
        if (command->entity)
            printf("%u fires at frame %llu\n", command->entity, frame);
        else if (context->rounds > 1)
            printf("%s falls near %g,%g from frame %llu (%u of %u)\n", command->kind, command->x_m,
                   command->z_m, frame, context->round, context->rounds);
        else
            printf("%s falls on %g,%g from frame %llu\n", command->kind, command->x_m, command->z_m,
                   frame);
        break;
    case jolon_COMMAND_SPAWN:
        printf("spawned %s %u at frame %llu\n", command->kind, reply->entity, frame);
        break;
    case jolon_COMMAND_REMOVE:
        printf("removed %u at frame %llu\n", command->entity, frame);
        break;
    case jolon_COMMAND_QUIT:
        printf("the run ends with frame %llu\n", frame);
        break;
    case jolon_COMMAND_NONE:
        break;
    }
}

void result_text_json(const struct command_text *order, const struct result_text_context *context,
                      const jolon_CommandReply *reply)
{
    cJSON *object = cJSON_CreateObject();
    json_text(object, "world", context->world);
    if (context->line)
        json_whole(object, "line", context->line);
    json_text(object, "command", order->verb->name);
    if (context->rounds > 1)
        json_whole(object, "round", context->round);
    json_text(object, "result",
              reply ? command_result_name((enum command_result)reply->result) : "no reply");
    if (reply) {
        json_whole(object, "frame", reply->frame);
        json_whole(object, "entity", reply->entity);
    }
    json_print(object);
}

void result_text_refusal(const struct command_text *order,
                         const struct result_text_context *context, const jolon_CommandReply *reply,
                         const char *more)
{
    const jolon_Command *command = &order->command;
    char line[24] = "", subject[64] = "";
    if (context->line)
        (void)snprintf(line, sizeof line, "line %u: ", context->line);
    if (command->kind[0])
        (void)snprintf(subject, sizeof subject, " %s", command->kind);
    else if (order->vehicle[0])
        (void)snprintf(subject, sizeof subject, " %s (%u)", order->vehicle, command->entity);
    else if (command->entity)
        (void)snprintf(subject, sizeof subject, " %u", command->entity);
    (void)fprintf(stderr, "jolon-ctl: %s%s%s: %s (frame %llu)%s\n", line, order->verb->name,
                  subject, command_result_name((enum command_result)reply->result),
                  (unsigned long long)reply->frame,
                  *more ? more : command_text_advice(order, reply->result));
}
