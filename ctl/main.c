/* jolon-ctl: sends one command to a world and waits for its reply. */
#include "ctl/parse.h"
#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "topics/caller.h"

#include "status.h"
#include "world/world.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>

struct ctl {
    struct dds_link link;
    struct caller caller;
    jolon_CommandReply reply;
};

static void print_done(const struct ctl_request *request, const jolon_CommandReply *reply)
{
    const jolon_Command *command = &request->command;
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
        printf("driving %u from frame %llu\n", command->entity, frame);
        break;
    case jolon_COMMAND_RELEASE:
        printf("released %u at frame %llu\n", command->entity, frame);
        break;
    case jolon_COMMAND_FIRE:
        if (command->entity)
            printf("%u fires at frame %llu\n", command->entity, frame);
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

/* result NULL: there was no reply. */
static void print_json(const struct ctl_request *request, const jolon_CommandReply *reply,
                       const char *result)
{
    cJSON *object = cJSON_CreateObject();
    (void)cJSON_AddStringToObject(object, "world", request->world);
    (void)cJSON_AddStringToObject(object, "command", request->verb);
    (void)cJSON_AddStringToObject(object, "result", result ? result : "no reply");
    if (result) {
        (void)cJSON_AddNumberToObject(object, "frame", (double)reply->frame);
        (void)cJSON_AddNumberToObject(object, "entity", reply->entity);
    }
    char *text = cJSON_PrintUnformatted(object);
    if (text)
        printf("%s\n", text);
    cJSON_free(text);
    cJSON_Delete(object);
}

/* The kinds there are, for whoever named another; "" when the world does not say. */
static void list_kinds(const struct ctl *ctl, bool munitions, char *text, size_t bytes)
{
    struct reason reason;
    void *sample = NULL;
    dds_sample_info_t info;
    size_t used = 0;
    text[0] = '\0';
    dds_entity_t reader = dds_topics_reader(&ctl->link, TOPIC_WORLD, &reason);
    dds_entity_t waitset = dds_topics_waitset(&ctl->link, &reader, 1, &reason);
    if (reader < 0 || waitset < 0)
        return;
    dds_topics_wait(waitset, 500 * (uint64_t)NS_PER_MS);
    if (dds_take(reader, &sample, &info, 1, 1) <= 0)
        return;
    const jolon_WorldInfo *world = sample;
    for (uint32_t i = 0; info.valid_data && i < world->kinds._length; i++) {
        const jolon_KindInfo *kind = &world->kinds._buffer[i];
        if (kind->domain == jolon_DOMAIN_FIXED ||
            (kind->domain == jolon_DOMAIN_MUNITION) != munitions || used >= bytes)
            continue;
        int length =
            snprintf(text + used, bytes - used, "%s%s", used ? ", " : "; there are ", kind->name);
        used += length > 0 ? (size_t)length : 0;
    }
    (void)dds_return_loan(reader, &sample, 1);
}

static void print_refusal(const struct ctl *ctl, const struct ctl_request *request)
{
    const jolon_Command *command = &request->command;
    const char *why = command_result_name((enum command_result)ctl->reply.result);
    char more[512] = "";
    char what[64] = "";
    if (ctl->reply.result == jolon_RESULT_NO_SUCH_KIND)
        list_kinds(ctl, command->type == jolon_COMMAND_FIRE, more, sizeof more);
    if (command->kind[0])
        (void)snprintf(what, sizeof what, " %s", command->kind);
    else if (command->entity)
        (void)snprintf(what, sizeof what, " %u", command->entity);
    (void)fprintf(stderr, "jolon-ctl: %s%s: %s (frame %llu)%s\n", request->verb, what, why,
                  (unsigned long long)ctl->reply.frame, more);
}

static void print_silence(const struct ctl *ctl, const struct ctl_request *request)
{
    if (!caller_heard(&ctl->caller))
        (void)fprintf(stderr,
                      "jolon-ctl: world '%s': nobody takes commands for it; is it running, with "
                      "its reporter? `jolon status -w %s` shows it\n",
                      request->world, request->world);
    else
        (void)fprintf(stderr,
                      "jolon-ctl: world '%s': no reply to %s within %g s; `jolon status -w %s` "
                      "shows whether its mover and collider run\n",
                      request->world, request->verb, request->timeout_s, request->world);
}

int main(int argc, char **argv)
{
    static struct ctl ctl;
    struct ctl_request request;
    struct reason reason;
    log_open("ctl");
    ctl_parse(&request, argc, argv);
    process_signals();
    if (dds_link_open(&ctl.link, &request.link, request.world, &reason) != 0 ||
        caller_open(&ctl.caller, &ctl.link, &reason) != 0)
        die_refused("%s", reason.text);
    uint64_t until_ns = clock_now_ns() + (uint64_t)(request.timeout_s * NS_PER_S);
    bool answered = caller_call(&ctl.caller, &request.command, until_ns, &ctl.reply);
    bool done = answered && ctl.reply.result == jolon_RESULT_DONE;
    if (request.json)
        print_json(&request, &ctl.reply,
                   answered ? command_result_name((enum command_result)ctl.reply.result) : NULL);
    else if (done)
        print_done(&request, &ctl.reply);
    if (answered && !done)
        print_refusal(&ctl, &request);
    else if (!answered)
        print_silence(&ctl, &request);
    int code = done ? EXIT_OK : EXIT_REFUSED;
    (void)fflush(stdout);
    dds_link_close(&ctl.link, code);
    return code;
}
