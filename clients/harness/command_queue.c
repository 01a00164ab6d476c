/* Sends commands in their order and answers them. */
#include "clients/harness/command_queue.h"

#include "ipc/process/clock.h"
#include "ipc/json/world_json.h"
#include "world/entity/command.h"
#include "world/enum_names.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

bool command_queue_room(const struct command_queue *queue)
{
    return queue->count < COMMAND_QUEUE_MAX;
}

/* The subject of a command: all, a vehicle's id, or 0 for a vehicle that does not exist yet. */
#define SUBJECT_ALL UINT64_MAX

static uint64_t subject_of(const struct command_text *order)
{
    switch (order->command.type) {
    case jolon_COMMAND_DRIVE:
    case jolon_COMMAND_RELEASE:
    case jolon_COMMAND_FIRE:
    case jolon_COMMAND_REMOVE:
        return order->command.entity;
    case jolon_COMMAND_SPAWN:
        return 0;
    default:
        return SUBJECT_ALL;
    }
}

/* Writes the answer to a command. reply NULL: there was none, and result says why. */
static void write_answer(struct command_queue *queue, const struct command_queue_item *item,
                         const char *result, const jolon_CommandReply *reply, uint32_t round)
{
    const struct command_text *order = &item->series.order;
    if (!item->id[0])
        return;
    cJSON *object = cJSON_CreateObject();
    (void)cJSON_AddRawToObject(object, "answer", item->id);
    json_text(object, "result", result);
    if (order->rounds > 1)
        json_whole(object, "round", round + 1);
    if (reply) {
        const char *advice = command_text_advice(order, reply->result);
        json_whole(object, "frame", reply->frame);
        json_whole(object, "entity", reply->entity);
        if (*advice)
            json_text(object, "next", advice + strspn(advice, "; "));
    }
    output_object(queue->output, OUTPUT_ANSWER, object);
}

static void drop(struct command_queue *queue, uint32_t i)
{
    queue->count--;
    memmove(&queue->item[i], &queue->item[i + 1], (queue->count - i) * sizeof *queue->item);
}

static void replace_drive(struct command_queue *queue, uint32_t vehicle)
{
    for (uint32_t i = queue->count; i-- > 0;) {
        struct command_queue_item *item = &queue->item[i];
        uint64_t subject = subject_of(&item->series.order);
        if (subject != vehicle && subject != SUBJECT_ALL)
            continue;
        if (item->series.order.command.type != jolon_COMMAND_DRIVE)
            return;
        command_series_forget(&item->series, queue->client);
        write_answer(queue, item, "replaced", NULL, 0);
        drop(queue, i);
        return;
    }
}

void command_queue_add(struct command_queue *queue, const char *id,
                       const struct command_text *order)
{
    struct command_queue_item *item;
    if (order->command.type == jolon_COMMAND_DRIVE)
        replace_drive(queue, order->command.entity);
    item = &queue->item[queue->count++];
    *item = (struct command_queue_item){.series.order = *order};
    (void)snprintf(item->id, sizeof item->id, "%s", id);
}

static bool may_begin(const struct command_queue *queue, uint32_t i)
{
    uint64_t subject = subject_of(&queue->item[i].series.order);
    for (uint32_t before = 0; before < i; before++) {
        uint64_t other = subject_of(&queue->item[before].series.order);
        if (subject == SUBJECT_ALL || other == SUBJECT_ALL || (subject != 0 && subject == other))
            return false;
    }
    return true;
}

static void take_answers(struct command_queue *queue, struct command_queue_item *item,
                         uint64_t now_ns)
{
    jolon_CommandReply reply;
    uint32_t round;
    const struct command_text *order = &item->series.order;
    while (command_series_answer(&item->series, queue->client, &reply, &round)) {
        item->until_ns = now_ns + queue->timeout_ns;
        leases_answer(queue->leases, order, &reply, now_ns);
        write_answer(queue, item, command_result_name((enum command_result)reply.result), &reply,
                     round);
    }
    if (!item->series.waiting)
        item->until_ns = now_ns + queue->timeout_ns; /* no reply is due before the next round */
}

void command_queue_turn(struct command_queue *queue, uint64_t now_ns)
{
    for (uint32_t i = 0; i < queue->count;) {
        struct command_queue_item *item = &queue->item[i];
        if (!item->begun && may_begin(queue, i)) {
            struct command_text order = item->series.order;
            leases_begin(queue->leases, queue->client, &order);
            command_series_begin(&item->series, &order, now_ns);
            item->until_ns = now_ns + queue->timeout_ns;
            item->begun = true;
        }
        if (item->begun) {
            command_series_send(&item->series, queue->client, now_ns);
            take_answers(queue, item, now_ns);
        }
        bool late = item->begun && now_ns >= item->until_ns;
        if (late) {
            command_series_forget(&item->series, queue->client);
            write_answer(queue, item, "no reply", NULL, item->series.answered);
            queue->no_reply = true;
        }
        if (late || (item->begun && command_series_over(&item->series)))
            drop(queue, i);
        else
            i++;
    }
    for (uint32_t i = 0; i < queue->count; i++) {
        if (queue->item[i].begun)
            leases_hold_off(queue->leases, &queue->item[i].series.order);
    }
}

uint64_t command_queue_due_ns(const struct command_queue *queue)
{
    uint64_t due_ns = UINT64_MAX;
    for (uint32_t i = 0; i < queue->count; i++) {
        const struct command_queue_item *item = &queue->item[i];
        if (!item->begun)
            continue;
        uint64_t next_ns = command_series_due_ns(&item->series);
        next_ns = next_ns < item->until_ns ? next_ns : item->until_ns;
        due_ns = next_ns < due_ns ? next_ns : due_ns;
    }
    return due_ns;
}
