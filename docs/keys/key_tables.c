/* Copies a document line by line, and replaces its tables by tables made from the schema. */
#include "docs/keys/key_tables.h"

#include "config/syntax/schema.h"

#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#define KEYS_BEGIN  "<!-- keys of "
#define WORDS_BEGIN "<!-- words of "
#define NAME_END    " -->"
#define TABLE_END   "<!-- end -->"
#define ALLOWED_MAX 256

static const struct {
    const char *name;   /* as in "keys of NAME"; NULL: a group's name */
    const char *prefix; /* prefix of its keys in the document */
    const struct key_table *table;
} sources[] = {
    {NULL, "", &schema_scenario},
    {"vehicles[]", "vehicles[].", &schema_vehicle},
    {"objects[]", "objects[].", &schema_object},
    {"earthworks[]", "earthworks[].", &schema_earthwork},
    {"bases[]", "bases[].", &schema_base},
    {"scripts[]", "scripts[].", &schema_script},
    {"steps[]", "steps[].", &schema_step},
    {"objectives[]", "objectives[].", &schema_objective},
    {"missions[]", "missions[].", &schema_mission},
    {"phases[]", "phases[].", &schema_phase},
    {"fires[]", "fires[].", &schema_fire},
    {"a kind", "", &schema_kind},
};

struct writing {
    FILE *to;
    bool written[COUNT(sources)][KEY_TABLE_MAX];
    char *problem;
    size_t bytes;
};

static int fail(struct writing *writing, const char *name, const char *what)
{
    snprintf(writing->problem, writing->bytes, "%s: %s", name, what);
    return -1;
}

static void write_key(FILE *to, const char *prefix, const struct key *key)
{
    char allowed[ALLOWED_MAX];

    key_table_allowed(key, allowed, sizeof(allowed));
    fprintf(to, "| `%s%s` | %s | %s | %s | %s |\n", prefix, key->name, key_type_name(key->type),
            allowed,
            key->fallback != NULL ? key->fallback
            : key->required       ? "required"
            : key->unset != NULL  ? key->unset
                                  : "none",
            key->meaning);
}

/* Returns true if this key of a scenario is in the group. */
static bool is_in_group(const struct key *key, const char *group)
{
    size_t length = strlen(group);

    return strncmp(key->name, group, length) == 0 && key->name[length] == '.';
}

static int write_keys(struct writing *writing, const char *name)
{
    size_t source = 0;
    bool any = false;

    for (size_t s = 1; s < COUNT(sources); s++) {
        if (strcmp(sources[s].name, name) == 0)
            source = s;
    }
    fprintf(writing->to, "| key | type | allowed | default | meaning |\n|---|---|---|---|---|\n");
    for (uint32_t i = 0; i < sources[source].table->count; i++) {
        const struct key *key = &sources[source].table->keys[i];

        if (source == 0 && !is_in_group(key, name))
            continue;
        if (writing->written[source][i])
            return fail(writing, key->name, "is in two tables");
        writing->written[source][i] = true;
        write_key(writing->to, sources[source].prefix, key);
        any = true;
    }
    return any ? 0 : fail(writing, name, "is no group, list or kind");
}

/* Returns the key of this name in the document, or NULL. */
static const struct key *find_key(const char *name)
{
    for (size_t s = 0; s < COUNT(sources); s++) {
        size_t length = strlen(sources[s].prefix);
        int index = strncmp(name, sources[s].prefix, length) == 0
                        ? key_table_find(sources[s].table, name + length)
                        : -1;

        if (index >= 0)
            return &sources[s].table->keys[index];
    }
    return NULL;
}

static int write_words(struct writing *writing, const char *name)
{
    const struct key *key = find_key(name);
    const char *dot = strrchr(name, '.');

    if (key == NULL || key->choice_count == 0)
        return fail(writing, name, "is no key with allowed words");
    fprintf(writing->to, "| %s | meaning |\n|---|---|\n", dot != NULL ? dot + 1 : name);
    for (uint32_t n = 0; n < key->choice_count; n++) {
        const struct key_choice choice = key_table_choice(key, n);

        if (choice.value == KEY_LATER)
            continue;
        if (choice.meaning == NULL)
            return fail(writing, choice.name, "has no meaning in the schema");
        fprintf(writing->to, "| `%s` | %s |\n", choice.name, choice.meaning);
    }
    return 0;
}

static int check_all_written(struct writing *writing)
{
    for (size_t s = 0; s < COUNT(sources); s++) {
        for (uint32_t i = 0; i < sources[s].table->count; i++) {
            if (!writing->written[s][i])
                return fail(writing, sources[s].table->keys[i].name, "is in no table");
        }
    }
    return 0;
}

/* Copies the name out of the line "BEGIN NAME -->". Returns false for any other line. */
static bool take_name(const char *line, size_t length, const char *begin, char name[KEY_PATH_MAX])
{
    size_t before = strlen(begin), after = strlen(NAME_END);

    if (length < before + after || strncmp(line, begin, before) != 0 ||
        strncmp(line + length - after, NAME_END, after) != 0)
        return false;
    snprintf(name, KEY_PATH_MAX, "%.*s", (int)(length - before - after), line + before);
    return true;
}

int key_tables_write(FILE *to, const char *document, char *problem, size_t bytes)
{
    struct writing writing = {.to = to, .problem = problem, .bytes = bytes};

    for (const char *line = document; *line != '\0';) {
        size_t length = strcspn(line, "\n");
        char name[KEY_PATH_MAX];
        bool keys = take_name(line, length, KEYS_BEGIN, name);
        bool words = !keys && take_name(line, length, WORDS_BEGIN, name);

        fprintf(to, "%.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
        if (!keys && !words)
            continue;
        line = strstr(line, TABLE_END);
        if (line == NULL)
            return fail(&writing, name, "has no \"" TABLE_END "\" behind its table");
        if ((keys ? write_keys(&writing, name) : write_words(&writing, name)) != 0)
            return -1;
    }
    return check_all_written(&writing);
}
