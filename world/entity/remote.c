/* The hash of records. */
#include "world/entity/remote.h"

#include "world/maths/hash.h"

uint64_t remote_record_hash(const struct command *slot, uint64_t before)
{
    struct command copy = *slot;
    copy.sequence = 0;
    return XXH3_64bits_withSeed(&copy, sizeof copy, before);
}
