/* What pictures take, where jolon status and others read it. */
#ifndef JOLON_RENDERER_TIMING_H
#define JOLON_RENDERER_TIMING_H

#include "renderer/render_session.h"

/* Statistics of one picture begun at begun_ns (CLOCK_MONOTONIC), into the role's slot; nobody
 * depends on them. */
void timing_picture(struct view *view, const struct render_session *session, uint64_t begun_ns);

#endif
