/* The world: what never changes after creation (struct world) and what a frame changes (struct
 * state). Both are views into memory somebody else owns: the shared segment, or a test's heap. */
#ifndef JOLON_WORLD_WORLD_H
#define JOLON_WORLD_WORLD_H

#include "world/entity/command.h"
#include "world/entity/dent.h"
#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/terrain/fixed.h"
#include "world/entity/formation.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/entity/script.h"
#include "world/terrain/terrain.h"

#include <stdbool.h>
#include <stdint.h>

#define WORLD_NAME_MAX 48
#define PATH_TEXT_MAX  256

/* How collisions are found. Swept, occupancy, hopcroft and brute find the same, each in its own
 * way; npsnet2 and mps look at the frame's end only, as published. */
enum method {
    METHOD_SWEPT,
    METHOD_NPSNET2,
    METHOD_MPS,
    METHOD_OCCUPANCY,
    METHOD_HOPCROFT,
    METHOD_BRUTE,
    METHOD_COUNT
};
enum shape { SHAPE_SPHERE, SHAPE_MODEL, SHAPE_COUNT };
enum response_model {
    MODEL_FIGURE8,
    MODEL_IMPULSE,
    MODEL_NONE,
    MODEL_SPRING,
    MODEL_MPS,
    MODEL_COUNT
};
/* Figure 8's "colliding mass": the mass alone, as printed, or the impact's energy. */
enum figure8_measure { MEASURE_ENERGY, MEASURE_MASS, MEASURE_COUNT };
/* NPSNET-2's 100 m test: X or Z within it, as printed, or both. */
enum nearness { NEARNESS_AND, NEARNESS_OR, NEARNESS_COUNT };
enum pace { PACE_REAL, PACE_MAX };
/* What becomes of events that the recorder cannot write before the ring is full of them. */
enum when_full { WHEN_FULL_GAP, WHEN_FULL_PAUSE, WHEN_FULL_COUNT };

/* Constants of the collision response; docs/scenario.md says what each does. */
struct collision_params {
    uint32_t method;   /* enum method */
    uint32_t shape;    /* enum shape */
    uint32_t response; /* enum response_model */
    uint32_t nearness; /* enum nearness; method npsnet2 */
    uint32_t measure;  /* enum figure8_measure */
    uint32_t reserved;
    double mps_near_m;                         /* method mps: this near on the map is a collision */
    double mass_c1_kg, mass_c2_kg, mass_c3_kg; /* Fig. 8 by mass alone: c1 > c2 > c3 */
    double threshold_height_m;                 /* above it nothing fixed is tested (row 17) */
    double fast_vehicle_mps;                   /* Fig. 8 "speed of colliding vehicle > constant" */
    double fast_fixed_mps; /* Fig. 8 "moving quickly", against a large fixed object */
    double large_fixed_kg; /* Fig. 8 "large" */
    double damage_high, damage_med, damage_low; /* Fig. 8 c1 > c2 > c3, impact energy over the
                                                   fixed object's resistance (row 27) */
};

/* What the renderer is told; the simulation does not read it. */
struct renderer_params {
    uint32_t width, height; /* [pixel] */
    double fps;             /* pictures a second of the clock, 0..120 */
    uint32_t views;         /* 1 << enum view_mode of each that is wanted */
    uint32_t follow;        /* entity id, 0: picks one */
    uint32_t fog, haze, texture;
    uint32_t back_end; /* enum back_end */
    uint32_t hold;     /* 1: less detail, then smaller, rather than fewer pictures */
    uint32_t reserved;
};

enum view_mode {
    VIEW_CHASE,    /* from behind */
    VIEW_MAP,      /* the map */
    VIEW_INSIDE,   /* as the crew sees it */
    VIEW_ORBIT,    /* around it */
    VIEW_FREE,     /* from a place that stays where it is */
    VIEW_OVERHEAD, /* straight down */
    VIEW_COUNT
};

/* What draws: OpenGL, the renderer's own rasteriser, or whichever suits the machine. */
enum back_end { BACK_END_AUTO, BACK_END_GL, BACK_END_SOFT, BACK_END_COUNT };

