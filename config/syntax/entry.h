/* What the readers of a scenario's lists share. A list is counted first, then memory is allocated
 * once, then the entries are read. */
#ifndef JOLON_CONFIG_SYNTAX_ENTRY_H
#define JOLON_CONFIG_SYNTAX_ENTRY_H

#include "config/syntax/key_table.h"
#include "world/entity/kind.h"

#define DOMAIN_BIT(domain) (1u << (domain))
#define DOMAINS_VEHICLE    (DOMAIN_BIT(DOMAIN_LAND) | DOMAIN_BIT(DOMAIN_SEA) | DOMAIN_BIT(DOMAIN_AIR))

/* An entry while it is read. */
struct entry {
    struct scenario *scenario;
    const config_setting_t *setting;
    struct key_reading keys;
    const char *within;      /* the path before the table's: "scripts[2]."; NULL: none */
    char path[KEY_PATH_MAX]; /* "vehicles[3]" */
    struct error_text *error;
};

static inline bool entry_given(const struct entry *entry, uint32_t key)
{
    return entry->keys.given[key];
}

/* The number of entries of a list; -1 with the message when it is no list or too long. */
int entry_count(const config_setting_t *list, const char *file, int max, struct error_text *error);

/* The same for a list within an entry, whose path is in messages. */
int entry_count_within(const char *path, const config_setting_t *list, const char *file, int max,
                       struct error_text *error);

/* Zeroed memory for count items, at least one; NULL with the message. */
void *entry_allocate(uint32_t count, size_t size, const char *file, struct error_text *error);

/* Stores the defaults and the values of entry `index` of a list into destination. Sets the entry's
 * setting, keys and path. 0; -1 with the message. */
int entry_read(struct entry *entry, const struct key_table *table, int index,
               const config_setting_t *list, void *destination);

/* Refuses the value that the file has for a key of the entry. Returns -1. */
int entry_refuse(const struct entry *entry, uint32_t key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Index of the kind called name, which must have one of these domains (DOMAIN_BIT); KIND_NONE with
 * the message. */
uint16_t entry_kind(const struct entry *entry, uint32_t key, const char *name, unsigned domains);

#endif
