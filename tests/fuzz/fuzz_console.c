/* Requests to a console: libmicrohttpd's parser, names, rates, routes, query keys, bodies. Commands
 * reach the command queue, where the harness answers them. */
#include "tests/fuzz/shared/http_client.h"
#include "tests/fuzz/support.h"

#include "clients/console/request.h"
#include "world/runtime/check.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static struct console console = {.lock = PTHREAD_MUTEX_INITIALIZER,
                                 .token = "0123456789abcdef0123456789abcdef"};

static void answer_pending(void)
{
    pthread_mutex_lock(&console.lock);
    while (console.queue.pending) {
        struct pending_command *pending = console.queue.pending;
        console.queue.pending = pending->next;
        console.queue.pending_count--;
        http_answer_error(&pending->answer, HTTP_ANSWER_NO_REPLY, "look", "no reply came");
        pending->done = true;
        pending->ready(pending);
    }
    pthread_mutex_unlock(&console.lock);
}

static void start(void)
{
    static char name[32];
    struct error_text error;
    (void)snprintf(name, sizeof name, "fuzz-%d", (int)getpid());
    world_reader_open(&console.reader, name);
    support_world(&console.reader.view);
    CHECK(snapshot_init(&console.reader.snapshot, &console.reader.view) == 0);
    console.reader.attached = true;
    console.listener = http_client_listener();
    CHECK(picture_proxy_open(&console.proxy, name, &error) == 0);
    CHECK(server_start(&console, &error) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!console.http)
        start();
    /* Each input is the first of its second, and there are no players. */
    pthread_mutex_lock(&console.lock);
    console.write_rate = (struct rate){0};
    console.players = (struct players){.joined = 0};
    pthread_mutex_unlock(&console.lock);
    http_client_send(data, size, answer_pending);
    http_client_get("/api/state?most=1", answer_pending);
    return 0;
}
