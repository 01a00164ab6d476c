/* Splits lines into words, and checks each line by the rule of its first word. */
#include "config/mesh/obj_file.h"

#include "config/syntax/key_table.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define WORDS_MAX (1 + OBJ_FILE_CORNERS_MAX)

#define NUMBER_TEXT_MAX 31

#define NAME_CHARACTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_"

/* A word of a line, without a NUL at its end. */
struct word {
    const char *text;
    size_t length;
};

struct materials {
    char name[OBJ_FILE_MATERIALS_MAX][OBJ_FILE_WORD_MAX + 1];
    bool colored[OBJ_FILE_MATERIALS_MAX]; /* it has a Kd */
    uint32_t count;
};

/* A file while it is checked, and its current line. */
struct checking {
    struct key_place place;
    struct error_text *error;
    struct word word[WORDS_MAX];
    uint32_t words; /* may be above WORDS_MAX, which is too many for any rule */
    obj_file_open *open;
    void *context;
    struct materials *materials; /* of the file that mtllib names */
    bool library, chosen;        /* there was a line mtllib, usemtl */
    uint32_t vertices, textures, normals, triangles, sections;
};

/* The rule of a line by its first word. */
struct statement {
    const char *name;
    int (*check)(struct checking *checking);
};

/* Refuses word `index` of the line; 0: the whole line. */
static int refuse(const struct checking *checking, uint32_t index, const char *wrong)
{
    char name[OBJ_FILE_WORD_MAX + 1], value[OBJ_FILE_WORD_MAX + 1];
    snprintf(name, sizeof(name), "%.*s", (int)checking->word[0].length, checking->word[0].text);
    snprintf(value, sizeof(value), "%.*s", (int)checking->word[index].length,
             checking->word[index].text);
    return key_table_refuse(checking->error, checking->place, name, index > 0 ? value : NULL, "%s",
                            wrong);
}

static int refuse_many(const struct checking *checking, const char *what, uint32_t most)
{
    char wrong[80];
    snprintf(wrong, sizeof(wrong), "is one of too many %s; allowed: up to %u", what, most);
    return refuse(checking, 0, wrong);
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
 * assimp does not accept every number of C, for example not .5. */
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

static int check_number(const struct checking *checking, uint32_t index, double low, double high)
{
    const struct word *word = &checking->word[index];
    char wrong[80];
    if (word->length > NUMBER_TEXT_MAX || number_length(word->text) != word->length)
        return refuse(checking, index, "is not a number; right would be: a number such as -1.25");
    double value = strtod(word->text, NULL);
    if (value >= low && value <= high)
        return 0;
    snprintf(wrong, sizeof(wrong), "out of range; allowed: %g..%g", low, high);
    return refuse(checking, index, wrong);
}

/* Checks that the words after the first are numbers, `least` to `most` of them. */
static int check_numbers(const struct checking *checking, uint32_t least, uint32_t most, double low,
                         double high)
{
    char wrong[80];
    if (checking->words - 1 < least || checking->words - 1 > most) {
        snprintf(wrong, sizeof(wrong), "has %u numbers; allowed: %u..%u", checking->words - 1,
                 least, most);
        return refuse(checking, 0, wrong);
    }
    for (uint32_t i = 1; i < checking->words; i++) {
        if (check_number(checking, i, low, high) != 0)
            return -1;
    }
    return 0;
}

/* Copies the one name that follows the first word. */
static int take_name(const struct checking *checking, char name[OBJ_FILE_WORD_MAX + 1])
{
    const struct word *word = &checking->word[1];
    if (checking->words != 2)
        return refuse(checking, 0, "needs one name; right would be: one word after it");
    if (word->length > OBJ_FILE_WORD_MAX || strspn(word->text, NAME_CHARACTERS) < word->length)
        return refuse(checking, 1, "is not a name; allowed: 1..63 of a-z A-Z 0-9 . - _");
    memcpy(name, word->text, word->length);
    name[word->length] = '\0';
    return 0;
}

/* --- lines -------------------------------------------------------------------------------------*/

/* Splits the line of this length into words. */
static void split(struct checking *checking, const char *line, size_t length)
{
    const char *end = line + length;
    checking->words = 0;
    for (;;) {
        while (line < end && (*line == ' ' || *line == '\t'))
            line++;
        if (line == end)
            return;
        const char *begin = line;
        while (line < end && *line != ' ' && *line != '\t')
            line++;
        if (checking->words < WORDS_MAX)
            checking->word[checking->words] = (struct word){begin, (size_t)(line - begin)};
        checking->words++;
    }
}

/* Refuses bytes that assimp could take for the end of a line or of the text, or for the
 * continuation of a line, so that both readers see the same lines. */
static int check_bytes(const struct checking *checking, const char *line, size_t length)
{
    bool comment = line[strspn(line, " \t")] == '#';
    if (length > OBJ_FILE_LINE_MAX)
        return key_table_refuse(checking->error, checking->place, NULL, NULL,
                                "has a line of %zu characters; allowed: up to %d", length,
                                OBJ_FILE_LINE_MAX);
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)line[i];
        if ((c < 0x20 && c != '\t') || c == 0x7f || c == '\\' || (c > 0x7f && !comment))
            return key_table_refuse(
                checking->error, checking->place, NULL, NULL,
                "has a byte 0x%02x; allowed: printable ASCII except the backslash, and any "
                "letters in comments",
                c);
    }
    return 0;
}

