/* The hash of records, and the words of identifiers and markings. */
#include "world/entity/remote.h"

#include "world/maths/hash.h"

#include <stdio.h>

const char *remote_id_text(uint64_t remote, char text[REMOTE_ID_TEXT])
{
    (void)snprintf(text, REMOTE_ID_TEXT, "%u:%u:%u", (unsigned)(remote >> 32 & 0xffff),
                   (unsigned)(remote >> 16 & 0xffff), (unsigned)(remote & 0xffff));
    return text;
}

uint64_t remote_record_hash(const struct command *slot, uint64_t before)
{
    struct command copy = *slot;
    copy.sequence = 0;
    return XXH3_64bits_withSeed(&copy, sizeof copy, before);
}

void remote_marking(const struct entities *e, uint32_t i, char marking[REMOTE_MARKING_MAX + 1])
{
    memset(marking, 0, REMOTE_MARKING_MAX + 1);
    if (!remote_is(e, i))
        return;
    memcpy(marking, &e->row[i].leg, 4);
    memcpy(marking + 4, &e->row[i].jolt_tick, 4);
    memcpy(marking + 8, &e->row[i].target_slot, 4);
    for (unsigned k = 0; k < REMOTE_MARKING_MAX && marking[k] != '\0'; k++) {
        if (marking[k] < ' ' || marking[k] > '~') /* a log that anybody has written */
            marking[k] = '?';
    }
}
