/* The session: one person at the wheel of one vehicle at a time.
 *
 * It chooses, takes, drives, aims, fires, changes and releases by commands alone, which go over the
 * world's command socket or, to another machine, over DDS. It knows only what the world says over
 * DDS. A vehicle is held by a lease, which is renewed all the time; when a session dies, its
 * vehicle goes back to its agent at the lease's end. A world that is silent, or whose reporter,
 * intake or mover is away, is waited for. */
#ifndef JOLON_CLIENTS_DRIVE_SESSION_H
#define JOLON_CLIENTS_DRIVE_SESSION_H

#include "clients/drive/control_shaping.h"
#include "ipc/topics/command_client.h"
#include "ipc/topics/world_mirror.h"

/* For so long a vehicle is ours without a word of ours, of the clock; and how often there is one.
 */
#define SESSION_LEASE_S  1.5
#define SESSION_RENEW_NS 150000000u

#define SESSION_NOTICE_MAX 200u
#define SESSION_ZOOMS      7u

enum session_state {
    SESSION_WAITING,  /* for a world, and for what it has */
    SESSION_WATCHING, /* sees a vehicle, drives none */
    SESSION_TAKING,   /* has asked for it */
    SESSION_DRIVING
};

struct session {
    struct world_mirror *mirror;
    struct command_client *client;
    const char *wanted; /* id, name, kind or force to begin with; NULL: any */
    bool ended;         /* by a key, or because wanted is not there: refused */
    bool refused;

    enum session_state state;
    uint64_t run;
    uint32_t vehicle; /* id, 0: none */
    bool seen;        /* the world told of it since it was chosen */
    bool loss_told;   /* it was said that it is destroyed or gone */
    struct control_shaping shaping;
    struct controls sent;
    uint64_t sent_ns;
    uint64_t drive, fire, release;      /* sequences that wait for their replies, 0: none */
    uint64_t lay_until_ns, lay_next_ns; /* while the gun is laid on the target, 0: it is not */

    uint32_t target;      /* id, 0: none locked */
    uint32_t last_target; /* the last that was locked */
    double look_rad;      /* off the heading */
    uint32_t zoom;        /* 0: nearest */
    bool help;

    char notice[SESSION_NOTICE_MAX];
    uint64_t notice_ns;
    uint32_t notices; /* ever given */
};

void session_open(struct session *session, struct world_mirror *mirror,
                  struct command_client *client, const char *wanted, uint64_t now_ns);

/* Takes an intent of the hands. */
void session_apply(struct session *session, const struct intent *intent, uint64_t now_ns);

/* Hears replies and what the world said, sends what is to be sent: at once when the controls have
 * changed, at most once a frame, and to renew. Does not block. Returns when to come again. */
uint64_t session_turn(struct session *session, uint64_t now_ns);

/* Gives the vehicle back and waits for the reply, at most until until_ns. */
void session_leave(struct session *session, uint64_t until_ns);

/* The vehicle as the world last told, NULL when it did not. */
const jolon_Entity *session_entity(const struct session *session);

/* "T1 (tank 12)", "tank 12", "nothing". */
const char *session_label(const struct world_mirror *mirror, uint32_t id, char text[64]);

/* The frame's length [ns], as the world's rate and scale make it. */
uint64_t session_frame_ns(const struct world_mirror *mirror);

void session_notify(struct session *session, uint64_t now_ns, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
