/* Tracks: where each vehicle has been lately, for the map (thesis row 12). Pure. */
#ifndef JOLON_RENDERER_CHART_TRACK_H
#define JOLON_RENDERER_CHART_TRACK_H

#include "renderer/scene/frame/frame_view.h"

#include <stdint.h>

#define TRACK_POINTS     48u    /* of each vehicle */
#define TRACK_INTERVAL_S 2.5    /* of simulation between two points */
#define TRACK_SLOTS_MAX  16384u /* vehicles in higher slots have no track */

struct track {
    uint32_t id;
    uint32_t count; /* of all points; the rings hold the last of them */
    float x[TRACK_POINTS], z[TRACK_POINTS];
};

struct tracks {
    struct track *track; /* by slot; owned */
    uint32_t slots;
    double last_s; /* of simulation, when points were last added */
};

/* Returns 0, or -1 with errno ENOMEM. */
int tracks_init(struct tracks *tracks, uint32_t capacity);
void tracks_free(struct tracks *tracks);

/* Adds a point to every vehicle's track when the interval has passed. */
void tracks_note(struct tracks *tracks, const struct frame_view *frame_view);

/* Returns the track of a slot if it belongs to this entity, else NULL. */
const struct track *tracks_of(const struct tracks *tracks, uint32_t slot, uint32_t id);

#endif
