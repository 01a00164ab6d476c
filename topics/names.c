/* The topic of names into a list. */
#include "topics/names.h"

#include "ipc/clock.h"
#include "ipc/log.h"
#include "topics/samples.h"

#include <stdlib.h>
#include <string.h>

int names_open(struct names *names, const struct dds_link *link, struct reason *reason)
{
    *names = (struct names){.link = link, .reader = dds_topics_reader(link, TOPIC_NAMES, reason)};
    return names->reader < 0 ? -1 : 0;
}

void names_close(struct names *names)
{
    free(names->entry);
    names->entry = NULL;
    names->count = 0;
}

bool names_learn(struct names *names, const jolon_EntityNames *told)
{
    uint32_t count = told->names._length;
    jolon_EntityName *entry = malloc((count + 1) * sizeof *entry);
    if (!entry)
        return false;
    if (count)
        memcpy(entry, told->names._buffer, count * sizeof *entry);
    names_close(names);
    names->entry = entry;
    names->count = count;
    names->run = told->run;
    names->told = true;
    return true;
}

void names_take(struct names *names)
{
    struct samples from = {.reader = names->reader, .topic = TOPIC_NAMES};
    while (samples_next(&from)) {
        (void)names_learn(names, from.sample); /* without memory nobody has a name */
        names->writer = from.writer;
    }
    /* They are written once: of whoever has left they are asked for again. */
    if (names->told && log_due(&names->looked_ns, NS_PER_S) &&
        dds_topics_orphaned(names->reader, names->writer))
        dds_topics_ask_again(names->link, TOPIC_NAMES, 0, &names->reader);
}

const char *names_of(const struct names *names, uint32_t id)
{
    uint32_t low = 0, high = names->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (names->entry[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < names->count && names->entry[low].id == id ? names->entry[low].name : "";
}

uint32_t names_find(const struct names *names, const char *name)
{
    for (uint32_t i = 0; i < names->count; i++) {
        if (strcmp(names->entry[i].name, name) == 0)
            return names->entry[i].id;
    }
    return 0;
}
