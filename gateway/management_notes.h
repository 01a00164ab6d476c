/* Requests that were acknowledged before their time came, in shared memory: a gateway that is
 * killed leaves them to the next one. One process writes, and reads only when it starts. */
#ifndef JOLON_GATEWAY_MANAGEMENT_NOTES_H
#define JOLON_GATEWAY_MANAGEMENT_NOTES_H

#include "gateway/pdu/pdu.h"

#include <stdbool.h>

#define MANAGEMENT_NOTES 64u /* requests at most */

struct management_note {
    double due_s;           /* since 1970, UTC */
    struct pdu_id from, as; /* the sender, and the identifier that acknowledges */
    uint32_t number;
    uint32_t type; /* enum pdu_type */
    uint32_t unused;
};

/* Zero bytes are notes of nothing. */
struct management_notes {
    struct {
        uint64_t check; /* of the note, 0: there is none; written last, and taken away first */
        struct management_note note;
    } place[MANAGEMENT_NOTES];
};

/* Writes a note into a place, and takes one away. place: below MANAGEMENT_NOTES. */
void management_notes_put(struct management_notes *notes, uint32_t place,
                          const struct management_note *note);
void management_notes_drop(struct management_notes *notes, uint32_t place);

/* Reads the note of a place. Returns false if there is none, or only a part of one, because its
 * writer was killed. */
bool management_notes_get(const struct management_notes *notes, uint32_t place,
                          struct management_note *note);

#endif
