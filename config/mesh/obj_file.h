/* Reader of Wavefront OBJ and MTL files. A model may use the plain part of the formats only
 * (docs/scenario.md): anything else is refused with file, line, word, value and what is allowed.
 * Reads no file but those that a model names. Start-up only. */
#ifndef JOLON_CONFIG_MESH_OBJ_FILE_H
#define JOLON_CONFIG_MESH_OBJ_FILE_H

#include "config/syntax/source.h"
#include "world/model.h"

#include <stdbool.h>
#include <stdint.h>

#define OBJ_FILE_LINE_MAX      1023    /* characters */
#define OBJ_FILE_WORD_MAX      63      /* of a name */
#define OBJ_FILE_CORNERS_MAX   64u     /* of a face */
#define OBJ_FILE_VERTICES_MAX  65535u  /* v */
#define OBJ_FILE_DATA_MAX      262140u /* vt, and vn */
#define OBJ_FILE_TRIANGLES_MAX 65535u  /* a face of n corners is n - 2 */
#define OBJ_FILE_SECTIONS_MAX  1024u   /* o, g and usemtl */
#define OBJ_FILE_MATERIALS_MAX 256u
#define OBJ_FILE_EXTENT_MAX    1000.0 /* [m] of a vertex's coordinate */

typedef char obj_file_name[OBJ_FILE_WORD_MAX + 1];

struct obj_file_material {
    obj_file_name name;
    double kd[3]; /* red, green, blue, 0..1 */
    bool colored; /* it has a Kd */
};

struct obj_file_triangle {
    uint32_t corner[3]; /* index of vertex; of vertices at one place always the same one */
};

/* Faces that follow each other and are of one object and one material. */
struct obj_file_mesh {
    obj_file_name object;  /* of the last o or g before them */
    uint32_t material;     /* index of material; it is coloured */
    uint32_t first, count; /* triangles */
};

struct obj_file {
    struct model_vertex *vertex;
    struct obj_file_triangle *triangle;
    struct obj_file_mesh *mesh;
    struct obj_file_material *material;
    uint32_t vertices, triangles, meshes, materials; /* at least one triangle */
};

/* Returns the text of a file in the folder of the model, which is read at most once; NULL with the
 * message. name: one word of a-z A-Z 0-9 . - _ that does not begin with a dot. */
typedef const struct source *obj_file_open(void *context, const char *name,
                                           struct error_text *error);

/* Reads an OBJ file and the MTL file that it names. A face of more than three corners is cut into
 * triangles, ears first, which is right for every plain polygon. 0, and the caller frees *file;
 * -1 with the message, and nothing is to be freed. */
int obj_file_read(struct obj_file *file, const struct source *source, obj_file_open *open,
                  void *context, struct error_text *error);
void obj_file_free(struct obj_file *file);

#endif
