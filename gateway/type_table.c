/* The table of types. */
#include "gateway/type_table.h"

#include "world/runtime/parse_number.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define WORDS_MAX  6
#define LINE_BYTES 256
#define ANY_FORCE  FORCE_COUNT
#define LIFE_FORM  3 /* kind of a type of DIS */

static const char type_form[] = "the type must be seven numbers with dots between them: "
                                "KIND.DOMAIN.COUNTRY.CATEGORY.SUBCATEGORY.SPECIFIC.EXTRA";

static const char *const forces[] = {
    [FORCE_NEUTRAL] = "neutral", [FORCE_BLUE] = "blue", [FORCE_RED] = "red", [ANY_FORCE] = "*"};
static const char *const domains[] = {[DOMAIN_LAND] = "<land>",
                                      [DOMAIN_SEA] = "<sea>",
                                      [DOMAIN_AIR] = "<air>",
                                      [DOMAIN_MUNITION] = "<munition>"};
#define DOMAINS (sizeof domains / sizeof domains[0])

/* The file's rows while it is read: of each kind, then of each domain; the last column is of all
 * forces. */
struct reading {
    struct type_row row[KIND_COUNT_MAX + DOMAINS][ANY_FORCE + 1];
    struct type_in in[TYPE_TABLE_INS];
    uint32_t ins;
};

static int force_of(const char *word)
{
    for (int i = 0; i <= ANY_FORCE; i++) {
        if (strcmp(forces[i], word) == 0)
            return i;
    }
    return -1;
}

/* Returns the index of a kind or domain in the reading. A kind that this scenario does not have is
 * -1, which is no error. */
static int subject_of(const char *word, const struct kind *kinds, uint32_t kind_count)
{
    for (unsigned i = 0; i < DOMAINS; i++) {
        if (strcmp(domains[i], word) == 0)
            return (int)(KIND_COUNT_MAX + i);
    }
    for (uint32_t i = 0; i < kind_count; i++) {
        if (strcmp(kinds[i].name, word) == 0)
            return (int)i;
    }
    return -1;
}

/* Reads KIND.DOMAIN.COUNTRY.CATEGORY.SUBCATEGORY.SPECIFIC.EXTRA. */
static bool read_type(char *word, struct pdu_entity_type *type)
{
    uint64_t number[7];
    char *rest = word;
    for (unsigned i = 0; i < 7; i++) {
        char *part = strsep(&rest, ".");
        if (!part || !parse_whole(part, 0, i == 2 ? UINT16_MAX : UINT8_MAX, &number[i]))
            return false;
    }
    *type = (struct pdu_entity_type){(uint8_t)number[0], (uint8_t)number[1], (uint16_t)number[2],
                                     (uint8_t)number[3], (uint8_t)number[4], (uint8_t)number[5],
                                     (uint8_t)number[6]};
    return rest == NULL;
}

/* Reads letters and digits with hyphens between them, from the letter of the dimension on. */
static bool read_cot(const char *word, char cot[TYPE_TABLE_COT])
{
    static const char allowed[] = "-ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    size_t length = strlen(word);
    if (length >= TYPE_TABLE_COT || strspn(word, allowed) != length || strstr(word, "--") ||
        word[0] < 'A' || word[0] > 'Z' || word[length - 1] == '-')
        return false;
    (void)snprintf(cot, TYPE_TABLE_COT, "%s", word);
    return true;
}

/* Reads the words of a row "in". Returns NULL, or what is wrong. */
static const char *read_in(struct reading *reading, char *word[], int count,
                           const struct kind *kinds, uint32_t kind_count)
{
    struct type_in in;
    int subject = subject_of(word[0], kinds, kind_count);
    if (count != 3 || subject >= (int)KIND_COUNT_MAX)
        return "a row of what comes in must be KIND in TYPE";
    if (!read_type(word[2], &in.type))
        return type_form;
    if (subject < 0)
        return NULL;
    if (reading->ins == TYPE_TABLE_INS)
        return "there are 256 rows of what comes in already";
    in.kind = (uint16_t)subject;
    reading->in[reading->ins++] = in;
    return NULL;
}

/* Reads the words of a line. Returns NULL, or what is wrong. */
static const char *read_row(struct reading *reading, char *word[], int count,
                            const struct kind *kinds, uint32_t kind_count)
{
    struct type_row row = {.given = true};
    uint64_t warhead = 0, fuse = 0;
    if (count < 3 || count > WORDS_MAX)
        return "must be KIND FORCE TYPE [WARHEAD FUSE] [COT]";
    if (strcmp(word[1], "in") == 0)
        return read_in(reading, word, count, kinds, kind_count);
    int force = force_of(word[1]);
    if (force < 0)
        return "the force must be blue, red, neutral or *, or in for a type that only comes in";
    if (!read_type(word[2], &row.type))
        return type_form;
    if (count >= 5 && (!parse_whole(word[3], 0, UINT16_MAX, &warhead) ||
                       !parse_whole(word[4], 0, UINT16_MAX, &fuse)))
        return "warhead and fuse must be whole numbers from 0 to 65535";
    if (count % 2 == 0 && !read_cot(word[count - 1], row.cot))
        return "the type of Cursor on Target must be letters with hyphens between them, such as "
               "G-E-V-A-T";
    row.warhead = (uint16_t)warhead;
    row.fuse = (uint16_t)fuse;
    int subject = subject_of(word[0], kinds, kind_count);
    if (subject < 0)
        return NULL;
    if (reading->row[subject][force].given)
        return "has a row before";
    reading->row[subject][force] = row;
    return NULL;
}

