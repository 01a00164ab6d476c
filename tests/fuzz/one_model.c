/* Replaces assimp for harnesses whose model never changes, because assimp clears 16 MB for each
 * file. Linked with --wrap (see the Makefile). fuzz_model.c tests models themselves. */

#include "world/runtime/check.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <string.h>

const struct aiScene *__real_aiImportFileEx(const char *path, unsigned flags, struct aiFileIO *io);
const struct aiScene *__wrap_aiImportFileEx(const char *path, unsigned flags, struct aiFileIO *io);
void __wrap_aiReleaseImport(const struct aiScene *scene);

static const struct aiScene *box;

const struct aiScene *__wrap_aiImportFileEx(const char *path, unsigned flags, struct aiFileIO *io)
{
    CHECK(strstr(path, "/models/box.obj"));
    if (!box)
        box = __real_aiImportFileEx(path, flags, io);
    return box;
}

void __wrap_aiReleaseImport(const struct aiScene *scene)
{
    CHECK(scene == box);
}
