/* Splits lines into words, and reads each line by the rule of its first word. */
#include "config/mesh/obj_file.h"

#include "config/syntax/key_table.h"
#include "world/maths/maths.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define WORDS_MAX (1 + OBJ_FILE_CORNERS_MAX)

#define NUMBERS_MAX     3 /* of a line */
#define NUMBER_TEXT_MAX 31

#define NAME_CHARACTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_"

/* A word of a line, without a NUL at its end. */
struct word {
    const char *text;
    size_t length;
};

/* A file while it is read, and its current line. */
struct reading {
    struct obj_file *file;
    struct key_place place;
    struct error_text *error;
    struct word word[WORDS_MAX];
    uint32_t words;             /* may be above WORDS_MAX, which is too many for any rule */
    double number[NUMBERS_MAX]; /* of the last line of numbers */
    obj_file_open *open;
    void *context;
    bool library;         /* there was a line mtllib */
    obj_file_name object; /* of the last line o or g; "": there was none */
    uint32_t material;    /* of the last line usemtl; OBJ_FILE_MATERIALS_MAX: there was none */
    bool changed;         /* object or material since the last face */
    uint32_t textures, normals, sections;
};

/* The rule of a line by its first word. */
struct statement {
    const char *name;
    int (*read)(struct reading *reading);
};

/* Refuses word `index` of the line; 0: the whole line. */
static int refuse(const struct reading *reading, uint32_t index, const char *wrong)
{
    char name[OBJ_FILE_WORD_MAX + 1], value[OBJ_FILE_WORD_MAX + 1];
    snprintf(name, sizeof(name), "%.*s", (int)reading->word[0].length, reading->word[0].text);
    snprintf(value, sizeof(value), "%.*s", (int)reading->word[index].length,
             reading->word[index].text);
    return key_table_refuse(reading->error, reading->place, name, index > 0 ? value : NULL, "%s",
                            wrong);
}

static int refuse_many(const struct reading *reading, const char *what, uint32_t most)
{
    char wrong[80];
    snprintf(wrong, sizeof(wrong), "is one of too many %s; allowed: up to %u", what, most);
    return refuse(reading, 0, wrong);
}

/* --- words -------------------------------------------------------------------------------------*/

static bool is_word(const struct word *word, const char *text)
{
    return word->length == strlen(text) && memcmp(word->text, text, word->length) == 0;
}

static size_t digits(const char *text)
{
    return strspn(text, "0123456789");
}

/* Length of the number at the beginning of text, such as 1, -2.5 or +1.0e-3; 0: there is none.
 * Other readers of models do not accept every number of C, for example not .5. */
static size_t number_length(const char *text)
{
    size_t length = *text == '+' || *text == '-';
    size_t whole = digits(text + length);
    if (whole == 0)
        return 0;
    length += whole;
    if (text[length] == '.' && digits(text + length + 1) > 0)
        length += 1 + digits(text + length + 1);
    if (text[length] == 'e' || text[length] == 'E') {
        size_t sign = text[length + 1] == '+' || text[length + 1] == '-';
        if (digits(text + length + 1 + sign) > 0)
            length += 1 + sign + digits(text + length + 1 + sign);
    }
    return length;
}

static int read_number(struct reading *reading, uint32_t index, double low, double high)
{
    const struct word *word = &reading->word[index];
    char wrong[80];
    if (word->length > NUMBER_TEXT_MAX || number_length(word->text) != word->length)
        return refuse(reading, index, "is not a number; right would be: a number such as -1.25");
    const double value = strtod(word->text, NULL);
    reading->number[index - 1] = value;
    if (value >= low && value <= high)
        return 0;
    snprintf(wrong, sizeof(wrong), "out of range; allowed: %g..%g", low, high);
    return refuse(reading, index, wrong);
}

/* Reads the words after the first, which are `least` to `most` numbers. */
static int read_numbers(struct reading *reading, uint32_t least, uint32_t most, double low,
                        double high)
{
    char wrong[80];
    if (reading->words - 1 < least || reading->words - 1 > most) {
        snprintf(wrong, sizeof(wrong), "has %u numbers; allowed: %u..%u", reading->words - 1, least,
                 most);
        return refuse(reading, 0, wrong);
    }
    for (uint32_t i = 1; i < reading->words; i++) {
        if (read_number(reading, i, low, high) != 0)
            return -1;
    }
    return 0;
}

