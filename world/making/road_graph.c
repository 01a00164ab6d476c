/* Splits roads into chains of nodes at their junctions; Dijkstra's search over them. */
#include "world/making/road_graph.h"

#include "world/maths/maths.h"
#include "world/road_index.h"
#include "world/world.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* What is as far as the width of a junction is found in the index [m]. */
#define ROUNDING_M 0.01

/* A place on a segment of a road, which begins with a point and ends with the next. */
struct cut {
    uint32_t stretch;
    double share; /* 0..1 */
    uint32_t meeting;
};

/* A junction: two cuts at the same place, or nearly. */
struct survey {
    const struct road_point *points;
    uint32_t count;
    struct road_index index;
    uint32_t *near; /* [near_room] stretches near a place, ascending */
    uint32_t near_count, near_room;
    struct cut *cuts; /* two of each junction */
    uint32_t cut_count, cut_room;
};

static bool is_stretch(const struct survey *s, uint32_t i)
{
    return road_index_is_stretch(s->points, s->count, i);
}

static int add_meeting(struct survey *s, uint32_t a, double a_share, uint32_t b, double b_share)
{
    if (s->cut_count + 2 > s->cut_room) {
        uint32_t room = s->cut_room * 2 + 256;
        struct cut *cuts = realloc(s->cuts, room * sizeof *cuts);
        if (!cuts)
            return -1;
        s->cuts = cuts;
        s->cut_room = room;
    }
    uint32_t meeting = s->cut_count / 2;
    s->cuts[s->cut_count++] = (struct cut){a, a_share, meeting};
    s->cuts[s->cut_count++] = (struct cut){b, b_share, meeting};
    return 0;
}

/* Returns the share of the distance from a to b that is nearest to (x, z), and its distance from
 * there. */
static double nearest_share(double ax, double az, double bx, double bz, double x, double z,
                            double *off_m)
{
    double dx = bx - ax, dz = bz - az, share = maths_nearest_share(x - ax, z - az, dx, dz);
    double ox = x - ax - dx * share, oz = z - az - dz * share;
    *off_m = sqrt(ox * ox + oz * oz);
    return share;
}

static double stretch_share(const struct survey *s, uint32_t i, double x, double z, double *off_m)
{
    const struct road_point *a = &s->points[i], *b = a + 1;
    return nearest_share(a->x, a->z, b->x, b->z, x, z, off_m);
}

/* Returns true if two segments cross, and the share of each at which they do. */
static bool crossing(const struct survey *s, uint32_t i, uint32_t j, double *share_i,
                     double *share_j)
{
    const struct road_point *a = &s->points[i], *b = &s->points[j];
    double ux = a[1].x - a[0].x, uz = a[1].z - a[0].z;
    double vx = b[1].x - b[0].x, vz = b[1].z - b[0].z;
    double wx = b[0].x - a[0].x, wz = b[0].z - a[0].z;
    double turn = ux * vz - uz * vx;
    if (turn == 0.0)
        return false;
    *share_i = (wx * vz - wz * vx) / turn;
    *share_j = (wx * uz - wz * ux) / turn;
    return *share_i >= 0.0 && *share_i <= 1.0 && *share_j >= 0.0 && *share_j <= 1.0;
}

/* Finds where two segments are nearest to each other: at a crossing, or at an end of one. */
static double nearest(const struct survey *s, uint32_t i, uint32_t j, double *share_i,
                      double *share_j)
{
    double least = INFINITY;
    if (crossing(s, i, j, share_i, share_j))
        return 0.0;
    for (uint32_t end = 0; end < 4; end++) {
        uint32_t own = end < 2 ? i : j, other = end < 2 ? j : i;
        const struct road_point *p = &s->points[own + end % 2];
        double off, share = stretch_share(s, other, p->x, p->z, &off);
        if (off >= least)
            continue;
        least = off;
        *share_i = end < 2 ? (double)(end % 2) : share;
        *share_j = end < 2 ? share : (double)(end % 2);
    }
    return least;
}

static int by_number(const void *a, const void *b)
{
    uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return (p > q) - (p < q);
}

