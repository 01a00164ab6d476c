/* Checks Wavefront OBJ and MTL files line by line before assimp reads them. A model may use the
 * plain part of the formats only, so that assimp gets small and complete input, whatever the file
 * was. Reads no file but those that a model names. Start-up only. */
#ifndef JOLON_CONFIG_MESH_OBJ_FILE_H
#define JOLON_CONFIG_MESH_OBJ_FILE_H

#include "config/syntax/source.h"

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

/* Returns the text of a file in the folder of the model, which is read at most once; NULL with the
 * message. name: one word of a-z A-Z 0-9 . - _ that does not begin with a dot. */
typedef const struct source *obj_file_open(void *context, const char *name,
                                           struct error_text *error);

/* Checks an OBJ file and the MTL file that it names. 0; -1 with a message that names file, line,
 * word, value and what is allowed. */
int obj_file_check(const struct source *source, obj_file_open *open, void *context,
                   struct error_text *error);

#endif
