/* Where vehicles have been lately, for the tracks on the map (thesis row 12). Pure. */
#ifndef JOLON_RENDERER_CHART_TRACK_H
#define JOLON_RENDERER_CHART_TRACK_H

#include "renderer/scene/frame/frame_view.h"

#include <stdint.h>

#define TRACK_POINTS     48u    /* remembered of each vehicle */
#define TRACK_INTERVAL_S 2.5    /* of simulation between two */
#define TRACK_SLOTS_MAX  16384u /* vehicles in higher slots are drawn without a track */

struct track {
    uint32_t id;
    uint32_t count; /* points ever; the ring holds the last of them */
    float x[TRACK_POINTS], z[TRACK_POINTS];
};

struct tracks {
    struct track *track; /* by slot; owned */
    uint32_t slots;
    double last_s; /* of simulation, when points were last added */
};

/* 0, or -1 with errno ENOMEM. */
int tracks_init(struct tracks *tracks, uint32_t capacity);
void tracks_free(struct tracks *tracks);

/* Adds a point to every vehicle's track when the interval has passed. */
void tracks_note(struct tracks *tracks, const struct frame_view *frame_view);

/* The track of a slot if it is this entity's, else NULL. */
const struct track *tracks_of(const struct tracks *tracks, uint32_t slot, uint32_t id);

#endif
