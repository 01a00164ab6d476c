/* Kinds: the properties shared by all vehicles, munitions and fixed objects of one sort (thesis row
 * 49: physical attributes in the object file). Written once at creation, read-only to all. */
#ifndef JOLON_WORLD_ENTITY_KIND_H
#define JOLON_WORLD_ENTITY_KIND_H

#include "world/maths/maths.h"

#include <stdbool.h>
#include <stdint.h>

#define KIND_NAME_MAX  24
#define KIND_COUNT_MAX 64
#define KIND_NONE      UINT16_MAX

/* The ground's slope under a body is taken between points at least this far from its middle [m]:
 * over a shorter distance rounding dominates it. */
#define KIND_STANCE_LEAST_M 0.5

#define CHASSIS_AXLES_MAX 7u

enum domain { DOMAIN_LAND, DOMAIN_SEA, DOMAIN_AIR, DOMAIN_MUNITION, DOMAIN_FIXED, DOMAIN_COUNT };

/* How a munition flies. */
enum guidance { GUIDANCE_BALLISTIC, GUIDANCE_HOMING };

/* The standard projectile by which the drag of a munition follows from its speed. */
enum drag_function { DRAG_NONE, DRAG_G1, DRAG_G7, DRAG_COUNT };

/* How a munition comes to its target: along the barrel, along an arc that a firing table gives, or
 * released by an aircraft. */
enum delivery { DELIVERY_DIRECT, DELIVERY_ARC, DELIVERY_DROP };

/* When a charge explodes: where it strikes, a moment later inside what it strikes, or in the air
 * over the point at which it was fired. The field flags of a round has its fuze. */
enum fuze { FUZE_POINT, FUZE_DELAY, FUZE_AIR, FUZE_COUNT };

/* The sides of a vehicle that its armour distinguishes. */
enum aspect { ASPECT_FRONT, ASPECT_SIDE, ASPECT_REAR, ASPECT_TOP, ASPECT_COUNT };

/* The aircraft at which a crew fires a munition. Slow are those that can hover. */
enum aircraft_targets { AIR_TARGETS_ALL, AIR_TARGETS_SLOW, AIR_TARGETS_NONE };

/* The table by which an agent reacts: mover/agent/behaviour_table.c. */
enum doctrine {
    DOCTRINE_ARMOUR,
    DOCTRINE_LIGHT,
    DOCTRINE_SOFT,
    DOCTRINE_HELICOPTER,
    DOCTRINE_JET,
    DOCTRINE_WARSHIP,
    DOCTRINE_BEAST,
    DOCTRINE_FLAK,
    DOCTRINE_COUNT
};

/* The rows of Table 1. */
enum object_class {
    OBJECT_TREE,
    OBJECT_BUSH,
    OBJECT_POLE,
    OBJECT_BUILDING,
    OBJECT_WATERTOWER,
    OBJECT_OTHER_MANMADE,
    OBJECT_OTHER_NATURAL,
    OBJECT_CLASS_COUNT
};

