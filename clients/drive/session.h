/* The session: a person drives one vehicle at a time.
 *
 * The session acts by commands alone, which go over the world's command socket or, to another
 * machine, over DDS. It reads the world's state from DDS. It holds a vehicle by a lease, which it
 * renews all the time. When the session dies, the vehicle returns to its agent at the end of the
 * lease. While the world is silent, or its reporter, intake or mover is absent, the session waits.
 */
#ifndef JOLON_CLIENTS_DRIVE_SESSION_H
#define JOLON_CLIENTS_DRIVE_SESSION_H

#include "clients/drive/control_shaping.h"
#include "ipc/topics/command_client.h"
#include "ipc/topics/world_mirror.h"

#define SESSION_LEASE_S  1.5        /* length of a lease, of the clock */
#define SESSION_RENEW_NS 150000000u /* period of its renewal */

#define SESSION_NOTICE_MAX 200u
#define SESSION_ZOOMS      7u

enum session_state {
    SESSION_WAITING,  /* for the world and its data */
    SESSION_WATCHING, /* shows a vehicle, drives none */
    SESSION_TAKING,   /* has requested the vehicle */
    SESSION_DRIVING
};

struct session {
    struct world_mirror *mirror;
    struct command_client *client;
    const char *wanted; /* id, name, kind or force of the first vehicle; NULL: any */
    bool ended;
    bool refused;       /* ended because there is no vehicle like `wanted` */
    uint64_t missed_ns; /* when `wanted` was first looked for in vain, 0: it was not */

    enum session_state state;
    uint64_t run;
    uint32_t vehicle; /* id, 0: none */
    bool seen;        /* the vehicle was in the world's data since it was chosen */
    bool loss_told;   /* its destruction or removal was reported */
    struct control_shaping shaping;
    struct controls sent;
    uint64_t sent_ns;
    uint64_t drive, fire, release; /* sequences of commands without a reply yet, 0: none */
    uint64_t lay_until_ns,
        lay_next_ns; /* limit and next shot while the gun is being laid, 0: not */

    uint32_t target;      /* id, 0: none locked */
    uint32_t last_target; /* the last one that was locked */
    double look_rad;      /* direction of view, relative to the heading */
    uint32_t zoom;        /* 0: nearest */
    bool help;

    char notice[SESSION_NOTICE_MAX];
    uint64_t notice_ns;
    uint32_t notices; /* given so far */
};

void session_open(struct session *session, struct world_mirror *mirror,
                  struct command_client *client, const char *wanted, uint64_t now_ns);

/* Applies an intent of the driver. */
void session_apply(struct session *session, const struct intent *intent, uint64_t now_ns);

/* Reads the replies and the world's data and sends the commands that are due: the controls when
 * they have changed, at most once a frame, and the renewal of the lease. Does not block. Returns
 * the time of the next call. */
uint64_t session_turn(struct session *session, uint64_t now_ns);

/* Releases the vehicle and waits for the reply, at most until until_ns. */
void session_leave(struct session *session, uint64_t until_ns);

/* Returns the vehicle as in the world's last data, or NULL. */
const jolon_Entity *session_entity(const struct session *session);

/* Writes the name of an entity: "T1 (tank 12)", "tank 12", "nothing". */
const char *session_label(const struct world_mirror *mirror, uint32_t id, char text[64]);

/* Sets the notice that is shown to the driver. */
void session_notify(struct session *session, uint64_t now_ns, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
