/* What pictures take, where jolon status and others read it. */
#ifndef JOLON_RENDERER_ACCOUNT_H
#define JOLON_RENDERER_ACCOUNT_H

#include "renderer/studio.h"

/* Statistics of one picture begun at begun_ns (CLOCK_MONOTONIC), into the role's slot; nobody
 * depends on them. */
void account_picture(struct view *view, const struct studio *studio, uint64_t begun_ns);

#endif
