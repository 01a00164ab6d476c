/* Whose turn it is. */
#include "renderer/turns.h"

#include "ipc/clock.h"
#include "ipc/frame.h"
#include "ipc/process.h"

#define LOOK_INTERVAL_NS 500000000u /* between two looks at the world when no picture is due */
#define WAIT_NS          100000000u /* the longest wait without a look at the signals */

int turns_wait(struct studio *studio, struct view *view, struct reason *reason)
{
    uint64_t now, look_ns = clock_now_ns() + LOOK_INTERVAL_NS, due_ns = studio_due_ns(studio);
    while ((now = clock_now_ns()) < due_ns && !process_stopping() && !frame_finished(view)) {
        uint64_t until = now + WAIT_NS < due_ns ? now + WAIT_NS : due_ns,
                 asked = booth_due_ns(studio);
        if (asked <= now) {
            if (studio_look(studio, reason) != 0 || booth_draw(studio, reason) != 0)
                return -1;
            continue;
        }
        stream_sleep(studio->outlets->stream, until < asked ? until : asked);
        pulse_stage(studio->pulse);
        if (now >= look_ns) {
            look_ns = now + LOOK_INTERVAL_NS;
            if (studio_look(studio, reason) != 0)
                return -1;
        }
    }
    return studio_look(studio, reason);
}

int turns_share(struct studio *studio, struct reason *reason)
{
    for (uint32_t i = 0; i < studio->shot_count; i++) {
        if (booth_due_ns(studio) > clock_now_ns())
            return 0;
        if (booth_draw(studio, reason) != 0)
            return -1;
    }
    return 0;
}