/* Copies the one name that follows the first word. */
static int take_name(const struct reading *reading, obj_file_name name)
{
    const struct word *word = &reading->word[1];
    if (reading->words != 2)
        return refuse(reading, 0, "needs one name; right would be: one word after it");
    if (word->length > OBJ_FILE_WORD_MAX || strspn(word->text, NAME_CHARACTERS) < word->length)
        return refuse(reading, 1, "is not a name; allowed: 1..63 of a-z A-Z 0-9 . - _");
    memcpy(name, word->text, word->length);
    name[word->length] = '\0';
    return 0;
}

/* --- lines -------------------------------------------------------------------------------------*/

/* Splits the line of this length into words. */
static void split(struct reading *reading, const char *line, size_t length)
{
    const char *end = line + length;
    reading->words = 0;
    for (;;) {
        while (line < end && (*line == ' ' || *line == '\t'))
            line++;
        if (line == end)
            return;
        const char *begin = line;
        while (line < end && *line != ' ' && *line != '\t')
            line++;
        if (reading->words < WORDS_MAX)
            reading->word[reading->words] = (struct word){begin, (size_t)(line - begin)};
        reading->words++;
    }
}

/* Refuses bytes that another reader could take for the end of a line or of the text, or for the
 * continuation of a line. */
static int check_bytes(const struct reading *reading, const char *line, size_t length)
{
    bool comment = line[strspn(line, " \t")] == '#';
    if (length > OBJ_FILE_LINE_MAX)
        return key_table_refuse(reading->error, reading->place, NULL, NULL,
                                "has a line of %zu characters; allowed: up to %d", length,
                                OBJ_FILE_LINE_MAX);
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)line[i];
        if ((c < 0x20 && c != '\t') || c == 0x7f || c == '\\' || (c > 0x7f && !comment))
            return key_table_refuse(
                reading->error, reading->place, NULL, NULL,
                "has a byte 0x%02x; allowed: printable ASCII except the backslash, and any "
                "letters in comments",
                c);
    }
    return 0;
}

static int read_line(struct reading *reading, const char *line, const struct statement *statements)
{
    if (reading->words == 0 || reading->word[0].text[0] == '#')
        return 0;
    if (reading->word[0].text != line)
        return refuse(reading, 0, "is indented; right would be: at the line's beginning");
    for (; statements->name != NULL; statements++) {
        if (is_word(&reading->word[0], statements->name))
            return statements->read(reading);
    }
    return refuse(reading, 0,
                  "is not supported in a model; docs/scenario.md lists the lines that are");
}

static int read_lines(struct reading *reading, const struct source *source,
                      const struct statement *statements)
{
    reading->place = (struct key_place){source->path, 0};
    if (strlen(source->text) != source->bytes)
        return key_table_refuse(reading->error, reading->place, NULL, NULL,
                                "is not text: it has a NUL byte");
    for (const char *line = source->text; *line != '\0';) {
        size_t whole = strcspn(line, "\n"), length = whole;
        if (line[whole] == '\n' && length > 0 && line[length - 1] == '\r')
            length--;
        reading->place.line++;
        if (check_bytes(reading, line, length) != 0)
            return -1;
        split(reading, line, length);
        if (read_line(reading, line, statements) != 0)
            return -1;
        line += whole + (line[whole] == '\n');
    }
    return 0;
}

/* --- materials ---------------------------------------------------------------------------------*/

static uint32_t find_material(const struct obj_file *file, const char *name)
{
    uint32_t i = 0;
    while (i < file->materials && strcmp(file->material[i].name, name) != 0)
        i++;
    return i;
}

static int read_newmtl(struct reading *reading)
{
    struct obj_file *file = reading->file;
    obj_file_name name;
    if (take_name(reading, name) != 0)
        return -1;
    if (file->materials == OBJ_FILE_MATERIALS_MAX)
        return refuse_many(reading, "materials", OBJ_FILE_MATERIALS_MAX);
    if (find_material(file, name) < file->materials)
        return refuse(reading, 1, "is another material's name too; allowed: each name once");
    memcpy(file->material[file->materials++].name, name, sizeof(name));
    return 0;
}

static int read_color(struct reading *reading)
{
    struct obj_file *file = reading->file;
    if (file->materials == 0)
        return refuse(reading, 0, "stands before any newmtl");
    if (read_numbers(reading, 3, 3, 0.0, 1.0) != 0)
        return -1;
    if (is_word(&reading->word[0], "Kd")) {
        struct obj_file_material *material = &file->material[file->materials - 1];
        material->colored = true;
        for (uint32_t i = 0; i < 3; i++)
            material->kd[i] = reading->number[i];
    }
    return 0;
}

