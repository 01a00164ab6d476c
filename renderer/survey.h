/* The ground of maps, for who draws the rest of a map himself: shaded, with contours and roads, and
 * nothing that moves. One thread at a time, whichever. */
#ifndef JOLON_RENDERER_SURVEY_H
#define JOLON_RENDERER_SURVEY_H

#include "renderer/chart/base.h"
#include "renderer/output/stream.h"

struct survey {
    struct base base;
};

void survey_open(struct survey *survey, const struct world *world);
void survey_close(struct survey *survey);

/* Paints maps with it, which must outlive that. The picture's pixels are those of the world's
 * raster at its scale, so its middle is up to half a pixel off; panning paints what comes into
 * view. */
struct stream_painter survey_painter(struct survey *survey);

#endif
