/* The players, each with a name, a key that identifies its requests, and the vehicle that it
 * drives. Pure: the caller provides the time and the random numbers. Called under the console's
 * lock. */
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

/* Time since a player's last request after which its lease is not renewed; its vehicle is released;
 * the player is forgotten. */
#define PLAYERS_HOLD_NS   800000000u
#define PLAYERS_LEAVE_NS  1500000000u
#define PLAYERS_FORGET_NS 120000000000u

/* A driver's controls, as in COMMAND_DRIVE. */
struct controls {
    float throttle, steer, climb, traverse, elevate, brake;
    uint32_t gear; /* enum gearing */
};

struct player {
    uint32_t number; /* 1, 2, ... in the order of joining; 0: a free entry */
    char name[PLAYERS_NAME_MAX];
    char key[PLAYERS_KEY_MAX];
    uint64_t source; /* of its commands */
    uint64_t last_request_ns;
    uint32_t vehicle;                   /* that it drives, 0: none */
    uint32_t wanted;                    /* the vehicle that it wants to drive, 0: none */
    struct controls controls, accepted; /* wanted; last accepted by the world for `vehicle` */
    uint64_t version;                   /* of the controls; each change increments it */
    uint64_t sent, sent_version;        /* the DRIVE that waits for its reply; 0: none */
    uint32_t sent_for;                  /* vehicle of that DRIVE */
    uint64_t sent_ns;                   /* of the last DRIVE */
    struct rate rate;                   /* of its changing requests */
    char lost[96];                      /* why it lost its vehicle, or "" */
};

struct players {
    struct player player[PLAYERS_MAX];
    uint32_t joined; /* number of players so far */
};

/* Returns true if the name has 1 to 32 visible characters of UTF-8, and not only spaces. */
bool players_name_is_valid(const char *name);

/* Returns a new player, or NULL if there are PLAYERS_MAX. key: random bytes. */
struct player *players_join(struct players *players, const char *name,
                            const uint8_t key[PLAYERS_KEY_BYTES], uint64_t source, uint64_t now_ns);

/* Returns the player with this key, or NULL. Takes the same time for any key. */
struct player *players_find(struct players *players, const char *key);

/* Returns the player who drives the vehicle, or NULL. */
const struct player *players_driver_of(const struct players *players, uint32_t vehicle);

/* Returns true if the player's last request is less than PLAYERS_HOLD_NS old. */
bool players_is_active(const struct player *player, uint64_t now_ns);

/* Takes the vehicle from the player. error: the reason, "" if the player released it. */
void players_release_vehicle(struct player *player, const char *error);

#endif
