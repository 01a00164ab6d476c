/* The software back end: a rasteriser that needs no graphics library. */
#ifndef JOLON_RENDERER_SOFT_SOFT_H
#define JOLON_RENDERER_SOFT_SOFT_H

#include "renderer/scene/back_end_interface.h"

#include <stdint.h>

struct soft_kernels;

/* Opens the software back end on this many threads (1 .. THREAD_POOL_MAX), for pictures up to width
 * x height. The same scene gives the same picture to the bit on every machine and for any number of
 * threads. Returns 0, or -1 with the reason: no memory, or too large a picture. */
int soft_open(struct back_end_interface *draw, const struct static_scene *static_scene,
              uint32_t width, uint32_t height, uint32_t threads, struct error_text *error);

/* Returns the vector instructions that it uses on this processor: "AVX2" or "SSE2". */
const char *soft_vectors(void);

/* Does the same as soft_open(), with a given build of the kernels. */
int soft_open_build(struct back_end_interface *draw, const struct static_scene *static_scene,
                    uint32_t width, uint32_t height, uint32_t threads,
                    const struct soft_kernels *kernels, struct error_text *error);

#endif
