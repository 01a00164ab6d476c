/* What the gateway's log says of what comes and goes: one line a second at most, over all subjects,
 * whatever happens. A subject counts; when its turn has come it writes one line with what has
 * happened since its last one. Subjects take turns, so none is kept from speaking by another. One
 * thread. */
#ifndef JOLON_GATEWAY_NOTICES_H
#define JOLON_GATEWAY_NOTICES_H

#include <stdbool.h>
#include <stdint.h>

#define NOTICES_MAX   16u
#define NOTICES_EVERY 1000000000u /* [ns] from one line to the next at least */

/* Writes one line of the log if there is something new. Returns whether there was. now_ns: the time
 * of the clock. */
typedef bool notices_teller(void *subject, uint64_t now_ns);

struct notices {
    uint32_t count, next;
    uint64_t due_ns; /* when the next line may be written */
    struct {
        notices_teller *tell;
        void *subject;
    } row[NOTICES_MAX];
};

/* Adds a subject, of NOTICES_MAX at most. */
void notices_add(struct notices *notices, notices_teller *tell, void *subject);

/* Lets the next subject that has something new write its line, if it is time. */
void notices_tell(struct notices *notices, uint64_t now_ns);

#endif