static int read_shine(struct reading *reading)
{
    if (reading->file->materials == 0)
        return refuse(reading, 0, "stands before any newmtl");
    return read_numbers(reading, 1, 1, 0.0, 1000.0);
}

static int read_library(struct obj_file *file, const struct source *source,
                        struct error_text *error)
{
    static const struct statement statements[] = {
        {"newmtl", read_newmtl}, {"Kd", read_color},    {"Ka", read_color}, {"Ks", read_color},
        {"Ke", read_color},      {"Tf", read_color},    {"Ns", read_shine}, {"Ni", read_shine},
        {"d", read_shine},       {"illum", read_shine}, {NULL, NULL}};
    struct reading reading = {.error = error, .file = file};
    return read_lines(&reading, source, statements);
}

static int read_mtllib(struct reading *reading)
{
    obj_file_name name = "";
    if (reading->library)
        return refuse(reading, 0, "stands twice; allowed: once");
    if (take_name(reading, name) != 0)
        return -1;
    if (name[0] == '.')
        return refuse(reading, 1, "is not a file's name; allowed: a file of this folder");
    const struct source *source = reading->open(reading->context, name, reading->error);
    if (source == NULL || read_library(reading->file, source, reading->error) != 0)
        return -1;
    reading->library = true;
    return 0;
}

/* --- shapes ------------------------------------------------------------------------------------*/

static int read_vertex(struct reading *reading)
{
    struct obj_file *file = reading->file;
    if (file->vertices == OBJ_FILE_VERTICES_MAX)
        return refuse_many(reading, "vertices", OBJ_FILE_VERTICES_MAX);
    if (read_numbers(reading, 3, 3, -OBJ_FILE_EXTENT_MAX, OBJ_FILE_EXTENT_MAX) != 0)
        return -1;
    file->vertex[file->vertices++] = (struct model_vertex){
        (float)reading->number[0], (float)reading->number[1], (float)reading->number[2]};
    return 0;
}

static int read_texture(struct reading *reading)
{
    if (reading->textures++ == OBJ_FILE_DATA_MAX)
        return refuse_many(reading, "texture places", OBJ_FILE_DATA_MAX);
    return read_numbers(reading, 2, 3, -1e6, 1e6);
}

static int read_normal(struct reading *reading)
{
    if (reading->normals++ == OBJ_FILE_DATA_MAX)
        return refuse_many(reading, "normals", OBJ_FILE_DATA_MAX);
    return read_numbers(reading, 3, 3, -1e6, 1e6);
}

static int read_smooth(struct reading *reading)
{
    return reading->words == 2 ? 0 : refuse(reading, 0, "needs one word; allowed: off, 0, 1 ...");
}

/* Reads the name of an object, a group or a material. */
static int read_section(struct reading *reading, obj_file_name name)
{
    reading->changed = true;
    if (reading->sections++ == OBJ_FILE_SECTIONS_MAX)
        return refuse_many(reading, "objects, groups and changes of material",
                           OBJ_FILE_SECTIONS_MAX);
    return take_name(reading, name);
}

static int read_object(struct reading *reading)
{
    return read_section(reading, reading->object);
}

static int read_usemtl(struct reading *reading)
{
    const struct obj_file *file = reading->file;
    obj_file_name name;
    if (read_section(reading, name) != 0)
        return -1;
    reading->material = find_material(file, name);
    if (reading->material == file->materials || !file->material[reading->material].colored)
        return refuse(reading, 1,
                      "unknown material; right would be: one with a Kd in the file of mtllib");
    return 0;
}

/* --- faces -------------------------------------------------------------------------------------*/

/* Reads a whole number of 1..count at *at and moves *at behind it; 0: there is none. */
static uint32_t take_index(const char **at, const char *end, uint32_t count)
{
    uint32_t value = 0;
    for (int digits = 0; *at < end && **at >= '0' && **at <= '9' && digits < 7; ++*at, digits++)
        value = value * 10 + (uint32_t)(**at - '0');
    return value <= count ? value : 0;
}

/* Returns the vertex, from 1, of v, v/vt, v//vn or v/vt/vn, with the indices of earlier lines; 0:
 * it is something else. */
static uint32_t corner_of(const struct reading *reading, const struct word *word)
{
    const char *at = word->text, *end = at + word->length;
    const uint32_t vertex = take_index(&at, end, reading->file->vertices);
    if (vertex == 0 || at == end)
        return vertex;
    if (*at++ != '/')
        return 0;
    if ((at == end || *at != '/') && take_index(&at, end, reading->textures) == 0)
        return 0;
    if (at == end)
        return vertex;
    return *at++ == '/' && take_index(&at, end, reading->normals) != 0 && at == end ? vertex : 0;
}

