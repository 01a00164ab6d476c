/* What a scenario chooses from: the values of enumerated parameters. Their words are in
 * world/enum_names.h. */
#ifndef JOLON_WORLD_PARAM_VALUES_H
#define JOLON_WORLD_PARAM_VALUES_H

/* How collisions are found. Swept, occupancy, hopcroft and brute find the same collisions by
 * different algorithms; npsnet2 and mps test the positions at the frame's end only, as published.
 */
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

#endif
