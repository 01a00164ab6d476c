/* The players: who joined, by which key they are known again, and what each of them drives. Pure:
 * the caller brings the time and the random numbers. Under the console's lock. */
#ifndef JOLON_CLIENTS_CONSOLE_PLAYERS_H
#define JOLON_CLIENTS_CONSOLE_PLAYERS_H

#include "ipc/process/rate.h"

#include <stdbool.h>
#include <stdint.h>

#define PLAYERS_MAX             32u
#define PLAYERS_NAME_CHARACTERS 32u
#define PLAYERS_NAME_MAX        (4 * PLAYERS_NAME_CHARACTERS + 1) /* [byte] with the NUL */
#define PLAYERS_KEY_BYTES       16u
#define PLAYERS_KEY_MAX         (2 * PLAYERS_KEY_BYTES + 1)

/* Nothing heard for so long: the hold on its vehicle is not renewed; the vehicle goes back to its
 * agent; the player is forgotten. */
#define PLAYERS_HOLD_NS   800000000u
#define PLAYERS_LEAVE_NS  1500000000u
#define PLAYERS_FORGET_NS 120000000000u

/* What a driver wants: as COMMAND_DRIVE has it. */
struct controls {
    float throttle, steer, climb, traverse, elevate, brake;
    uint32_t gear; /* enum gearing */
};

struct player {
    uint32_t number; /* 1, 2, ... in the order of joining; 0: the place is free */
    char name[PLAYERS_NAME_MAX];
    char key[PLAYERS_KEY_MAX];
    uint64_t source; /* of its commands */
    uint64_t last_request_ns;
    uint32_t vehicle;                   /* it drives, 0: none */
    uint32_t wanted;                    /* it is to drive: the same, or the one to change to */
    struct controls controls, accepted; /* wanted; as the world last took them for `vehicle` */
    uint64_t version;                   /* of the controls: goes up with each order */
    uint64_t sent, sent_version;        /* DRIVE that waits for its reply, 0: none does */
    uint32_t sent_for;                  /* its vehicle */
    uint64_t sent_ns;                   /* of the last DRIVE */
    struct rate rate;                   /* of its orders */
    char lost[96];                      /* why it has no vehicle any more, "" */
};

struct players {
    struct player player[PLAYERS_MAX];
    uint32_t joined; /* ever */
};

/* Is this a name to show: 1 to 32 characters of UTF-8, all of them visible, and not only spaces? */
bool players_name_is_valid(const char *name);

/* A new player; NULL when there are PLAYERS_MAX. key: random bytes. */
struct player *players_join(struct players *players, const char *name,
                            const uint8_t key[PLAYERS_KEY_BYTES], uint64_t source, uint64_t now_ns);

/* The player with this key, NULL when there is none. Takes as long for any key. */
struct player *players_find(struct players *players, const char *key);

/* Who of them drives the vehicle, NULL: none. */
const struct player *players_driver_of(const struct players *players, uint32_t vehicle);

/* Is the player still there? */
bool players_is_active(const struct player *player, uint64_t now_ns);

/* It drives nothing any more; why: in words, "" when it wanted so. */
void players_release_vehicle(struct player *player, const char *error);

#endif
