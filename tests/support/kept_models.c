/* Reads each shipped model once for a whole test. assimp clears 16 MB twice for each file, and a
 * test makes dozens of worlds. Linked with --wrap (see the Makefile). Other models are read each
 * time, because their tests write them anew. */
#include "tests/support/fixture.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KEPT_MAX 64 /* more models than are shipped; those after them are not kept */

const struct aiScene *__real_aiImportFileEx(const char *path, unsigned flags, struct aiFileIO *io);
const struct aiScene *__wrap_aiImportFileEx(const char *path, unsigned flags, struct aiFileIO *io);
void __real_aiReleaseImport(const struct aiScene *scene);
void __wrap_aiReleaseImport(const struct aiScene *scene);

static struct {
    char path[PATH_MAX];
    unsigned flags;
    const struct aiScene *scene;
} kept[KEPT_MAX];
static int kept_count;

static bool is_shipped(const char *path)
{
    char models[PATH_MAX + 8];
    int length = snprintf(models, sizeof models, "%s/models/", fixture_shipped_dir());
    return length > 0 && strncmp(path, models, (size_t)length) == 0;
}

const struct aiScene *__wrap_aiImportFileEx(const char *path, unsigned flags, struct aiFileIO *io)
{
    char real[PATH_MAX];
    if (!realpath(path, real) || !is_shipped(real))
        return __real_aiImportFileEx(path, flags, io);
    for (int i = 0; i < kept_count; i++) {
        if (kept[i].flags == flags && strcmp(kept[i].path, real) == 0)
            return kept[i].scene;
    }
    const struct aiScene *scene = __real_aiImportFileEx(path, flags, io);
    if (scene && kept_count < KEPT_MAX) {
        memcpy(kept[kept_count].path, real, sizeof real);
        kept[kept_count].flags = flags;
        kept[kept_count++].scene = scene;
    }
    return scene;
}

void __wrap_aiReleaseImport(const struct aiScene *scene)
{
    for (int i = 0; i < kept_count; i++) {
        if (kept[i].scene == scene)
            return;
    }
    __real_aiReleaseImport(scene);
}
