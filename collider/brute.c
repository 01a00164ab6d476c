/* Every body with every other: slow, and right by inspection. The oracle of the other methods. */
#include "collider/detect.h"

#include "world/work_done.h"

static void meet_rows(const struct detect_input *input, const struct sweep_box *box, uint32_t a,
                      struct pair_list *pairs)
{
    for (uint32_t b = a + 1; b < input->rows; b++) {
        if (detect_there(input, b) && detect_boxes_meet(&box[a], &box[b]) &&
            !detect_apart(input, a, b))
            pair_list_add(pairs, a, b);
    }
}

static void meet_fixed(const struct detect_input *input, const struct sweep_box *box, uint32_t a,
                       struct pair_list *pairs)
{
    if (!detect_tests_fixed(input, a))
        return;
    for (uint32_t b = 0; b < input->world->counts.fixed; b++) {
        if (detect_stands(input, b) &&
            detect_box_meets_fixed(input, &box[a], &input->world->fixed[b]))
            pair_list_add(pairs, a, b | PAIR_FIXED);
    }
}

void brute_pairs(const struct detect_input *input, struct detect_workspace *workspace,
                 struct pair_list *pairs)
{
    struct sweep_box *box = detect_block(workspace, 0, input->rows, sizeof *box);
    for (uint32_t i = 0; i < input->rows; i++) {
        if (detect_there(input, i))
            box[i] = detect_box(input, i);
    }
    for (uint32_t i = 0; i < input->rows; i++) {
        if (detect_there(input, i)) {
            meet_rows(input, box, i, pairs);
            meet_fixed(input, box, i, pairs);
            work_done();
        }
    }
}
