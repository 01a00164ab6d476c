/* The followed vehicle in figures (thesis row 13), in common units. Pure. */
#ifndef JOLON_RENDERER_SCENE_FRAME_STATISTICS_H
#define JOLON_RENDERER_SCENE_FRAME_STATISTICS_H

#include "renderer/scene/frame/frame_view.h"

#include <stddef.h>
#include <stdint.h>

struct statistics {
    char name[64]; /* its own name, or the name of the kind and the id */
    const char *kind, *force, *state, *damage, *behaviour;
    uint32_t id;
    double speed_kmh, heading_deg, pitch_deg, roll_deg;
    double altitude_m;     /* above sea level */
    double above_ground_m; /* height of the position above the ground */
    double fuel_share;     /* 0..1 of the full tank; 1 for kinds without one */
    uint32_t rounds;
    uint32_t rounds_full; /* a full load; 0 for kinds without rounds */
    uint64_t frame;
    double time_s; /* of simulation */
};

void statistics_of(struct statistics *statistics, const struct frame_view *frame_view,
                   uint32_t slot);

/* Writes all of them in one line, as it is stored with a picture. */
void statistics_line(const struct statistics *statistics, char *text, size_t bytes);

#endif
