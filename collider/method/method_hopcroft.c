/* All intersecting pairs by sorting and sweeping, after Hopcroft, Schwartz and Sharir 1983 (as
 * cited by Osborne 1991, p. 5). Their method finds whether any two of n spheres intersect in O(n
 * log^2 n), by a plane that passes through all of them and a structure of the spheres that it cuts.
 *
 * Here the plane moves along x through the swept boxes. The boxes that it cuts are kept in a
 * balanced tree by z, in which each node knows where the intervals below it end at the latest. Six
 * and Wood (1982) report all intersecting boxes in this way, with a further tree for the heights.
 * That tree is left out, since on terrain few pairs that overlap on the map are separate in height.
 * A frame takes O((n + k) log n), where k pairs of boxes overlap on the map. */
#include "collider/method/method.h"

#include "world/maths/random.h"
#include "world/maths/sort.h"
#include "world/runtime/work_done.h"

#include <string.h>

#define NO_BODY UINT32_MAX

enum { BLOCK_STARTS, BLOCK_ENDS, BLOCK_NODE };

/* Where along x the plane enters or leaves a body, as bits in ascending order. */
struct mark {
    uint32_t key, what;
};

/* A body in the treap of bodies that the plane cuts: ordered by least z, a heap by a hash of its
 * number. Nodes are numbered in the order in which the plane enters them, so that those in use lie
 * together. */
struct node {
    float min_z, max_z;
    float last_z; /* greatest max_z of it and of the nodes below it */
    uint32_t left, right;
    uint32_t body;
};

struct sort_and_sweep {
    const struct method_input *input;
    struct method_bodies bodies;
    struct node *node;      /* [bodies] */
    uint32_t moving, fixed; /* roots */
    struct pair_list *pairs;
};

/* --- sorting -----------------------------------------------------------------------------------*/

/* No box has a bound of -0, which would sort before 0. */
static uint32_t ascending_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/* --- what the plane cuts -----------------------------------------------------------------------*/

static bool before(const struct sort_and_sweep *sweep, uint32_t i, uint32_t j)
{
    float a = sweep->node[i].min_z, b = sweep->node[j].min_z;
    return a < b || (!(b < a) && i < j);
}

static bool above(uint32_t i, uint32_t j)
{
    return random_mix(i) > random_mix(j); /* a bijection: two are never equal */
}

static void refresh(const struct sort_and_sweep *sweep, uint32_t i)
{
    struct node *node = &sweep->node[i];
    node->last_z = node->max_z;
    if (node->left != NO_BODY && sweep->node[node->left].last_z > node->last_z)
        node->last_z = sweep->node[node->left].last_z;
    if (node->right != NO_BODY && sweep->node[node->right].last_z > node->last_z)
        node->last_z = sweep->node[node->right].last_z;
}

/* Splits a tree into the nodes before node i and those after it. */
static void split(const struct sort_and_sweep *sweep, uint32_t root, uint32_t i, uint32_t *low,
                  uint32_t *high)
{
    if (root == NO_BODY) {
        *low = *high = NO_BODY;
        return;
    }
    struct node *node = &sweep->node[root];
    if (before(sweep, root, i)) {
        *low = root;
        split(sweep, node->right, i, &node->right, high);
    } else {
        *high = root;
        split(sweep, node->left, i, low, &node->left);
    }
    refresh(sweep, root);
}

/* Joins two trees; all nodes of low come before those of high. */
static uint32_t join(const struct sort_and_sweep *sweep, uint32_t low, uint32_t high)
{
    if (low == NO_BODY)
        return high;
    if (high == NO_BODY)
        return low;
    uint32_t root = above(low, high) ? low : high;
    if (root == low)
        sweep->node[low].right = join(sweep, sweep->node[low].right, high);
    else
        sweep->node[high].left = join(sweep, low, sweep->node[high].left);
    refresh(sweep, root);
    return root;
}

