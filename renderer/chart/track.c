/* Tracks: a ring of points a slot. */
#include "renderer/chart/track.h"

#include <stdlib.h>

int tracks_init(struct tracks *tracks, uint32_t capacity)
{
    tracks->slots = capacity < TRACK_SLOTS_MAX ? capacity : TRACK_SLOTS_MAX;
    tracks->last_s = -TRACK_INTERVAL_S;
    tracks->track = calloc(tracks->slots, sizeof *tracks->track);
    return tracks->track == NULL ? -1 : 0;
}

void tracks_free(struct tracks *tracks)
{
    free(tracks->track);
    tracks->track = NULL;
}

void tracks_note(struct tracks *tracks, const struct frame_view *frame_view)
{
    double now = state_time_s(frame_view->world, frame_view->head);
    if (now - tracks->last_s < TRACK_INTERVAL_S)
        return;
    tracks->last_s = now;
    const struct entities *e = frame_view->entities;
    for (uint32_t i = 0; i < frame_view->head->used && i < tracks->slots; i++) {
        if (e->row[i].state != ENTITY_ACTIVE)
            continue;
        struct track *track = &tracks->track[i];
        if (track->id != e->row[i].id) {
            track->id = e->row[i].id;
            track->count = 0;
        }
        track->x[track->count % TRACK_POINTS] = (float)e->row[i].x;
        track->z[track->count % TRACK_POINTS] = (float)e->row[i].z;
        track->count++;
    }
}

const struct track *tracks_of(const struct tracks *tracks, uint32_t slot, uint32_t id)
{
    if (slot >= tracks->slots || tracks->track[slot].id != id)
        return NULL;
    return &tracks->track[slot];
}
