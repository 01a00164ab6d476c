/* The values of enumerated parameters in a scenario, with their words. A value out of range has the
 * word "?". */
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

const char *method_name(enum method method);
const char *shape_name(enum shape shape);
const char *response_model_name(enum response_model model);

#endif
