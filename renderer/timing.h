/* The renderer's statistics in its role slot, which jolon status and others read. */
#ifndef JOLON_RENDERER_TIMING_H
#define JOLON_RENDERER_TIMING_H

#include "renderer/render_session.h"

/* Writes the time that pictures begun at begun_ns (CLOCK_MONOTONIC) took, and their quality. */
void timing_picture(struct view *view, const struct render_session *session, uint64_t begun_ns);

#endif
