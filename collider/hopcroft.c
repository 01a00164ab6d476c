/* All intersecting pairs by sorting and sweeping, after Hopcroft, Schwartz and Sharir 1983 (as
 * Osborne 1991, p. 5, tells of it): theirs finds whether any two of n spheres intersect in O(n
 * log^2 n), by a plane that passes through all of them and a structure of what it cuts.
 *
 * Here the plane passes along x through the swept boxes, and what it cuts is kept in a balanced
 * tree by z that knows where the intervals below each node end at the latest, as in Six and Wood's
 * report of all intersecting boxes (1982), but without a further tree for the heights: on terrain
 * few pairs that overlap on the map are apart by height. So a frame is O((n + k) log n), k the
 * pairs of boxes that overlap on the map. */
#include "collider/detect.h"

#include "world/random.h"

#include <string.h>

#define NOBODY UINT32_MAX

enum { BLOCK_STARTS, BLOCK_ENDS, BLOCK_SORT, BLOCK_NODE };

/* A body and where along x the plane meets or leaves it, as bits that ascend with it. */
struct mark {
    uint32_t key, body;
};

/* A body that the plane cuts, in a treap: ordered by its least z (then by number), a heap by a
 * hash of its number. */
struct node {
    uint32_t left, right;
    float last_z; /* greatest z of it and of all below it */
};

struct sweep {
    const struct detect_input *input;
    struct detect_bodies bodies;
    struct node *node;      /* [bodies] */
    uint32_t moving, fixed; /* roots */
    struct pair_list *pairs;
};

/* --- sorting -----------------------------------------------------------------------------------*/

/* No edge of a box is -0, which would come before 0. */
static uint32_t ascending_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/* Stable radix sort by key, in four passes of 8 bits: the result is in mark again. */
static void sort_marks(struct mark *mark, struct mark *other, uint32_t count)
{
    for (uint32_t shift = 0; shift < 32; shift += 8) {
        uint32_t start[257] = {0};
        for (uint32_t i = 0; i < count; i++)
            start[(mark[i].key >> shift & 255u) + 1]++;
        for (int digit = 0; digit < 256; digit++)
            start[digit + 1] += start[digit];
        for (uint32_t i = 0; i < count; i++)
            other[start[mark[i].key >> shift & 255u]++] = mark[i];
        struct mark *swap = mark;
        mark = other;
        other = swap;
    }
}

/* --- what the plane cuts -----------------------------------------------------------------------*/

static bool before(const struct sweep *sweep, uint32_t i, uint32_t j)
{
    float a = sweep->bodies.box[i].min_z, b = sweep->bodies.box[j].min_z;
    return a < b || (!(b < a) && i < j);
}

static bool above(uint32_t i, uint32_t j)
{
    return random_mix(i) > random_mix(j); /* a bijection: never equal */
}

static void refresh(const struct sweep *sweep, uint32_t i)
{
    struct node *node = &sweep->node[i];
    float last_z = sweep->bodies.box[i].max_z;
    if (node->left != NOBODY && sweep->node[node->left].last_z > last_z)
        last_z = sweep->node[node->left].last_z;
    if (node->right != NOBODY && sweep->node[node->right].last_z > last_z)
        last_z = sweep->node[node->right].last_z;
    node->last_z = last_z;
}

/* Parts a tree into what comes before body i and what comes after it. */
static void part(const struct sweep *sweep, uint32_t root, uint32_t i, uint32_t *low,
                 uint32_t *high)
{
    if (root == NOBODY) {
        *low = *high = NOBODY;
        return;
    }
    struct node *node = &sweep->node[root];
    if (before(sweep, root, i)) {
        *low = root;
        part(sweep, node->right, i, &node->right, high);
    } else {
        *high = root;
        part(sweep, node->left, i, low, &node->left);
    }
    refresh(sweep, root);
}

/* Joins two trees, all of low before all of high. */
static uint32_t join(const struct sweep *sweep, uint32_t low, uint32_t high)
{
    if (low == NOBODY)
        return high;
    if (high == NOBODY)
        return low;
    uint32_t root = above(low, high) ? low : high;
    if (root == low)
        sweep->node[low].right = join(sweep, sweep->node[low].right, high);
    else
        sweep->node[high].left = join(sweep, low, sweep->node[high].left);
    refresh(sweep, root);
    return root;
}

