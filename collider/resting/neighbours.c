/* A search over the frame's pairs, from body to body. */
#include "collider/resting/neighbours.h"

#include "collider/response/path_change.h"
#include "world/maths/sort.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

int neighbours_init(struct neighbours *neighbours, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *neighbours = (struct neighbours){.row = reserve_take(rows, sizeof *neighbours->row),
                                      .listed = calloc(rows, sizeof *neighbours->listed)};
    if (neighbours->row && neighbours->listed)
        return 0;
    neighbours_free(neighbours);
    errno = ENOMEM;
    return -1;
}

void neighbours_free(struct neighbours *neighbours)
{
    reserve_free(neighbours->row);
    free(neighbours->listed);
    *neighbours = (struct neighbours){0};
}

static void add_row(struct neighbours *neighbours, uint32_t row)
{
    if (!neighbours->listed[row])
        neighbours->row[neighbours->count++] = row;
    neighbours->listed[row] = 1;
}

void neighbours_add(struct neighbours *neighbours, const struct pair *pair)
{
    add_row(neighbours, pair->a);
    if (!(pair->b & PAIR_FIXED))
        add_row(neighbours, pair->b);
}

bool neighbours_has(const struct neighbours *neighbours, const struct pair *pair)
{
    return neighbours->listed[pair->a] || (!(pair->b & PAIR_FIXED) && neighbours->listed[pair->b]);
}

/* Returns true if the other side can bear a load. */
static bool is_solid(const struct response_context *context, uint32_t other)
{
    const struct entities *e = &context->next->entities;
    if (other & PAIR_FIXED)
        return contact_groups_is_wall(context, other & ~PAIR_FIXED);
    return e->row[other].state != ENTITY_FREE && e->row[other].behaviour != BEHAVIOUR_FLIGHT &&
           path_change_grounded(context, other);
}

/* A pair that is marked has been measured: its other body may be pushed. */
static void list_pairs_of(struct neighbours *neighbours, struct response_context *context,
                          struct contact_groups *groups, uint32_t row, double reach_m)
{
    struct contact_queue *contacts = context->contacts;
    contact_queue_look_wider(contacts, &context->input, row, reach_m);
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t index = contacts->link[link - 1].pair;
        const struct pair pair = contacts->pair[index];
        uint32_t other = pair.a == row ? pair.b : pair.a;
        if (contacts->marks[index] & CONTACT_GATHERED) {
            neighbours_add(neighbours, &pair);
            continue;
        }
        if (!is_solid(context, other))
            continue;
        contacts->marks[index] |= CONTACT_GATHERED;
        if (!(other & PAIR_FIXED))
            body_motion_require(context->motion, other);
        contact_groups_add(groups, &pair);
    }
}

bool neighbours_list(struct neighbours *neighbours, struct response_context *context,
                     double reach_m, struct contact_groups *groups)
{
    uint32_t first = groups->count;
    for (; neighbours->looked < neighbours->count; neighbours->looked++) {
        list_pairs_of(neighbours, context, groups, neighbours->row[neighbours->looked], reach_m);
        work_done();
    }
    sort_words(&groups->pair[first], groups->count - first);
    return groups->count > first;
}

void neighbours_unmark(struct response_context *context)
{
    for (uint32_t i = 0; i < context->contacts->pair_count; i++)
        context->contacts->marks[i] &= (uint8_t)~CONTACT_GATHERED;
}

void neighbours_begin(struct neighbours *neighbours)
{
    for (uint32_t i = 0; i < neighbours->count; i++)
        neighbours->listed[neighbours->row[i]] = 0;
    neighbours->count = neighbours->looked = 0;
}
