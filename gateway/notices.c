/* Lines of the log in turns. */
#include "gateway/notices.h"

#include "world/runtime/check.h"

void notices_add(struct notices *notices, notices_teller *tell, void *subject)
{
    CHECK(notices->count < NOTICES_MAX);
    notices->row[notices->count].tell = tell;
    notices->row[notices->count++].subject = subject;
}

void notices_tell(struct notices *notices, uint64_t now_ns)
{
    if (now_ns < notices->due_ns)
        return;
    for (uint32_t i = 0; i < notices->count; i++) {
        uint32_t row = (notices->next + i) % notices->count;
        if (!notices->row[row].tell(notices->row[row].subject, now_ns))
            continue;
        notices->next = (row + 1) % notices->count;
        notices->due_ns = now_ns + NOTICES_EVERY;
        return;
    }
}
