/* When to draw: the renderer's own pictures at their rate, and requested pictures between them. */
#ifndef JOLON_RENDERER_DRAW_SCHEDULE_H
#define JOLON_RENDERER_DRAW_SCHEDULE_H

#include "renderer/render_session.h"

/* Waits for the time of the renderer's next pictures, the end of the run or a signal to stop.
 * Meanwhile it draws requested pictures. At the end it updates the session, so that the next
 * pictures show the latest frame. Returns 0, or -1 with the reason. */
int draw_schedule_wait(struct render_session *session, struct view *view, struct error_text *error);

/* After the renderer's own pictures, draws requested pictures that are due, at most the same
 * number. Without this a renderer that cannot keep its rate would never draw them. Returns 0, or -1
 * with the reason. */
int draw_schedule_share(struct render_session *session, struct error_text *error);

#endif
