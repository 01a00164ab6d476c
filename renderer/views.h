/* Which pictures a renderer makes of a frame: the list of its views. Pure. */
#ifndef JOLON_RENDERER_VIEWS_H
#define JOLON_RENDERER_VIEWS_H

#include "ipc/segment/segment.h"
#include "world/param_values.h"

#include <stdint.h>

#define VIEWS_MAX       8u
#define VIEW_NAME_BYTES 24u

struct view_spec {
    enum view_mode mode;
    uint32_t vehicle;           /* its own; 0: whom the renderer follows */
    char name[VIEW_NAME_BYTES]; /* of its files: "chase", or "chase.17" for vehicle 17's own */
};

struct views {
    struct view_spec spec[VIEWS_MAX];
    uint32_t count;
};

/* Reads "VIEW[:ID][,VIEW[:ID]...]"; "both" is "chase,map". 0, or -1 with what is wrong and what
 * would be right: the value's, without the option's name. */
int views_read(struct views *views, const char *text, struct error_text *error);

/* The list that a set of bits 1 << enum view_mode stands for, in the order of the enum. */
void views_of_bits(struct views *views, uint32_t bits);

#endif