/* Finds the stretches within reach_m of the bounds of two points. Returns 0, or -1: no memory. */
static int find_near(struct survey *s, const struct road_point *a, const struct road_point *b,
                     double reach_m)
{
    struct road_walk walk =
        road_index_walk(&s->index, maths_min(a->x, b->x) - reach_m, maths_min(a->z, b->z) - reach_m,
                        maths_max(a->x, b->x) + reach_m, maths_max(a->z, b->z) + reach_m);
    uint32_t stretch;
    s->near_count = 0;
    while (road_walk_next(&walk, &stretch)) {
        if (s->near_count == s->near_room) {
            uint32_t room = s->near_room * 2 + 256;
            uint32_t *near = realloc(s->near, room * sizeof *near);
            if (!near)
                return -1;
            s->near = near;
            s->near_room = room;
        }
        s->near[s->near_count++] = stretch;
    }
    if (s->near_count > 0)
        qsort(s->near, s->near_count, sizeof *s->near, by_number);
    return 0;
}

static int meet_between(struct survey *s)
{
    for (uint32_t i = 0; i + 1 < s->count; i++) {
        if (!is_stretch(s, i))
            continue;
        if (find_near(s, &s->points[i], &s->points[i + 1], ROAD_GRAPH_MEET_M + ROUNDING_M) != 0)
            return -1;
        for (uint32_t n = 0; n < s->near_count; n++) {
            double share_i, share_j;
            uint32_t j = s->near[n];
            if (j < i + 2 || nearest(s, i, j, &share_i, &share_j) > ROAD_GRAPH_MEET_M)
                continue;
            if (add_meeting(s, i, share_i, j, share_j) != 0)
                return -1;
        }
    }
    return 0;
}

/* Joins an end of a road to the nearest other road. */
static int meet_end(struct survey *s, uint32_t end)
{
    const struct road_point *p = &s->points[end];
    double least = ROAD_GRAPH_END_M, share = 0.0;
    uint32_t found = UINT32_MAX;
    if (find_near(s, p, p, ROAD_GRAPH_END_M + ROUNDING_M) != 0)
        return -1;
    for (uint32_t n = 0; n < s->near_count; n++) {
        uint32_t j = s->near[n];
        double off;
        if (s->points[j].road == p->road)
            continue;
        double at = stretch_share(s, j, p->x, p->z, &off);
        if (off > least)
            continue;
        least = off;
        share = at;
        found = j;
    }
    if (found == UINT32_MAX)
        return 0;
    return is_stretch(s, end) ? add_meeting(s, end, 0.0, found, share)
                              : add_meeting(s, end - 1, 1.0, found, share);
}

static int meet_ends(struct survey *s)
{
    for (uint32_t i = 0; i < s->count; i++) {
        bool begins = is_stretch(s, i), ends = i > 0 && is_stretch(s, i - 1);
        if (begins != ends && meet_end(s, i) != 0)
            return -1;
    }
    return 0;
}

static int by_place(const void *a, const void *b)
{
    const struct cut *p = a, *q = b;
    if (p->stretch != q->stretch)
        return p->stretch < q->stretch ? -1 : 1;
    if (p->share != q->share)
        return p->share < q->share ? -1 : 1;
    return (p->meeting > q->meeting) - (p->meeting < q->meeting);
}

/* Adds the nodes in the roads' order; met[junction][2]: both nodes of each. */
static void lay_nodes(struct road_graph *net, const struct survey *s, uint32_t (*met)[2],
                      uint8_t *seen)
{
    uint32_t cut = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        const struct road_point *a = &s->points[i], *b = a + 1;
        bool goes_on = is_stretch(s, i);
        net->nodes[net->node_count++] = (struct road_node){a->x, a->z, 0, 0, 0};
        for (; goes_on && cut < s->cut_count && s->cuts[cut].stretch == i; cut++) {
            double t = s->cuts[cut].share;
            uint32_t meeting = s->cuts[cut].meeting;
            met[meeting][seen[meeting]++] = net->node_count;
            net->nodes[net->node_count++] =
                (struct road_node){a->x + (b->x - a->x) * t, a->z + (b->z - a->z) * t, 0, 0, 0};
        }
        net->nodes[net->node_count - 1].next = goes_on ? net->node_count : UINT32_MAX;
    }
    for (uint32_t n = 0; n < net->node_count; n++) {
        if (net->nodes[n].next == 0)
            net->nodes[n].next = n + 1;
    }
}

static void count_edge(struct road_graph *net, uint32_t a, uint32_t b)
{
    net->nodes[a].edge_count++;
    net->nodes[b].edge_count++;
}

