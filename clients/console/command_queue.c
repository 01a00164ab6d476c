/* Orders out, replies in. */
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

int command_queue_open(struct command_queue *desk, const char *world, struct reason *reason)
{
    *desk = (struct command_queue){.bell = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
    if (desk->bell < 0)
        return reason_set(reason, "eventfd: %s", strerror(errno));
    return command_client_open(&desk->caller, command_socket_open(&desk->socket, world), reason);
}

/* --- tickets -----------------------------------------------------------------------------------*/

static void finish(struct command_queue *desk, struct pending_command **at)
{
    struct pending_command *ticket = *at;
    *at = ticket->next;
    desk->tickets--;
    ticket->done = true;
    ticket->ready(ticket);
}

void command_queue_close(struct command_queue *desk)
{
    while (desk->ticket) {
        result_text_none(&desk->ticket->answer, &desk->ticket->order, true);
        finish(desk, &desk->ticket);
    }
    name_table_close(&desk->names);
    command_socket_close(&desk->socket);
    close(desk->bell);
}

static bool is_drive(const struct command_text *order)
{
    return order->command.type == jolon_COMMAND_DRIVE;
}

static bool is_mission(const struct command_text *order)
{
    return order->given & 1u << COMMAND_TEXT_MUNITION;
}

/* One command with one reply, as it is. */
static bool is_command(const struct command_text *order)
{
    return !is_drive(order) && !is_mission(order);
}

static struct command_queue_mission *find_mission(struct command_queue *desk, uint32_t number)
{
    for (uint32_t i = 0; i < COMMAND_QUEUE_MISSIONS; i++) {
        if (desk->mission[i].number == number)
            return &desk->mission[i];
    }
    return NULL;
}

/* Which vehicle an order is for, when it does not say: the player's own. */
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

static bool find_names(const struct command_queue *desk, struct command_text *order,
                       struct http_answer *answer)
{
    struct reason reason;
    if (command_text_resolve(order, &desk->names, 0.0, &reason) == 0)
        return true;
    http_answer_error(answer, HTTP_ANSWER_CONFLICT, "choose one on the map or in the list",
                      "%s: %s", order->verb->name, reason.text);
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

/* From the server's thread: notes what the player wants; the desk sends it. */
static void put_drive(struct pending_command *ticket, struct player *player)
{
    player->wanted = ticket->order.command.entity;
    player->controls = controls_of(&ticket->order.command);
    ticket->sequence = ++player->version;
}

static void end_mission(struct command_queue *desk, struct command_queue_mission *mission)
{
    command_series_forget(&mission->mission, &desk->caller);
    mission->number = 0;
}

static bool put_cancel(struct command_queue *desk, struct pending_command *ticket,
                       struct http_answer *answer)
{
    struct command_queue_mission *mission = find_mission(desk, ticket->cancel);
    if (!mission) {
        http_answer_error(answer, HTTP_ANSWER_CONFLICT, "the state lists the missions there are",
                          "there is no mission %u any more, or never was", ticket->cancel);
        return false;
    }
    json_writer_begin(&answer->text, '{');
    json_writer_key_word(&answer->text, "result", "done");
    json_writer_key_whole(&answer->text, "mission", mission->number);
    json_writer_key_whole(&answer->text, "fired", mission->mission.done);
    json_writer_end(&answer->text, '}');
    end_mission(desk, mission);
    return false;
}

bool command_queue_put(struct command_queue *desk, struct pending_command *ticket,
                       struct player *player, uint64_t now_ns, struct http_answer *answer)
{
    struct command_text *order = &ticket->order;
    if (ticket->cancel)
        return put_cancel(desk, ticket, answer);
    bool mission = is_mission(order);
    if (!find_names(desk, order, answer) || !name_vehicle(order, player, answer))
        return false;
    if (is_drive(order) && !player) {
        http_answer_error(answer, HTTP_ANSWER_FORBIDDEN, "POST /api/join first",
                          "only a player drives; X-Jolon-Player names none");
        return false;
    }
    if (desk->tickets == COMMAND_QUEUE_TICKETS || (mission && !find_mission(desk, 0))) {
        http_answer_error(answer, HTTP_ANSWER_TOO_MANY, "wait until some are done",
                          mission ? "%u fire missions run already"
                                  : "more than %u orders wait already",
                          mission ? COMMAND_QUEUE_MISSIONS : COMMAND_QUEUE_TICKETS);
        return false;
    }
    ticket->next = NULL;
    ticket->player = player ? player->number : 0;
    ticket->source = player ? player->source : 0;
    ticket->sequence = 0;
    ticket->until_ns = now_ns + COMMAND_QUEUE_REPLY_NS;
    if (is_drive(order))
        put_drive(ticket, player);
    struct pending_command **at = &desk->ticket;
    while (*at)
        at = &(*at)->next;
    *at = ticket;
    desk->tickets++;
    (void)eventfd_write(desk->bell, 1);
    return true;
}

/* --- driving -----------------------------------------------------------------------------------*/

static uint32_t lease_frames(const struct world_reader *watch)
{
    const struct params *params = watch->view.world.params;
    double a_second = world_reader_rate_hz(watch);
    if (params->pace == PACE_REAL)
        a_second = params->hz * (watch->scale > 0.0 ? watch->scale : 1.0);
    return (uint32_t)fmin(fmax(ceil(a_second * COMMAND_QUEUE_LEASE_S), 2.0), COMMAND_LEASE_MAX);
}

static void send_drive(struct command_queue *desk, struct player *player,
                       const struct world_reader *watch, uint64_t now_ns)
{
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
                             .lease_frames = lease_frames(watch)};
    player->sent = command_client_send(&desk->caller, &command);
    player->sent_version = player->version;
    player->sent_for = player->wanted;
    player->sent_ns = now_ns;
}

/* Nobody waits for the answer: when it is lost, the lease ends soon. */
static void send_release(struct command_queue *desk, const struct player *player, uint32_t vehicle)
{
    jolon_Command command = {
        .source = player->source, .type = jolon_COMMAND_RELEASE, .entity = vehicle};
    (void)command_client_send(&desk->caller, &command);
}

static void on_drive_reply(struct command_queue *desk, struct player *player,
                           const jolon_CommandReply *reply)
{
    char why[sizeof player->lost];
    player->sent = 0;
    if (reply->result == jolon_RESULT_DONE) {
        if (player->vehicle && player->vehicle != player->sent_for)
            send_release(desk, player, player->vehicle);
        player->vehicle = player->sent_for;
        if (player->sent_version == player->version)
            player->accepted = player->controls;
        player->lost[0] = '\0';
        return;
    }
    if (player->vehicle == player->sent_for) {
        (void)snprintf(why, sizeof why, "%u: %s", player->vehicle,
                       command_result_name((enum command_result)reply->result));
        players_drop(player, why);
    } else if (player->wanted == player->sent_for) {
        player->wanted = player->vehicle;
        player->controls = player->accepted;
    }
}

/* The drives of the player that this reply answers. */
static void answer_drives(struct command_queue *desk, const struct player *player,
                          const jolon_CommandReply *reply, const struct world_reader *watch,
                          const struct players *players)
{
    struct pending_command **at = &desk->ticket;
    while (*at) {
        struct pending_command *ticket = *at;
        if (is_drive(&ticket->order) && ticket->player == player->number &&
            ticket->sequence <= player->sent_version &&
            ticket->order.command.entity == player->sent_for) {
            result_text_put(&ticket->answer, &ticket->order, reply, watch, players);
            finish(desk, at);
        } else {
            at = &ticket->next;
        }
    }
}

static void turn_player(struct command_queue *desk, struct player *player,
                        const struct players *players, const struct world_reader *watch,
                        uint64_t now_ns)
{
    jolon_CommandReply reply;
    if (player->sent && command_client_answered(&desk->caller, player->sent, &reply)) {
        on_drive_reply(desk, player, &reply);
        answer_drives(desk, player, &reply, watch, players);
    } else if (player->sent && now_ns > player->sent_ns + COMMAND_QUEUE_REPLY_NS) {
        command_client_forget(&desk->caller, player->sent);
        player->sent = 0;
    }
    if (player->wanted && now_ns > player->heard_ns + PLAYERS_LEAVE_NS) {
        if (player->sent)
            command_client_forget(&desk->caller, player->sent);
        send_release(desk, player, player->wanted);
        players_drop(player, "given back: nothing was heard of your page");
    }
    bool news = player->version != player->sent_version;
    bool due =
        players_present(player, now_ns) && now_ns >= player->sent_ns + COMMAND_QUEUE_RENEW_NS;
    if (player->wanted && !player->sent && watch->there && (news || due))
        send_drive(desk, player, watch, now_ns);
    if (now_ns > player->heard_ns + PLAYERS_FORGET_NS)
        player->number = 0;
}

/* --- other orders ------------------------------------------------------------------------------*/

static struct player *player_of(struct players *players, uint32_t number)
{
    for (uint32_t i = 0; i < PLAYERS_MAX && number; i++) {
        if (players->player[i].number == number)
            return &players->player[i];
    }
    return NULL;
}

static uint64_t simulated_ns(const struct world_reader *watch)
{
    return (uint64_t)(watch->time_s * NS_PER_S);
}

static void start_mission(struct command_queue *desk, struct pending_command *ticket,
                          const struct world_reader *watch)
{
    struct command_queue_mission *mission = find_mission(desk, 0);
    if (!mission)
        return; /* others were put at the same moment: it waits for a place */
    mission->number = ++desk->missions;
    command_series_begin(&mission->mission, &ticket->order, simulated_ns(watch));
    ticket->sequence = mission->number;
}

static void send_ticket(struct command_queue *desk, struct pending_command *ticket,
                        struct players *players, const struct world_reader *watch)
{
    if (is_mission(&ticket->order)) {
        start_mission(desk, ticket, watch);
        return;
    }
    jolon_Command command = ticket->order.command;
    struct player *player = player_of(players, ticket->player);
    command.source = ticket->source;
    if (player && command.type == jolon_COMMAND_RELEASE && command.entity == player->wanted) {
        if (player->sent)
            command_client_forget(&desk->caller, player->sent);
        players_drop(player, "");
    }
    ticket->sequence = command_client_send(&desk->caller, &command);
}

/* Nobody is told "no reply" and drives all the same later. */
static void give_up(struct command_queue *desk, struct pending_command *ticket,
                    struct players *players)
{
    struct player *player = player_of(players, ticket->player);
    if (is_command(&ticket->order) && ticket->sequence)
        command_client_forget(&desk->caller, ticket->sequence);
    if (is_drive(&ticket->order) && player && player->wanted != player->vehicle) {
        player->wanted = player->vehicle;
        player->controls = player->accepted;
    }
    result_text_none(&ticket->answer, &ticket->order, command_client_heard(&desk->caller));
}

static void turn_tickets(struct command_queue *desk, struct players *players,
                         const struct world_reader *watch, uint64_t now_ns)
{
    jolon_CommandReply reply;
    struct pending_command **at = &desk->ticket;
    while (*at) {
        struct pending_command *ticket = *at;
        if (!ticket->sequence)
            send_ticket(desk, ticket, players, watch);
        if (is_command(&ticket->order) && ticket->sequence &&
            command_client_answered(&desk->caller, ticket->sequence, &reply)) {
            result_text_put(&ticket->answer, &ticket->order, &reply, watch, players);
            finish(desk, at);
        } else if (now_ns >= ticket->until_ns) {
            give_up(desk, ticket, players);
            finish(desk, at);
        } else {
            at = &ticket->next;
        }
    }
}

/* --- fire missions -----------------------------------------------------------------------------*/

/* Who ordered it hears of its first round. */
static void answer_mission(struct command_queue *desk, const struct command_queue_mission *mission,
                           const jolon_CommandReply *reply, const struct world_reader *watch,
                           const struct players *players)
{
    struct pending_command **at = &desk->ticket;
    while (*at && (!is_mission(&(*at)->order) || (*at)->sequence != mission->number))
        at = &(*at)->next;
    if (!*at)
        return;
    struct pending_command *ticket = *at;
    struct json_writer *text = &ticket->answer.text;
    if (reply->result == jolon_RESULT_DONE) {
        json_writer_begin(text, '{');
        json_writer_key_word(text, "result", "done");
        json_writer_key_whole(text, "frame", reply->frame);
        json_writer_key_whole(text, "entity", reply->entity);
        json_writer_key_whole(text, "mission", mission->number);
        json_writer_key_whole(text, "seed", mission->mission.seed);
        json_writer_end(text, '}');
    } else {
        result_text_put(&ticket->answer, &ticket->order, reply, watch, players);
    }
    finish(desk, at);
}

static void turn_mission(struct command_queue *desk, struct command_queue_mission *mission,
                         const struct world_reader *watch, const struct players *players)
{
    jolon_CommandReply reply;
    uint32_t round;
    bool possible = true;
    while (command_series_answer(&mission->mission, &desk->caller, &reply, &round)) {
        answer_mission(desk, mission, &reply, watch, players);
        possible = possible && reply.result != jolon_RESULT_NO_SUCH_KIND;
    }
    /* One that can never fall is not tried again. */
    if (command_series_over(&mission->mission) || !possible)
        end_mission(desk, mission);
    else if (watch->there)
        command_series_send(&mission->mission, &desk->caller, simulated_ns(watch));
}

/* --- turns -------------------------------------------------------------------------------------*/

void command_queue_turn(struct command_queue *desk, struct players *players,
                        const struct world_reader *watch, uint64_t now_ns)
{
    eventfd_t rung;
    (void)eventfd_read(desk->bell, &rung);
    command_client_turn(&desk->caller);
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        if (players->player[i].number)
            turn_player(desk, &players->player[i], players, watch, now_ns);
    }
    turn_tickets(desk, players, watch, now_ns);
    for (uint32_t i = 0; i < COMMAND_QUEUE_MISSIONS; i++) {
        if (desk->mission[i].number)
            turn_mission(desk, &desk->mission[i], watch, players);
    }
}

void command_queue_world_changed(struct command_queue *desk, struct players *players,
                                 const struct world_reader *watch)
{
    name_table_close(&desk->names); /* without memory no vehicle has a name */
    if (watch->there)
        (void)name_table_read_world(&desk->names, &watch->view.world, watch->view.header->made);
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        struct player *player = &players->player[i];
        if (!player->number)
            continue;
        if (player->sent)
            command_client_forget(&desk->caller, player->sent);
        if (player->wanted)
            players_drop(player, "the world is another one");
    }
    for (uint32_t i = 0; i < COMMAND_QUEUE_MISSIONS; i++) {
        if (desk->mission[i].number)
            end_mission(desk, &desk->mission[i]);
    }
}

void command_queue_wait(struct command_queue *desk, uint64_t until_ns)
{
    struct pollfd wakes[] = {{.fd = desk->bell, .events = POLLIN},
                             {.fd = command_client_descriptor(&desk->caller), .events = POLLIN}};
    uint64_t now_ns = clock_now_ns();
    uint64_t left_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec left = {.tv_sec = (time_t)(left_ns / NS_PER_S),
                            .tv_nsec = (long)(left_ns % NS_PER_S)};
    (void)ppoll(wakes, 2, &left, NULL);
}
