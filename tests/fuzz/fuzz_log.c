/* Logs of events and of commands that a recorder finds at its start, or that `jolon replay` reads:
 * any bytes as a file. The first byte chooses the reader and whether each line gets a correct
 * checksum, so that the code behind the check is reached. Refusals end the process. */
#include "tests/fuzz/support.h"

#include "recorder/log/command_log.h"
#include "recorder/log/event_log.h"
#include "recorder/replay/log_replay.h"
#include "tests/fuzz/shared/ending.h"
#include "world/runtime/check.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sanitizer/lsan_interface.h>
#include <unistd.h>
#include <xxhash.h>

#define TEXT_MAX 65536u

enum how {
    HOW_SEALED = 1,
    HOW_EVENTS = 2, /* read as a log of events, otherwise of commands */
    HOW_TAPE = 4,   /* read by a replay, otherwise by a recorder */
    HOW_ORIGIN = 8  /* the world was made from an image */
};

static struct view view;

static void make_world(void)
{
    struct segment_header *header;
    support_world(&view);
    header = view.base;
    header->made = 0x0123456789abcdef;
    struct state_head *head = view.w[0].head;
    for (; head->event_end < 4; head->event_end++)
        view.events[head->event_end] = (struct event){
            .sequence = head->event_end, .type = EVENT_COMMAND, .index = (uint32_t)head->event_end};
    head->checksum = state_checksum(&view.w[0], view.world.counts.fixed);
}

/* Copies the lines and replaces the closing brace of each by its checksum. */
static size_t seal(char *to, const char *from, size_t size)
{
    size_t used = 0;
    while (size > 0 && used < TEXT_MAX) {
        const char *end = memchr(from, '\n', size);
        size_t length = end ? (size_t)(end - from) : size;
        size_t kept = length > 0 && from[length - 1] == '}' ? length - 1 : length;
        memcpy(to + used, from, kept);
        used += kept;
        if (end)
            used += (size_t)sprintf(to + used, ",\"check\":\"%016llx\"}\n",
                                    (unsigned long long)XXH3_64bits(from, kept));
        from += length + (end != NULL);
        size -= length + (end != NULL);
    }
    return used;
}

static void replay(const char *path)
{
    struct log_replay replay;
    struct error_text error = {.text = ""};
    (void)log_replay_is_command_log(path);
    if (log_replay_open(&replay, path, &error) != 0) {
        CHECK(error.text[0] != '\0');
        return;
    }
    (void)log_replay_end(&replay);
    (void)log_replay_provenance(&replay, "scenario");
    for (uint32_t i = 0; i < replay.count; i++)
        CHECK(replay.record[i].type != RECORD_COMMAND ||
              replay.record[i].command.ring < COMMAND_RING_COUNT);
    log_replay_close(&replay);
}

/* After a recorder has started and ended, the log must be a series of whole records. */
static void record(const char *path, bool events)
{
    static struct event_log event_log;
    static struct command_log command_log;
    if (events) {
        event_log_open(&event_log, &view, path);
        while (event_log_append(&event_log, &view))
            ;
        event_log_close(&event_log, &view);
    } else {
        command_log_open(&command_log, &view, path);
        while (command_log_append(&command_log, &view))
            ;
        command_log_close(&command_log, &view);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char text[2 * TEXT_MAX];
    static int first_fd;
    char path[64];
    if (!view.base) {
        make_world();
        first_fd = dup(STDIN_FILENO);
        close(first_fd);
    }
    if (size < 1 || size > TEXT_MAX / 32)
        return 0;
    enum how how = (enum how)data[0];
    ((struct segment_header *)view.base)->origin = how & HOW_ORIGIN ? 1 : 0;
    if (how & HOW_SEALED)
        size = seal(text, (const char *)data + 1, size - 1);
    else
        memcpy(text, data + 1, --size);
    support_put("models/k.obj", text, size);
    support_path(path, sizeof path, "models/k.obj");
    if (how & HOW_TAPE) {
        replay(path);
        return 0;
    }
    __lsan_disable(); /* the process does not free memory before its exit */
    if (ENDING_CATCH() == 0)
        record(path, how & HOW_EVENTS);
    ending_done();
    __lsan_enable();
    CHECK(close_range((unsigned)first_fd, ~0U, 0) == 0);
    return 0;
}
