/* A look at the bits of the rows that are awake, and at each contact. */
#include "collider/resting/sleeping_contacts.h"

#include "collider/broad_phase/broad_phase.h"
#include "collider/broad_phase/resting_records.h"
#include "collider/motion/pair_filter.h"
#include "collider/resting/contact_groups.h"
#include "world/checksum.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/world.h"

#include <string.h>

static bool rests(const struct response_context *context, uint32_t row, uint32_t id)
{
    return entities_alive(&context->next->entities, row, id) &&
           !resting_records_awake(&context->broad->resting, row);
}

static bool bears(const struct persistent_contact *contact)
{
    static const struct contact_load none[PERSISTENT_CONTACT_NEAREST];
    return memcmp((const unsigned char *)contact->load, (const unsigned char *)none, sizeof none) !=
           0;
}

/* Returns true if a standing object leaves the row as it is. A bush does not bear a wreck, which
 * wakes in each frame. */
static bool leaves(const struct response_context *context, uint32_t row, uint32_t object)
{
    return pair_filter_stands(&context->input.detect, object) &&
           (context->next->entities.row[row].state != ENTITY_WRECK ||
            contact_groups_is_wall(context, object));
}

static bool sleeps(const struct response_context *context, const struct persistent_contact *contact)
{
    if (contact->flags & PERSISTENT_CONTACT_OVERLAPS ||
        !rests(context, contact->a_row, contact->a_id) || bears(contact))
        return false;
    return contact->b_id & PERSISTENT_CONTACT_FIXED
               ? leaves(context, contact->a_row, contact->b_id & ~PERSISTENT_CONTACT_FIXED)
               : rests(context, contact->b_row, contact->b_id);
}

bool sleeping_contacts_all(const struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    /* The owner of a remote entity may move it after the contacts of a frame. */
    if (context->world->params->remotes_max != 0)
        return false;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        if (!sleeps(context, &committed->contacts[i]))
            return false;
    }
    return true;
}

/* Returns true if a row that a response has written may no longer hold the body that it held. */
static bool may_be_gone(const struct state *committed, const struct state *next, uint32_t row)
{
    const struct entity *now = &next->entities.row[row], *before = &committed->entities.row[row];
    return now->state == ENTITY_FREE || now->state != before->state || now->id != before->id;
}

/* Returns true if a response may have ended the life of a body, or has broken a fixed object. */
static bool any_gone(const struct response_context *context)
{
    const struct state *committed = context->motion->committed, *next = context->next;
    for (uint32_t w = 0; w * 64 < next->head->used; w++) {
        for (uint64_t left = context->writer.written[w]; left != 0; left &= left - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(left);
            if (may_be_gone(committed, next, row))
                return true;
        }
    }
    return committed->head->tally.fixed_damaged != next->head->tally.fixed_damaged;
}

/* Returns true if two bodies touched in this frame, with room for their contact or without. */
static bool any_touched(const struct response_context *context)
{
    for (uint32_t i = 0; i < context->contacts->pair_count; i++) {
        if (context->contacts->marks[i] & CONTACT_PRESSED)
            return true;
    }
    return context->without_room != 0;
}

bool sleeping_contacts_keep(const struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    struct state *next = context->next;
    uint32_t count = committed->head->contact_count;
    if (!context->contacts_sleep || context->motion->changes != 0 || any_touched(context) ||
        any_gone(context))
        return false;
    memcpy(next->contacts, committed->contacts, count * sizeof *next->contacts);
    next->head->contact_count = count;
    return true;
}
