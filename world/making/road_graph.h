/* The roads as one graph: their junctions, and shortest paths along them. Used at creation.
 * Pure. */
#ifndef JOLON_WORLD_MAKING_ROAD_GRAPH_H
#define JOLON_WORLD_MAKING_ROAD_GRAPH_H

#include <stdbool.h>
#include <stdint.h>

struct road_point;
struct route_point;

/* Roads this near to each other meet there [m]: as drawn, both are wider. A smaller value would
 * separate roads that share a stretch, since each is rounded by itself. */
#define ROAD_GRAPH_MEET_M 10.0
/* An end of a road this near to another road joins it [m]: it led to a point of the other road that
 * rounding then cut off. */
#define ROAD_GRAPH_END_M 100.0

/* A road's point, or a junction. */
struct road_node {
    double x, z;
    uint32_t next; /* the next node of its road, UINT32_MAX at its end */
    uint32_t first_edge, edge_count;
};

struct road_edge {
    uint32_t to;
    double length_m;
};

struct road_graph {
    struct road_node *nodes;
    uint32_t node_count;
    struct road_edge *edges; /* each direction once */
    uint32_t edge_count;
};

/* A place on the graph: at a share 0..1 of the distance from a node to the next of its road. */
struct road_place {
    uint32_t node;
    double share;
    double x, z;
    double off_m; /* distance from the given point */
};

/* 0, or -1 with errno ENOMEM and nothing to free. */
int road_graph_build(struct road_graph *net, const struct road_point *points, uint32_t count,
                     double side_m);
void road_graph_free(struct road_graph *net);

/* Finds the place nearest to a point. Returns false if there are no roads. */
bool road_graph_place(const struct road_graph *net, double x, double z, struct road_place *place);

/* Finds the shortest path between two places, both included: *points, which the caller frees, with
 * *count of them, and the path's length. Returns 0; -1 with errno ENOMEM, or EHOSTUNREACH: no
 * path. */
int road_graph_way(const struct road_graph *net, const struct road_place *from,
                   const struct road_place *to, struct route_point **points, uint32_t *count,
                   double *length_m);

#endif
