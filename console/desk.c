/* Orders out, replies in. */
#include "console/desk.h"

#include "console/reply.h"
#include "ipc/clock.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

int desk_open(struct desk *desk, const char *world, struct reason *reason)
{
    *desk = (struct desk){.bell = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
    if (desk->bell < 0)
        return reason_set(reason, "eventfd: %s", strerror(errno));
    return caller_open(&desk->caller, command_socket_open(&desk->socket, world), reason);
}

/* --- tickets -----------------------------------------------------------------------------------*/

static void finish(struct desk *desk, struct ticket **at)
{
    struct ticket *ticket = *at;
    *at = ticket->next;
    desk->tickets--;
    ticket->done = true;
    ticket->ready(ticket);
}

void desk_close(struct desk *desk)
{
    while (desk->ticket) {
        reply_none(&desk->ticket->answer, &desk->ticket->order, true);
        finish(desk, &desk->ticket);
    }
    names_close(&desk->names);
    command_socket_close(&desk->socket);
    close(desk->bell);
}

static bool is_drive(const struct order *order)
{
    return order->command.type == jolon_COMMAND_DRIVE;
}

static bool is_mission(const struct order *order)
{
    return order->given & 1u << ORDER_MUNITION;
}

/* One command with one reply, as it is. */
static bool is_command(const struct order *order)
{
    return !is_drive(order) && !is_mission(order);
}

static struct desk_mission *find_mission(struct desk *desk, uint32_t number)
{
    for (uint32_t i = 0; i < DESK_MISSIONS; i++) {
        if (desk->mission[i].number == number)
            return &desk->mission[i];
    }
    return NULL;
}

/* Which vehicle an order is for, when it does not say: the player's own. */
static bool name_vehicle(struct order *order, const struct player *player, struct answer *answer)
{
    jolon_Command *command = &order->command;
    if (!(order->given & 1u << ORDER_VEHICLE) || command->entity)
        return true;
    command->entity = player ? player->vehicle : 0;
    if (command->entity)
        return true;
    answer_error(answer, ANSWER_CONFLICT, "take one: drive with a \"vehicle\"",
                 "%s: you drive nothing", order->verb->name);
    return false;
}

static bool find_names(const struct desk *desk, struct order *order, struct answer *answer)
{
    struct reason reason;
    if (order_resolve(order, &desk->names, 0.0, &reason) == 0)
        return true;
    answer_error(answer, ANSWER_CONFLICT, "choose one on the map or in the list", "%s: %s",
                 order->verb->name, reason.text);
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
static void put_drive(struct ticket *ticket, struct player *player)
{
    player->wanted = ticket->order.command.entity;
    player->controls = controls_of(&ticket->order.command);
    ticket->sequence = ++player->version;
}

static void end_mission(struct desk *desk, struct desk_mission *mission)
{
    mission_forget(&mission->mission, &desk->caller);
    mission->number = 0;
}

static bool put_cancel(struct desk *desk, struct ticket *ticket, struct answer *answer)
{
    struct desk_mission *mission = find_mission(desk, ticket->cancel);
    if (!mission) {
        answer_error(answer, ANSWER_CONFLICT, "the state lists the missions there are",
                     "there is no mission %u any more, or never was", ticket->cancel);
        return false;
    }
    text_begin(&answer->text, '{');
    text_key_word(&answer->text, "result", "done");
    text_key_whole(&answer->text, "mission", mission->number);
    text_key_whole(&answer->text, "fired", mission->mission.done);
    text_end(&answer->text, '}');
    end_mission(desk, mission);
    return false;
}

bool desk_put(struct desk *desk, struct ticket *ticket, struct player *player, uint64_t now_ns,
              struct answer *answer)
{
    struct order *order = &ticket->order;
    if (ticket->cancel)
        return put_cancel(desk, ticket, answer);
    bool mission = is_mission(order);
    if (!find_names(desk, order, answer) || !name_vehicle(order, player, answer))
        return false;
    if (is_drive(order) && !player) {
        answer_error(answer, ANSWER_FORBIDDEN, "POST /api/join first",
                     "only a player drives; X-Jolon-Player names none");
        return false;
    }
    if (desk->tickets == DESK_TICKETS || (mission && !find_mission(desk, 0))) {
        answer_error(answer, ANSWER_TOO_MANY, "wait until some are done",
                     mission ? "%u fire missions run already" : "more than %u orders wait already",
                     mission ? DESK_MISSIONS : DESK_TICKETS);
        return false;
    }
    ticket->next = NULL;
    ticket->player = player ? player->number : 0;
    ticket->source = player ? player->source : 0;
    ticket->sequence = 0;
    ticket->until_ns = now_ns + DESK_REPLY_NS;
    if (is_drive(order))
        put_drive(ticket, player);
    struct ticket **at = &desk->ticket;
    while (*at)
        at = &(*at)->next;
    *at = ticket;
    desk->tickets++;
    (void)eventfd_write(desk->bell, 1);
    return true;
}

/* --- driving -----------------------------------------------------------------------------------*/

static uint32_t lease_frames(const struct watch *watch)
{
    const struct params *params = watch->view.world.params;
    double a_second = watch_rate_hz(watch);
    if (params->pace == PACE_REAL)
        a_second = params->hz * (watch->scale > 0.0 ? watch->scale : 1.0);
    return (uint32_t)fmin(fmax(ceil(a_second * DESK_LEASE_S), 2.0), COMMAND_LEASE_MAX);
}

static void send_drive(struct desk *desk, struct player *player, const struct watch *watch,
                       uint64_t now_ns)
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
    player->sent = caller_send(&desk->caller, &command);
    player->sent_version = player->version;
    player->sent_for = player->wanted;
    player->sent_ns = now_ns;
}

/* Nobody waits for the answer: when it is lost, the lease ends soon. */
static void send_release(struct desk *desk, const struct player *player, uint32_t vehicle)
{
    jolon_Command command = {
        .source = player->source, .type = jolon_COMMAND_RELEASE, .entity = vehicle};
    (void)caller_send(&desk->caller, &command);
}

static void on_drive_reply(struct desk *desk, struct player *player,
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
static void answer_drives(struct desk *desk, const struct player *player,
                          const jolon_CommandReply *reply, const struct watch *watch,
                          const struct players *players)
{
    struct ticket **at = &desk->ticket;
    while (*at) {
        struct ticket *ticket = *at;
        if (is_drive(&ticket->order) && ticket->player == player->number &&
            ticket->sequence <= player->sent_version &&
            ticket->order.command.entity == player->sent_for) {
            reply_put(&ticket->answer, &ticket->order, reply, watch, players);
            finish(desk, at);
        } else {
            at = &ticket->next;
        }
    }
}

static void turn_player(struct desk *desk, struct player *player, const struct players *players,
                        const struct watch *watch, uint64_t now_ns)
{
    jolon_CommandReply reply;
    if (player->sent && caller_answered(&desk->caller, player->sent, &reply)) {
        on_drive_reply(desk, player, &reply);
        answer_drives(desk, player, &reply, watch, players);
    } else if (player->sent && now_ns > player->sent_ns + DESK_REPLY_NS) {
        caller_forget(&desk->caller, player->sent);
        player->sent = 0;
    }
    if (player->wanted && now_ns > player->heard_ns + PLAYERS_LEAVE_NS) {
        if (player->sent)
            caller_forget(&desk->caller, player->sent);
        send_release(desk, player, player->wanted);
        players_drop(player, "given back: nothing was heard of your page");
    }
    bool news = player->version != player->sent_version;
    bool due = players_present(player, now_ns) && now_ns >= player->sent_ns + DESK_RENEW_NS;
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

static uint64_t simulated_ns(const struct watch *watch)
{
    return (uint64_t)(watch->time_s * NS_PER_S);
}

static void start_mission(struct desk *desk, struct ticket *ticket, const struct watch *watch)
{
    struct desk_mission *mission = find_mission(desk, 0);
    if (!mission)
        return; /* others were put at the same moment: it waits for a place */
    mission->number = ++desk->missions;
    mission_begin(&mission->mission, &ticket->order, simulated_ns(watch));
    ticket->sequence = mission->number;
}

static void send_ticket(struct desk *desk, struct ticket *ticket, struct players *players,
                        const struct watch *watch)
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
            caller_forget(&desk->caller, player->sent);
        players_drop(player, "");
    }
    ticket->sequence = caller_send(&desk->caller, &command);
}

/* Nobody is told "no reply" and drives all the same later. */
static void give_up(struct desk *desk, struct ticket *ticket, struct players *players)
{
    struct player *player = player_of(players, ticket->player);
    if (is_command(&ticket->order) && ticket->sequence)
        caller_forget(&desk->caller, ticket->sequence);
    if (is_drive(&ticket->order) && player && player->wanted != player->vehicle) {
        player->wanted = player->vehicle;
        player->controls = player->accepted;
    }
    reply_none(&ticket->answer, &ticket->order, caller_heard(&desk->caller));
}

static void turn_tickets(struct desk *desk, struct players *players, const struct watch *watch,
                         uint64_t now_ns)
{
    jolon_CommandReply reply;
    struct ticket **at = &desk->ticket;
    while (*at) {
        struct ticket *ticket = *at;
        if (!ticket->sequence)
            send_ticket(desk, ticket, players, watch);
        if (is_command(&ticket->order) && ticket->sequence &&
            caller_answered(&desk->caller, ticket->sequence, &reply)) {
            reply_put(&ticket->answer, &ticket->order, &reply, watch, players);
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
static void answer_mission(struct desk *desk, const struct desk_mission *mission,
                           const jolon_CommandReply *reply, const struct watch *watch,
                           const struct players *players)
{
    struct ticket **at = &desk->ticket;
    while (*at && (!is_mission(&(*at)->order) || (*at)->sequence != mission->number))
        at = &(*at)->next;
    if (!*at)
        return;
    struct ticket *ticket = *at;
    struct text *text = &ticket->answer.text;
    if (reply->result == jolon_RESULT_DONE) {
        text_begin(text, '{');
        text_key_word(text, "result", "done");
        text_key_whole(text, "frame", reply->frame);
        text_key_whole(text, "entity", reply->entity);
        text_key_whole(text, "mission", mission->number);
        text_key_whole(text, "seed", mission->mission.seed);
        text_end(text, '}');
    } else {
        reply_put(&ticket->answer, &ticket->order, reply, watch, players);
    }
    finish(desk, at);
}

static void turn_mission(struct desk *desk, struct desk_mission *mission, const struct watch *watch,
                         const struct players *players)
{
    jolon_CommandReply reply;
    uint32_t round;
    bool possible = true;
    while (mission_answer(&mission->mission, &desk->caller, &reply, &round)) {
        answer_mission(desk, mission, &reply, watch, players);
        possible = possible && reply.result != jolon_RESULT_NO_SUCH_KIND;
    }
    /* One that can never fall is not tried again. */
    if (mission_over(&mission->mission) || !possible)
        end_mission(desk, mission);
    else if (watch->there)
        mission_send(&mission->mission, &desk->caller, simulated_ns(watch));
}

/* --- turns -------------------------------------------------------------------------------------*/

void desk_turn(struct desk *desk, struct players *players, const struct watch *watch,
               uint64_t now_ns)
{
    eventfd_t rung;
    (void)eventfd_read(desk->bell, &rung);
    caller_turn(&desk->caller);
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        if (players->player[i].number)
            turn_player(desk, &players->player[i], players, watch, now_ns);
    }
    turn_tickets(desk, players, watch, now_ns);
    for (uint32_t i = 0; i < DESK_MISSIONS; i++) {
        if (desk->mission[i].number)
            turn_mission(desk, &desk->mission[i], watch, players);
    }
}

void desk_world_changed(struct desk *desk, struct players *players, const struct watch *watch)
{
    names_close(&desk->names); /* without memory no vehicle has a name */
    if (watch->there)
        (void)names_read_world(&desk->names, &watch->view.world, watch->view.header->made);
    for (uint32_t i = 0; i < PLAYERS_MAX; i++) {
        struct player *player = &players->player[i];
        if (!player->number)
            continue;
        if (player->sent)
            caller_forget(&desk->caller, player->sent);
        if (player->wanted)
            players_drop(player, "the world is another one");
    }
    for (uint32_t i = 0; i < DESK_MISSIONS; i++) {
        if (desk->mission[i].number)
            end_mission(desk, &desk->mission[i]);
    }
}

void desk_wait(struct desk *desk, uint64_t until_ns)
{
    struct pollfd wakes[] = {{.fd = desk->bell, .events = POLLIN},
                             {.fd = caller_descriptor(&desk->caller), .events = POLLIN}};
    uint64_t now_ns = clock_now_ns();
    uint64_t left_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec left = {.tv_sec = (time_t)(left_ns / NS_PER_S),
                            .tv_nsec = (long)(left_ns % NS_PER_S)};
    (void)ppoll(wakes, 2, &left, NULL);
}
