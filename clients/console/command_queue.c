/* Sends commands and reads replies. */
#include "clients/console/command_queue.h"

#include "clients/console/result_text.h"
#include "ipc/process/clock.h"
#include "world/enum_names.h"
#include "world/param_values.h"
#include "world/params.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

int command_queue_open(struct command_queue *queue, const char *world, struct error_text *error)
{
    *queue = (struct command_queue){.wake_fd = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
    if (queue->wake_fd < 0)
        return error_text_set(error, "eventfd: %s", strerror(errno));
    return command_client_open(&queue->client, command_socket_open(&queue->socket, world), error);
}

/* --- pending commands --------------------------------------------------------------------------*/

static void finish(struct command_queue *queue, struct pending_command **at)
{
    struct pending_command *pending = *at;
    *at = pending->next;
    queue->pending_count--;
    pending->done = true;
    pending->ready(pending);
}

void command_queue_close(struct command_queue *queue)
{
    while (queue->pending) {
        result_text_none(&queue->pending->answer, &queue->pending->order, true);
        finish(queue, &queue->pending);
    }
    name_table_close(&queue->names);
    command_socket_close(&queue->socket);
    close(queue->wake_fd);
}

static bool is_drive(const struct command_text *order)
{
    return order->command.type == jolon_COMMAND_DRIVE;
}

static bool is_mission(const struct command_text *order)
{
    return order->given & 1u << COMMAND_TEXT_MUNITION;
}

/* Returns true if the command is sent as it is and has one reply. */
static bool is_command(const struct command_text *order)
{
    return !is_drive(order) && !is_mission(order);
}

static struct fire_mission *find_mission(struct command_queue *queue, uint32_t number)
{
    for (uint32_t i = 0; i < COMMAND_QUEUE_MISSIONS; i++) {
        if (queue->mission[i].number == number)
            return &queue->mission[i];
    }
    return NULL;
}

/* Without a vehicle the command is for the vehicle that the player drives. */
static bool name_vehicle(struct command_text *order, const struct player *player,
                         struct http_answer *answer)
{
    jolon_Command *command = &order->command;
    if (!(order->given & 1u << COMMAND_TEXT_VEHICLE) || command->entity)
        return true;
    command->entity = player ? player->vehicle : 0;
    if (command->entity)
        return true;
    http_answer_error(answer, HTTP_ANSWER_CONFLICT, "take one: drive with a \"vehicle\"",
                      "%s: you drive nothing", order->verb->name);
    return false;
}

static bool find_names(const struct command_queue *queue, struct command_text *order,
                       struct http_answer *answer)
{
    struct error_text error;
    if (command_text_resolve(order, &queue->names, 0.0, &error) == 0)
        return true;
    http_answer_error(answer, HTTP_ANSWER_CONFLICT, "choose one on the map or in the list",
                      "%s: %s", order->verb->name, error.text);
    return false;
}

static struct controls controls_of(const jolon_Command *command)
{
    return (struct controls){.throttle = command->throttle,
                             .steer = command->steer,
                             .climb = command->climb,
                             .traverse = command->traverse,
                             .elevate = command->elevate,
                             .brake = command->brake,
                             .gear = (uint32_t)command->gear};
}

/* Runs in the server's thread. It notes the player's controls; the main thread sends them. */
static void put_drive(struct pending_command *pending, struct player *player)
{
    player->wanted = pending->order.command.entity;
    player->controls = controls_of(&pending->order.command);
    pending->sequence = ++player->version;
}

static void end_mission(struct command_queue *queue, struct fire_mission *mission)
{
    command_series_forget(&mission->series, &queue->client);
    mission->number = 0;
}

static bool put_cancel(struct command_queue *queue, struct pending_command *pending,
                       struct http_answer *answer)
{
    struct fire_mission *mission = find_mission(queue, pending->cancel);
    if (!mission) {
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, "the state lists the missions there are",
                          "there is no mission %u", pending->cancel);
        return false;
    }
    json_writer_begin(&answer->json, '{');
    json_writer_key_word(&answer->json, "result", "done");
    json_writer_key_whole(&answer->json, "mission", mission->number);
    json_writer_key_whole(&answer->json, "fired", mission->series.done);
    json_writer_end(&answer->json, '}');
    end_mission(queue, mission);
    return false;
}

