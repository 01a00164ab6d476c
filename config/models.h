/* Polygon models: config/models/NAME.obj and the material files they name, read with assimp into
 * a scenario's model tables, their hulls beside them. Each file is read once, hashed once, and only
 * from that folder. */
#ifndef JOLON_CONFIG_MODELS_H
#define JOLON_CONFIG_MODELS_H

#include "config/hulls.h"
#include "config/source.h"
#include "world/scenario.h"

#include <stdint.h>
#include <xxhash.h>

#define MODELS_VERTEX_MAX   65535u /* of one model */
#define MODELS_TRIANGLE_MAX 65535u
#define MODELS_EXTENT_MAX   1000.0f /* [m] of a coordinate */
#define MODELS_FILE_MAX     (2 * KIND_COUNT_MAX)

struct models {
    struct scenario *scenario; /* whose tables grow */
    const char *data_dir;
    XXH3_state_t *hash;
    struct source file[MODELS_FILE_MAX];
    int file_count;
    struct hulls hulls[KIND_COUNT_MAX]; /* of each of the scenario's models */
};

void models_open(struct models *models, struct scenario *scenario, const char *data_dir,
                 XXH3_state_t *hash);
void models_close(struct models *models);

/* Index in the scenario's models of the model called name, reading it when it is new. -1 with the
 * message: not a name, no such file, not a model, too large, a part or material that means
 * nothing. */
int models_find(struct models *models, const char *name, struct loader_message *message);

#endif
