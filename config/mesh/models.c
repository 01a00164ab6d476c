/* Reads polygon models with assimp. assimp opens files through the functions here, so that it reads
 * the bytes that were checked (config/mesh/obj_file.h) and hashed, and no file outside the folder
 * of models.
 */
#include "config/mesh/models.h"

#include "config/syntax/key_table.h"
#include "config/syntax/memory.h"
#include "config/syntax/table.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/model.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NODE_DEPTH_MAX 8

/* A file that assimp has open. */
struct reader {
    struct aiFile file;
    const struct source *source;
    size_t at;
};

/* Parts that a model can have several of have a number behind the name. */
static const char *const part_names[PART_COUNT] = {
    [PART_BODY] = "body",
    [PART_TURRET] = "turret",
    [PART_GUN] = "gun",
    [PART_ROTOR] = "rotor",
    [PART_TAIL_ROTOR] = "tail_rotor",
    [PART_WHEEL] = "wheel",
    [PART_FRONT_WHEEL] = "front_wheel",
    [PART_TRACK] = "track",
};

/* Objects that collide and are not drawn, by the part with which they move. */
static const char *const solid_names[PART_COUNT] = {
    [PART_BODY] = "solid",
    [PART_TURRET] = "solid_turret",
    [PART_GUN] = "solid_gun",
};

void models_open(struct models *models, struct scenario *scenario, const char *data_dir,
                 XXH3_state_t *hash)
{
    memset(models, 0, sizeof(*models));
    models->scenario = scenario;
    models->data_dir = data_dir;
    models->hash = hash;
}

void models_close(struct models *models)
{
    for (int i = 0; i < models->file_count; i++)
        source_free(&models->file[i]);
    models->file_count = 0;
}

/* An obj_file_open: the file of this name in the folder of models, which is read at most once. NULL
 * with the message. */
static const struct source *find_file(void *context, const char *name, struct error_text *error)
{
    struct models *models = context;
    char folder[PATH_MAX], path[PATH_MAX];
    struct source *source = &models->file[models->file_count];
    const struct key_place place = {path, 0};
    int length = snprintf(folder, sizeof(folder), "%s/models", models->data_dir);
    if (length >= 0 && (size_t)length < sizeof(folder))
        length = snprintf(path, sizeof(path), "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= sizeof(path)) {
        key_table_refuse(error, (struct key_place){models->data_dir, 0}, NULL, NULL,
                         "is too long for a path");
        return NULL;
    }
    for (int i = 0; i < models->file_count; i++) {
        if (strcmp(models->file[i].path, path) == 0)
            return &models->file[i];
    }
    if (models->file_count == MODELS_FILE_MAX) {
        key_table_refuse(error, place, NULL, NULL, "is one model file too many; allowed: up to %d",
                         MODELS_FILE_MAX);
        return NULL;
    }
    if (source_read_in(source, folder, name, MODELS_BYTES_MAX, error) != 0)
        return NULL;
    models->file_count++;
    XXH3_64bits_update(models->hash, name, strlen(name) + 1);
    XXH3_64bits_update(models->hash, source->text, source->bytes);
    return source;
}

static size_t reader_read(struct aiFile *file, char *to, size_t size, size_t count)
{
    struct reader *reader = (struct reader *)(void *)file->UserData;
    size_t left = reader->source->bytes - reader->at;
    if (size == 0 || count == 0)
        return 0;
    if (count > left / size)
        count = left / size;
    memcpy(to, reader->source->text + reader->at, size * count);
    reader->at += size * count;
    return count;
}

static size_t reader_write(struct aiFile *file, const char *from, size_t size, size_t count)
{
    (void)file, (void)from, (void)size, (void)count;
    return 0;
}

static size_t reader_tell(struct aiFile *file)
{
    return ((struct reader *)(void *)file->UserData)->at;
}

static size_t reader_size(struct aiFile *file)
{
    return ((struct reader *)(void *)file->UserData)->source->bytes;
}

