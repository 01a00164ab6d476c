/* The software back end: a rasteriser of our own. */
#ifndef JOLON_RENDERER_SOFT_SOFT_H
#define JOLON_RENDERER_SOFT_SOFT_H

#include "renderer/scene/back_end_interface.h"

#include <stdint.h>

struct soft_kernels;

/* Our own software, on as many threads (1 .. THREAD_POOL_MAX), for pictures up to width x height.
 * The same scene gives the same picture to the bit on every machine and any number of threads. 0,
 * or -1 with the reason: no memory, or too large a picture. */
int soft_open(struct back_end_interface *draw, const struct static_scene *static_scene,
              uint32_t width, uint32_t height, uint32_t threads, struct error_text *error);

/* The vectors that it works with on this processor: "AVX2". */
const char *soft_vectors(void);

/* soft_open() with one build of the kernels. */
int soft_open_build(struct back_end_interface *draw, const struct static_scene *static_scene,
                    uint32_t width, uint32_t height, uint32_t threads,
                    const struct soft_kernels *kernels, struct error_text *error);

#endif
