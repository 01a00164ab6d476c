/* Leases of the vehicles that the program drives, renewed for as long as the program lives.
 *
 * A drive without a lease gets one of LEASES_S. The vehicle's last drive is sent again every
 * LEASES_RENEW_NS until the program releases the vehicle or another client takes it. */
#ifndef JOLON_CLIENTS_HARNESS_LEASES_H
#define JOLON_CLIENTS_HARNESS_LEASES_H

#include "clients/harness/output.h"
#include "ipc/topics/command_client.h"
#include "ipc/topics/world_mirror.h"
#include "ipc/topics/command_text.h"

#define LEASES_MAX      4096u
#define LEASES_S        1.5
#define LEASES_RENEW_NS 200000000u

struct leases {
    const struct world_mirror *mirror;
    struct output *output;
    uint32_t count;
    struct lease {
        jolon_Command command; /* the last drive that was done */
        uint64_t renew_ns;     /* CLOCK_MONOTONIC */
        uint64_t tick;         /* of the world at the last renewal */
        uint64_t sequence;     /* of the renewal that waits for its reply, 0: none */
        bool command_pending;  /* a renewal must not overtake a command of the program */
    } held[LEASES_MAX];        /* [count] */
};

/* Called before a command is sent: gives a drive its lease, if it has none, and stops repeating a
 * renewal for the same vehicle. */
void leases_begin(struct leases *leases, struct command_client *client, struct command_text *order);

/* Called while a command has no reply yet: suppresses the renewal in the next leases_turn(). */
void leases_hold_off(struct leases *leases, const struct command_text *order);

/* Begins, changes or ends the vehicle's lease after the reply to a command. */
void leases_answer(struct leases *leases, const struct command_text *order,
                   const jolon_CommandReply *reply, uint64_t now_ns);

/* Renews the leases that are due and reports those that were lost. Does not block. */
void leases_turn(struct leases *leases, struct command_client *client, uint64_t now_ns);

/* Returns when leases_turn() is due [CLOCK_MONOTONIC ns]; UINT64_MAX: never. */
uint64_t leases_due_ns(const struct leases *leases);

/* Forgets all leases, when another world has taken this one's place. */
void leases_clear(struct leases *leases);

#endif