static enum aiReturn reader_seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct reader *reader = (struct reader *)(void *)file->UserData;
    size_t size = reader->source->bytes;
    size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? reader->at : size;
    /* assimp may count back from the end and from here; unsigned wrap-around subtracts. */
    if (base + offset > size)
        return aiReturn_FAILURE;
    reader->at = base + offset;
    return aiReturn_SUCCESS;
}

static void reader_flush(struct aiFile *file)
{
    (void)file;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

/* assimp passes a path. Only its last part counts, which obj_file_check() has accepted. */
static struct aiFile *open_reader(struct aiFileIO *io, const char *path, const char *mode)
{
    struct models *models = (struct models *)(void *)io->UserData;
    struct error_text ignored; /* obj_file_check() has read the file before */
    struct reader *reader;
    const struct source *source;
    if (mode[0] != 'r')
        return NULL;
    source = find_file(models, base_name(path), &ignored);
    if (source == NULL || (reader = calloc(1, sizeof(*reader))) == NULL)
        return NULL;
    reader->source = source;
    reader->file = (struct aiFile){.ReadProc = reader_read,
                                   .WriteProc = reader_write,
                                   .TellProc = reader_tell,
                                   .FileSizeProc = reader_size,
                                   .SeekProc = reader_seek,
                                   .FlushProc = reader_flush,
                                   .UserData = (aiUserData)(void *)reader};
    return &reader->file;
}

static void close_reader(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    free(file->UserData);
}

/* A model while it is copied from assimp's scene. */
struct taking {
    struct models *models;
    const struct aiScene *scene;
    struct key_place place;
    struct model *model;
    uint32_t joints; /* used, that of the turret included */
    struct error_text *error;
};

static int take_vertices(struct taking *taking, const struct aiMesh *mesh)
{
    struct scenario *scenario = taking->models->scenario;
    void *table = scenario->vertices;
    if (mesh->mNumVertices > MODELS_VERTEX_MAX - taking->model->vertex_count)
        return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                "has too many vertices; allowed: up to %u", MODELS_VERTEX_MAX);
    struct model_vertex *vertex =
        table_extend(&table, &scenario->vertex_count, mesh->mNumVertices, sizeof(*vertex));
    if (vertex == NULL)
        return key_table_refuse(taking->error, taking->place, NULL, NULL, "no memory for it");
    scenario->vertices = table;
    taking->model->vertex_count += mesh->mNumVertices;
    for (uint32_t i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *from = &mesh->mVertices[i];
        vertex[i] = (struct model_vertex){from->x, from->y, from->z};
        if (!(fabsf(from->x) <= MODELS_EXTENT_MAX && fabsf(from->y) <= MODELS_EXTENT_MAX &&
              fabsf(from->z) <= MODELS_EXTENT_MAX))
            return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                    "vertex %u (%g, %g, %g) is out of range; allowed: -%g..%g m", i,
                                    (double)from->x, (double)from->y, (double)from->z,
                                    (double)MODELS_EXTENT_MAX, (double)MODELS_EXTENT_MAX);
    }
    return 0;
}

static uint8_t tint_of(const char *material)
{
    if (strcmp(material, "force") == 0)
        return MODEL_TINT_FORCE;
    if (strcmp(material, "paint") == 0)
        return MODEL_TINT_PAINT;
    return strncmp(material, "wash", 4) == 0 ? MODEL_TINT_WASH : 0;
}

/* Sets the colour and the tint of a mesh's triangles from its material. 0; -1 with the message. */
static int take_material(struct taking *taking, const struct aiMesh *mesh,
                         struct model_triangle *like)
{
    const struct aiMaterial *material = taking->scene->mMaterials[mesh->mMaterialIndex];
    struct aiString name = {0};
    struct aiColor4D color;
    if (aiGetMaterialString(material, AI_MATKEY_NAME, &name) != aiReturn_SUCCESS ||
        aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &color) != aiReturn_SUCCESS)
        return key_table_refuse(
            taking->error, taking->place, NULL, NULL,
            "has a material without a colour; right would be: Kd red green blue");
    if (!(color.r >= 0 && color.r <= 1 && color.g >= 0 && color.g <= 1 && color.b >= 0 &&
          color.b <= 1))
        return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                "material %s: Kd is out of range; allowed: 0..1", name.data);
    like->red = (uint8_t)lrintf(color.r * 255.0f);
    like->green = (uint8_t)lrintf(color.g * 255.0f);
    like->blue = (uint8_t)lrintf(color.b * 255.0f);
    like->force_tint = tint_of(name.data);
    return 0;
}

