/* Commands in, replies out. */
#include "reporter/orders.h"

#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/snapshot.h"
#include "reporter/check.h"
#include "reporter/recall.h"

#include <errno.h>

#define TAKE_AT_ONCE 32

int orders_open(struct orders *orders, const struct view *view, const struct dds_link *link,
                struct reason *reason)
{
    *orders = (struct orders){0};
    book_clear(&orders->book);
    if (recall(&orders->book, view, RING_REPORTER) != 0)
        return reason_set(reason, "world \"%s\": its last frame cannot be read", view->name);
    orders->writer = dds_topics_writer(link, TOPIC_REPLY, reason);
    if (orders->writer < 0)
        return -1;
    orders->reader = dds_topics_reader(link, TOPIC_COMMAND, reason);
    return orders->reader < 0 ? -1 : 0;
}

static void send_reply(struct orders *orders, const struct book_entry *entry)
{
    jolon_CommandReply reply = {
        .source = entry->source,
        .sequence = entry->sequence,
        .type = (jolon_CommandType)entry->type,
        .result = (jolon_CommandResult)entry->result,
        .frame = entry->frame,
        .entity = entry->entity,
    };
    /* A reply that does not get out is sent again when the command is repeated. */
    (void)dds_write(orders->writer, &reply);
}

/* False when the ring is full. */
static bool put(struct orders *orders, struct view *view, const struct command *command)
{
    if (command_put(view, RING_REPORTER, command) != 0 && errno != EEXIST) {
        if (log_due(&orders->full_logged_ns, NS_PER_S))
            log_warn("command ring: %s; commands wait in DDS until the mover takes some",
                     errno == ENOBUFS ? "full" : "cannot be written");
        return false;
    }
    book_wait(&orders->book, command->source, command->source_sequence, command->type);
    return true;
}

static void refuse(struct orders *orders, const jolon_Command *wire, enum command_result result,
                   const struct view *view)
{
    struct book_entry refusal = {
        .source = wire->source,
        .sequence = wire->sequence,
        .frame = atomic_load_explicit(&view->commit->commit, memory_order_acquire),
        .type = (uint32_t)wire->type,
        .result = (uint32_t)result,
        .entity = wire->entity};
    if (log_due(&orders->refused_logged_ns, NS_PER_S))
        log_warn("command %s refused: %s", command_type_name((enum command_type)wire->type),
                 command_result_name(result));
    send_reply(orders, &refusal);
}

static void take_one(struct orders *orders, struct view *view, const jolon_Command *wire, bool over)
{
    struct command command;
    const struct book_entry *known = book_find(&orders->book, wire->source, wire->sequence);
    if (known && known->answered) {
        send_reply(orders, known);
        return;
    }
    enum command_result result = check_command(&command, wire, &view->world);
    if (result == COMMAND_DONE && over)
        result = COMMAND_CANNOT; /* nobody takes it out of the ring any more */
    if (result != COMMAND_DONE) {
        refuse(orders, wire, result, view);
    } else if (!known && !put(orders, view, &command)) {
        orders->held = command;
        orders->holding = true;
    }
}

void orders_take(struct orders *orders, struct view *view, bool over)
{
    if (over)
        orders->holding = false; /* its sender repeats it and is told */
    if (orders->holding) {
        if (!put(orders, view, &orders->held))
            return;
        orders->holding = false;
    }
    /* One at a time: a sample taken is out of DDS, and only one can be held. */
    for (int i = 0; i < TAKE_AT_ONCE && !orders->holding; i++) {
        void *sample = NULL;
        dds_sample_info_t info;
        if (dds_take(orders->reader, &sample, &info, 1, 1) <= 0)
            return;
        if (info.valid_data)
            take_one(orders, view, sample, over);
        (void)dds_return_loan(orders->reader, &sample, 1);
    }
}

void orders_answer(struct orders *orders, const struct event *event, bool reply)
{
    const struct event_command *answer = &event->command;
    if (answer->ring != RING_REPORTER || !answer->source)
        return;
    const struct book_entry *entry =
        book_answer(&orders->book, answer->source, answer->sequence, answer->type, answer->result,
                    answer->entity, event->frame);
    if (reply)
        send_reply(orders, entry);
}

bool orders_waiting(const struct orders *orders)
{
    return orders->holding || orders->book.waiting > 0;
}
