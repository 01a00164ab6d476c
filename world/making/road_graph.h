/* The roads as one graph: where they meet, and the shortest way along them. Used at creation. Pure.
 */
#ifndef JOLON_WORLD_MAKING_ROAD_GRAPH_H
#define JOLON_WORLD_MAKING_ROAD_GRAPH_H

#include <stdbool.h>
#include <stdint.h>

struct road_point;
struct route_point;

/* Roads that come as near to each other as this are one at that place [m]: drawn, both are wider.
 * Less would part roads that share a stretch and are rounded each for itself. */
#define ROAD_GRAPH_MEET_M 10.0
/* An end of a road as near to another joins it [m]: it was laid to a place of that one which its
 * rounding then cut off. */
#define ROAD_GRAPH_END_M 100.0

/* A road's point, or a place where it meets another. */
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
    struct road_edge *edges; /* each way once */
    uint32_t edge_count;
};

/* A place on the net: at share 0..1 of the way from a node to the next of its road. */
struct road_place {
    uint32_t node;
    double share;
    double x, z;
    double off_m; /* from the point that was asked for */
};

/* 0, or -1 with errno ENOMEM and nothing to free. */
int road_graph_build(struct road_graph *net, const struct road_point *points, uint32_t count);
void road_graph_free(struct road_graph *net);

/* The place nearest to a point. False when there are no roads. */
bool road_graph_place(const struct road_graph *net, double x, double z, struct road_place *place);

/* The shortest way between two places, both of them in it: *points is the caller's to free, with
 * *count of them and the way's length. 0; -1 with errno ENOMEM, or EHOSTUNREACH: no way. */
int road_graph_way(const struct road_graph *net, const struct road_place *from,
                   const struct road_place *to, struct route_point **points, uint32_t *count,
                   double *length_m);

#endif