static int take_mesh(struct taking *taking, const struct aiMesh *mesh, struct model_triangle like)
{
    struct scenario *scenario = taking->models->scenario;
    uint32_t first = taking->model->vertex_count;
    void *table = scenario->triangles;
    if (take_material(taking, mesh, &like) != 0 || take_vertices(taking, mesh) != 0)
        return -1;
    if (mesh->mNumFaces > MODELS_TRIANGLE_MAX - taking->model->triangle_count)
        return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                "has too many triangles; allowed: up to %u", MODELS_TRIANGLE_MAX);
    struct model_triangle *triangle =
        table_extend(&table, &scenario->triangle_count, mesh->mNumFaces, sizeof(*triangle));
    if (triangle == NULL)
        return key_table_refuse(taking->error, taking->place, NULL, NULL, "no memory for it");
    scenario->triangles = table;
    taking->model->triangle_count += mesh->mNumFaces;
    for (uint32_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        triangle[i] = like;
        if (face->mNumIndices != 3)
            return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                    "has a face of %u corners; allowed: 3 or more",
                                    face->mNumIndices);
        for (int corner = 0; corner < 3; corner++) {
            if (face->mIndices[corner] >= mesh->mNumVertices)
                return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                        "has a face with vertex %u of %u", face->mIndices[corner],
                                        mesh->mNumVertices);
            triangle[i].vertex[corner] = first + face->mIndices[corner];
        }
    }
    return 0;
}

/* The part that an object's name means, without "_" and a number at its end; PART_COUNT: none. */
static uint32_t part_of(const char *name)
{
    size_t length = strlen(name), end = length;
    uint32_t part = 0;
    while (end > 0 && name[end - 1] >= '0' && name[end - 1] <= '9')
        end--;
    if (end < length && end > 0 && name[end - 1] == '_')
        length = end - 1;
    while (part < PART_COUNT &&
           (strncmp(name, part_names[part], length) != 0 || part_names[part][length] != '\0'))
        part++;
    return part;
}

/* The part that an object which only collides moves with; PART_COUNT: it is drawn. */
static uint32_t solid_part_of(const char *name)
{
    uint32_t part = 0;
    while (part < PART_COUNT && (solid_names[part] == NULL || strcmp(name, solid_names[part]) != 0))
        part++;
    return part;
}

/* Sets the part and the joint of an object's triangles. 0; -1 with the message. */
static int take_part(struct taking *taking, const struct aiNode *node, struct model_triangle *like)
{
    uint32_t part = part_of(node->mName.data);
    if (part == PART_COUNT)
        return key_table_refuse(
            taking->error, taking->place, NULL, NULL,
            "object %s: unknown part; allowed: body, turret, gun, rotor, "
            "tail_rotor, wheel, front_wheel, track, solid, solid_turret, solid_gun; "
            "\"_1\" and so on may follow",
            node->mName.data);
    like->part = (uint16_t)part;
    if (part == PART_BODY || part == PART_TURRET)
        return 0;
    if (taking->joints == MODEL_JOINTS_MAX)
        return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                "object %s: is one moving part too many; allowed: up to %u",
                                node->mName.data, MODEL_JOINTS_MAX - 1);
    like->joint = (uint16_t)taking->joints++;
    return 0;
}

/* Copies the meshes of a node and of the nodes below it. OBJ objects and groups are nodes of their
 * name below the root. solid: true copies the objects that only collide, false all others. */