/* Where vehicles of a force withdraw to. */
struct force_base {
    double x, z; /* [m] */
};

struct params {
    char name[WORLD_NAME_MAX];    /* of the ground: "hunter-liggett" */
    char scenario[PATH_TEXT_MAX]; /* the file it came from, for people */
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
    uint32_t command_slots;     /* power of two, of each ring */
    uint32_t crater_slots;
    uint32_t dent_slots;
    uint32_t when_full; /* enum when_full */
    uint32_t initial_entities;
    struct collision_params collision;
    struct force_base
        base[FORCE_COUNT]; /* a scenario's, or the mean of the force's initial places */
    struct renderer_params renderer;
};

/* Polygon models. Body axes: x forward, y up, z right, origin at the entity's position, metres.
 * Triangles are counter-clockwise from outside. */
struct model {
    char name[KIND_NAME_MAX];
    uint32_t first_triangle, triangle_count;
    uint32_t first_vertex, vertex_count;
    uint32_t solid_triangles, solid_vertices; /* the first so many collide and are not seen, the
                                                 others are seen only; 0: all of them do both */
};

struct model_vertex {
    float x, y, z;
};

/* How a part of a model moves (docs/scenario.md, Models). */
enum model_part {
    PART_BODY,
    PART_TURRET,
    PART_GUN, /* on the turret, where there is one */
    PART_ROTOR,
    PART_TAIL_ROTOR,
    PART_WHEEL,
    PART_FRONT_WHEEL, /* steers */
    PART_TRACK,
    PART_COUNT
};

#define MODEL_JOINTS_MAX 32u /* things of a model that move each by itself, and the turret */

/* How much of a triangle's colour is its force's, 255 being all of it: of the materials "force",
 * for flags and panels, "paint", in camouflage, and "wash" with what follows, plain. */
#define MODEL_TINT_FORCE 255
#define MODEL_TINT_PAINT 80
#define MODEL_TINT_WASH  70

struct model_triangle {
    uint32_t vertex[3];       /* index within the model */
    uint8_t red, green, blue; /* 0..255, sRGB */
    uint8_t force_tint;       /* MODEL_TINT_..., or 0 */
    uint16_t part;            /* enum model_part */
    uint16_t joint;           /* which of them; 0: the body and the turret */
};

/* How many of a model's first triangles collide. */
static inline uint32_t model_solid_triangles(const struct model *model)
{
    return model->solid_triangles > 0 ? model->solid_triangles : model->triangle_count;
}

struct area {
    double x0, z0, x1, z1;
};

struct route_point {
    double x, z;
};

struct route {
    uint32_t first, count; /* points */
};

/* A shot the scenario orders. */
struct fire_order {
    uint64_t tick;         /* when, in steps of simulated time */
    uint32_t shooter_slot; /* initial slot, SLOT_NONE: out of the sky */
    uint32_t target_slot;  /* SLOT_NONE: the point */
    uint16_t kind;         /* munition, KIND_NONE: the shooter's own */
    uint16_t reserved;
    double x, z;
};

struct road_point {
    float x, z;
    uint32_t road; /* points of one road follow each other */
    uint32_t reserved;
};

struct entity_name {
    char text[ENTITY_NAME_MAX];
};

struct counts {
    uint32_t kinds, models, model_vertices, model_triangles;
    uint32_t hulls, hull_vertices, hull_planes;
    uint32_t posts_side, fixed, reach, areas, routes, route_points, fires, road_points, names;
    uint32_t formations, scripts, script_steps;
    uint32_t recipe; /* [byte] */
};