static struct vec3 place_of(const struct obj_file *file, uint32_t vertex)
{
    const struct model_vertex *v = &file->vertex[vertex];
    return (struct vec3){(double)v->x, (double)v->y, (double)v->z};
}

/* Returns the normal of a polygon, as long as twice its area (Newell). */
static struct vec3 normal_of(const struct obj_file *file, const uint32_t *corner, uint32_t count)
{
    const struct vec3 first = place_of(file, corner[0]);
    struct vec3 normal = {0};
    for (uint32_t i = 1; i + 1 < count; i++)
        normal = vec3_add(normal, vec3_cross(vec3_sub(place_of(file, corner[i]), first),
                                             vec3_sub(place_of(file, corner[i + 1]), first)));
    return normal;
}

/* Returns true if a point is to the left of the way from a to b, or on it, seen from where the
 * normal points. */
static bool is_left(struct vec3 normal, struct vec3 a, struct vec3 b, struct vec3 point)
{
    return vec3_dot(normal, vec3_cross(vec3_sub(b, a), vec3_sub(point, a))) >= 0.0;
}

/* Returns true if the corner `tip` of a polygon sticks out, and no other corner is in the triangle
 * of it and its neighbours. */
static bool is_ear(const struct obj_file *file, const uint32_t *corner, uint32_t count,
                   uint32_t tip, struct vec3 normal)
{
    const uint32_t a = corner[tip - 1], b = corner[tip], c = corner[(tip + 1) % count];
    const struct vec3 from = place_of(file, a), at = place_of(file, b), to = place_of(file, c);
    if (is_left(normal, at, from, to)) /* it does not turn left there */
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const struct vec3 other = place_of(file, corner[i]);
        if (corner[i] != a && corner[i] != b && corner[i] != c &&
            is_left(normal, from, at, other) && is_left(normal, at, to, other) &&
            is_left(normal, to, from, other))
            return false;
    }
    return true;
}

static void add_triangle(struct reading *reading, uint32_t a, uint32_t b, uint32_t c)
{
    struct obj_file *file = reading->file;
    if (reading->changed) {
        struct obj_file_mesh *mesh = &file->mesh[file->meshes++];
        memcpy(mesh->object, reading->object, sizeof(mesh->object));
        mesh->material = reading->material;
        mesh->first = file->triangles;
        mesh->count = 0;
        reading->changed = false;
    }
    file->mesh[file->meshes - 1].count++;
    file->triangle[file->triangles++] = (struct obj_file_triangle){{a, b, c}};
}

/* Returns the corner of an ear; in a face that is no plain polygon any corner. Of each polygon two
 * corners that are not neighbours are ears, so the first one need not be looked at. */
static uint32_t find_ear(const struct obj_file *file, const uint32_t *corner, uint32_t count,
                         struct vec3 normal)
{
    for (uint32_t tip = 1; tip < count; tip++) {
        if (is_ear(file, corner, count, tip, normal))
            return tip;
    }
    return 1;
}

/* Cuts ears off until a triangle is left. */
static void add_face(struct reading *reading, uint32_t *corner, uint32_t count)
{
    const struct vec3 normal = normal_of(reading->file, corner, count);
    while (count > 3) {
        const uint32_t tip = find_ear(reading->file, corner, count, normal);
        add_triangle(reading, corner[tip - 1], corner[tip], corner[(tip + 1) % count]);
        memmove(&corner[tip], &corner[tip + 1], (count - tip - 1) * sizeof(*corner));
        count--;
    }
    add_triangle(reading, corner[0], corner[1], corner[2]);
}

static int read_face(struct reading *reading)
{
    const uint32_t corners = reading->words - 1;
    uint32_t corner[OBJ_FILE_CORNERS_MAX];
    char wrong[80];
    if (corners < 3 || corners > OBJ_FILE_CORNERS_MAX) {
        snprintf(wrong, sizeof(wrong), "has %u corners; allowed: 3..%u", corners,
                 OBJ_FILE_CORNERS_MAX);
        return refuse(reading, 0, wrong);
    }
    if (reading->material == OBJ_FILE_MATERIALS_MAX)
        return refuse(reading, 0, "has no material; right would be: usemtl NAME before it");
    if (corners - 2 > OBJ_FILE_TRIANGLES_MAX - reading->file->triangles)
        return refuse_many(reading, "triangles", OBJ_FILE_TRIANGLES_MAX);
    for (uint32_t i = 0; i < corners; i++) {
        const uint32_t vertex = corner_of(reading, &reading->word[1 + i]);
        if (vertex == 0) {
            snprintf(wrong, sizeof(wrong),
                     "is not a corner; allowed: 1..%u, the vertices before it",
                     reading->file->vertices);
            return refuse(reading, 1 + i, wrong);
        }
        corner[i] = vertex - 1;
    }
    if (reading->object[0] == '\0')
        return refuse(reading, 0, "is of no object; right would be: o NAME before it");
    add_face(reading, corner, corners);
    return 0;
}