static int take_node(struct taking *taking, const struct aiNode *node, bool solid, int depth)
{
    struct model_triangle like = {.part = PART_BODY};
    if (depth > NODE_DEPTH_MAX)
        return key_table_refuse(taking->error, taking->place, NULL, NULL, "is nested too deeply");
    uint32_t part = solid_part_of(node->mName.data);
    if (node->mNumMeshes > 0 && (part != PART_COUNT) == solid) {
        if (!solid && take_part(taking, node, &like) != 0)
            return -1;
        if (solid)
            like.part = (uint16_t)part;
        for (unsigned i = 0; i < node->mNumMeshes; i++) {
            if (take_mesh(taking, taking->scene->mMeshes[node->mMeshes[i]], like) != 0)
                return -1;
        }
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) {
        if (take_node(taking, node->mChildren[i], solid, depth + 1) != 0)
            return -1;
    }
    return 0;
}

/* Gives the triangles of the gun that only collide the joint of the gun that is drawn: a small
 * model is drawn as its solid. */
static void join_solid_gun(const struct scenario *scenario, const struct model *model)
{
    struct model_triangle *triangle = &scenario->triangles[model->first_triangle];
    uint32_t drawn = model->solid_triangles;
    while (drawn < model->triangle_count && triangle[drawn].part != PART_GUN)
        drawn++;
    for (uint32_t t = 0; drawn < model->triangle_count && t < model->solid_triangles; t++) {
        if (triangle[t].part == PART_GUN)
            triangle[t].joint = triangle[drawn].joint;
    }
}

static int take_scene(struct models *models, const struct aiScene *scene, const char *name,
                      struct key_place place, struct error_text *error)
{
    struct scenario *scenario = models->scenario;
    void *table = scenario->models;
    struct model *model = table_extend(&table, &scenario->model_count, 1, sizeof(*model));
    if (model == NULL)
        return key_table_refuse(error, place, NULL, NULL, "no memory for it");
    scenario->models = table;
    memset(model, 0, sizeof(*model));
    memcpy(model->name, name, strlen(name));
    model->first_vertex = scenario->vertex_count;
    model->first_triangle = scenario->triangle_count;
    struct taking taking = {models, scene, place, model, 1, error};
    if (take_node(&taking, scene->mRootNode, true, 0) != 0)
        return -1;
    model->solid_triangles = model->triangle_count;
    model->solid_vertices = model->vertex_count;
    if (take_node(&taking, scene->mRootNode, false, 0) != 0)
        return -1;
    if (model->triangle_count == model->solid_triangles)
        return key_table_refuse(error, place, NULL, NULL, "has no triangles");
    join_solid_gun(scenario, model);
    if (hulls_build(&models->hulls[scenario->model_count - 1], scenario, model, place, error) != 0)
        return -1;
    return (int)scenario->model_count - 1;
}

int models_find(struct models *models, const char *name, struct error_text *error)
{
    const struct scenario *scenario = models->scenario;
    struct aiFileIO io = {open_reader, close_reader, (aiUserData)(void *)models};
    char file[KIND_NAME_MAX + sizeof(".obj")];
    for (uint32_t i = 0; i < scenario->model_count; i++) {
        if (strcmp(scenario->models[i].name, name) == 0)
            return (int)i;
    }
    snprintf(file, sizeof(file), "%s.obj", name);
    const struct source *source = find_file(models, file, error);
    if (source == NULL)
        return -1;
    const struct key_place place = {source->path, 0};
    if (obj_file_check(source, find_file, models, error) != 0)
        return -1;
    memory_watch();
    const struct aiScene *scene =
        aiImportFileEx(source->path, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices, &io);
    if (memory_missed()) {
        aiReleaseImport(scene);
        return key_table_refuse(error, place, NULL, NULL, "no memory to read it");
    }
    if (scene == NULL)
        return key_table_refuse(error, place, NULL, NULL, "is not a model: %s", aiGetErrorString());
    int index = take_scene(models, scene, name, place, error);
    aiReleaseImport(scene);
    return index;
}
