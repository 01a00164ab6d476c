/* Tables of the keys that configuration files may have, and the functions that store their values.
 * A value comes from a file, an override or a default. Its key is found by name, and its type and
 * range are checked. Then the value is stored, or refused with a message that names file, line,
 * key, value and what is allowed.
 *
 * The tables are in config/syntax/schema.h. `make docs` writes the same rows into docs/scenario.md,
 * and a test fails when the two differ. */
#ifndef JOLON_CONFIG_SYNTAX_KEY_TABLE_H
#define JOLON_CONFIG_SYNTAX_KEY_TABLE_H

#include "world/runtime/error_text.h"

#include <libconfig.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define KEY_PATH_MAX 96

enum key_type {
    KEY_BOOLEAN,
    KEY_INTEGER,
    KEY_NUMBER, /* integers too; with choices: one of them */
    KEY_TEXT,
    KEY_CHOICE,
    KEY_CHOICES, /* one or several words, with commas between; their values are or-ed */
    KEY_POINT,   /* [x, z] */
    KEY_AREA,    /* [x0, z0, x1, z1] with x0 < x1 and z0 < z1 */
    KEY_NUMBERS, /* [n, n, ...], exactly size of them */
    KEY_ROUTE,   /* ( [x, z], [x, z], ... ), two points or more */
    KEY_TYPE_COUNT
};

/* The type of the memory at the key's offset. */
enum key_store {
    STORE_U8,
    STORE_U32,
    STORE_U64,
    STORE_DOUBLE, /* value * scale; [2] for a point, [4] for an area, [size] for numbers */
    STORE_TEXT,   /* char[size], NUL-terminated */
    STORE_ROUTE   /* const config_setting_t *, checked; lives as long as its config_t */
};

/* One allowed word. */
struct key_choice {
    const char *name;    /* NULL: key.word has it */
    uint32_t value;      /* KEY_LATER: the word is refused as not in this version */
    const char *meaning; /* a sentence for documents; NULL where the key's meaning says it */
};

#define KEY_LATER UINT32_MAX

struct key {
    const char *name; /* with the groups that it is in: "world.seed" */
    enum key_type type;
    enum key_store store;
    uint32_t size;        /* STORE_TEXT: bytes, the NUL included; KEY_NUMBERS: how many */
    size_t offset;        /* within the table's destination */
    double low, high;     /* inclusive; of each coordinate of points, areas and routes, which
                             key_reading.side_m replaces */
    double scale;         /* of STORE_DOUBLE: the stored value is the file's times this */
    const char *fallback; /* the default, as in an override; NULL: nothing is stored */
    bool required;
    const struct key_choice *choices; /* NULL: 0..choice_count - 1, with the words of word */
    uint32_t choice_count;            /* 0: any value that is in range */
    const char *(*word)(uint32_t value);
    const char *unit;    /* in the file, of the value: "m"; NULL: it has none */
    const char *meaning; /* what the value does: sentences, in Markdown */
    const char *unset;   /* what holds when nothing is stored; NULL: "none" */
};

#define KEY_TABLE_MAX 128u /* keys of one table */

struct key_table {
    const char *path; /* of an entry, in messages: "", "vehicles", "kind" */
    const struct key *keys;
    uint32_t count; /* at most KEY_TABLE_MAX */
    size_t size;    /* of the destination */
};

/* Where a value comes from. line 0: from no line of a file ("--set", a default). */
struct key_place {
    const char *file;
    int line;
};

/* Writes "file:line: path = value: text" into the message and returns -1. Leaves out a line of 0, a
 * path of NULL and a value of NULL. Escapes control characters. */
int key_table_refuse(struct error_text *error, struct key_place place, const char *path,
                     const char *value, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* Index of the key called name; -1: there is none. */
int key_table_find(const struct key_table *table, const char *name);

/* Choice n of a key, with its name. n < key->choice_count. */
struct key_choice key_table_choice(const struct key *key, uint32_t n);

/* What is allowed, for messages and documents: "1..1000 Hz", "real, max", "true, false". */
void key_table_allowed(const struct key *key, char *text, size_t bytes);
const char *key_type_name(enum key_type type);

/* The range of a key's number, or of each coordinate of a place: "0..50000 m". */
void key_table_range(const struct key *key, char *text, size_t bytes);

/* Stores every fallback. 0; -1 when a fallback breaks the rule of its key (a bug in the table). */
int key_table_defaults(const struct key_table *table, void *destination, struct error_text *error);

/* Stores a value that is written as in an override: text has no quotes. 0; -1 with the message. */
int key_table_set_text(const struct key *key, void *destination, const char *text,
                       struct key_place place, struct error_text *error);

/* The input and the output of key_table_read(). */
struct key_reading {
    const struct key_table *table;
    void *destination;
    const char *file;
    double side_m; /* of the world: the limit of points, areas and routes; 0: key.high */
    bool given[KEY_TABLE_MAX]; /* out: the file has this key */
    int line[KEY_TABLE_MAX];   /* out: of each key that the file has */
    /* The top-level lists that other functions read, NULL at the end; NULL: there are none. One may
     * have the name of a group of the table. */
    const char *const *lists;
};

/* Stores every setting of a group. prefix: the path of the group within the table, "" at its top.
 * shown: the path of the group in messages. Refuses unknown keys, and with prefix "" also required
 * keys that are missing. 0; -1 with the message. */
int key_table_read(struct key_reading *reading, const config_setting_t *group, const char *prefix,
                   const char *shown, struct error_text *error);

/* Reads a setting that is [x, z] or (x, z). Returns false for any other. */
bool key_table_point(const config_setting_t *setting, double point[2]);

/* The setting as a file would have it, for messages; cut to bytes. */
void key_table_value_text(const config_setting_t *setting, char *text, size_t bytes);

#endif
