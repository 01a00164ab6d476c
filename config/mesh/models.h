/* Reader of the polygon models, config/models/NAME.obj, and of the material files that they name.
 * It fills a scenario's tables of models and of their hulls. Each file is read once and hashed
 * once, and only files of that folder are read. */
#ifndef JOLON_CONFIG_MESH_MODELS_H
#define JOLON_CONFIG_MESH_MODELS_H

#include "config/mesh/hulls.h"
#include "config/mesh/obj_file.h"
#include "config/syntax/source.h"
#include "world/entity/kind.h"

#include <stdint.h>
#include <xxhash.h>

#define MODELS_BYTES_MAX  (16u * 1024u * 1024u) /* of one file */
#define MODELS_VERTEX_MAX OBJ_FILE_VERTICES_MAX /* of one model */
#define MODELS_FILE_MAX   (2 * KIND_COUNT_MAX)

struct models {
    struct scenario *scenario; /* whose tables grow */
    const char *data_dir;
    XXH3_state_t *hash;
    struct source file[MODELS_FILE_MAX];
    int file_count;
    struct hulls hulls[KIND_COUNT_MAX]; /* of each model of the scenario */
};

void models_open(struct models *models, struct scenario *scenario, const char *data_dir,
                 XXH3_state_t *hash);
void models_close(struct models *models);

/* Index in the scenario's models of the model called name, which is read when it is new. -1 with
 * the message: no such file, not a model, too large, an unknown part or material. */
int models_find(struct models *models, const char *name, struct error_text *error);

#endif