static void put_edge(struct road_graph *net, uint32_t a, uint32_t b)
{
    struct road_node *p = &net->nodes[a], *q = &net->nodes[b];
    double dx = q->x - p->x, dz = q->z - p->z, length = sqrt(dx * dx + dz * dz);
    net->edges[p->first_edge + p->edge_count++] = (struct road_edge){b, length};
    net->edges[q->first_edge + q->edge_count++] = (struct road_edge){a, length};
}

/* Calls each() for the two nodes of every edge. */
static void each_edge(struct road_graph *net, uint32_t (*met)[2], uint32_t meetings,
                      void (*each)(struct road_graph *net, uint32_t a, uint32_t b))
{
    for (uint32_t n = 0; n < net->node_count; n++) {
        if (net->nodes[n].next != UINT32_MAX)
            each(net, n, net->nodes[n].next);
    }
    for (uint32_t m = 0; m < meetings; m++)
        each(net, met[m][0], met[m][1]);
}

static int lay_edges(struct road_graph *net, uint32_t (*met)[2], uint32_t meetings)
{
    each_edge(net, met, meetings, count_edge);
    for (uint32_t n = 0; n < net->node_count; n++) {
        net->nodes[n].first_edge = net->edge_count;
        net->edge_count += net->nodes[n].edge_count;
        net->nodes[n].edge_count = 0;
    }
    net->edges = calloc(net->edge_count + 1, sizeof *net->edges);
    if (!net->edges)
        return -1;
    each_edge(net, met, meetings, put_edge);
    return 0;
}

int road_graph_build(struct road_graph *net, const struct road_point *points, uint32_t count,
                     double side_m)
{
    struct survey s = {.points = points, .count = count};
    uint32_t(*met)[2] = NULL;
    uint8_t *seen = NULL;
    int result = -1;
    *net = (struct road_graph){0};
    if (road_index_make(&s.index, points, count, side_m) == 0 && meet_between(&s) == 0 &&
        meet_ends(&s) == 0) {
        uint32_t meetings = s.cut_count / 2;
        if (s.cut_count > 0)
            qsort(s.cuts, s.cut_count, sizeof *s.cuts, by_place);
        net->nodes = calloc(count + s.cut_count + 1, sizeof *net->nodes);
        met = calloc(meetings + 1, sizeof *met);
        seen = calloc(meetings + 1, 1);
        if (net->nodes && met && seen) {
            lay_nodes(net, &s, met, seen);
            result = lay_edges(net, met, meetings);
        }
    }
    road_index_free(&s.index);
    free(s.near);
    free(s.cuts);
    free(met);
    free(seen);
    if (result == 0)
        return 0;
    road_graph_free(net);
    errno = ENOMEM;
    return -1;
}

void road_graph_free(struct road_graph *net)
{
    free(net->nodes);
    free(net->edges);
    *net = (struct road_graph){0};
}

bool road_graph_place(const struct road_graph *net, double x, double z, struct road_place *place)
{
    *place = (struct road_place){.node = UINT32_MAX, .off_m = INFINITY};
    for (uint32_t n = 0; n < net->node_count; n++) {
        const struct road_node *a = &net->nodes[n];
        if (a->next == UINT32_MAX)
            continue;
        const struct road_node *b = &net->nodes[a->next];
        double off, share = nearest_share(a->x, a->z, b->x, b->z, x, z, &off);
        if (off < place->off_m)
            *place = (struct road_place){n, share, a->x + (b->x - a->x) * share,
                                         a->z + (b->z - a->z) * share, off};
    }
    return place->node != UINT32_MAX;
}

/* --- the search --------------------------------------------------------------------------------*/

struct waiting {
    double length_m;
    uint32_t node;
};

struct search {
    double *length_m; /* [nodes] from the start */
    uint32_t *from;   /* [nodes] UINT32_MAX: the start itself */
    struct waiting *heap;
    uint32_t heap_count;
};

static bool before(struct waiting a, struct waiting b)
{
    return a.length_m < b.length_m || (a.length_m == b.length_m && a.node < b.node);
}

static void push(struct search *s, struct waiting waiting)
{
    uint32_t i = s->heap_count++;
    for (; i > 0 && before(waiting, s->heap[(i - 1) / 2]); i = (i - 1) / 2)
        s->heap[i] = s->heap[(i - 1) / 2];
    s->heap[i] = waiting;
}

