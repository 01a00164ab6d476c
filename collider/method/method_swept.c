/* The method "swept": the pairs of the broad phase. The broad phase runs in each frame, under every
 * method, because explosions and changed paths use it for look-ups. */
#include "collider/broad_phase/broad_phase.h"
#include "collider/method/method.h"

void method_swept_pairs(const struct method_input *input, struct method_workspace *workspace,
                        struct pair_list *pairs)
{
    const struct broad_phase *broad = method_broad_phase(workspace);
    (void)input;
    for (uint32_t i = 0; i < THREAD_POOL_MAX; i++)
        pair_list_append(pairs, &broad->list[i]);
}