static uint32_t insert(const struct sweep *sweep, uint32_t root, uint32_t i)
{
    if (root == NOBODY || above(i, root)) {
        part(sweep, root, i, &sweep->node[i].left, &sweep->node[i].right);
        root = i;
    } else if (before(sweep, i, root)) {
        sweep->node[root].left = insert(sweep, sweep->node[root].left, i);
    } else {
        sweep->node[root].right = insert(sweep, sweep->node[root].right, i);
    }
    refresh(sweep, root);
    return root;
}

static uint32_t extract(const struct sweep *sweep, uint32_t root, uint32_t i)
{
    struct node *node = &sweep->node[root];
    if (root == i)
        return join(sweep, node->left, node->right);
    if (before(sweep, i, root))
        node->left = extract(sweep, node->left, i);
    else
        node->right = extract(sweep, node->right, i);
    refresh(sweep, root);
    return root;
}

/* Everything in the tree that overlaps body i in z may meet it. */
static int meet(const struct sweep *sweep, uint32_t root, uint32_t i)
{
    const struct sweep_box *box = &sweep->bodies.box[i];
    if (root == NOBODY || sweep->node[root].last_z < box->min_z)
        return 0;
    if (meet(sweep, sweep->node[root].left, i) != 0)
        return -1;
    if (sweep->bodies.box[root].min_z > box->max_z)
        return 0; /* and so are all to its right */
    if (detect_meet(sweep->input, &sweep->bodies, root, i, sweep->pairs) != 0)
        return -1;
    return meet(sweep, sweep->node[root].right, i);
}

/* --- the sweep ---------------------------------------------------------------------------------*/

static uint32_t *root_of(struct sweep *sweep, uint32_t body)
{
    return body < sweep->bodies.moving ? &sweep->moving : &sweep->fixed;
}

/* The plane reaches body i. */
static int reach(struct sweep *sweep, uint32_t i)
{
    bool moving = i < sweep->bodies.moving;
    if (meet(sweep, sweep->moving, i) != 0 ||
        (moving && sweep->bodies.tests_fixed[i] && meet(sweep, sweep->fixed, i) != 0))
        return -1;
    uint32_t *root = root_of(sweep, i);
    *root = insert(sweep, *root, i);
    return 0;
}

static int pass(struct sweep *sweep, const struct mark *starts, const struct mark *ends)
{
    for (uint32_t n = 0, left = 0; n < sweep->bodies.count; n++) {
        while (ends[left].key < starts[n].key) {
            uint32_t *root = root_of(sweep, ends[left].body);
            *root = extract(sweep, *root, ends[left].body);
            left++;
        }
        if (reach(sweep, starts[n].body) != 0)
            return -1;
    }
    return 0;
}

int hopcroft_pairs(const struct detect_input *input, struct detect_workspace **workspace,
                   struct pair_list *pairs)
{
    struct sweep sweep = {.input = input, .moving = NOBODY, .fixed = NOBODY, .pairs = pairs};
    if (detect_bodies(input, workspace, &sweep.bodies) != 0)
        return -1;
    uint32_t count = sweep.bodies.count;
    struct mark *starts = detect_block(workspace, BLOCK_STARTS, count, sizeof *starts);
    struct mark *ends = detect_block(workspace, BLOCK_ENDS, count, sizeof *ends);
    struct mark *other = detect_block(workspace, BLOCK_SORT, count, sizeof *other);
    sweep.node = detect_block(workspace, BLOCK_NODE, count, sizeof *sweep.node);
    if (!starts || !ends || !other || !sweep.node)
        return -1;
    for (uint32_t i = 0; i < count; i++) {
        starts[i] = (struct mark){ascending_bits(sweep.bodies.box[i].min_x), i};
        ends[i] = (struct mark){ascending_bits(sweep.bodies.box[i].max_x), i};
    }
    sort_marks(starts, other, count);
    sort_marks(ends, other, count);
    return pass(&sweep, starts, ends);
}
