/* Waiting, and drawing requested pictures between the renderer's own. */
#include "renderer/draw_schedule.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/process.h"
#include "renderer/output/stream_requests.h"

#define UPDATE_INTERVAL_NS 500000000u /* between two updates when no picture is due */
#define WAIT_NS            100000000u /* longest wait before signals are checked */

int draw_schedule_wait(struct render_session *session, struct view *view, struct error_text *error)
{
    uint64_t now_ns, update_ns = clock_now_ns() + UPDATE_INTERVAL_NS,
                     due_ns = render_session_due_ns(session);
    while ((now_ns = clock_now_ns()) < due_ns && !process_stopping() &&
           !frame_protocol_finished(view)) {
        uint64_t until_ns = now_ns + WAIT_NS < due_ns ? now_ns + WAIT_NS : due_ns,
                 request_ns = requested_pictures_due_ns(session);
        if (request_ns <= now_ns) {
            if (render_session_update(session, error) != 0 ||
                requested_pictures_draw(session, error) != 0)
                return -1;
            continue;
        }
        stream_requests_wait(session->outputs->stream,
                             until_ns < request_ns ? until_ns : request_ns);
        heartbeat_stage(session->heartbeat);
        if (now_ns >= update_ns) {
            update_ns = now_ns + UPDATE_INTERVAL_NS;
            if (render_session_update(session, error) != 0)
                return -1;
        }
    }
    return render_session_update(session, error);
}

int draw_schedule_share(struct render_session *session, struct error_text *error)
{
    for (uint32_t i = 0; i < session->picture_count; i++) {
        if (requested_pictures_due_ns(session) > clock_now_ns())
            return 0;
        if (requested_pictures_draw(session, error) != 0)
            return -1;
    }
    return 0;
}