bool command_queue_put(struct command_queue *queue, struct pending_command *pending,
                       struct player *player, uint64_t now_ns, struct http_answer *answer)
{
    struct command_text *order = &pending->order;
    if (pending->cancel)
        return put_cancel(queue, pending, answer);
    bool mission = is_mission(order);
    if (!find_names(queue, order, answer) || !name_vehicle(order, player, answer))
        return false;
    if (is_drive(order) && !player) {
        http_answer_error(answer, HTTP_ANSWER_FORBIDDEN, "POST /api/join first",
                          "only a player can drive, and X-Jolon-Player names no player");
        return false;
    }
    if (queue->pending_count == COMMAND_QUEUE_PENDING_MAX || (mission && !find_mission(queue, 0))) {
        http_answer_error(answer, HTTP_ANSWER_TOO_MANY, "wait until some are done",
                          mission ? "%u fire missions run already"
                                  : "more than %u orders wait already",
                          mission ? COMMAND_QUEUE_MISSIONS : COMMAND_QUEUE_PENDING_MAX);
        return false;
    }
    pending->next = NULL;
    pending->player = player ? player->number : 0;
    pending->source = player ? player->source : 0;
    pending->sequence = 0;
    pending->until_ns = now_ns + COMMAND_QUEUE_REPLY_NS;
    if (is_drive(order))
        put_drive(pending, player);
    struct pending_command **at = &queue->pending;
    while (*at)
        at = &(*at)->next;
    *at = pending;
    queue->pending_count++;
    (void)eventfd_write(queue->wake_fd, 1);
    return true;
}

/* --- driving -----------------------------------------------------------------------------------*/

static uint32_t lease_frames(const struct world_reader *reader)
{
    const struct params *params = reader->view.world.params;
    double a_second = world_reader_rate_hz(reader);
    if (params->pace == PACE_REAL)
        a_second = params->hz * (reader->scale > 0.0 ? reader->scale : 1.0);
    return (uint32_t)fmin(fmax(ceil(a_second * COMMAND_QUEUE_LEASE_S), 2.0), COMMAND_LEASE_MAX);
}

/* Answers the player's drives of other vehicles: only the last one is sent. */
static void answer_superseded(struct command_queue *queue, const struct player *player)
{
    struct pending_command **at = &queue->pending;
    while (*at) {
        struct pending_command *pending = *at;
        uint32_t vehicle = pending->order.command.entity;
        if (is_drive(&pending->order) && pending->player == player->number &&
            vehicle != player->wanted) {
            http_answer_error(&pending->answer, HTTP_ANSWER_CONFLICT,
                              "send a drive when the one before has its answer",
                              "drive: your order for %u came before this one for %u was sent",
                              player->wanted, vehicle);
            finish(queue, at);
        } else {
            at = &pending->next;
        }
    }
}

static void send_drive(struct command_queue *queue, struct player *player,
                       const struct world_reader *reader, uint64_t now_ns)
{
    answer_superseded(queue, player);
    const struct controls *controls = &player->controls;
    jolon_Command command = {.source = player->source,
                             .type = jolon_COMMAND_DRIVE,
                             .entity = player->wanted,
                             .throttle = controls->throttle,
                             .steer = controls->steer,
                             .climb = controls->climb,
                             .traverse = controls->traverse,
                             .elevate = controls->elevate,
                             .brake = controls->brake,
                             .gear = (jolon_Gear)controls->gear,
                             .lease_frames = lease_frames(reader)};
    player->sent = command_client_send(&queue->client, &command);
    player->sent_version = player->version;
    player->sent_for = player->wanted;
    player->sent_ns = now_ns;
}

/* The reply is not awaited: if the command is lost, the lease ends soon. */
static void send_release(struct command_queue *queue, const struct player *player, uint32_t vehicle)
{
    jolon_Command command = {
        .source = player->source, .type = jolon_COMMAND_RELEASE, .entity = vehicle};
    (void)command_client_send(&queue->client, &command);
}

static void on_drive_reply(struct command_queue *queue, struct player *player,
                           const jolon_CommandReply *reply)
{
    char detail[sizeof player->lost];
    player->sent = 0;
    if (reply->result == jolon_RESULT_DONE) {
        if (player->vehicle && player->vehicle != player->sent_for)
            send_release(queue, player, player->vehicle);
        player->vehicle = player->sent_for;
        if (player->sent_version == player->version)
            player->accepted = player->controls;
        player->lost[0] = '\0';
        return;
    }
    if (player->vehicle == player->sent_for) {
        (void)snprintf(detail, sizeof detail, "%u: %s", player->vehicle,
                       command_result_name((enum command_result)reply->result));
        players_release_vehicle(player, detail);
    } else if (player->wanted == player->sent_for) {
        player->wanted = player->vehicle;
        player->controls = player->accepted;
    }
}

