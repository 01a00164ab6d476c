/* Polygon models: config/models/NAME.obj and the material files they name, read with assimp into
 * a scenario's model tables, their hulls beside them. Each file is read once, hashed once, and only
 * from that folder. */
#ifndef JOLON_CONFIG_MODELS_H
#define JOLON_CONFIG_MODELS_H

#include "config/hulls.h"
#include "config/obj.h"
#include "config/source.h"
#include "world/scenario.h"

#include <stdint.h>
#include <xxhash.h>

#define MODELS_BYTES_MAX    (16u * 1024u * 1024u) /* of one file */
#define MODELS_VERTEX_MAX   OBJ_VERTICES_MAX      /* of one model */
#define MODELS_TRIANGLE_MAX OBJ_TRIANGLES_MAX
#define MODELS_EXTENT_MAX   ((float)OBJ_EXTENT_MAX) /* [m] of a coordinate */
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
