/* Parameters of a run: the settings of a scenario for the whole world. A new scenario key changes
 * this header, so only .c files that read or write parameters include it. Headers declare `struct
 * params;`. */
#ifndef JOLON_WORLD_PARAMS_H
#define JOLON_WORLD_PARAMS_H

#include "world/entity/entity.h"
#include "world/param_values.h"

#include <stdint.h>

#define WORLD_NAME_MAX 48
#define PATH_TEXT_MAX  256

/* Constants of the collision response; docs/scenario.md says what each does. */
struct collision_params {
    uint32_t method;   /* enum method */
    uint32_t shape;    /* enum shape */
    uint32_t response; /* enum response_model */
    uint32_t nearness; /* enum nearness; method npsnet2 */
    uint32_t measure;  /* enum figure8_measure */
    uint32_t reserved;
    double mps_near_m; /* method mps: greatest distance on the map of a collision */
    double mass_c1_kg, mass_c2_kg, mass_c3_kg; /* Fig. 8 by mass alone: c1 > c2 > c3 */
    double threshold_height_m;                 /* above it fixed objects are not tested (row 17) */
    double fast_vehicle_mps;                   /* Fig. 8 "speed of colliding vehicle > constant" */
    double fast_fixed_mps; /* Fig. 8 "moving quickly", against a large fixed object */
    double large_fixed_kg; /* Fig. 8 "large" */
    double damage_high, damage_med, damage_low; /* Fig. 8 c1 > c2 > c3, impact energy over the
                                                   fixed object's resistance (row 27) */
};

/* Settings of the renderer; the simulation does not read them. */
struct renderer_params {
    uint32_t width, height; /* [pixel] */
    double fps;             /* pictures a second of the clock, 0..120 */
    uint32_t views;         /* 1 << enum view_mode for each view */
    uint32_t follow;        /* entity id, 0: the renderer chooses */
    uint32_t fog, haze, texture;
    uint32_t back_end; /* enum back_end */
    uint32_t hold;     /* 1: keeps fps by less detail, then by smaller pictures */
    uint32_t reserved;
};

/* Settings of the gateway to exercises of DIS; the simulation does not read them. */
struct gateway_params {
    char address[48];   /* in numbers */
    char listen[64];    /* where PDUs are received, "none": nowhere */
    char interface[48]; /* of multicast: a name or an address of this machine, "any" */
    uint32_t enabled;   /* 1: a set has a gateway */
    uint32_t port, exercise, site;
    uint32_t application, applications; /* the first, and how many */
    uint32_t version;                   /* of DIS: 6 or 7 */
    uint32_t rate_ps;                   /* PDUs a second at most */
    uint32_t clamp;                     /* 1: land vehicles of others are set on our ground */
    uint32_t undulation_grid;           /* 1: the undulation of each place, from PROJ's grid */
    double timeout_s;                   /* without an Entity State an entity of others is lost */
    double latitude_deg, longitude_deg; /* of the middle of the square */
    double undulation_m;                /* of the sea above the ellipsoid there */
    char cot[64];      /* where events of Cursor on Target are sent, "none": nowhere */
    char peers[256];   /* world/gateway_lists.h */
    char control[256]; /* world/gateway_lists.h */
};

/* The place to which vehicles of a force withdraw. */
struct force_base {
    double x, z; /* [m] */
};

/* When a battle of missions ends [s since it began]; 0: never. */
struct battle_params {
    double end_s;   /* its result is told */
    double again_s; /* all missions begin again */
};

struct params {
    char name[WORLD_NAME_MAX];    /* of the ground: "hunter-liggett" */
    char scenario[PATH_TEXT_MAX]; /* path of its file, for people */
    uint64_t seed;
    uint64_t scenario_hash; /* of the text and the overrides */
    uint64_t frame_limit;   /* the run ends with this frame, 0: never */
    double hz;
    double dt_s;   /* 1 / hz */
    uint32_t pace; /* enum pace */
    uint32_t capacity;
    uint32_t event_slots;       /* power of two */
    uint32_t events_per_frame;  /* at most; 1 .. event_slots / 2, the loader sets / 8 */
    uint32_t intents_per_frame; /* at most */
    uint32_t command_slots;     /* power of two, of each ring but the gateway's */
    uint32_t crater_slots;
    uint32_t dent_slots;
    uint32_t contact_slots; /* persistent contacts at most, in each world buffer */
    uint32_t remotes_max;   /* rows of remote entities at most (world/entity/remote.h) */
    uint32_t when_full;     /* enum when_full */
    uint32_t cruise;        /* 1: vehicles may cruise (world/entity/cruise.h) */
    uint32_t reserved;
    uint32_t initial_entities;
    double wind_mps, wind_from_rad; /* the air's speed, and the bearing from which it comes */
    struct collision_params collision;
    struct battle_params battle;
    struct force_base
        base[FORCE_COUNT]; /* the scenario's, or the middle of the force's initial places */
    struct renderer_params renderer;
    struct gateway_params gateway;
};

#endif
