/* Turns: the renderer's own pictures, and those that clients ask for in between. */
#ifndef JOLON_RENDERER_DRAW_SCHEDULE_H
#define JOLON_RENDERER_DRAW_SCHEDULE_H

#include "renderer/render_session.h"

/* Waits for the time of the renderer's next pictures, the end of the run or a signal to stop; draws
 * meanwhile what is asked for, and looks at the world: last of all for those pictures. 0, or -1
 * with the reason. */
int draw_schedule_wait(struct render_session *session, struct view *view, struct error_text *error);

/* After the renderer's pictures, draws as many of those that are asked for and due: so they have
 * their share even when the renderer's own leave no time. 0, or -1 with the reason. */
int draw_schedule_share(struct render_session *session, struct error_text *error);

#endif
