/* The views that a renderer draws and its back ends, with their words. A value out of range has the
 * word "?". */
#ifndef JOLON_WORLD_VIEW_MODE_H
#define JOLON_WORLD_VIEW_MODE_H

enum view_mode {
    VIEW_CHASE,    /* from behind */
    VIEW_MAP,      /* the map */
    VIEW_INSIDE,   /* from the crew's eye */
    VIEW_ORBIT,    /* around it */
    VIEW_FREE,     /* from a fixed place */
    VIEW_OVERHEAD, /* straight down */
    VIEW_COUNT
};

/* How to draw: OpenGL, the renderer's own rasteriser, or the one that suits the machine. */
enum back_end { BACK_END_AUTO, BACK_END_GL, BACK_END_SOFT, BACK_END_COUNT };

const char *view_mode_name(enum view_mode view);
const char *back_end_name(enum back_end back_end);

#endif
