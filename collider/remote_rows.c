/* Remote entities keep what their owner told. */
#include "collider/remote_rows.h"

#include "world/checksum.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/world.h"

static void restore_block(struct response_context *context, const struct entities *moved,
                          uint32_t first, uint32_t end)
{
    const struct entities *e = &context->next->entities;
    for (uint32_t row = first; row < end; row++) {
        if (remote_is(moved, row) && entities_differing(e, moved, row) != 0)
            table_copy_row(&context->writer, moved, row);
    }
}

void remote_rows_restore(struct response_context *context, const struct entities *moved)
{
    uint32_t used = context->next->head->used;
    if (context->world->params->remotes_max == 0)
        return;
    for (uint32_t first = 0; first < used; first += CHECKSUM_ROWS) {
        if (context->writer.changed[first / CHECKSUM_ROWS] != 0)
            restore_block(context, moved, first,
                          used - first < CHECKSUM_ROWS ? used : first + CHECKSUM_ROWS);
    }
}