static int check_line(struct checking *checking, const char *line,
                      const struct statement *statements)
{
    if (checking->words == 0 || checking->word[0].text[0] == '#')
        return 0;
    if (checking->word[0].text != line) /* assimp would skip the line */
        return refuse(checking, 0, "is indented; right would be: at the line's beginning");
    for (; statements->name != NULL; statements++) {
        if (is_word(&checking->word[0], statements->name))
            return statements->check(checking);
    }
    return refuse(checking, 0,
                  "is not supported in a model; docs/scenario.md lists the lines that are");
}

static int check_lines(struct checking *checking, const struct source *source,
                       const struct statement *statements)
{
    checking->place = (struct key_place){source->path, 0};
    if (strlen(source->text) != source->bytes)
        return key_table_refuse(checking->error, checking->place, NULL, NULL,
                                "is not text: it has a NUL byte");
    for (const char *line = source->text; *line != '\0';) {
        size_t whole = strcspn(line, "\n"), length = whole;
        if (line[whole] == '\n' && length > 0 && line[length - 1] == '\r')
            length--;
        checking->place.line++;
        if (check_bytes(checking, line, length) != 0)
            return -1;
        split(checking, line, length);
        if (check_line(checking, line, statements) != 0)
            return -1;
        line += whole + (line[whole] == '\n');
    }
    return 0;
}

/* --- materials ---------------------------------------------------------------------------------*/

static int find_material(const struct materials *materials, const char *name)
{
    for (uint32_t i = 0; i < materials->count; i++) {
        if (strcmp(materials->name[i], name) == 0)
            return (int)i;
    }
    return -1;
}

static int check_newmtl(struct checking *checking)
{
    struct materials *materials = checking->materials;
    char name[OBJ_FILE_WORD_MAX + 1];
    if (take_name(checking, name) != 0)
        return -1;
    if (materials->count == OBJ_FILE_MATERIALS_MAX)
        return refuse_many(checking, "materials", OBJ_FILE_MATERIALS_MAX);
    if (find_material(materials, name) >= 0)
        return refuse(checking, 1, "is another material's name too; allowed: each name once");
    memcpy(materials->name[materials->count++], name, sizeof(name));
    return 0;
}

static int check_color(struct checking *checking)
{
    struct materials *materials = checking->materials;
    if (materials->count == 0)
        return refuse(checking, 0, "stands before any newmtl");
    if (check_numbers(checking, 3, 3, 0.0, 1.0) != 0)
        return -1;
    if (is_word(&checking->word[0], "Kd"))
        materials->colored[materials->count - 1] = true;
    return 0;
}

static int check_shine(struct checking *checking)
{
    if (checking->materials->count == 0)
        return refuse(checking, 0, "stands before any newmtl");
    return check_numbers(checking, 1, 1, 0.0, 1000.0);
}

static int check_library(struct materials *materials, const struct source *source,
                         struct error_text *error)
{
    static const struct statement statements[] = {
        {"newmtl", check_newmtl}, {"Kd", check_color},    {"Ka", check_color}, {"Ks", check_color},
        {"Ke", check_color},      {"Tf", check_color},    {"Ns", check_shine}, {"Ni", check_shine},
        {"d", check_shine},       {"illum", check_shine}, {NULL, NULL}};
    struct checking checking = {.error = error, .materials = materials};
    return check_lines(&checking, source, statements);
}

static int check_mtllib(struct checking *checking)
{
    char name[OBJ_FILE_WORD_MAX + 1] = "";
    if (checking->library)
        return refuse(checking, 0, "stands twice; allowed: once");
    if (take_name(checking, name) != 0)
        return -1;
    if (name[0] == '.')
        return refuse(checking, 1, "is not a file's name; allowed: a file of this folder");
    const struct source *source = checking->open(checking->context, name, checking->error);
    if (source == NULL || check_library(checking->materials, source, checking->error) != 0)
        return -1;
    checking->library = true;
    return 0;
}

/* --- shapes ------------------------------------------------------------------------------------*/

static int check_vertex(struct checking *checking)
{
    if (checking->vertices++ == OBJ_FILE_VERTICES_MAX)
        return refuse_many(checking, "vertices", OBJ_FILE_VERTICES_MAX);
    return check_numbers(checking, 3, 3, -OBJ_FILE_EXTENT_MAX, OBJ_FILE_EXTENT_MAX);
}

