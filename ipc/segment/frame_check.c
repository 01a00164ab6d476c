/* Checks of the frames in a world's buffers. */
#include "ipc/segment/frame_check.h"

#include "ipc/segment/segment_internal.h"
#include "world/checksum.h"
#include "world/entity/persistent_contact.h"

#include <inttypes.h>

static int check_batteries(const struct segment_header *header, const struct state_head *head,
                           struct error_text *error)
{
    if (head->battery_count > BATTERIES_MAX)
        return error_text_set(error, "battery_count = %u; at most %u", head->battery_count,
                              BATTERIES_MAX);
    for (uint32_t i = 0; i < head->battery_count; i++) {
        const struct battery *battery = &head->battery[i];
        if (battery->guns > BATTERY_GUNS_MAX)
            return error_text_set(error, "battery %u: guns = %u; at most %u", i, battery->guns,
                                  BATTERY_GUNS_MAX);
        if (battery->munition >= header->counts.kinds)
            return error_text_set(error, "battery %u: munition = %u; kinds = %u", i,
                                  battery->munition, header->counts.kinds);
    }
    return 0;
}

static int check_debris(const struct segment_header *header, const struct state_head *head,
                        struct error_text *error)
{
    if (head->debris_count > DEBRIS_MAX)
        return error_text_set(error, "debris_count = %u; room for %u", head->debris_count,
                              DEBRIS_MAX);
    for (uint32_t i = 0; i < head->debris_count; i++) {
        if (head->debris[i].object >= header->counts.fixed)
            return error_text_set(error, "debris %u: object = %u; fixed objects = %u", i,
                                  head->debris[i].object, header->counts.fixed);
    }
    return 0;
}

int segment_check_head(const struct view *view, const struct state_head *head,
                       struct error_text *error)
{
    const struct segment_header *header = view->header;
    if (head->used > header->capacity)
        return error_text_set(error, "used = %u; capacity = %u", head->used, header->capacity);
    if (head->crater_count > header->crater_slots)
        return error_text_set(error, "crater_count = %u; crater_slots = %u", head->crater_count,
                              header->crater_slots);
    if (head->dent_count > header->dent_slots)
        return error_text_set(error, "dent_count = %u; dent_slots = %u", head->dent_count,
                              header->dent_slots);
    if (head->contact_count > header->contact_slots)
        return error_text_set(error, "contact_count = %u; contact_slots = %u", head->contact_count,
                              header->contact_slots);
    if (head->intent_count > header->intents_per_frame)
        return error_text_set(error, "intent_count = %u; intents_per_frame = %u",
                              head->intent_count, header->intents_per_frame);
    if (check_debris(header, head, error) != 0)
        return -1;
    return check_batteries(header, head, error);
}

static int check_frame(const struct view *view, const struct state_head *head, uint64_t frame,
                       enum region region, struct error_text *error)
{
    struct error_text what;
    if (head->frame != frame)
        return error_text_set(error, "%s holds frame %" PRIu64 ", not %" PRIu64,
                              region_name(region), head->frame, frame);
    if (segment_check_head(view, head, &what) != 0)
        return error_text_set(error, "%s: %s", region_name(region), what.text);
    return 0;
}

/* Checks one contact without its place in the list. */
static int check_contact(const struct persistent_contact *contact, uint32_t used, uint32_t fixed,
                         struct error_text *error)
{
    bool on_fixed = (contact->b_id & PERSISTENT_CONTACT_FIXED) != 0;
    if (contact->a_id == 0 || (contact->a_id & PERSISTENT_CONTACT_FIXED) != 0 ||
        contact->a_id >= contact->b_id)
        return error_text_set(error, "a_id = %u; b_id = %u", contact->a_id, contact->b_id);
    if (on_fixed && (contact->b_id & ~PERSISTENT_CONTACT_FIXED) >= fixed)
        return error_text_set(error, "b_id = fixed object %u; fixed objects = %u",
                              contact->b_id & ~PERSISTENT_CONTACT_FIXED, fixed);
    if (contact->a_row >= used)
        return error_text_set(error, "a_row = %u; used = %u", contact->a_row, used);
    if (on_fixed && contact->b_row != SLOT_NONE)
        return error_text_set(error, "b_row = %u; a fixed object has none", contact->b_row);
    if (!on_fixed && contact->b_row >= used)
        return error_text_set(error, "b_row = %u; used = %u", contact->b_row, used);
    return 0;
}

static int check_contacts(const struct state *state, uint32_t fixed, struct error_text *error)
{
    struct error_text what;
    for (uint32_t i = 0; i < state->head->contact_count; i++) {
        const struct persistent_contact *contact = &state->contacts[i];
        if (check_contact(contact, state->head->used, fixed, &what) != 0)
            return error_text_set(error, "contact %u: %s", i, what.text);
        if (i > 0 && persistent_contact_key(contact - 1) >= persistent_contact_key(contact))
            return error_text_set(error, "contact %u: not in the order of ids", i);
    }
    return 0;
}

int segment_check_state(const struct view *view, uint64_t frame, struct error_text *error)
{
    const struct state *state = &view->w[frame & 1];
    struct error_text what;
    enum region region = frame & 1 ? REGION_WORLD_B : REGION_WORLD_A;
    if (check_frame(view, state->head, frame, region, error) != 0)
        return -1;
    if (!state_whole(state, view->header->counts.fixed))
        return error_text_set(error, "frame %" PRIu64 " fails its checksum (%s, craters or dents)",
                              frame, region_name(region));
    if (check_contacts(state, view->header->counts.fixed, &what) != 0)
        return error_text_set(error, "%s: %s", region_name(region), what.text);
    return 0;
}

int segment_check_moved(const struct view *view, uint64_t frame, struct error_text *error)
{
    if (check_frame(view, view->m.head, frame, REGION_MOVED, error) != 0)
        return -1;
    if (!moved_whole(&view->m))
        return error_text_set(error, "frame %" PRIu64 " of the moved table fails its checksum",
                              frame);
    return 0;
}