struct kind {
    char name[KIND_NAME_MAX];
    uint8_t domain;       /* enum domain */
    uint8_t guidance;     /* enum guidance; munitions */
    uint8_t object_class; /* enum object_class; fixed objects */
    uint8_t drag;         /* enum drag_function; munitions */
    uint8_t air_targets;  /* enum aircraft_targets; munitions */
    uint8_t craters;      /* munitions: makes a crater when it hits the ground */
    uint8_t delivery;     /* enum delivery; munitions */
    uint8_t fuze;         /* enum fuze; munitions */
    uint16_t model;       /* index into the world's models */
    uint16_t munition;    /* kind it fires, KIND_NONE for none */
    double mass_kg;
    double radius_m; /* of the bounding sphere, whose centre is the position */
    double max_speed_mps;
    double min_speed_mps;     /* aircraft that cannot hover: below it they stall */
    double acceleration_mps2; /* braking is twice as hard */
    double turn_rate_rps;     /* [rad/s] */
    double max_slope_rad;     /* steepest ground a land vehicle climbs */
    /* The chassis of a land vehicle (mover/motion/chassis.h). */
    uint8_t tracked;        /* 1: tracks, which turn it on the spot; 0: wheels */
    uint8_t outline;        /* 1: of one building, from its outline (config/ground_objects.h) */
    uint32_t axles;         /* pairs of wheels, 2..CHASSIS_AXLES_MAX */
    double power_w;         /* of the engine */
    double track_m;         /* between the middles of left and right wheels */
    double centre_height_m; /* of the centre of mass over the ground */
    double travel_m;        /* of a wheel from its place at rest up to the bump stop */
    double heave_hz;        /* frequency of the body on its springs */
    double least_turn_m;    /* radius of the tightest circle; tracks: 0 */
    double ford_m;          /* deepest water that it crosses */
    double step_m;          /* highest step that its wheels roll onto; higher ones are walls */
    double trench_m;        /* widest trench that its agent crosses */
    double length_m, width_m, height_m;
    double cruise_altitude_m; /* aircraft: above the ground */
    double climb_rate_mps;    /* aircraft */
    double max_load;          /* [g] aircraft and homing munitions: at most so much lift */
    double rigidity;          /* 0..1: share of an impact that becomes damage at once */
    double moldability;       /* 0..1: share of a dent that remains */
    double restitution;       /* 0..1: share of the closing speed after a bounce */
    double friction;          /* 0..2: Coulomb's coefficient of its skin */
    double resistance_j;      /* energy that destroys it */
    double stiffness_npm;     /* [N/m] of its skin, for the response "spring" */
    double severe_rad;        /* Fig. 8: largest angle off a quarter turn of a square impact */
    double bounce_keep;       /* Fig. 8: 0..1 of its speed after a bounce */
    double fast_mps;          /* Fig. 8: a square impact is fatal from here; 0: the scenario's */
    double damage_high;       /* fixed objects, Fig. 8 c1 > c2 > c3: impact energy over its */
    double damage_med;        /* resistance_j from which damage is high, medium, low; 0: the */
    double damage_low;        /* scenario's */
    double debris_keep;  /* fixed objects: 0..1 of the debris that lies firm; the rest is pushed */
    double explosive_kg; /* TNT; of a vehicle: explodes when it is destroyed */
    double range_m;      /* vehicles: of their guns */
    double sight_m;      /* vehicles: at which they see enemies */
    double view_rad;     /* vehicles: width of view, about the turret's direction */
    uint32_t doctrine;   /* enum doctrine; vehicles */
    double reload_s;     /* vehicles: between two rounds */
    double reaction_s;   /* vehicles: median time from the sight of a target to the shot */
    double turret_rate_rps;           /* vehicles: 0: no turret, it aims with the hull */
    double gun_rate_rps;              /* up and down; 0: the gun does not move */
    double gun_low_rad, gun_high_rad; /* limits, relative to the hull's own plane */
    double seeker_rad;                /* homing munitions: half angle of the seeker's cone */
    double burn_s;                    /* homing munitions: time of the motor; 0: all their life */
    double reliability;               /* homing munitions: 0..1 that nothing in them fails */
    double decoyed;                   /* homing munitions: 0..1 that a decoy takes the seeker */
    double ballistic_kgpm2;           /* munitions with drag: mass / (form factor x calibre^2) */
    double dispersion_rad;            /* munitions: standard error from a shooter that stands */
    double dispersion_moving_rad;     /* and from one at half of its top speed or above */
    double life_s;                    /* munitions: end of flight */
    double penetration_mm;            /* munitions: of steel at the muzzle; 0: energy counts */
    double penetration_loss;          /* munitions: [mm/km] of it lost on the way */
    double armour_mm[ASPECT_COUNT];   /* vehicles: of steel, along a line square to the side */
    double courage;                   /* 0..1: probability of returning fire rather than fleeing */
    double fuel_l, fuel_lps;          /* tank, and burnt at full throttle a second */
    double idle_share;                /* land vehicles: of fuel_lps, burnt while the engine idles */
    uint32_t rounds;
    /* These follow from the model's hulls. */
    uint32_t first_hull, hull_count; /* index into the world's hulls: body, then turret, gun */
    uint32_t outer_hull;             /* the hull around all of them */
    uint32_t first_part_hull;        /* one hull around each part */
    uint32_t part_count;             /* 0: the model has no turret */
    uint32_t body_hulls;             /* the first so many are of the body */
    uint32_t light_munition; /* vehicles: 1 + the kind that it fires at thin armour; 0: none */
    struct vec3 turret_pivot, gun_pivot; /* [m] body axes */
    double bound_m;       /* radius about the position that contains every hull in any rotation */
    double reach_m;       /* the same wherever turret and gun point */
    double level_m;       /* the same on the map, upright */
    double low_m, high_m; /* lowest and highest point over the position, upright */
};

/* Returns true if it is an aircraft that can hover, such as a helicopter. */
static inline bool kind_hovers(const struct kind *kind)
{
    return kind->domain == DOMAIN_AIR && !(kind->min_speed_mps > 0.0);
}

/* Returns the munition that a vehicle fires at one of another kind, KIND_NONE for none. Thin armour
 * is below KIND_LIGHT_MM at the sides. */
#define KIND_LIGHT_MM 45.0
static inline uint16_t kind_munition_at(const struct kind *kind, const struct kind *target)
{
    bool light = kind->light_munition != 0 && target->domain != DOMAIN_AIR &&
                 target->armour_mm[ASPECT_SIDE] < KIND_LIGHT_MM;
    return light ? (uint16_t)(kind->light_munition - 1u) : kind->munition;
}

/* Most kinds of a world: those of files, KIND_COUNT_MAX at most, and behind them one for each
 * building of a ground file. Vehicles and munitions are of the former. */
#define KIND_ALL_MAX 65472u

/* Returns how many of the first kinds are of files. */
static inline uint32_t kind_of_files(const struct kind *kinds, uint32_t count)
{
    uint32_t files = 0;
    while (files < count && files < KIND_COUNT_MAX && !kinds[files].outline)
        files++;
    return files;
}

/* Index of the kind called name, KIND_NONE when there is none. */
uint16_t kind_find(const struct kind *kinds, uint32_t count, const char *name);

#endif
