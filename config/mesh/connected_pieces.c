/* Finds the places of a model's corners, and connects them by its triangles. */
#include "config/mesh/connected_pieces.h"

#include "config/mesh/model_parts.h"
#include "config/syntax/table.h"
#include "world/making/scenario.h"
#include "world/model.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* The places of a model's corners, each once, in a union-find forest. A tree is a piece. */
struct places {
    struct vec3 *at;  /* [count] by part, in order of x, y, z */
    uint8_t *part;    /* [count] enum hull_part */
    uint32_t *of;     /* [vertices] index of each vertex's place */
    uint32_t *parent; /* [count] the index of a parent is never above its child's */
    uint32_t count;
};

static void places_free(struct places *places)
{
    free(places->at);
    free(places->part);
    free(places->of);
    free(places->parent);
}

static uint32_t root_of(const struct places *places, uint32_t place)
{
    while (places->parent[place] != place) {
        places->parent[place] = places->parent[places->parent[place]];
        place = places->parent[place];
    }
    return place;
}

static void join_places(const struct places *places, uint32_t a, uint32_t b)
{
    uint32_t root_a = root_of(places, a), root_b = root_of(places, b);
    if (root_a < root_b)
        places->parent[root_b] = root_a;
    else
        places->parent[root_a] = root_b;
}

/* A corner, for sorting by place. */
struct arrival {
    struct vec3 at;
    uint32_t vertex;
    uint8_t part; /* enum hull_part */
};

static int compare_arrivals(const void *left, const void *right)
{
    const struct arrival *a = left, *b = right;
    int order = (a->part > b->part) - (a->part < b->part);
    if (order == 0)
        order = convex_hull_compare(&a->at, &b->at);
    return order != 0 ? order : (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static int find_places(struct places *places, const struct model_vertex *vertex,
                       const uint8_t *part, uint32_t count)
{
    struct arrival *arrival = malloc(count * sizeof(*arrival));
    memset(places, 0, sizeof(*places));
    places->at = malloc(count * sizeof(*places->at));
    places->part = malloc(count * sizeof(*places->part));
    places->of = malloc(count * sizeof(*places->of));
    places->parent = malloc(count * sizeof(*places->parent));
    if (arrival == NULL || places->at == NULL || places->part == NULL || places->of == NULL ||
        places->parent == NULL) {
        free(arrival);
        return -1;
    }
    for (uint32_t i = 0; i < count; i++)
        arrival[i] = (struct arrival){
            {(double)vertex[i].x, (double)vertex[i].y, (double)vertex[i].z}, i, part[i]};
    qsort(arrival, count, sizeof(*arrival), compare_arrivals);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t last = places->count - 1;
        if (i == 0 || places->part[last] != arrival[i].part ||
            convex_hull_compare(&places->at[last], &arrival[i].at) != 0) {
            last = places->count++;
            places->at[last] = arrival[i].at;
            places->part[last] = arrival[i].part;
            places->parent[last] = last;
        }
        places->of[arrival[i].vertex] = last;
    }
    free(arrival);
    return 0;
}

static void join_corners(const struct places *places, const struct model_triangle *triangle,
                         uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corner = triangle[i].vertex;
        join_places(places, places->of[corner[0]], places->of[corner[1]]);
        join_places(places, places->of[corner[0]], places->of[corner[2]]);
    }
}

static int add_point(struct piece *piece, struct vec3 at)
{
    void *table = piece->point;
    struct vec3 *point = table_extend(&table, &piece->count, 1, sizeof(*point));
    if (point == NULL)
        return -1;
    *point = at;
    piece->point = table;
    return 0;
}

/* Adds each place to the piece of its tree. */
static int deal_places(struct connected_pieces *pieces, const struct places *places)
{
    uint32_t *piece_of = calloc(places->count, sizeof(*piece_of)); /* of each root */
    int result = piece_of != NULL ? 0 : -1;
    for (uint32_t i = 0; result == 0 && i < places->count; i++) {
        uint32_t root = root_of(places, i);
        if (root == i && pieces->count == CONNECTED_PIECES_MAX) {
            errno = E2BIG;
            result = -1;
            break;
        }
        if (root == i) {
            pieces->piece[pieces->count].part = (enum hull_part)places->part[i];
            piece_of[i] = pieces->count++;
        }
        result = add_point(&pieces->piece[piece_of[root]], places->at[i]);
    }
    free(piece_of);
    return result;
}

/* Makes a flat piece thick: along every axis that it does not span, each point becomes two, one to
 * either side. */
static int thicken(struct piece *piece)
{
    struct vec3 axis[3];
    int missing = convex_hull_missing(piece->point, piece->count, CONNECTED_PIECES_FLAT_M, axis);
    for (int i = 0; i < missing; i++) {
        const struct vec3 half = vec3_scale(axis[i], CONNECTED_PIECES_THICKNESS_M / 2.0);
        uint32_t count = piece->count;
        void *table = piece->point;
        struct vec3 *copy = table_extend(&table, &piece->count, count, sizeof(*copy));
        if (copy == NULL)
            return -1;
        piece->point = table;
        for (uint32_t k = 0; k < count; k++) {
            copy[k] = vec3_add(piece->point[k], half);
            piece->point[k] = vec3_sub(piece->point[k], half);
        }
    }
    return 0;
}

int connected_pieces_find(struct connected_pieces *pieces, const struct scenario *scenario,
                          const struct model *model)
{
    struct places places = {.count = 0};
    int result = -1;
    uint32_t vertices = model->solid_triangles > 0 ? model->solid_vertices : model->vertex_count;
    uint8_t *part = calloc(vertices + 1, sizeof(*part));
    memset(pieces, 0, sizeof(*pieces));
    if (part != NULL) {
        model_parts_of_vertices(part, scenario, model);
        result = find_places(&places, &scenario->vertices[model->first_vertex], part, vertices);
    }
    free(part);
    if (result == 0) {
        join_corners(&places, &scenario->triangles[model->first_triangle],
                     model_solid_triangles(model));
        result = deal_places(pieces, &places);
    }
    places_free(&places);
    for (uint32_t i = 0; result == 0 && i < pieces->count; i++) {
        struct piece *piece = &pieces->piece[i];
        result = thicken(piece);
        if (result == 0)
            result = convex_hull_points(&piece->hull, piece->point, piece->count);
    }
    return result;
}

static void drop(struct piece *piece)
{
    free(piece->point);
    convex_hull_free(&piece->hull);
    memset(piece, 0, sizeof(*piece));
}

void connected_pieces_free(struct connected_pieces *pieces)
{
    for (uint32_t i = 0; i < pieces->count; i++)
        drop(&pieces->piece[i]);
    pieces->count = 0;
}

int connected_pieces_join(struct piece *piece, struct piece *other, struct convex_hull *hull)
{
    void *table = piece->point;
    struct vec3 *point = table_extend(&table, &piece->count, other->count, sizeof(*point));
    if (point == NULL)
        return -1;
    piece->point = table;
    memcpy(point, other->point, other->count * sizeof(*point));
    drop(other);
    if (hull != NULL) {
        convex_hull_free(&piece->hull);
        piece->hull = *hull;
        memset(hull, 0, sizeof(*hull));
    }
    return 0;
}