struct world {
    const struct params *params;
    struct counts counts;
    struct terrain terrain;
    const struct kind *kinds;
    const struct model *models;
    const struct model_vertex *model_vertices;
    const struct model_triangle *model_triangles;
    const struct hull *hulls;
    const struct vec3 *hull_vertices;
    const struct hull_plane *hull_planes;
    const struct fixed_object *fixed;
    const uint32_t *reach_start; /* [GRIDSQUARE_COUNT + 1] into reach */
    const uint32_t *reach;       /* fixed object indices, ascending within a square */
    const struct area *areas;
    const struct route *routes;
    const struct route_point *route_points;
    const struct fire_order *fires; /* ascending tick */
    const struct road_point *road_points;
    const struct formation *formations;
    const struct script *scripts;
    const struct script_step *script_steps;
    const struct entity_name *names; /* of the initial entities: slot i has id i + 1 */
    const char *recipe;              /* [counts.recipe] what it was made from */
};

/* Counters since the world began; part of the digest. */
struct tally {
    uint64_t collisions, fires, detonations, destroyed, fixed_damaged, agent_changes, commands;
    uint64_t events_dropped;  /* more in a frame than events_per_frame: counted, never silent */
    uint64_t craters_refused; /* no room in the list of craters */
    uint64_t spawns_refused;  /* no free slot */
    uint64_t dents_refused;   /* no room in the list of dents */
};

/* The head of a world buffer and, as the mover stages it, of the moved table. */
struct state_head {
    uint64_t frame;        /* this buffer holds this frame */
    uint64_t tick;         /* steps of simulated time: frames less those that stood paused */
    uint64_t event_end;    /* events of the run so far */
    uint64_t event_digest; /* over all of them, in order */
    uint64_t command_cursor[COMMAND_RING_COUNT]; /* commands taken from each ring */
    double time_scale; /* simulated seconds a second of the clock; pacing only */
    uint32_t paused;
    uint32_t steps_left; /* frames to advance while paused */
    uint32_t quit;
    uint32_t used;       /* slots 0 .. used - 1 have ever held an entity */
    uint32_t alloc_next; /* where the search for a free slot goes on */
    uint32_t next_id;
    uint32_t vehicles, munitions; /* active or wrecks; in flight */
    uint32_t crater_count;
    uint32_t dent_count;
    uint32_t reserved;
    uint32_t fire_cursor;  /* scenario fires done */
    uint32_t intent_count; /* M only: events the mover hands to the collider */
    uint32_t advanced;     /* 1: simulated time moved in this frame */
    uint64_t mover_ns;     /* M only: what moving took; not in the digest */
    struct tally tally;
    uint64_t checksum; /* state_checksum(), moved_checksum() */
};

struct piece_hashes;

/* One buffer of the world. fixed_damage and the crater list belong to W only. */
struct state {
    struct state_head *head;
    struct entities entities;
    struct piece_hashes *hashes; /* of the rows (checksum.h); a reader's copy has none: NULL */
    uint8_t *fixed_damage;       /* [counts.fixed] enum damage */
    struct crater *craters; /* shared by both buffers, append-only: committed by crater_count */
    struct dent *dents;     /* likewise, by dent_count */
};

/* The mover's output. */
struct moved {
    struct state_head *head;
    struct entities entities;
    struct piece_hashes *hashes; /* as in struct state */
    struct event *intents; /* [params.intents_per_frame]; sequence, frame, index not yet set */
};

double world_time_s(const struct world *world, const struct state_head *head);

/* Name of the entity with this id if the scenario gave it one, else "". */
const char *world_entity_name(const struct world *world, uint32_t id);

/* Id of the entity that the scenario gave this name, 0 when there is none. */
uint32_t world_entity_named(const struct world *world, const char *name);

/* Indices of the fixed objects that reach into a square. */
static inline uint32_t world_reach(const struct world *world, uint32_t square,
                                   const uint32_t **objects)
{
    *objects = world->reach + world->reach_start[square];
    return world->reach_start[square + 1] - world->reach_start[square];
}

/* Digest of a frame: everything that the next frame depends on, in a fixed order, as XXH3-64.
 * Not in it: pacing, stage times, slots beyond used. */
uint64_t world_digest(const struct world *world, const struct state *state);

const char *method_name(enum method method);
const char *shape_name(enum shape shape);
const char *response_model_name(enum response_model model);
const char *view_mode_name(enum view_mode view);
const char *back_end_name(enum back_end back_end);

#endif
