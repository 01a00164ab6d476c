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
    double fps;              /* pictures a second; below 0: the scenario's */
    uint32_t width, height;  /* [pixel] 0: the scenario's */
    struct views views;      /* none: the scenario's */
    uint32_t follow;         /* entity id; 0: the renderer chooses a vehicle */
    const char *follow_name; /* its name; NULL: the id is given */
    bool follow_given; /* follow it even as a wreck; else the scenario's until it is destroyed */
    double field_rad;  /* field of view */
    struct view_camera_pose pose; /* of the free camera */
    bool look_given;              /* --look: direction of the free camera */
    int back_end;                 /* enum back_end; below 0: the scenario's */
    const char *device; /* OpenGL device: number or part of its name; NULL: the first usable */
    uint32_t threads;   /* of the own rasteriser; 0: by the number of cores */
    int hold;           /* reduce detail to keep the rate; below 0: the scenario's */
    bool exact;         /* draw committed frames only, without interpolation */
    bool list_devices;
    struct output_set_options outputs; /* used when out is given */
    int parent;                        /* process id, 0: none */
    bool sandbox_off;
};

/* Reads the command line. Ends the process on wrong usage (exit 2) and on --help (exit 0). own: the
 * option table of another program that draws, which takes these options as well, or NULL. Such a
 * program needs no --out, and its default view is chase. Returns the number of arguments that are
 * no options, like option_table_read(). */
int options_read(struct options *options, const struct option_table *own, int argc, char **argv);

#endif