static struct waiting pop(struct search *s)
{
    struct waiting least = s->heap[0], last = s->heap[--s->heap_count];
    uint32_t i = 0, child;
    while ((child = 2 * i + 1) < s->heap_count) {
        if (child + 1 < s->heap_count && before(s->heap[child + 1], s->heap[child]))
            child++;
        if (!before(s->heap[child], last))
            break;
        s->heap[i] = s->heap[child];
        i = child;
    }
    s->heap[i] = last;
    return least;
}

static void reach(struct search *s, uint32_t node, double length_m, uint32_t from)
{
    if (!(length_m < s->length_m[node]))
        return;
    s->length_m[node] = length_m;
    s->from[node] = from;
    push(s, (struct waiting){length_m, node});
}

static double to_node(const struct road_graph *net, const struct road_place *place, uint32_t node)
{
    double dx = net->nodes[node].x - place->x, dz = net->nodes[node].z - place->z;
    return sqrt(dx * dx + dz * dz);
}

/* Finds the lengths to the nodes at both ends of the goal, or to all nodes that can be reached. */
static void spread(const struct road_graph *net, struct search *s, const struct road_place *from,
                   const struct road_place *to)
{
    uint32_t next = net->nodes[from->node].next, goals = 2;
    for (uint32_t n = 0; n < net->node_count; n++)
        s->length_m[n] = INFINITY;
    reach(s, from->node, to_node(net, from, from->node), UINT32_MAX);
    reach(s, next, to_node(net, from, next), UINT32_MAX);
    while (s->heap_count > 0) {
        struct waiting least = pop(s);
        const struct road_node *node = &net->nodes[least.node];
        if (least.length_m > s->length_m[least.node])
            continue;
        goals -= least.node == to->node || least.node == net->nodes[to->node].next;
        if (goals == 0)
            return;
        for (uint32_t e = 0; e < node->edge_count; e++) {
            const struct road_edge *edge = &net->edges[node->first_edge + e];
            reach(s, edge->to, least.length_m + edge->length_m, least.node);
        }
    }
}

/* Writes the path back from the last node; UINT32_MAX: straight from one place to the other. */
static int write_way(const struct road_graph *net, const struct search *s,
                     const struct road_place *from, const struct road_place *to, uint32_t last,
                     struct route_point **points, uint32_t *count)
{
    uint32_t nodes = 0;
    for (uint32_t n = last; n != UINT32_MAX; n = s->from[n])
        nodes++;
    *count = nodes + 2;
    *points = calloc(*count, sizeof **points);
    if (!*points)
        return -1;
    (*points)[0] = (struct route_point){from->x, from->z};
    (*points)[nodes + 1] = (struct route_point){to->x, to->z};
    for (uint32_t n = last; n != UINT32_MAX; n = s->from[n])
        (*points)[nodes--] = (struct route_point){net->nodes[n].x, net->nodes[n].z};
    return 0;
}

static int find_way(const struct road_graph *net, struct search *s, const struct road_place *from,
                    const struct road_place *to, struct route_point **points, uint32_t *count,
                    double *length_m)
{
    uint32_t ends[2] = {to->node, net->nodes[to->node].next}, last = UINT32_MAX;
    double least = INFINITY;
    spread(net, s, from, to);
    if (from->node == to->node) {
        double dx = to->x - from->x, dz = to->z - from->z;
        least = sqrt(dx * dx + dz * dz);
    }
    for (int i = 0; i < 2; i++) {
        double length = s->length_m[ends[i]] + to_node(net, to, ends[i]);
        if (length < least) {
            least = length;
            last = ends[i];
        }
    }
    if (!(least < INFINITY)) {
        errno = EHOSTUNREACH;
        return -1;
    }
    *length_m = least;
    return write_way(net, s, from, to, last, points, count);
}

int road_graph_way(const struct road_graph *net, const struct road_place *from,
                   const struct road_place *to, struct route_point **points, uint32_t *count,
                   double *length_m)
{
    struct search s = {0};
    int result = -1;
    s.length_m = malloc(net->node_count * sizeof *s.length_m);
    s.from = malloc(net->node_count * sizeof *s.from);
    s.heap = malloc((net->edge_count + 2) * sizeof *s.heap);
    if (s.length_m && s.from && s.heap)
        result = find_way(net, &s, from, to, points, count, length_m);
    else
        errno = ENOMEM;
    free(s.length_m);
    free(s.from);
    free(s.heap);
    return result;
}
