/* The parts of an image and their sizes. */
#include "recorder/archive/image_format.h"
#include "ipc/process/log.h"
#include "world/entity/dent.h"
#include "world/entity/event.h"
#include "world/entity/persistent_contact.h"
#include "world/runtime/check.h"

#include <xxhash.h>

/* Regions that the image holds unchanged: all static regions except the header and the parameters,
 * which are in the image header. */
#define FIRST_STATIC REGION_KINDS
#define LAST_STATIC  REGION_RECIPE

struct list {
    struct image_part *part;
    uint32_t count;
};

static void add(struct list *list, const void *at, size_t bytes)
{
    if (bytes == 0)
        return;
    CHECK(list->count < IMAGE_PARTS_MAX);
    list->part[list->count++] = (struct image_part){(void *)(uintptr_t)at, bytes};
}

/* Commands first .. end - 1: one part, or two if they wrap around the end of the ring. */
static void add_ring(struct list *list, const struct command *ring, uint64_t slots, uint64_t first,
                     uint64_t end)
{
    uint64_t count = end - first, at = first & (slots - 1);
    uint64_t before = count < slots - at ? count : slots - at;
    add(list, ring + at, before * sizeof *ring);
    add(list, ring, (count - before) * sizeof *ring);
}

uint32_t image_parts(const struct image_header *header, const struct image_tables *tables,
                     struct image_part parts[IMAGE_PARTS_MAX])
{
    const struct view *view = tables->view;
    const struct segment_header *segment = &header->segment;
    struct list list = {parts, 0};
    for (int i = FIRST_STATIC; i <= LAST_STATIC; i++)
        add(&list, (const unsigned char *)view->base + view->layout.offset[i],
            view->layout.bytes[i]);
    add(&list, tables->state.head, sizeof *tables->state.head);
    add(&list, tables->state.entities.row, header->used * sizeof(struct entity));
    add(&list, tables->state.fixed_damage, segment->counts.fixed);
    add(&list, tables->state.contacts, header->contacts * sizeof(struct persistent_contact));
    add(&list, view->w[0].craters, header->craters * sizeof(struct crater));
    add(&list, view->w[0].dents, header->dents * sizeof(struct dent));
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        add_ring(&list, tables->ring[i], layout_ring_slots(segment, i), header->ring_first[i],
                 header->ring_end[i]);
    if (header->inputs) {
        add(&list, tables->moved.head, sizeof *tables->moved.head);
        add(&list, tables->moved.entities.row, header->moved_used * sizeof(struct entity));
        add(&list, tables->moved.intents, header->intents * sizeof(struct event));
    }
    return list.count;
}

uint64_t image_content_bytes(const struct image_header *header, const struct layout *layout)
{
    uint64_t bytes = sizeof(struct state_head) + header->used * sizeof(struct entity) +
                     header->segment.counts.fixed + header->craters * sizeof(struct crater) +
                     header->dents * sizeof(struct dent) +
                     header->contacts * sizeof(struct persistent_contact);
    for (int i = FIRST_STATIC; i <= LAST_STATIC; i++)
        bytes += layout->bytes[i];
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        bytes += (header->ring_end[i] - header->ring_first[i]) * sizeof(struct command);
    if (header->inputs)
        bytes += sizeof(struct state_head) + header->moved_used * sizeof(struct entity) +
                 header->intents * sizeof(struct event);
    return bytes;
}

uint64_t image_header_hash(const struct image_header *header)
{
    struct image_header copy = *header;
    copy.header_hash = 0;
    return XXH3_64bits(&copy, sizeof copy);
}
