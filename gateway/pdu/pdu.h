/* Protocol data units (PDUs) of Distributed Interactive Simulation, IEEE 1278.1: the types that
 * Jolon knows, as structures in the byte order of the machine.
 *
 * World coordinates are earth-centred, earth-fixed (ECEF) on WGS 84 [m]. Body axes are x forward, y
 * right, z down. gateway/earth converts both. Numbers of enumerations are those of SISO-REF-010. */
#ifndef JOLON_GATEWAY_PDU_PDU_H
#define JOLON_GATEWAY_PDU_PDU_H

#include <stdint.h>

#define PDU_HEADER_BYTES 12u
#define PDU_BYTES_MAX    8192u /* of one PDU (IEEE 1278.1) */
#define PDU_PARTS_MAX    255u
#define PDU_PART_BYTES   16u
#define PDU_MARKING_MAX  11u
#define PDU_PORT         3000 /* by convention */

/* Versions: 5 is 1278.1-1995, 6 is 1278.1A-1998, 7 is 1278.1-2012. */
#define PDU_VERSION_LEAST 5
#define PDU_VERSION_MOST  7

enum pdu_type {
    PDU_ENTITY_STATE = 1,
    PDU_FIRE = 2,
    PDU_DETONATION = 3,
    PDU_COLLISION = 4,
    PDU_CREATE = 11,
    PDU_REMOVE = 12,
    PDU_START_RESUME = 13,
    PDU_STOP_FREEZE = 14,
    PDU_ACKNOWLEDGE = 15,
    PDU_COLLISION_ELASTIC = 66
};

enum pdu_family { PDU_FAMILY_ENTITY = 1, PDU_FAMILY_WARFARE = 2, PDU_FAMILY_MANAGEMENT = 5 };

/* Version 7 has further ones up to 30: friendly, opposing and neutral again and again. */
enum pdu_force {
    PDU_FORCE_OTHER,
    PDU_FORCE_FRIENDLY,
    PDU_FORCE_OPPOSING,
    PDU_FORCE_NEUTRAL,
    PDU_FORCE_LAST = 30
};

/* Bits of the appearance of any platform; the damage is a number of two bits. */
#define PDU_APPEARANCE_MOBILITY_KILL (1u << 1) /* of land platforms */
#define PDU_APPEARANCE_FIRE_KILL     (1u << 2) /* of land platforms */
#define PDU_APPEARANCE_DAMAGE(level) ((uint32_t)(level) << 3)
#define PDU_APPEARANCE_SMOKE         (1u << 5)
#define PDU_APPEARANCE_FLAMES        (1u << 15)
#define PDU_APPEARANCE_FROZEN        (1u << 21)
#define PDU_APPEARANCE_ENGINE        (1u << 22)
#define PDU_APPEARANCE_DEACTIVATED   (1u << 23)

enum pdu_detonation_result {
    PDU_RESULT_OTHER = 0,
    PDU_RESULT_ENTITY_IMPACT = 1,
    PDU_RESULT_ENTITY_PROXIMATE = 2,
    PDU_RESULT_GROUND_IMPACT = 3,
    PDU_RESULT_GROUND_PROXIMATE = 4,
    PDU_RESULT_DETONATION = 5,
    PDU_RESULT_DUD = 6,
    PDU_RESULT_WATER = 14,
    PDU_RESULT_AIR_HIT = 17,
    PDU_RESULT_BUILDING = 18,
    PDU_RESULT_OBJECT_PROXIMATE = 23,
    PDU_RESULT_AIR_BURST = 25,
    PDU_RESULT_MISS = 31, /* of three kinds */
    PDU_RESULT_MISS_LAST = 33
};

struct pdu_header {
    uint8_t version, exercise, type, family;
    uint32_t timestamp; /* gateway/pdu/timestamp.h */
    uint16_t length;    /* [octets], the header included */
    uint8_t status;     /* version 7; else 0 */
};

/* What an Acknowledge answers, and how (SISO-REF-010 UID 69 and 70). */
enum pdu_acknowledge {
    PDU_ACKNOWLEDGE_CREATE = 1,
    PDU_ACKNOWLEDGE_REMOVE = 2,
    PDU_ACKNOWLEDGE_START = 3,
    PDU_ACKNOWLEDGE_STOP = 4
};
enum pdu_response { PDU_RESPONSE_ABLE = 1, PDU_RESPONSE_UNABLE = 2 };

#define PDU_ID_ALL 0xffffu /* a site, an application or an entity: all of them */