/* Answers the player's drives that this reply covers. */
static void answer_drives(struct command_queue *queue, const struct player *player,
                          const jolon_CommandReply *reply, const struct world_reader *reader,
                          const struct players *players)
{
    struct pending_command **at = &queue->pending;
    while (*at) {
        struct pending_command *pending = *at;
        if (is_drive(&pending->order) && pending->player == player->number &&
            pending->sequence <= player->sent_version &&
            pending->order.command.entity == player->sent_for) {
            result_text_put(&pending->answer, &pending->order, reply, reader, players);
            finish(queue, at);
        } else {
            at = &pending->next;
        }
    }
}

static void update_player(struct command_queue *queue, struct player *player,
                          const struct players *players, const struct world_reader *reader,
                          uint64_t now_ns)
{
    jolon_CommandReply reply;
    if (player->sent && command_client_answered(&queue->client, player->sent, &reply)) {
        on_drive_reply(queue, player, &reply);
        answer_drives(queue, player, &reply, reader, players);
    } else if (player->sent && now_ns > player->sent_ns + COMMAND_QUEUE_REPLY_NS) {
        command_client_forget(&queue->client, player->sent);
        player->sent = 0;
    }
    if (player->wanted && now_ns > player->last_request_ns + PLAYERS_LEAVE_NS) {
        if (player->sent)
            command_client_forget(&queue->client, player->sent);
        send_release(queue, player, player->wanted);
        players_release_vehicle(player, "given back: nothing was heard of your page");
    }
    bool changed = player->version != player->sent_version;
    bool due =
        players_is_active(player, now_ns) && now_ns >= player->sent_ns + COMMAND_QUEUE_RENEW_NS;
    if (player->wanted && !player->sent && reader->attached && (changed || due))
        send_drive(queue, player, reader, now_ns);
    if (now_ns > player->last_request_ns + PLAYERS_FORGET_NS)
        player->number = 0;
}

/* --- other commands ----------------------------------------------------------------------------*/

static struct player *player_of(struct players *players, uint32_t number)
{
    for (uint32_t i = 0; i < PLAYERS_MAX && number; i++) {
        if (players->player[i].number == number)
            return &players->player[i];
    }
    return NULL;
}

static uint64_t simulated_ns(const struct world_reader *reader)
{
    return (uint64_t)(reader->time_s * NS_PER_S);
}

static void start_mission(struct command_queue *queue, struct pending_command *pending,
                          const struct world_reader *reader)
{
    struct fire_mission *mission = find_mission(queue, 0);
    if (!mission)
        return; /* all places are taken: the command waits for one */
    mission->number = ++queue->missions;
    command_series_begin(&mission->series, &pending->order, simulated_ns(reader));
    pending->sequence = mission->number;
}

static void send_pending(struct command_queue *queue, struct pending_command *pending,
                         struct players *players, const struct world_reader *reader)
{
    if (is_mission(&pending->order)) {
        start_mission(queue, pending, reader);
        return;
    }
    jolon_Command command = pending->order.command;
    struct player *player = player_of(players, pending->player);
    command.source = pending->source;
    if (player && command.type == jolon_COMMAND_RELEASE && command.entity == player->wanted) {
        if (player->sent)
            command_client_forget(&queue->client, player->sent);
        players_release_vehicle(player, "");
    }
    pending->sequence = command_client_send(&queue->client, &command);
}

/* Forgets a command without a reply, so that it is not carried out after the player has read that
 * no reply came. */
static void give_up(struct command_queue *queue, struct pending_command *pending,
                    struct players *players)
{
    struct player *player = player_of(players, pending->player);
    if (is_command(&pending->order) && pending->sequence)
        command_client_forget(&queue->client, pending->sequence);
    if (is_drive(&pending->order) && player && player->wanted != player->vehicle) {
        player->wanted = player->vehicle;
        player->controls = player->accepted;
    }
    result_text_none(&pending->answer, &pending->order, command_client_reachable(&queue->client));
}

