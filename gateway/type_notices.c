/* A hash table with open addresses. */
#include "gateway/type_notices.h"

#include "world/maths/random.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define ONE_TYPE 128u /* bytes that the words of a type may take */

static uint64_t key_of(struct pdu_entity_type type)
{
    uint64_t key;
    _Static_assert(sizeof key == sizeof type, "a type is a number");
    memcpy(&key, &type, sizeof key);
    return key;
}

void type_notices_note(struct type_notices *notices, struct pdu_entity_type type, uint16_t kind)
{
    uint32_t at = (uint32_t)random_mix(key_of(type)) & (TYPE_NOTICES_BUCKETS - 1);
    for (; notices->bucket[at] != 0; at = (at + 1) & (TYPE_NOTICES_BUCKETS - 1)) {
        if (key_of(notices->seen[notices->bucket[at] - 1].type) == key_of(type))
            return;
    }
    if (notices->count == TYPE_NOTICES_MAX) {
        notices->beyond++;
        return;
    }
    notices->seen[notices->count].type = type;
    notices->seen[notices->count].kind = kind;
    notices->bucket[at] = (uint16_t)++notices->count;
}

static size_t add_type(char *text, size_t size, bool first, struct pdu_entity_type type,
                       const char *kind)
{
    int length = snprintf(text, size, "%s%u.%u.%u.%u.%u.%u.%u%s: %s%s", first ? "type " : "; ",
                          type.kind, type.domain, type.country, type.category, type.subcategory,
                          type.specific, type.extra, first ? " is not in the table of types" : "",
                          kind ? "shown as " : "left out", kind ? kind : "");
    return length < 0 ? 0 : (size_t)length < size ? (size_t)length : size - 1;
}

uint32_t type_notices_text(struct type_notices *notices, const struct kind *kinds, char *text,
                           size_t size)
{
    uint32_t told = 0;
    size_t length = 0;
    while (notices->told < notices->count && length + 2 * ONE_TYPE < size) {
        uint16_t kind = notices->seen[notices->told].kind;
        length +=
            add_type(text + length, size - length, told == 0, notices->seen[notices->told].type,
                     kind == KIND_NONE ? NULL : kinds[kind].name);
        notices->told++;
        told++;
    }
    if (told > 0 && notices->told < notices->count) {
        (void)snprintf(text + length, size - length, "; %u more types are told later",
                       notices->count - notices->told);
    } else if (told == 0 && notices->beyond > notices->beyond_told) {
        (void)snprintf(text, size,
                       "%" PRIu64 " more PDUs have types that are not in the table of types and "
                       "are not told, because %u others were",
                       notices->beyond - notices->beyond_told, TYPE_NOTICES_MAX);
        notices->beyond_told = notices->beyond;
        told = 1;
    }
    return told;
}
