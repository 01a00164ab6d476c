/* How much a renderer draws, so that it keeps its rate: less detail first, then smaller pictures
 * that are stretched. Pure: it is told what pictures took, and looks at no clock. */
#ifndef JOLON_RENDERER_QUALITY_CONTROL_H
#define JOLON_RENDERER_QUALITY_CONTROL_H

#include <stdint.h>

#define QUALITY_CONTROL_LEVELS     6u
#define QUALITY_CONTROL_PICTURES   9u   /* whose median counts */
#define QUALITY_CONTROL_BUSY       0.92 /* of the interval: more, and it draws less */
#define QUALITY_CONTROL_IDLE       0.50 /* of the interval: less for its patience, and it draws more */
#define QUALITY_CONTROL_PATIENCE_S 3.0 /* at first; doubled each time that more was too much */
#define QUALITY_CONTROL_LONGEST_S  96.0
#define QUALITY_CONTROL_TRIAL_S    8.0 /* so long after a rise, a fall says that it was too much */

struct quality_control_level {
    double detail;     /* of the scene (renderer/scene/scene.h), 1 is all */
    uint32_t quarters; /* of the picture's width and height */
};

struct quality_control {
    double interval_s; /* between two pictures; 0: holds nothing, draws everything */
    uint32_t level;    /* of quality_control_levels, 0: everything */
    uint32_t count;    /* pictures since the last change; of the ring when more */
    double took_s[QUALITY_CONTROL_PICTURES];
    double judged_s; /* what the pictures took that the last change was made for */
    double patience_s;
    double idle_since_s, raised_s;
};

extern const struct quality_control_level quality_control_levels[QUALITY_CONTROL_LEVELS];

/* fps 0: there is no rate to keep. */
void quality_control_init(struct quality_control *quality, double fps);

/* A picture took so long and was ready at now_s (of any clock that goes on evenly). -1: draws less
 * from now on; 1: more; 0: as before. */
int quality_control_note(struct quality_control *quality, double took_s, double now_s);

/* Median of the last pictures [s]; 0 before there were QUALITY_CONTROL_PICTURES of one level. */
double quality_control_median_s(const struct quality_control *quality);

#endif