/* Splits a line without its comment into words. Returns their number, WORDS_MAX + 1 for more. */
static int split(char *line, char *word[WORDS_MAX])
{
    int count = 0;
    char *rest = line, *next;
    line[strcspn(line, "#\n")] = '\0';
    while ((next = strsep(&rest, " \t\r")) != NULL) {
        if (*next == '\0')
            continue;
        if (count == WORDS_MAX)
            return WORDS_MAX + 1;
        word[count++] = next;
    }
    return count;
}

static int read_lines(struct reading *reading, FILE *file, const char *path,
                      const struct kind *kinds, uint32_t kind_count, struct error_text *error)
{
    char line[LINE_BYTES], *word[WORDS_MAX];
    for (int number = 1; fgets(line, sizeof line, file); number++) {
        if (!strchr(line, '\n') && !feof(file))
            return error_text_set(error, "%s:%d: a line has at most %d characters", path, number,
                                  LINE_BYTES - 2);
        int count = split(line, word);
        const char *wrong = count == 0 ? NULL : read_row(reading, word, count, kinds, kind_count);
        if (wrong)
            return error_text_set(error, "%s:%d: %s: %s", path, number, word[0], wrong);
    }
    if (ferror(file))
        return error_text_set(error, "%s: cannot be read: %s", path, strerror(errno));
    return 0;
}

/* Selects the row of a kind and a force: its own, that of all forces, or that of its domain. A row
 * without a type of Cursor on Target has that of the next of them. */
static int choose(struct type_row *row, const struct reading *reading, const struct kind *kind,
                  uint32_t number, int force)
{
    uint32_t domain = KIND_COUNT_MAX + kind->domain;
    const struct type_row *const candidates[] = {
        &reading->row[number][force], &reading->row[number][ANY_FORCE],
        &reading->row[domain][force], &reading->row[domain][ANY_FORCE]};
    for (unsigned i = 0; i < 4; i++) {
        if (!candidates[i]->given)
            continue;
        *row = *candidates[i];
        row->nearest = i >= 2;
        for (unsigned j = i + 1; j < 4 && row->cot[0] == '\0'; j++)
            memcpy(row->cot, candidates[j]->cot, sizeof row->cot);
        return 0;
    }
    return -1;
}

int type_table_read(struct type_table *table, const char *path, const struct kind *kinds,
                    uint32_t kind_count, struct error_text *error)
{
    static struct reading reading;
    memset(&reading, 0, sizeof reading);
    memset(table, 0, sizeof *table);
    FILE *file = fopen(path, "re");
    if (!file)
        return error_text_set(error, "%s: cannot be read: %s", path, strerror(errno));
    int result = read_lines(&reading, file, path, kinds, kind_count, error);
    (void)fclose(file);
    memcpy(table->in, reading.in, sizeof table->in);
    table->ins = reading.ins;
    for (uint32_t i = 0; i < kind_count && i < KIND_COUNT_MAX && result == 0; i++) {
        table->munition[i] = kinds[i].domain == DOMAIN_MUNITION;
        for (int force = 0; force < FORCE_COUNT && kinds[i].domain < DOMAINS; force++) {
            if (choose(&table->row[i][force], &reading, &kinds[i], i, force) != 0)
                return error_text_set(error, "%s: has no row of %s or %s", path, kinds[i].name,
                                      domains[kinds[i].domain]);
        }
    }
    return result;
}

const struct type_row *type_table_row(const struct type_table *table, uint16_t kind, uint8_t force)
{
    static const struct type_row none;
    return kind < KIND_COUNT_MAX && force < FORCE_COUNT ? &table->row[kind][force] : &none;
}

#define REST_OF_DOMAIN 24u  /* more than a country, less than a category */
#define THE_SAME       128u /* more than all else together */

static bool is_same(struct pdu_entity_type a, struct pdu_entity_type b)
{
    return a.kind == b.kind && a.domain == b.domain && a.country == b.country &&
           a.category == b.category && a.subcategory == b.subcategory && a.specific == b.specific &&
           a.extra == b.extra;
}

/* Returns how much a type of the table has in common with another, 0 when it does not fit. */
static unsigned likeness(struct pdu_entity_type own, struct pdu_entity_type type)
{
    if (own.kind != type.kind || own.domain != type.domain)
        return 0;
    /* Category 0 says nothing. An animal or a soldier is like none of another category. */
    bool category = own.category == type.category && own.category != 0;
    if (own.kind == LIFE_FORM && !category)
        return 0;
    if (is_same(own, type))
        return THE_SAME;
    bool subcategory = category && own.subcategory == type.subcategory;
    bool specific = subcategory && own.specific == type.specific;
    unsigned common = 1;
    common += category ? 64 : 0;
    common += subcategory ? 32 : 0;
    common += own.country == type.country ? 16 : 0;
    common += specific ? 8 : 0;
    common += specific && own.extra == type.extra ? 4 : 0;
    return common;
}

uint16_t type_table_kind(const struct type_table *table, struct pdu_entity_type type, bool munition,
                         bool *same)
{
    unsigned best = 0;
    uint16_t kind = KIND_NONE;
    for (uint32_t i = 0; i < KIND_COUNT_MAX; i++) {
        for (int force = 0; force < FORCE_COUNT && table->munition[i] == munition; force++) {
            const struct type_row *row = &table->row[i][force];
            unsigned common = row->given && !row->nearest ? likeness(row->type, type) : 0;
            if (common > best)
                best = common, kind = (uint16_t)i;
        }
    }
    for (uint32_t i = 0; i < table->ins; i++) {
        const struct type_in *in = &table->in[i];
        unsigned common = table->munition[in->kind] == munition ? likeness(in->type, type) : 0;
        if (common > 0 && common < REST_OF_DOMAIN && in->type.category == 0)
            common = REST_OF_DOMAIN;
        if (common > best)
            best = common, kind = in->kind;
    }
    *same = best == THE_SAME;
    return kind;
}
