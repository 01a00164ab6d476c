/* The list of a renderer's views: which pictures it draws of a frame. Pure. */
#ifndef JOLON_RENDERER_VIEWS_H
#define JOLON_RENDERER_VIEWS_H

#include "ipc/segment/segment.h"
#include "world/view_mode.h"

#include <stdint.h>

#define VIEWS_MAX       8u
#define VIEW_NAME_BYTES 24u

struct view_spec {
    enum view_mode mode;
    uint32_t vehicle; /* id of the vehicle to show; 0: the one that the renderer follows */
    char name[VIEW_NAME_BYTES]; /* of its files: "chase", or "chase.17" with a vehicle */
};

struct views {
    struct view_spec spec[VIEWS_MAX];
    uint32_t count;
};

/* Reads "VIEW[:ID][,VIEW[:ID]...]"; "both" is "chase,map". Returns 0, or -1 with the reason, which
 * does not name the option. */
int views_read(struct views *views, const char *text, struct error_text *error);

/* Makes the list of a set of bits 1 << enum view_mode, in the order of the enum. */
void views_of_bits(struct views *views, uint32_t bits);

#endif
