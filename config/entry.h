/* Entries: what the readers of a scenario's lists share. A list is counted first, then allocated
 * once, then read entry by entry. */
#ifndef JOLON_CONFIG_ENTRY_H
#define JOLON_CONFIG_ENTRY_H

#include "config/keys.h"

#define DOMAIN_BIT(domain) (1u << (domain))
#define DOMAINS_VEHICLE    (DOMAIN_BIT(DOMAIN_LAND) | DOMAIN_BIT(DOMAIN_SEA) | DOMAIN_BIT(DOMAIN_AIR))

/* One entry on its way from the file. */
struct entry {
    struct scenario *scenario;
    const config_setting_t *setting;
    struct key_reading keys;
    const char *within;      /* before the table's path: "scripts[2]."; NULL: nothing */
    char path[KEY_PATH_MAX]; /* "vehicles[3]" */
    struct loader_message *message;
};

static inline bool entry_given(const struct entry *entry, uint32_t key)
{
    return (entry->keys.given >> key & 1u) != 0;
}

/* How many entries a list has, -1 with the message when it is none or too long. */
int entry_count(const config_setting_t *list, const char *file, int max,
                struct loader_message *message);

/* Space for count items, zeroed; NULL with the message. At least one, so that NULL means failure.
 */
void *entry_allocate(uint32_t count, size_t size, const char *file, struct loader_message *message);

/* Prepares the entry, sets defaults and reads what the file gives. */
int entry_read(struct entry *entry, const struct key_table *table, int index,
               const config_setting_t *list, void *destination);

/* Refuses the value of one of the entry's keys, with what the file says there. Returns -1. */
int entry_refuse(const struct entry *entry, uint32_t key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Index of a kind of one of these domains (DOMAIN_BIT), KIND_NONE with the message. */
uint16_t entry_kind(const struct entry *entry, uint32_t key, const char *name, unsigned domains);

#endif
