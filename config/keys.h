/* Keys: what a configuration file may say, as tables, and the one way a value gets from a file, an
 * override or a default into memory: found by name, checked for type and range, then stored - or
 * refused with a line that names file, line, key, value and what is allowed.
 *
 * The tables are in config/schema.h. `make docs` writes the same rows into docs/scenario.md, and a
 * test fails when the two differ. */
#ifndef JOLON_CONFIG_KEYS_H
#define JOLON_CONFIG_KEYS_H

#include "config/loader.h"

#include <libconfig.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define KEY_PATH_MAX 96

enum key_type {
    KEY_BOOLEAN,
    KEY_INTEGER,
    KEY_NUMBER, /* an integer is taken too; with choices: one of them */
    KEY_TEXT,
    KEY_CHOICE,
    KEY_CHOICES, /* one or several, with commas between; their values added by "or" */
    KEY_POINT,   /* [x, z] */
    KEY_AREA,    /* [x0, z0, x1, z1] with x0 < x1 and z0 < z1 */
    KEY_ROUTE,   /* ( [x, z], [x, z], ... ), two points or more */
    KEY_TYPE_COUNT
};

/* What lies at the key's offset. */
enum key_store {
    STORE_U8,
    STORE_U32,
    STORE_U64,
    STORE_DOUBLE, /* value * scale; [2] for a point, [4] for an area */
    STORE_TEXT,   /* char[size], NUL-terminated */
    STORE_ROUTE   /* const config_setting_t *, checked, alive as long as its file */
};

/* One allowed word. */
struct key_choice {
    const char *name;
    uint32_t value;      /* KEY_LATER: the word is refused as not in this version */
    const char *meaning; /* a sentence for documents; NULL where the key's meaning says it */
};

#define KEY_LATER UINT32_MAX

struct key {
    const char *name; /* dotted, from the table's top: "world.seed" */
    enum key_type type;
    enum key_store store;
    uint32_t size;        /* STORE_TEXT: bytes with the NUL */
    size_t offset;        /* within the table's destination */
    double low, high;     /* inclusive; of each coordinate for points and areas */
    double scale;         /* from the key's unit to the stored one */
    const char *fallback; /* as one would write it in an override; NULL: nothing is stored */
    bool required;
    const struct key_choice *choices; /* ends with a NULL name */
    const char *unit;                 /* in the file, of the value: "m"; NULL: it has none */
    const char *meaning;              /* what the value does: sentences, in Markdown */
    const char *unset;                /* what holds when nothing is stored; NULL: "none" */
};

struct key_table {
    const char *path; /* of one destination: "", "vehicles", "kind" */
    const struct key *keys;
    uint32_t count; /* at most 64: keys_read() says what was given in one word */
};

/* Where a value came from. line 0: not from a file's line ("--set", a default). */
struct key_place {
    const char *file;
    int line;
};

/* Formats "file:line: key = value: text" (without "= value" when value is NULL, without the line
 * when it is 0), control characters escaped, and returns -1. */
int keys_refuse(struct loader_message *message, struct key_place place, const char *path,
                const char *value, const char *format, ...) __attribute__((format(printf, 5, 6)));

/* Index of the key called name, -1 when there is none. */
int keys_find(const struct key_table *table, const char *name);

/* What is allowed, for messages and documents: "1..1000 Hz", "real, max", "true, false". */
void keys_allowed(const struct key *key, char *text, size_t bytes);
const char *key_type_name(enum key_type type);

/* The range of a key's number, or of each coordinate of a place: "0..50000 m". */
void keys_range(const struct key *key, char *text, size_t bytes);

/* Stores every fallback. 0; -1 when one breaks its own key's rule (a bug in the table). */
int keys_defaults(const struct key_table *table, void *destination, struct loader_message *message);

/* Stores text as the key's value, as an override writes it: dotted key, no quotes needed. */
int keys_set_text(const struct key *key, void *destination, const char *text,
                  struct key_place place, struct loader_message *message);

/* What reading a group of settings needs to know and finds out. */
struct key_reading {
    const struct key_table *table;
    void *destination;
    const char *file;
    uint64_t given; /* out: bit i for key i */
    int line[64];   /* out: of each key given */
    /* Top-level settings that are read elsewhere; NULL: none. */
    bool (*skip)(const config_setting_t *setting);
};

/* Stores every setting of group; prefix is the path of group within the table ("" at its top) and
 * shown the path for messages. Refuses unknown keys and missing required ones (those only with
 * prefix ""). */
int keys_read(struct key_reading *reading, const config_setting_t *group, const char *prefix,
              const char *shown, struct loader_message *message);

/* One point out of a setting that is [x, z] or (x, z); false when it is not that. */
bool keys_point(const config_setting_t *setting, double point[2]);

/* The setting as one would write it, cut to bytes: for messages. */
void keys_value_text(const config_setting_t *setting, char *text, size_t bytes);

#endif
