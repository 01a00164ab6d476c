/* Every body with every other: slow, and easily seen to be right. The oracle of the other
 * methods. */
#include "collider/method/method.h"

#include "world/runtime/work_done.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

static void meet_rows(const struct method_input *input, const struct path_box *box, uint32_t a,
                      struct pair_list *pairs)
{
    for (uint32_t b = a + 1; b < input->rows; b++) {
        if (pair_filter_there(input, b) && pair_filter_boxes_meet(&box[a], &box[b]) &&
            !pair_excluded(input, a, b))
            pair_list_add(pairs, a, b);
    }
}

static void meet_fixed(const struct method_input *input, const struct path_box *box, uint32_t a,
                       struct pair_list *pairs)
{
    if (!pair_filter_tests_fixed(input, a))
        return;
    for (uint32_t b = 0; b < input->world->counts.fixed; b++) {
        if (pair_filter_stands(input, b) &&
            pair_filter_box_meets_fixed(input, &box[a], &input->world->fixed[b]))
            pair_list_add(pairs, a, b | PAIR_FIXED);
    }
}

void method_brute_pairs(const struct method_input *input, struct method_workspace *workspace,
                        struct pair_list *pairs)
{
    struct path_box *box = method_block(workspace, 0, input->rows, sizeof *box);
    for (uint32_t i = 0; i < input->rows; i++) {
        if (pair_filter_there(input, i))
            box[i] = pair_filter_box(input, i);
    }
    for (uint32_t i = 0; i < input->rows; i++) {
        if (pair_filter_there(input, i)) {
            meet_rows(input, box, i, pairs);
            meet_fixed(input, box, i, pairs);
            work_done();
        }
    }
}
