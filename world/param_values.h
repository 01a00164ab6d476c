/* The values of enumerated parameters in a scenario. Their words are in world/enum_names.h. */
#ifndef JOLON_WORLD_PARAM_VALUES_H
#define JOLON_WORLD_PARAM_VALUES_H

#include "world/collision_models.h"

enum shape { SHAPE_SPHERE, SHAPE_MODEL, SHAPE_COUNT };
/* Figure 8's "colliding mass": the mass alone, as printed, or the impact's energy. */
enum figure8_measure { MEASURE_ENERGY, MEASURE_MASS, MEASURE_COUNT };
/* NPSNET-2's 100 m test: within 100 m in X or Z, as printed, or in both. */
enum nearness { NEARNESS_AND, NEARNESS_OR, NEARNESS_COUNT };
enum pace { PACE_REAL, PACE_MAX };
/* What happens when the recorder is so late that the ring is full of events that it has not
 * written. */
enum when_full { WHEN_FULL_GAP, WHEN_FULL_PAUSE, WHEN_FULL_COUNT };

enum view_mode {
    VIEW_CHASE,    /* from behind */
    VIEW_MAP,      /* the map */
    VIEW_INSIDE,   /* from the crew's eye */
    VIEW_ORBIT,    /* around it */
    VIEW_FREE,     /* from a fixed place */
    VIEW_OVERHEAD, /* straight down */
    VIEW_COUNT
};

/* How to draw: OpenGL, the renderer's own rasteriser, or the one that suits the machine. */
enum back_end { BACK_END_AUTO, BACK_END_GL, BACK_END_SOFT, BACK_END_COUNT };

#endif
