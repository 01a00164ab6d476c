/* The types of other simulators that the table of types does not have: each is told once, several
 * in a line of the log. One thread. */
#ifndef JOLON_GATEWAY_TYPE_NOTICES_H
#define JOLON_GATEWAY_TYPE_NOTICES_H

#include "gateway/pdu/pdu.h"
#include "world/entity/kind.h"

#include <stdbool.h>
#include <stddef.h>

#define TYPE_NOTICES_MAX     4096u /* types that are remembered */
#define TYPE_NOTICES_BUCKETS 8192u /* a power of two */

struct type_notices {
    struct {
        struct pdu_entity_type type;
        uint16_t kind; /* that it is shown as, KIND_NONE: none */
    } seen[TYPE_NOTICES_MAX];
    uint16_t bucket[TYPE_NOTICES_BUCKETS]; /* index into seen + 1; 0: free */
    uint32_t count, told;
    uint64_t beyond, beyond_told; /* PDUs of types that are not remembered */
};

/* Notes a type. kind: what it is shown as, KIND_NONE when it is left out. */
void type_notices_note(struct type_notices *notices, struct pdu_entity_type type, uint16_t kind);

/* Writes what has not been told, as far as it fits, and takes it for told. kinds: the world's.
 * Returns the number of types, or 1 for those that are not remembered; 0: there is nothing new. */
uint32_t type_notices_text(struct type_notices *notices, const struct kind *kinds, char *text,
                           size_t size);

#endif
