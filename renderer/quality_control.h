/* Quality control: a renderer that cannot keep its rate draws less detail first, then smaller
 * pictures that are scaled up. Pure: the caller measures the times. */
#ifndef JOLON_RENDERER_QUALITY_CONTROL_H
#define JOLON_RENDERER_QUALITY_CONTROL_H

#include <stdint.h>

#define QUALITY_CONTROL_LEVELS            6u
#define QUALITY_CONTROL_PICTURES          9u   /* in the median that decides */
#define QUALITY_CONTROL_BUSY              0.92 /* of the interval: a longer median lowers quality */
#define QUALITY_CONTROL_IDLE              0.50 /* a shorter median for the raise delay raises it */
#define QUALITY_CONTROL_RAISE_DELAY_S     3.0  /* at first; doubled after each raise that failed */
#define QUALITY_CONTROL_RAISE_DELAY_MAX_S 96.0
#define QUALITY_CONTROL_TRIAL_S           8.0 /* a raise has failed if a fall follows so soon */

struct quality_control_level {
    double detail;     /* of the scene (renderer/scene/scene.h), 1: all */
    uint32_t quarters; /* of the picture's width and height that are drawn */
};

struct quality_control {
    double interval_s;                       /* between two pictures; 0: quality stays at level 0 */
    uint32_t level;                          /* index in quality_control_levels, 0: all */
    uint32_t count;                          /* pictures since the last change */
    double took_s[QUALITY_CONTROL_PICTURES]; /* ring */
    double judged_s;                         /* median that caused the last change */
    double raise_delay_s;
    double idle_since_s, raised_s;
};

extern const struct quality_control_level quality_control_levels[QUALITY_CONTROL_LEVELS];

/* fps 0: there is no rate to keep, and quality stays at level 0. */
void quality_control_init(struct quality_control *quality, double fps);

/* Notes a picture that took took_s and was ready at now_s of a steady clock. Returns -1 when
 * quality was lowered, 1 when it was raised, else 0. */
int quality_control_note(struct quality_control *quality, double took_s, double now_s);

/* Returns the median of the last pictures [s]; 0 before QUALITY_CONTROL_PICTURES of one level. */
double quality_control_median_s(const struct quality_control *quality);

#endif
