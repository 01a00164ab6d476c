/* Choosing and opening the back end. */
#include "renderer/back_end.h"

#include "ipc/process/log.h"
#include "renderer/gl/gl.h"
#include "renderer/gl/gl_context.h"
#include "renderer/gl/gl_devices.h"
#include "renderer/soft/soft.h"
#include "world/view_mode.h"

#include <stdio.h>
#include <unistd.h>

#define REASON_BYTES    400
#define THREADS_DEFAULT 4u /* at most, without --threads */

static int open_gl(struct back_end_interface *draw, const struct options *options,
                   const struct static_scene *static_scene, const char *because,
                   struct error_text *error)
{
    struct gl_request request = {.device = options->device,
                                 .hardware =
                                     options->back_end != BACK_END_GL && options->device == NULL};
    char name[BACK_END_NAME_BYTES];
    if (gl_open(draw, static_scene, options->width, options->height, &request, name, error) != 0)
        return -1;
    log_info("draws with %s: %s", name, because);
    return 0;
}

/* Without --threads half of the cores remain for the simulation and other renderers. */
static uint32_t threads_for(const struct options *options)
{
    if (options->threads > 0)
        return options->threads;
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 4 ? 1 : cores > 8 ? THREADS_DEFAULT : (uint32_t)(cores / 2);
}

static int open_soft(struct back_end_interface *draw, const struct options *options,
                     const struct static_scene *static_scene, const char *because,
                     struct error_text *error)
{
    uint32_t threads = threads_for(options);
    if (soft_open(draw, static_scene, options->width, options->height, threads, error) != 0)
        return -1;
    log_info("draws with the own rasteriser, %u thread%s, %s: %s", threads, threads == 1 ? "" : "s",
             soft_vectors(), because);
    return 0;
}

int back_end_open(struct back_end_interface *draw, const struct options *options,
                  const struct static_scene *static_scene, struct error_text *error)
{
    char missing[REASON_BYTES], because[REASON_BYTES + 32];
    if (options->back_end == BACK_END_GL || options->device != NULL)
        return open_gl(draw, options, static_scene, "asked for", error);
    if (options->back_end == BACK_END_SOFT)
        return open_soft(draw, options, static_scene, "asked for", error);
    if (gl_hardware(missing, sizeof missing)) {
        if (open_gl(draw, options, static_scene, "graphics hardware", error) == 0)
            return 0;
        snprintf(missing, sizeof missing, "%.390s", error->text);
    }
    snprintf(because, sizeof because, "no graphics hardware (%s)", missing);
    return open_soft(draw, options, static_scene, because, error);
}

int back_end_list(void)
{
    printf("soft  own rasteriser, %s; --backend soft\n", soft_vectors());
    gl_context_list();
    return 0;
}
