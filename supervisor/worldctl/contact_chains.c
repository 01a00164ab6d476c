/* Chains of contacts by rows. */
#include "supervisor/worldctl/contact_chains.h"

#include "world/entity/persistent_contact.h"

#include <errno.h>
#include <stdlib.h>

static void add_side(struct contact_chains *chains, uint32_t used, uint32_t row, uint32_t side)
{
    if (row >= used)
        return; /* a fixed object's */
    chains->next[side] = chains->first[row];
    chains->first[row] = side + 1;
}

int contact_chains_make(struct contact_chains *chains, const struct snapshot *snapshot)
{
    uint32_t used = snapshot->head.used, count = snapshot->head.contact_count;
    *chains = (struct contact_chains){.contacts = snapshot->contacts,
                                      .first = calloc(used + 1u, sizeof *chains->first),
                                      .next = calloc(2u * count + 1u, sizeof *chains->next)};
    if (!chains->first || !chains->next) {
        contact_chains_free(chains);
        errno = ENOMEM;
        return -1;
    }
    for (uint32_t n = count; n-- > 0;) { /* from the end, so that each chain rises */
        add_side(chains, used, snapshot->contacts[n].b_row, 2 * n + 1);
        add_side(chains, used, snapshot->contacts[n].a_row, 2 * n);
    }
    return 0;
}

void contact_chains_free(struct contact_chains *chains)
{
    free(chains->first);
    free(chains->next);
    *chains = (struct contact_chains){0};
}

void contact_chains_json(cJSON *object, const struct contact_chains *chains, uint32_t row)
{
    cJSON *array = json_array(object, "contacts");
    for (uint32_t side = chains->first[row]; side != 0; side = chains->next[side - 1]) {
        const struct persistent_contact *contact = &chains->contacts[(side - 1) / 2];
        uint32_t other = (side - 1) % 2 ? contact->a_id : contact->b_id;
        bool fixed = (other & PERSISTENT_CONTACT_FIXED) != 0;
        cJSON *item = cJSON_CreateObject();
        (void)cJSON_AddItemToArray(array, item); /* NULL: the first json_whole() reports that */
        json_whole(item, "id", fixed ? (other & ~PERSISTENT_CONTACT_FIXED) + 1 : other);
        json_bool(item, "fixed", fixed);
        json_whole(item, "begin_tick", contact->begin_tick);
        json_whole(item, "pressed_tick", contact->pressed_tick);
    }
}
