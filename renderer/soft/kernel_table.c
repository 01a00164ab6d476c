/* The kernels of this build. */
#include "renderer/soft/kernel.h"
#include "renderer/soft/simd8.h"

#define ENTRY(name, result, parameters) .name = KERNEL(name),
const struct soft_kernels KERNEL(soft_kernels) = {SOFT_KERNELS(ENTRY)};
