/* What a world's vehicles are called: the names that its scenario gave them, by EntityNames.
 *
 * A vehicle that was spawned has none. One thread at a time. */
#ifndef JOLON_TOPICS_NAMES_H
#define JOLON_TOPICS_NAMES_H

#include "topics/dds_topics.h"

#include "status.h"

#include <stdbool.h>

struct names {
    const struct dds_link *link; /* the caller's */
    dds_entity_t reader;
    dds_instance_handle_t writer;
    uint64_t looked_ns;
    bool told; /* the names are here; there may be none */
    uint64_t run;
    uint32_t count;
    jolon_EntityName *entry; /* [count], by rising id */
};

/* Makes the reader on the link, which must outlive the names; -1 with the reason. */
int names_open(struct names *names, const struct dds_link *link, struct reason *reason);
void names_close(struct names *names);

/* Takes the names if they came, or came anew for another world. Does not block. */
void names_take(struct names *names);

/* Takes these names for those of the world, in place of what there was; false: no memory. */
bool names_learn(struct names *names, const jolon_EntityNames *told);

/* The name of an entity, "" when it has none. */
const char *names_of(const struct names *names, uint32_t id);

/* Who is called so, 0 when nobody is. */
uint32_t names_find(const struct names *names, const char *name);

#endif
