/* Events: what happened in a frame, in the order it happened. Key (frame, index). Collisions and
 * what follows from them come from the collider; shots, agents' changes and answers to commands
 * are intents of the mover that the collider puts first. The collider alone writes the ring. */
#ifndef JOLON_WORLD_ENTITY_EVENT_H
#define JOLON_WORLD_ENTITY_EVENT_H

#include <stdint.h>

/* The registry of event types: X(TAG, word), a row each. The word is that of logs and filters, and
 * names the type's struct event_WORD, its member of struct event, and the functions that write it:
 * WORD_text() in world/event_text.c and add_WORD() in ipc/json/world_json.c. A type with a status
 * topic also has fill_WORD() in reporter/event_topics.c and, for clients, good_WORD() in
 * ipc/topics/samples.c and read_WORD() in event_reading.c. The topics are
 * in the order of their rows.
 * An answer to a command has no topic here: the reporter publishes it as a CommandReply. Missions
 * have none, as status has their state. Inputs have none, as they are for the recorder. */
#define EVENT_TYPES_WITH_TOPIC(X)                                                                  \
    X(COLLISION, collision)                                                                        \
    X(FIRE, fire)                                                                                  \
    X(DETONATION, detonation)                                                                      \
    X(CRATER, crater)                                                                              \
    X(AGENT, agent)                                                                                \
    X(CONTACT_END, contact_end)
#define EVENT_TYPES(X)                                                                             \
    EVENT_TYPES_WITH_TOPIC(X) X(COMMAND, command) X(MISSION, mission) X(INPUT, input)

enum event_type {
    EVENT_NONE,
#define X(tag, word) EVENT_##tag,
    EVENT_TYPES(X)
#undef X
        EVENT_TYPE_COUNT
};

enum {
#define X(tag, word) +1
    EVENT_TOPIC_COUNT = 0 EVENT_TYPES_WITH_TOPIC(X) /* types with a status topic, from 1 on */
#undef X
};

enum response {
    RESPONSE_NONE,
    RESPONSE_BOUNCE,
    RESPONSE_STOP,
    RESPONSE_SLOW,
    RESPONSE_DESTROYED,
    RESPONSE_COUNT
};

enum struck { STRUCK_VEHICLE, STRUCK_FIXED, STRUCK_GROUND, STRUCK_WATER, STRUCK_AIR, STRUCK_COUNT };

/* Why an agent changed its behaviour. */
enum agent_reason {
    REASON_FIRED_UPON,
    REASON_TARGET_GONE,
    REASON_OUT_OF_ROUNDS,
    REASON_TIME_OVER,
    REASON_COLLISION,
    REASON_ENEMY_SEEN,
    REASON_COMMAND,
    REASON_OUT_OF_FUEL,
    REASON_LOST_SIGHT,
    REASON_HURT,
    REASON_OUTNUMBERED,
    REASON_LOW_FUEL,
    REASON_SUPPLIED,
    REASON_ARRIVED,
    REASON_LEADER_LOST,
    REASON_SCRIPT,       /* a step of its script says so */
    REASON_LEASE_OVER,   /* its driver sent no more commands */
    REASON_SUPPRESSED,   /* a charge has burst near it */
    REASON_LOSSES,       /* half of its group is lost */
    REASON_STUCK,        /* it drove and did not get on */
    REASON_ROUNDS_FIRED, /* it has fired a salvo, and moves or leaves */
    REASON_LEFT_WORLD,   /* it has crossed the edge of the world, and is gone */
    REASON_COUNT
};

/* Why a contact ended. */
enum contact_end_reason {
    CONTACT_END_PARTED,
    CONTACT_END_GONE,    /* one of the two bodies is gone, or a fixed object has fallen */
    CONTACT_END_NO_ROOM, /* the table of contacts is full: it is not followed any further */
    CONTACT_END_REASON_COUNT
};

/* What a mission's event tells. */
enum mission_news {
    MISSION_NEWS_PHASE,     /* a phase has begun */
    MISSION_NEWS_REACTION,  /* a reaction interrupts the phase */
    MISSION_NEWS_OBJECTIVE, /* an objective has another owner */
    MISSION_NEWS_RESULT,    /* the battle has ended */
    MISSION_NEWS_AGAIN,     /* it begins again */
    MISSION_NEWS_COUNT
};

/* One side of an event: an entity (id) or a fixed object (its index + 1). */
struct event_party {
    uint32_t id;
    uint16_t kind;
    uint8_t fixed;  /* 1: a fixed object */
    uint8_t damage; /* enum damage, after the event */
};