static int check_texture(struct checking *checking)
{
    if (checking->textures++ == OBJ_FILE_DATA_MAX)
        return refuse_many(checking, "texture places", OBJ_FILE_DATA_MAX);
    return check_numbers(checking, 2, 3, -1e6, 1e6);
}

static int check_normal(struct checking *checking)
{
    if (checking->normals++ == OBJ_FILE_DATA_MAX)
        return refuse_many(checking, "normals", OBJ_FILE_DATA_MAX);
    return check_numbers(checking, 3, 3, -1e6, 1e6);
}

static int check_smooth(struct checking *checking)
{
    return checking->words == 2 ? 0 : refuse(checking, 0, "needs one word; allowed: off, 0, 1 ...");
}

static int check_section(struct checking *checking)
{
    char name[OBJ_FILE_WORD_MAX + 1];
    if (checking->sections++ == OBJ_FILE_SECTIONS_MAX)
        return refuse_many(checking, "objects, groups and changes of material",
                           OBJ_FILE_SECTIONS_MAX);
    return take_name(checking, name);
}

/* The material must exist: assimp would give triangles without one the colour of another. */
static int check_usemtl(struct checking *checking)
{
    char name[OBJ_FILE_WORD_MAX + 1];
    if (check_section(checking) != 0 || take_name(checking, name) != 0)
        return -1;
    int index = find_material(checking->materials, name);
    if (index < 0 || !checking->materials->colored[index])
        return refuse(checking, 1,
                      "unknown material; right would be: one with a Kd in the file of mtllib");
    checking->chosen = true;
    return 0;
}

/* Reads a whole number of 1..count at *at and moves *at behind it; false: there is none. */
static bool take_index(const char **at, const char *end, uint32_t count)
{
    uint32_t value = 0;
    int digits = 0;
    for (; *at < end && **at >= '0' && **at <= '9' && digits < 7; ++*at, digits++)
        value = value * 10 + (uint32_t)(**at - '0');
    return digits > 0 && value >= 1 && value <= count;
}

/* Returns true for v, v/vt, v//vn or v/vt/vn, with the indices of earlier lines. */
static bool is_corner(const struct checking *checking, const struct word *word)
{
    const char *at = word->text, *end = at + word->length;
    if (!take_index(&at, end, checking->vertices))
        return false;
    if (at == end)
        return true;
    if (*at++ != '/')
        return false;
    if ((at == end || *at != '/') && !take_index(&at, end, checking->textures))
        return false;
    if (at == end)
        return true;
    return *at++ == '/' && take_index(&at, end, checking->normals) && at == end;
}

static int check_face(struct checking *checking)
{
    uint32_t corners = checking->words - 1;
    char wrong[80];
    if (corners < 3 || corners > OBJ_FILE_CORNERS_MAX) {
        snprintf(wrong, sizeof(wrong), "has %u corners; allowed: 3..%u", corners,
                 OBJ_FILE_CORNERS_MAX);
        return refuse(checking, 0, wrong);
    }
    if (!checking->chosen)
        return refuse(checking, 0, "has no material; right would be: usemtl NAME before it");
    checking->triangles += corners - 2;
    if (checking->triangles > OBJ_FILE_TRIANGLES_MAX)
        return refuse_many(checking, "triangles", OBJ_FILE_TRIANGLES_MAX);
    for (uint32_t i = 1; i <= corners; i++) {
        if (!is_corner(checking, &checking->word[i])) {
            snprintf(wrong, sizeof(wrong),
                     "is not a corner; allowed: 1..%u, the vertices before it", checking->vertices);
            return refuse(checking, i, wrong);
        }
    }
    return 0;
}

int obj_file_check(const struct source *source, obj_file_open *open, void *context,
                   struct error_text *error)
{
    static const struct statement statements[] = {
        {"v", check_vertex}, {"vt", check_texture},    {"vn", check_normal},
        {"f", check_face},   {"o", check_section},     {"g", check_section},
        {"s", check_smooth}, {"usemtl", check_usemtl}, {"mtllib", check_mtllib},
        {NULL, NULL}};
    struct checking checking = {.error = error, .open = open, .context = context};
    int result = -1;
    checking.materials = calloc(1, sizeof(*checking.materials));
    if (checking.materials == NULL)
        key_table_refuse(error, (struct key_place){source->path, 0}, NULL, NULL,
                         "no memory for it");
    else
        result = check_lines(&checking, source, statements);
    free(checking.materials);
    if (result == 0 && checking.triangles == 0)
        return key_table_refuse(error, (struct key_place){source->path, 0}, NULL, NULL,
                                "has no faces; right would be: f 1 2 3");
    return result;
}
