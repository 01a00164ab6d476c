/* Chooses between the two builds of the same loop. */
#include "renderer/soft/fxaa.h"

void fxaa_rows(struct image *to, const struct image *from, uint32_t first, uint32_t end)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        fxaa_rows_avx2(to, from, first, end);
        return;
    }
#endif
    fxaa_rows_plain(to, from, first, end);
}
