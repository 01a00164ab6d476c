/* Leases: the vehicles that the program drives, kept for it for as long as it lives.
 *
 * A drive without a lease of its own gets one of LEASES_S, and what was last done is sent again
 * five times in that time, until the program releases the vehicle or somebody takes it. */
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
        jolon_Command command; /* what was last done */
        uint64_t renew_ns;     /* CLOCK_MONOTONIC */
        uint64_t tick;         /* of the world, when it was last renewed */
        uint64_t sequence;     /* of the renewal under way, 0: none */
        bool command_pending;  /* an order for it is under way, which a renewal must not overtake */
    } held[LEASES_MAX];        /* [count] */
};

/* An order is about to be sent: a drive gets its lease, if it has none, and a renewal of the same
 * vehicle is not repeated any more. */
void leases_begin(struct leases *leases, struct command_client *client, struct command_text *order);

/* The order is still under way: no renewal in the next leases_turn(). */
void leases_hold_off(struct leases *leases, const struct command_text *order);

/* Notes what an answered order means for the vehicle. */
void leases_answer(struct leases *leases, const struct command_text *order,
                   const jolon_CommandReply *reply, uint64_t now_ns);

/* Renews what is due, and tells of those that were lost. Does not block. */
void leases_turn(struct leases *leases, struct command_client *client, uint64_t now_ns);

/* When leases_turn() has something to do [CLOCK_MONOTONIC ns]; UINT64_MAX: never. */
uint64_t leases_due_ns(const struct leases *leases);

/* Another world: nothing is held in it. */
void leases_clear(struct leases *leases);

#endif
