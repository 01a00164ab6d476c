/* Kernels: the inner loops, in the files kernel_*.c. Each is compiled twice, for every processor of
 * the architecture and for those with AVX2. Both give the same picture to the bit. The back end
 * chooses when it is opened. */
#ifndef JOLON_RENDERER_SOFT_KERNEL_H
#define JOLON_RENDERER_SOFT_KERNEL_H

#include "renderer/soft/soft_internal.h"

struct soft_ground;
struct soft_bodies;
struct soft_plants;
struct soft_particles;

/* X(name, result, parameters) of each kernel. */
#define SOFT_KERNELS(X)                                                                            \
    X(soft_ground_set_up, void, (struct soft_ground * ground, const struct soft_frame *frame))     \
    X(soft_ground_fill, void,                                                                      \
      (const struct soft_ground *ground, const struct soft_frame *frame,                           \
       const struct soft_target *target))                                                          \
    X(soft_bodies_set_up, void, (struct soft_bodies * bodies, const struct soft_frame *frame))     \
    X(soft_bodies_fill, void,                                                                      \
      (const struct soft_bodies *bodies, const struct soft_frame *frame,                           \
       const struct soft_target *target))                                                          \
    X(soft_shadows_fill, void,                                                                     \
      (const struct soft_bodies *bodies, const struct soft_plants *plants,                         \
       const struct soft_frame *frame, const struct soft_target *target))                          \
    X(soft_plants_set_up, void, (struct soft_plants * plants, const struct soft_frame *frame))     \
    X(soft_plants_fill, void,                                                                      \
      (const struct soft_plants *plants, const struct soft_frame *frame,                           \
       const struct soft_target *target))                                                          \
    X(soft_particles_set_up, void,                                                                 \
      (struct soft_particles * particles, const struct soft_frame *frame))                         \
    X(soft_particles_fill, void,                                                                   \
      (const struct soft_particles *particles, const struct soft_frame *frame,                     \
       const struct soft_target *target))                                                          \
    X(soft_shade_fill, void,                                                                       \
      (const struct soft_ground *ground, const struct soft_frame *frame,                           \
       const struct soft_target *target))

#define SOFT_DECLARE(name, result, parameters)                                                     \
    result name##_plain parameters;                                                                \
    result name##_avx2 parameters;
SOFT_KERNELS(SOFT_DECLARE)
#undef SOFT_DECLARE

#define SOFT_MEMBER(name, result, parameters) result(*name) parameters;
struct soft_kernels {
    SOFT_KERNELS(SOFT_MEMBER)
};
#undef SOFT_MEMBER

extern const struct soft_kernels soft_kernels_plain, soft_kernels_avx2;

#endif
