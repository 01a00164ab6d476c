/* Notes of requests. */
#include "gateway/management_notes.h"

#include "ipc/process/crash_point.h"
#include "world/maths/hash.h"

#include <stdatomic.h>
#include <string.h>

_Static_assert(sizeof(struct management_note) == 2 * sizeof(struct pdu_id) + 20 &&
                   sizeof(struct pdu_id) == 6,
               "a note has no padding, which has no value to check");

/* Never 0. */
static uint64_t check_of(const struct management_note *note)
{
    return XXH3_64bits(note, sizeof *note) | 1;
}

void management_notes_put(struct management_notes *notes, uint32_t place,
                          const struct management_note *note)
{
    management_notes_drop(notes, place);
    CRASH_POINT("note of a request");
    notes->place[place].note = *note;
    atomic_signal_fence(memory_order_seq_cst);
    CRASH_POINT("note's check");
    notes->place[place].check = check_of(note);
    atomic_signal_fence(memory_order_seq_cst);
}

void management_notes_drop(struct management_notes *notes, uint32_t place)
{
    CRASH_POINT("note dropped");
    notes->place[place].check = 0;
    atomic_signal_fence(memory_order_seq_cst);
}

bool management_notes_get(const struct management_notes *notes, uint32_t place,
                          struct management_note *note)
{
    *note = notes->place[place].note;
    return notes->place[place].check == check_of(note);
}