static void update_pending(struct command_queue *queue, struct players *players,
                           const struct world_reader *reader, uint64_t now_ns)
{
    jolon_CommandReply reply;
    struct pending_command **at = &queue->pending;
    while (*at) {
        struct pending_command *pending = *at;
        if (!pending->sequence)
            send_pending(queue, pending, players, reader);
        if (is_command(&pending->order) && pending->sequence &&
            command_client_answered(&queue->client, pending->sequence, &reply)) {
            result_text_put(&pending->answer, &pending->order, &reply, reader, players);
            finish(queue, at);
        } else if (now_ns >= pending->until_ns) {
            give_up(queue, pending, players);
            finish(queue, at);
        } else {
            at = &pending->next;
        }
    }
}

/* --- fire missions -----------------------------------------------------------------------------*/

/* Answers the request for the mission with the reply to its first round. */
static void answer_mission(struct command_queue *queue, const struct fire_mission *mission,
                           const jolon_CommandReply *reply, const struct world_reader *reader,
                           const struct players *players)
{
    struct pending_command **at = &queue->pending;
    while (*at && (!is_mission(&(*at)->order) || (*at)->sequence != mission->number))
        at = &(*at)->next;
    if (!*at)
        return;
    struct pending_command *pending = *at;
    struct json_writer *json = &pending->answer.json;
    if (reply->result == jolon_RESULT_DONE) {
        json_writer_begin(json, '{');
        json_writer_key_word(json, "result", "done");
        json_writer_key_whole(json, "frame", reply->frame);
        json_writer_key_whole(json, "entity", reply->entity);
        json_writer_key_whole(json, "mission", mission->number);
        json_writer_key_whole(json, "seed", mission->series.seed);
        json_writer_end(json, '}');
    } else {
        result_text_put(&pending->answer, &pending->order, reply, reader, players);
    }
    finish(queue, at);
}

static void update_mission(struct command_queue *queue, struct fire_mission *mission,
                           const struct world_reader *reader, const struct players *players)
{
    jolon_CommandReply reply;
    uint32_t round;
    bool possible = true;
    while (command_series_answer(&mission->series, &queue->client, &reply, &round)) {
        answer_mission(queue, mission, &reply, reader, players);
        possible = possible && reply.result != jolon_RESULT_NO_SUCH_KIND;
    }
    /* A munition that does not exist is not tried again. */
    if (command_series_over(&mission->series) || !possible)
        end_mission(queue, mission);
    else if (reader->attached)
        command_series_send(&mission->series, &queue->client, simulated_ns(reader));
}

/* --- turns -------------------------------------------------------------------------------------*/

void command_queue_turn(struct command_queue *queue, struct players *players,
                        const struct world_reader *reader, uint64_t now_ns)
{
    eventfd_t counter;
    (void)eventfd_read(queue->wake_fd, &counter);
    command_client_poll(&queue->client);
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        if (players->player[i].number)
            update_player(queue, &players->player[i], players, reader, now_ns);
    }
    update_pending(queue, players, reader, now_ns);
    for (uint32_t i = 0; i < COMMAND_QUEUE_MISSIONS; i++) {
        if (queue->mission[i].number)
            update_mission(queue, &queue->mission[i], reader, players);
    }
}

void command_queue_world_changed(struct command_queue *queue, struct players *players,
                                 const struct world_reader *reader)
{
    name_table_close(&queue->names); /* out of memory: vehicles have no names */
    if (reader->attached)
        (void)name_table_read_world(&queue->names, &reader->view.world, reader->view.header->made);
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        struct player *player = &players->player[i];
        if (!player->number)
            continue;
        if (player->sent)
            command_client_forget(&queue->client, player->sent);
        if (player->wanted)
            players_release_vehicle(player, "the world is another one");
    }
    for (uint32_t i = 0; i < COMMAND_QUEUE_MISSIONS; i++) {
        if (queue->mission[i].number)
            end_mission(queue, &queue->mission[i]);
    }
}

void command_queue_wait(struct command_queue *queue, uint64_t until_ns)
{
    struct pollfd watched[] = {{.fd = queue->wake_fd, .events = POLLIN},
                               {.fd = command_client_descriptor(&queue->client), .events = POLLIN}};
    uint64_t now_ns = clock_now_ns();
    uint64_t left_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec left = {.tv_sec = (time_t)(left_ns / NS_PER_S),
                            .tv_nsec = (long)(left_ns % NS_PER_S)};
    (void)ppoll(watched, 2, &left, NULL);
}
