/* Makes the tables of models from the files that config/mesh/obj_file.h reads. */
#include "config/mesh/models.h"

#include "config/syntax/key_table.h"
#include "config/syntax/table.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* A model while it is copied from its file. */
struct taking {
    struct scenario *scenario;
    const struct obj_file *file;
    uint32_t *vertex; /* of each of the file, that of the model + 1; 0: none yet */
    struct key_place place;
    struct model *model;
    uint32_t joints; /* used, that of the turret included */
    struct error_text *error;
};

static int lacks_memory(const struct taking *taking)
{
    return key_table_refuse(taking->error, taking->place, NULL, NULL, "no memory for it");
}

/* Returns the model's vertex, from 1, for one of the file; 0 with the message. Each mesh, whose
 * vertices are from `first` on, has vertices of its own. */
static uint32_t take_vertex(struct taking *taking, uint32_t vertex, uint32_t first)
{
    struct scenario *scenario = taking->scenario;
    const struct model_vertex *from = &taking->file->vertex[vertex];
    void *table = scenario->vertices;
    if (taking->vertex[vertex] > first)
        return taking->vertex[vertex];
    if (taking->model->vertex_count == MODELS_VERTEX_MAX) {
        key_table_refuse(taking->error, taking->place, NULL, NULL,
                         "has too many vertices; allowed: up to %u", MODELS_VERTEX_MAX);
        return 0;
    }
    struct model_vertex *to = table_extend(&table, &scenario->vertex_count, 1, sizeof(*to));
    if (to == NULL) {
        (void)lacks_memory(taking);
        return 0;
    }
    scenario->vertices = table;
    *to = *from;
    return taking->vertex[vertex] = ++taking->model->vertex_count;
}

static uint8_t tint_of(const char *material)
{
    if (strcmp(material, "force") == 0)
        return MODEL_TINT_FORCE;
    if (strcmp(material, "paint") == 0)
        return MODEL_TINT_PAINT;
    return strncmp(material, "wash", 4) == 0 ? MODEL_TINT_WASH : 0;
}

/* Copies a mesh. 0; -1 with the message. */
static int take_mesh(struct taking *taking, const struct obj_file_mesh *mesh,
                     struct model_triangle like)
{
    struct scenario *scenario = taking->scenario;
    const struct obj_file_material *material = &taking->file->material[mesh->material];
    const uint32_t first = taking->model->vertex_count;
    void *table = scenario->triangles;
    struct model_triangle *triangle =
        table_extend(&table, &scenario->triangle_count, mesh->count, sizeof(*triangle));
    if (triangle == NULL)
        return lacks_memory(taking);
    scenario->triangles = table;
    taking->model->triangle_count += mesh->count;
    like.red = (uint8_t)lrint(material->kd[0] * 255.0);
    like.green = (uint8_t)lrint(material->kd[1] * 255.0);
    like.blue = (uint8_t)lrint(material->kd[2] * 255.0);
    like.force_tint = tint_of(material->name);
    for (uint32_t i = 0; i < mesh->count; i++) {
        triangle[i] = like;
        for (int corner = 0; corner < 3; corner++) {
            const uint32_t from = taking->file->triangle[mesh->first + i].corner[corner];
            const uint32_t vertex = take_vertex(taking, from, first);
            if (vertex == 0)
                return -1;
            triangle[i].vertex[corner] = vertex - 1;
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
static int take_part(struct taking *taking, const char *object, struct model_triangle *like)
{
    uint32_t part = part_of(object);
    if (part == PART_COUNT)
        return key_table_refuse(
            taking->error, taking->place, NULL, NULL,
            "object %s: unknown part; allowed: body, turret, gun, rotor, "
            "tail_rotor, wheel, front_wheel, track, solid, solid_turret, solid_gun; "
            "\"_1\" and so on may follow",
            object);
    like->part = (uint16_t)part;
    if (part == PART_BODY || part == PART_TURRET)
        return 0;
    if (taking->joints == MODEL_JOINTS_MAX)
        return key_table_refuse(taking->error, taking->place, NULL, NULL,
                                "object %s: is one moving part too many; allowed: up to %u", object,
                                MODEL_JOINTS_MAX - 1);
    like->joint = (uint16_t)taking->joints++;
    return 0;
}

/* Copies the meshes of the object of mesh m, which is its first one. */
static int take_object(struct taking *taking, uint32_t m, struct model_triangle like)
{
    const struct obj_file_mesh *mesh = taking->file->mesh;
    for (uint32_t i = m; i < taking->file->meshes; i++) {
        if (strcmp(mesh[i].object, mesh[m].object) == 0 && take_mesh(taking, &mesh[i], like) != 0)
            return -1;
    }
    return 0;
}

/* Returns true if an earlier mesh is of the same object. */
static bool is_of_earlier(const struct obj_file *file, uint32_t m)
{
    uint32_t i = 0;
    while (strcmp(file->mesh[i].object, file->mesh[m].object) != 0)
        i++;
    return i < m;
}

/* Copies the objects in their order. solid: true copies those that only collide, false all others.
 * 0; -1 with the message. */
static int take_objects(struct taking *taking, bool solid)
{
    for (uint32_t m = 0; m < taking->file->meshes; m++) {
        const char *object = taking->file->mesh[m].object;
        const uint32_t part = solid_part_of(object);
        struct model_triangle like = {.part = (uint16_t)part};
        if ((part != PART_COUNT) != solid || is_of_earlier(taking->file, m))
            continue;
        if ((!solid && take_part(taking, object, &like) != 0) || take_object(taking, m, like) != 0)
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

/* Adds a model to the scenario. vertex: as in struct taking. Returns its index, or -1 with the
 * message. */
static int take_model(struct models *models, const struct obj_file *file, uint32_t *vertex,
                      const char *name, struct key_place place, struct error_text *error)
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
    struct taking taking = {scenario, file, vertex, place, model, 1, error};
    if (take_objects(&taking, true) != 0)
        return -1;
    model->solid_triangles = model->triangle_count;
    model->solid_vertices = model->vertex_count;
    if (take_objects(&taking, false) != 0)
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
    char file_name[KIND_NAME_MAX + sizeof(".obj")];
    struct obj_file file;
    int index = -1;
    for (uint32_t i = 0; i < scenario->model_count; i++) {
        if (strcmp(scenario->models[i].name, name) == 0)
            return (int)i;
    }
    snprintf(file_name, sizeof(file_name), "%s.obj", name);
    const struct source *source = find_file(models, file_name, error);
    if (source == NULL || obj_file_read(&file, source, find_file, models, error) != 0)
        return -1;
    const struct key_place place = {source->path, 0};
    uint32_t *vertex = calloc(file.vertices, sizeof(*vertex));
    if (vertex == NULL)
        key_table_refuse(error, place, NULL, NULL, "no memory for it");
    else
        index = take_model(models, &file, vertex, name, place, error);
    free(vertex);
    obj_file_free(&file);
    return index;
}
