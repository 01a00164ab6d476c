/* The renderer's command line. */
#ifndef JOLON_RENDERER_OPTIONS_H
#define JOLON_RENDERER_OPTIONS_H

#include "ipc/process/option_table.h"
#include "ipc/segment/role.h"
#include "renderer/output/output_set.h"
#include "renderer/scene/camera/view_camera.h"
#include "renderer/views.h"

#include <stdbool.h>
#include <stdint.h>

#define OPTIONS_SIDE_MIN 64u
#define OPTIONS_SIDE_MAX 4096u

struct options {
    const char *world, *out, *snap; /* out, snap: NULL when not given */
    enum role role;
    double fps;              /* pictures a second; below 0: the world's */
    uint32_t width, height;  /* 0: the world's */
    struct views views;      /* none: the world's */
    uint32_t follow;         /* entity id, 0: picks one */
    const char *follow_name; /* or its name, NULL */
    bool follow_given; /* follows it even as a wreck; else the world's choice while it lives */
    double field_rad;  /* of view */
    struct view_camera_pose pose; /* of the free camera */
    bool look_given;              /* its direction */
    int back_end;                 /* enum back_end; below 0: the world's */
    const char *device;           /* number or part of the name; NULL: the first that draws */
    uint32_t threads;             /* of the own rasteriser; 0: as suits the machine */
    int hold;                     /* less detail rather than fewer pictures; below 0: the world's */
    bool exact;                   /* committed frames alone, nothing between them */
    bool list_devices;
    struct output_set_options outputs; /* where pictures go, when out is given */
    int parent;                        /* 0: none */
    bool sandbox_off;
};

/* Ends the process on wrong usage (exit 2) and on --help (exit 0). own is the table of another
 * program that draws, where these options are read too: it needs no --out, and its view is chase
 * unless another is given; NULL: the renderer's. Returns how many arguments are no options, as
 * option_table_read(). */
int options_read(struct options *options, const struct option_table *own, int argc, char **argv);

#endif