/* Of an entity, or of an event. The numbers 0 (none), FFFF (all) and FFFE (request one) are
 * reserved. */
struct pdu_id {
    uint16_t site, application, entity;
};

struct pdu_entity_type {
    uint8_t kind, domain;
    uint16_t country;
    uint8_t category, subcategory, specific, extra;
};

struct pdu_clock {
    int32_t hours;      /* since 1970-01-01 00:00 UTC */
    uint32_t past_hour; /* in timestamp units of 3600 s / 2^31, without the low bit's meaning */
};

struct pdu_entity_state {
    struct pdu_id id;
    uint8_t force;
    struct pdu_entity_type type, alternative_type;
    float velocity[3];    /* [m/s] world axes; body axes for dead reckoning 6 to 9 */
    double location[3];   /* [m] ECEF */
    float orientation[3]; /* psi, theta, phi [rad]: gateway/earth/euler.h */
    uint32_t appearance;
    uint8_t dead_reckoning;            /* world/maths/dead_reckoning.h */
    float acceleration[3];             /* [m/s^2] axes as for velocity */
    float angular_velocity[3];         /* [rad/s] body axes */
    uint8_t character_set;             /* 1: ASCII */
    char marking[PDU_MARKING_MAX + 1]; /* ends with a NUL; printable ASCII alone */
    uint32_t capabilities;
};

struct pdu_fire {
    struct pdu_id firer, target, munition, event;
    uint32_t fire_mission; /* 0: none */
    double location[3];    /* [m] ECEF, of the launch */
    struct pdu_entity_type munition_type;
    uint16_t warhead, fuse, quantity, rate;
    float velocity[3]; /* [m/s] world axes */
    float range;       /* [m] 0: unknown */
};

struct pdu_detonation {
    struct pdu_id firer, target, munition, event; /* the event is that of the Fire */
    float velocity[3];                            /* [m/s] world axes */
    double location[3];                           /* [m] ECEF */
    struct pdu_entity_type munition_type;
    uint16_t warhead, fuse, quantity, rate;
    float point[3]; /* [m] in the target's body axes */
    uint8_t result; /* enum pdu_detonation_result */
};

struct pdu_collision {
    struct pdu_id issuer, other, event;
    uint8_t collision_type; /* 0 inelastic, 1 elastic */
    float velocity[3];      /* [m/s] world axes */
    float mass;             /* [kg] */
    float point[3];         /* [m] in the other entity's body axes */
};

struct pdu_collision_elastic {
    struct pdu_id issuer, other, event;
    float velocity[3]; /* [m/s] of the contact, world axes */
    float mass;        /* [kg] */
    float point[3];    /* [m] in the other entity's body axes */
    float result[6];   /* XX XY XZ YY YZ ZZ of the intermediate result */
    float normal[3];   /* unit, world axes */
    float restitution;
};

/* Create, Remove, Start/Resume, Stop/Freeze and Acknowledge. Each type has some of the fields. */
struct pdu_management {
    struct pdu_id originator, receiver;
    struct pdu_clock real_time, simulation_time;
    uint8_t reason, frozen;
    uint16_t acknowledge, response;
    uint32_t request;
};

enum pdu_part_kind { PDU_PART_ARTICULATED = 0, PDU_PART_ATTACHED = 1 };

/* Articulation types: class + metric. */
#define PDU_TURRET_AZIMUTH                                                                         \
    4107u                       /* [rad] clockwise from above; the turret is attached to part 0    \
                                 */
#define PDU_GUN_ELEVATION 4429u /* [rad] up; the gun is attached to part 1 */

struct pdu_part {
    uint8_t kind;   /* enum pdu_part_kind */
    uint8_t change; /* articulated: counts changes; attached: 1 when it is detached */
    uint16_t attached_to;
    uint32_t type;                  /* articulated: class + metric; attached: the station */
    float value;                    /* articulated alone */
    struct pdu_entity_type carried; /* attached alone */
};

struct pdu {
    struct pdu_header header;
    union {
        struct pdu_entity_state entity_state;
        struct pdu_fire fire;
        struct pdu_detonation detonation;
        struct pdu_collision collision;
        struct pdu_collision_elastic collision_elastic;
        struct pdu_management management;
    };
    uint8_t parts;         /* of Entity State and Detonation */
    uint8_t parts_skipped; /* records of other kinds, which a reader steps over */
    struct pdu_part part[PDU_PARTS_MAX];
};

#endif
