/* The methods' workspace and their pairs. */
#include "tests/support/pair_search.h"

struct pair_search pair_search;

int pair_search_open(struct small_world *w, uint64_t most)
{
    pair_search.w = w;
    pair_search.workspace = method_workspace_create(&w->world, NULL);
    return pair_search.workspace ? pair_list_init(&pair_search.pairs, most) : -1;
}

int pair_search_teardown(void **state)
{
    (void)state;
    small_world_end(pair_search.w);
    pair_list_free(&pair_search.pairs);
    method_workspace_free(pair_search.workspace);
    return 0;
}

uint32_t pair_search_run(method_pairs_function *method)
{
    const struct method_input input = small_world_input(pair_search.w);
    pair_search.pairs.count = 0;
    method(&input, pair_search.workspace, &pair_search.pairs);
    return pair_search.pairs.count;
}

bool pair_search_has(uint32_t a, uint32_t b)
{
    const struct pair_list *pairs = &pair_search.pairs;
    for (uint32_t n = 0; n < pairs->count; n++) {
        if (pairs->pair[n].a == a && pairs->pair[n].b == b)
            return true;
    }
    return false;
}
