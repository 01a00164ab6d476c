/* What a scenario chooses from: the values of enumerated parameters. Their words are in
 * world/enum_names.h. */
#ifndef JOLON_WORLD_PARAM_VALUES_H
#define JOLON_WORLD_PARAM_VALUES_H

#include "world/collision_models.h"

enum shape { SHAPE_SPHERE, SHAPE_MODEL, SHAPE_COUNT };
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