struct event_collision {
    struct event_party a, b;
    double point[3];      /* [m, world] where the bodies touch */
    double toi;           /* 0..1 of the frame */
    float normal[3];      /* unit, from a towards b */
    float closing_mps;    /* along the normal, before */
    float angle_deg;      /* 0..360: b's heading off a's */
    float impulse_ns;     /* on each body, friction included */
    float direction_a[3]; /* unit direction of travel, 0 when at rest (thesis row 34) */
    uint32_t response;    /* enum response */
    uint32_t begins;      /* 1: a contact begins with it, which a contact_end will end */
    uint32_t remote;      /* 1: another simulator told of it (remote.h) */
};

struct event_fire {
    struct event_party shooter, target, munition; /* target id 0: the ground or the sky */
    double point[3];                              /* [m, world] muzzle */
};

struct event_detonation {
    struct event_party munition, struck_party;
    double point[3];
    float explosive_kg;
    uint32_t struck;   /* enum struck */
    uint32_t remote;   /* 1: another simulator said that it detonates here (remote.h) */
    uint32_t reserved; /* 0 */
};

struct event_crater {
    double point[3];
    float radius_m, depth_m;
};

struct event_agent {
    struct event_party agent;
    uint32_t from, to; /* enum behaviour */
    uint32_t because;  /* enum agent_reason */
};

/* A contact has ended (world/entity/persistent_contact.h). */
struct event_contact_end {
    struct event_party a, b; /* b may be a fixed object */
    double lasted_s;         /* simulated time from its first load to its last */
    uint32_t impacts;        /* in this time, the first one included */
    float impulse_ns;        /* of all these impacts together */
    uint32_t because;        /* enum contact_end_reason */
    uint32_t reserved;       /* 0 */
};

/* The whole command as it was taken, so that a run's commands can be sent again from its events. */
struct event_command {
    uint64_t source, sequence; /* the sender's own key */
    double value[6];           /* this and the following: as sent, see struct command */
    uint32_t type;             /* enum command_type */
    uint32_t given;            /* entity */
    uint32_t target, amount;
    uint16_t kind, force;
    uint8_t result; /* enum command_result */
    uint8_t ring;   /* enum command_ring from which it came */
    uint8_t reserved[2];
    uint32_t entity; /* the entity it made or changed, 0 for none */
    uint32_t number; /* commands of the run before it, modulo 2^32 */
};

/* A frame has taken records of the gateway's ring (remote.h). The records themselves are in the
 * ring, which the recorder reads: with 10,000 of them a second, an event for each would drown the
 * others. */
struct event_input {
    uint64_t first;  /* number of the first record in its ring */
    uint64_t hash;   /* remote_record_hash() of all of them, one after the other */
    uint64_t remote; /* remote_id() of the first that was refused, 0: none */
    uint32_t count;
    uint32_t refused; /* of them */
    uint32_t because; /* enum remote_refusal of the first that was refused */
    uint8_t ring;     /* enum command_ring */
    uint8_t reserved[3];
};

#define EVENT_NAME_MAX 24

struct event_mission {
    char name[EVENT_NAME_MAX];  /* of the mission or objective; "" for a whole battle */
    char phase[EVENT_NAME_MAX]; /* that begins */
    uint32_t news;              /* enum mission_news */
    uint32_t round;             /* the battle: 1, 2, ... */
    uint32_t force;             /* enum force: the mission's, the new owner, the winner */
    uint32_t from;              /* enum force: the owner before */
    uint32_t held[3];           /* result: objectives of each enum force */
    uint32_t lost[3];           /* result: vehicles of each enum force */
};

struct event {
    uint64_t sequence; /* number among all of the run's events, from 0 */
    uint64_t frame;
    uint64_t tick;  /* steps of simulated time at that frame */
    uint32_t index; /* within the frame, from 0 */
    uint32_t type;  /* enum event_type */
    union {
#define X(tag, word) struct event_##word word;
        EVENT_TYPES(X)
#undef X
        uint8_t bytes[96];
    };
};

_Static_assert(sizeof(struct event_collision) == 96, "shared layout");
_Static_assert(sizeof(struct event_contact_end) == 40, "shared layout");
_Static_assert(sizeof(struct event_command) == 96, "shared layout");
_Static_assert(sizeof(struct event_mission) == 88, "shared layout");
_Static_assert(sizeof(struct event_input) == 40, "shared layout");
_Static_assert(sizeof(struct event_detonation) == 56, "shared layout");
_Static_assert(sizeof(struct event) == 128, "two cache lines a slot");

#endif