static uint32_t insert(const struct sort_and_sweep *sweep, uint32_t root, uint32_t i)
{
    if (root == NO_BODY || above(i, root)) {
        split(sweep, root, i, &sweep->node[i].left, &sweep->node[i].right);
        root = i;
    } else if (before(sweep, i, root)) {
        sweep->node[root].left = insert(sweep, sweep->node[root].left, i);
    } else {
        sweep->node[root].right = insert(sweep, sweep->node[root].right, i);
    }
    refresh(sweep, root);
    return root;
}

static uint32_t extract(const struct sort_and_sweep *sweep, uint32_t root, uint32_t i)
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

/* Tests node i against each node of the tree that overlaps it in z. */
static void report_overlaps(const struct sort_and_sweep *sweep, uint32_t root, uint32_t i)
{
    if (root == NO_BODY || sweep->node[root].last_z < sweep->node[i].min_z)
        return;
    const struct node *node = &sweep->node[i], *other = &sweep->node[root];
    report_overlaps(sweep, other->left, i);
    if (other->min_z > node->max_z)
        return; /* and so do all nodes to its right */
    if (other->max_z >= node->min_z)
        method_meet(sweep->input, &sweep->bodies, other->body, node->body, sweep->pairs);
    report_overlaps(sweep, other->right, i);
}

/* --- the sweep ---------------------------------------------------------------------------------*/

static uint32_t *root_of(struct sort_and_sweep *sweep, uint32_t i)
{
    return sweep->node[i].body < sweep->bodies.moving ? &sweep->moving : &sweep->fixed;
}

/* The plane enters node i. */
static void enter(struct sort_and_sweep *sweep, uint32_t i)
{
    uint32_t body = sweep->node[i].body;
    bool asks_fixed = body < sweep->bodies.moving && sweep->bodies.tests_fixed[body];
    report_overlaps(sweep, sweep->moving, i);
    if (asks_fixed)
        report_overlaps(sweep, sweep->fixed, i);
    uint32_t *root = root_of(sweep, i);
    *root = insert(sweep, *root, i);
}

static void pass(struct sort_and_sweep *sweep, const struct mark *starts, const struct mark *ends)
{
    for (uint32_t i = 0, left = 0; i < sweep->bodies.count; i++) {
        while (ends[left].key < starts[i].key) {
            uint32_t *root = root_of(sweep, ends[left].what);
            *root = extract(sweep, *root, ends[left].what);
            left++;
        }
        enter(sweep, i);
        work_done();
    }
}

/* Sorts the bodies in the order in which the plane enters them (starts) and leaves them (ends, by
 * node). */
static void put_in_order(struct sort_and_sweep *sweep, struct mark *starts, struct mark *ends)
{
    uint32_t count = sweep->bodies.count;
    for (uint32_t i = 0; i < count; i++)
        starts[i] = (struct mark){ascending_bits(sweep->bodies.box[i].min_x), i};
    sort_words(starts, count);
    for (uint32_t i = 0; i < count; i++) {
        const struct path_box *box = &sweep->bodies.box[starts[i].what];
        sweep->node[i] = (struct node){.min_z = box->min_z,
                                       .max_z = box->max_z,
                                       .left = NO_BODY,
                                       .right = NO_BODY,
                                       .body = starts[i].what};
        ends[i] = (struct mark){ascending_bits(box->max_x), i};
    }
    sort_words(ends, count);
}

void method_hopcroft_pairs(const struct method_input *input, struct method_workspace *workspace,
                           struct pair_list *pairs)
{
    struct sort_and_sweep sweep = {
        .input = input, .moving = NO_BODY, .fixed = NO_BODY, .pairs = pairs};
    method_bodies(input, workspace, &sweep.bodies);
    uint32_t count = sweep.bodies.count;
    struct mark *starts = method_block(workspace, BLOCK_STARTS, count, sizeof *starts);
    struct mark *ends = method_block(workspace, BLOCK_ENDS, count, sizeof *ends);
    sweep.node = method_block(workspace, BLOCK_NODE, count, sizeof *sweep.node);
    put_in_order(&sweep, starts, ends);
    pass(&sweep, starts, ends);
}