/* --- files -------------------------------------------------------------------------------------*/

static int compare_places(const void *a, const void *b, void *context)
{
    const struct model_vertex *vertex = context;
    const uint32_t i = *(const uint32_t *)a, k = *(const uint32_t *)b;
    const struct model_vertex *p = &vertex[i], *q = &vertex[k];
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    if (p->z != q->z)
        return p->z < q->z ? -1 : 1;
    return i < k ? -1 : i > k;
}

static bool is_same_place(const struct model_vertex *p, const struct model_vertex *q)
{
    return p->x == q->x && p->y == q->y && p->z == q->z;
}

/* Makes corners at one place the same vertex, the first one there. 0; -1: no memory. */
static int join_vertices(struct obj_file *file)
{
    uint32_t *order = calloc(2 * (size_t)file->vertices, sizeof(*order));
    if (order == NULL)
        return -1;
    uint32_t *first = order + file->vertices;
    for (uint32_t i = 0; i < file->vertices; i++)
        order[i] = i;
    qsort_r(order, file->vertices, sizeof(*order), compare_places, file->vertex);
    for (uint32_t i = 0; i < file->vertices; i++) {
        const bool same =
            i > 0 && is_same_place(&file->vertex[order[i - 1]], &file->vertex[order[i]]);
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    for (uint32_t t = 0; t < file->triangles; t++) {
        for (int c = 0; c < 3; c++)
            file->triangle[t].corner[c] = first[file->triangle[t].corner[c]];
    }
    free(order);
    return 0;
}

/* Takes memory for as much as a file of this size can hold. */
static bool take_memory(struct obj_file *file, size_t bytes)
{
    const size_t vertices = bytes / strlen("v 0 0 0") + 1, triangles = bytes / strlen(" 1") + 1;
    *file = (struct obj_file){0};
    file->vertex = calloc(vertices < OBJ_FILE_VERTICES_MAX ? vertices : OBJ_FILE_VERTICES_MAX,
                          sizeof(*file->vertex));
    file->triangle = calloc(triangles < OBJ_FILE_TRIANGLES_MAX ? triangles : OBJ_FILE_TRIANGLES_MAX,
                            sizeof(*file->triangle));
    file->mesh = calloc(OBJ_FILE_SECTIONS_MAX, sizeof(*file->mesh));
    file->material = calloc(OBJ_FILE_MATERIALS_MAX, sizeof(*file->material));
    return file->vertex && file->triangle && file->mesh && file->material;
}

static int refuse_memory(const struct source *source, struct error_text *error)
{
    return key_table_refuse(error, (struct key_place){source->path, 0}, NULL, NULL,
                            "no memory to read it");
}

int obj_file_read(struct obj_file *file, const struct source *source, obj_file_open *open,
                  void *context, struct error_text *error)
{
    static const struct statement statements[] = {
        {"v", read_vertex},      {"vt", read_texture}, {"vn", read_normal}, {"f", read_face},
        {"o", read_object},      {"g", read_object},   {"s", read_smooth},  {"usemtl", read_usemtl},
        {"mtllib", read_mtllib}, {NULL, NULL}};
    const struct key_place place = {source->path, 0};
    struct reading reading = {.file = file,
                              .error = error,
                              .open = open,
                              .context = context,
                              .material = OBJ_FILE_MATERIALS_MAX};
    int result = take_memory(file, source->bytes) ? read_lines(&reading, source, statements)
                                                  : refuse_memory(source, error);
    if (result == 0 && file->triangles == 0)
        result =
            key_table_refuse(error, place, NULL, NULL, "has no faces; right would be: f 1 2 3");
    if (result == 0 && join_vertices(file) != 0)
        result = refuse_memory(source, error);
    if (result != 0)
        obj_file_free(file);
    return result;
}

void obj_file_free(struct obj_file *file)
{
    free(file->vertex);
    free(file->triangle);
    free(file->mesh);
    free(file->material);
    *file = (struct obj_file){0};
}
