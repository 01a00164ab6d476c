/* jolon-console: serves the console's page to browsers. It reads the world like any reader and
 * writes nothing of the world's memory except the slot of its role, if it is the console of the
 * world's set. Its players' commands go to the intake over the command socket, like those of every
 * client. It may start, end and be killed at any time. */
#include "clients/console/options.h"
#include "clients/console/server.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/sandbox/sandbox.h"
#include "ipc/segment/segment_attach.h"

#include <stdio.h>

/* Longest time between two turns of the main loop. */
#define TURN_NS (50 * (uint64_t)NS_PER_MS)

static struct console console = {.lock = PTHREAD_MUTEX_INITIALIZER};

static int choose_token(const struct options *options, struct error_text *error)
{
    uint8_t bytes[SESSION_KEY_BYTES];
    if (options->token_file)
        return session_key_file(console.token, options->token_file, error);
    if (!session_key_random(bytes))
        return error_text_set(error, "the system gives no random numbers");
    session_key_text(console.token, bytes);
    return 0;
}

/* Prints the address. The set's console prints no token, because its output goes to the set's log.
 */
static void print_address(const struct options *options)
{
    if (options->role) {
        log_info("serves %s", console.listener.url);
    } else {
        printf("%s#token=%s\n", console.listener.url, console.token);
        (void)fflush(stdout);
        log_info("world \"%s\": open the address above; without its end (#...) the page shows the "
                 "world and changes nothing",
                 options->world);
    }
    if (!console.listener.local)
        log_warn("any user who reaches %s can see the world; the traffic and the token in it are "
                 "not encrypted: use a private network",
                 options->address);
}

/* Writes the heartbeat of the role, by which the keeper sees that this process lives. */
static void beat(struct view *set)
{
    frame_protocol_beat(set);
    atomic_store_explicit(&set->slot[ROLE_CONSOLE]->frame, atomic_load(&set->commit->commit),
                          memory_order_relaxed);
}

static void turn(uint64_t now_ns)
{
    pthread_mutex_lock(&console.lock);
    if (world_reader_turn(&console.reader, now_ns)) {
        command_queue_world_changed(&console.queue, &console.players, &console.reader);
        if (console.reader.attached)
            log_info("world \"%s\" is there", console.reader.name);
        else
            log_info("%s; waiting for it", console.reader.detail.text);
    }
    command_queue_turn(&console.queue, &console.players, &console.reader, now_ns);
    pthread_mutex_unlock(&console.lock);
    http_server_sweep(console.http, now_ns);
}

int main(int argc, char **argv)
{
    struct options options;
    struct sandbox sandbox;
    struct view set = {0}; /* attached in the role, if this is the set's console */
    struct error_text error;
    char folder[RUNTIME_FOLDER_MAX];
    log_open("console");
    options_parse(&options, argc, argv);
    process_begin_beside(options.parent);
    const struct http_listen_options where = {.address_option = "--address",
                                              .port_option = "--port",
                                              .address = options.address,
                                              .port = (uint16_t)options.port};
    world_reader_open(&console.reader, options.world);
    if (runtime_folder(folder, &error) != 0 || choose_token(&options, &error) != 0 ||
        (options.role && segment_attach(&set, options.world, ROLE_CONSOLE, &error) != 0) ||
        sandbox_begin(&sandbox, ROLE_CONSOLE, options.sandbox_off, &error) != 0 ||
        sandbox_files(&sandbox, NULL, 0, &error) != 0 ||
        http_listen(&console.listener, &where, &error) != 0 ||
        command_queue_open(&console.queue, options.world, &error) != 0 ||
        picture_proxy_open(&console.proxy, options.world, &error) != 0 ||
        server_start(&console, &error) != 0)
        die_refused("%s", error.text);
    print_address(&options); /* before the sandbox: the first output reads the terminal's type */
    if (sandbox_enter(&sandbox, &error) != 0)
        die_refused("%s", error.text);
    if (options.role)
        segment_ready(&set);
    while (!process_stopping()) {
        uint64_t now_ns = clock_now_ns();
        if (options.role)
            beat(&set);
        turn(now_ns);
        command_queue_wait(&console.queue, now_ns + TURN_NS);
    }
    server_end(&console);
    world_reader_close(&console.reader);
    segment_detach(&set);
    return EXIT_OK;
}
