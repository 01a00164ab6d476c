/* Edges are collapsed into one of their ends, the cheapest first. The cost is the sum of the
 * squared distances from the planes of all facets that met at the vertex (M. Garland, P. Heckbert,
 * "Surface simplification using quadric error metrics", 1997). At the border of a colour or of a
 * sheet, a plane through the edge keeps the edge in place. */
#include "renderer/scene/model/mesh_simplify.h"
#include "world/model.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define SEAM_WEIGHT  0.5     /* weight of a colour's border relative to a facet */
#define TURN_COSINE  0.25    /* a facet must not turn by more than 75 degrees */
#define THIN_SHARE   0.45    /* allowed error as a share of a part's thickness */
#define STEP_FIRST   0.125   /* first share of the limits; ... */
#define STEP         1.25    /* ... factor while there are too many facets ... */
#define STEPS_MAX    36u     /* ... and most such steps */
#define KNIFE_COSINE (-0.2f) /* facets that meet at less than 80 degrees keep their edge */

/* Weighted sum of squared distances from planes: p' A p + 2 b p + c. */
struct quadric {
    double xx, xy, xz, yy, yz, zz, bx, by, bz, c;
};

struct simplification {
    struct mesh_facets *facets;
    uint32_t *vertex; /* [3 * count] vertex of each corner */
    uint32_t vertices;
    struct quadric *quadric; /* [vertices] */
    float (*at)[3];          /* [vertices] */
    double *bound;           /* [vertices] square of the allowed error at the vertex [m2] */
    double *cost; /* [3 * count][2] cost of collapsing the edge from a corner to the next into its
                     end and into its start, over the bound */
    double *breadth;             /* [count] breadth of each facet's part [m] */
    bool *removed;               /* [count] */
    bool *touched;               /* [vertices] in this round */
    uint32_t remaining;          /* facets */
    uint32_t *first, *at_vertex; /* [vertices + 2], [3 * count]: the facets at each vertex */
};

static void add_plane(struct quadric *q, const double n[3], const float at[3], double weight)
{
    double d = -(n[0] * (double)at[0] + n[1] * (double)at[1] + n[2] * (double)at[2]);
    q->xx += weight * n[0] * n[0];
    q->xy += weight * n[0] * n[1];
    q->xz += weight * n[0] * n[2];
    q->yy += weight * n[1] * n[1];
    q->yz += weight * n[1] * n[2];
    q->zz += weight * n[2] * n[2];
    q->bx += weight * n[0] * d;
    q->by += weight * n[1] * d;
    q->bz += weight * n[2] * d;
    q->c += weight * d * d;
}

static void add_quadric(struct quadric *to, const struct quadric *from)
{
    to->xx += from->xx;
    to->xy += from->xy;
    to->xz += from->xz;
    to->yy += from->yy;
    to->yz += from->yz;
    to->zz += from->zz;
    to->bx += from->bx;
    to->by += from->by;
    to->bz += from->bz;
    to->c += from->c;
}

static double distance2(const struct quadric *q, const float at[3])
{
    double x = (double)at[0], y = (double)at[1], z = (double)at[2];
    double sum = q->xx * x * x + q->yy * y * y + q->zz * z * z +
                 2.0 * (q->xy * x * y + q->xz * x * z + q->yz * y * z) +
                 2.0 * (q->bx * x + q->by * y + q->bz * z) + q->c;
    return sum > 0.0 ? sum : 0.0;
}

static bool same_colour(const struct model_triangle *a, const struct model_triangle *b)
{
    return a->red == b->red && a->green == b->green && a->blue == b->blue &&
           a->force_tint == b->force_tint;
}

static uint32_t next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/* --- the pieces ------------------------------------------------------------------------------- */

/* A connected part of the mesh. */
struct piece {
    float low[3], high[3];
    double volume, area; /* six times the volume, twice the area */
};

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

static void measure(struct piece *piece, const struct facet *facet)
{
    const float(*c)[3] = facet->corner;
    float across[3];
    piece->area += (double)facet_across(facet, across);
    for (uint32_t i = 0; i < 3; i++) {
        piece->volume += (double)c[0][i] * (double)across[i];
        for (uint32_t k = 0; k < 3; k++) {
            piece->low[i] = fminf(piece->low[i], c[k][i]);
            piece->high[i] = fmaxf(piece->high[i], c[k][i]);
        }
    }
}

/* Returns the side of a square as large as the part's largest view. */
static double breadth(const struct piece *piece)
{
    double a = (double)piece->high[0] - (double)piece->low[0];
    double b = (double)piece->high[1] - (double)piece->low[1];
    double c = (double)piece->high[2] - (double)piece->low[2];
    return sqrt(fmax(a * b, fmax(b * c, c * a)));
}

/* Returns the square of the allowed error. Rods and sheets keep some of their thickness, which is
 * about twice the volume divided by the area. */
static double bound(const struct piece *piece, double error_m)
{
    double thick_m = piece->area > 0.0 ? 2.0 / 3.0 * fabs(piece->volume) / piece->area : 0.0;
    double most_m = fmin(error_m, THIN_SHARE * thick_m);
    return fmax(most_m * most_m, 1e-12);
}

/* Computes the bound of each vertex and the breadth of each facet's part. */
static int measure_pieces(struct simplification *t, double error_m)
{
    uint32_t *parent = malloc((t->vertices + 1) * sizeof *parent);
    struct piece *piece = malloc((t->vertices + 1) * sizeof *piece);
    if (parent == NULL || piece == NULL) {
        free(parent);
        free(piece);
        return -1;
    }
    for (uint32_t i = 0; i < t->vertices; i++) {
        parent[i] = i;
        piece[i] = (struct piece){.low = {INFINITY, INFINITY, INFINITY},
                                  .high = {-INFINITY, -INFINITY, -INFINITY}};
    }
    for (uint32_t c = 0; c < 3 * t->facets->count; c++)
        parent[root_of(parent, t->vertex[c])] = root_of(parent, t->vertex[next_corner(c)]);
    for (uint32_t f = 0; f < t->facets->count; f++)
        measure(&piece[root_of(parent, t->vertex[3 * f])], &t->facets->facet[f]);
    for (uint32_t f = 0; f < t->facets->count; f++)
        t->breadth[f] = breadth(&piece[root_of(parent, t->vertex[3 * f])]);
    for (uint32_t i = 0; i < t->vertices; i++)
        t->bound[i] = bound(&piece[root_of(parent, i)], error_m);
    free(parent);
    free(piece);
    return 0;
}

/* --- quadrics --------------------------------------------------------------------------------- */

static int seam_order(const void *left, const void *right)
{
    return memcmp(left, right, 2 * sizeof(uint32_t));
}

/* An edge by its vertices, the lower number first. */
struct seam {
    uint32_t from, to, corner;
};

/* Adds the plane through the edge at a right angle to its facet. */
static void add_seam(struct simplification *t, uint32_t corner)
{
    const struct facet *facet = &t->facets->facet[corner / 3];
    const float *a = facet->corner[corner % 3], *b = facet->corner[next_corner(corner) % 3];
    float across[3];
    double edge[3], n[3];
    (void)facet_across(facet, across);
    for (uint32_t i = 0; i < 3; i++)
        edge[i] = (double)b[i] - (double)a[i];
    n[0] = edge[1] * (double)across[2] - edge[2] * (double)across[1];
    n[1] = edge[2] * (double)across[0] - edge[0] * (double)across[2];
    n[2] = edge[0] * (double)across[1] - edge[1] * (double)across[0];
    double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(size > 0.0))
        return;
    for (uint32_t i = 0; i < 3; i++)
        n[i] /= size;
    add_plane(&t->quadric[t->vertex[corner]], n, a, SEAM_WEIGHT);
    add_plane(&t->quadric[t->vertex[next_corner(corner)]], n, a, SEAM_WEIGHT);
}

static bool is_knife(const struct simplification *t, uint32_t f, uint32_t g)
{
    float a[3], b[3];
    float length = facet_across(&t->facets->facet[f], a) * facet_across(&t->facets->facet[g], b);
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < KNIFE_COSINE * length;
}

/* Adds the edges between two colours, at a border, and between the two sides of a sheet. */
static int add_seams(struct simplification *t)
{
    uint32_t corners = 3 * t->facets->count;
    struct seam *seam = malloc((corners + 1) * sizeof *seam);
    if (seam == NULL)
        return -1;
    for (uint32_t c = 0; c < corners; c++) {
        uint32_t a = t->vertex[c], b = t->vertex[next_corner(c)];
        seam[c] = (struct seam){a < b ? a : b, a < b ? b : a, c};
    }
    qsort(seam, corners, sizeof *seam, seam_order);
    for (uint32_t c = 0, end; c < corners; c = end) {
        const struct model_triangle *from = t->facets->facet[seam[c].corner / 3].from;
        bool plain = true;
        for (end = c + 1; end < corners && seam_order(&seam[c], &seam[end]) == 0; end++)
            plain = plain && same_colour(from, t->facets->facet[seam[end].corner / 3].from) &&
                    !is_knife(t, seam[c].corner / 3, seam[end].corner / 3);
        for (uint32_t i = c; (!plain || end == c + 1) && i < end; i++)
            add_seam(t, seam[i].corner);
    }
    free(seam);
    return 0;
}

static void add_facets(struct simplification *t)
{
    for (uint32_t f = 0; f < t->facets->count; f++) {
        float across[3];
        double n[3], length = (double)facet_across(&t->facets->facet[f], across);
        for (uint32_t i = 0; i < 3; i++)
            n[i] = length > 0.0 ? (double)across[i] / length : 0.0;
        for (uint32_t i = 0; i < 3; i++)
            add_plane(&t->quadric[t->vertex[3 * f + i]], n, t->facets->facet[f].corner[0], 1.0);
    }
}

/* --- collapsing ------------------------------------------------------------------------------- */

static double cost_into(const struct simplification *t, uint32_t from, uint32_t to)
{
    struct quadric sum = t->quadric[from];
    add_quadric(&sum, &t->quadric[to]);
    return distance2(&sum, t->at[to]);
}

static void update_cost(struct simplification *t, uint32_t corner)
{
    uint32_t a = t->vertex[corner], b = t->vertex[next_corner(corner)];
    t->cost[2 * corner] = cost_into(t, a, b) / t->bound[a];
    t->cost[2 * corner + 1] = cost_into(t, b, a) / t->bound[a];
}

static bool has(const struct simplification *t, uint32_t facet, uint32_t vertex)
{
    const uint32_t *corner = &t->vertex[3 * facet];
    return corner[0] == vertex || corner[1] == vertex || corner[2] == vertex;
}

/* Lists the facets at each vertex. */
static void find_neighbours(struct simplification *t)
{
    memset(t->first, 0, (t->vertices + 2) * sizeof *t->first);
    for (uint32_t c = 0; c < 3 * t->facets->count; c++)
        if (!t->removed[c / 3])
            t->first[t->vertex[c] + 2]++;
    for (uint32_t i = 2; i < t->vertices + 2; i++)
        t->first[i] += t->first[i - 1];
    for (uint32_t c = 0; c < 3 * t->facets->count; c++)
        if (!t->removed[c / 3])
            t->at_vertex[t->first[t->vertex[c] + 1]++] = c / 3;
}

/* Returns true if moving one vertex to another would turn a facet over or shrink it to a line. */
static bool turns_over(const struct simplification *t, uint32_t from, uint32_t to)
{
    for (uint32_t i = t->first[from]; i < t->first[from + 1]; i++) {
        uint32_t f = t->at_vertex[i];
        if (has(t, f, to))
            continue;
        struct facet moved = t->facets->facet[f];
        float before[3], after[3];
        float was = facet_across(&moved, before);
        for (uint32_t c = 0; c < 3; c++)
            if (t->vertex[3 * f + c] == from)
                memcpy(moved.corner[c], t->at[to], sizeof moved.corner[c]);
        float is = facet_across(&moved, after);
        double along = (double)(before[0] * after[0] + before[1] * after[1] + before[2] * after[2]);
        if (!(along > TURN_COSINE * (double)was * (double)is))
            return true;
    }
    return false;
}

/* Moves one vertex to the other. The lists of neighbours are those at the start of the round, so
 * vertices touched are not moved again in the same round. */
static void collapse(struct simplification *t, uint32_t from, uint32_t to)
{
    add_quadric(&t->quadric[to], &t->quadric[from]);
    for (uint32_t i = t->first[from]; i < t->first[from + 1]; i++) {
        uint32_t f = t->at_vertex[i];
        for (uint32_t c = 0; c < 3; c++)
            t->touched[t->vertex[3 * f + c]] = true;
        if (has(t, f, to)) {
            t->remaining -= t->removed[f] ? 0 : 1;
            t->removed[f] = true;
            continue;
        }
        for (uint32_t c = 0; c < 3; c++)
            if (t->vertex[3 * f + c] == from) {
                t->vertex[3 * f + c] = to;
                memcpy(t->facets->facet[f].corner[c], t->at[to], sizeof t->at[to]);
            }
        for (uint32_t c = 0; c < 3; c++)
            update_cost(t, 3 * f + c);
    }
    for (uint32_t i = t->first[to]; i < t->first[to + 1]; i++)
        for (uint32_t c = 0; c < 3; c++)
            update_cost(t, 3 * t->at_vertex[i] + c);
}

/* Collapses edges up to this cost, no two of them adjacent, until `most` facets remain. Returns the
 * number of edges collapsed. */
static uint32_t collapse_round(struct simplification *t, double cost, uint32_t most)
{
    uint32_t collapsed = 0;
    memset(t->touched, 0, t->vertices * sizeof *t->touched);
    find_neighbours(t);
    for (uint32_t i = 0; t->remaining > most && i < 6 * t->facets->count; i++) {
        if (t->removed[i / 6] || !(t->cost[i] <= cost))
            continue;
        uint32_t start = t->vertex[i / 2], end = t->vertex[next_corner(i / 2)];
        uint32_t from = i % 2 == 0 ? start : end, to = i % 2 == 0 ? end : start;
        if (t->touched[from] || t->touched[to] || turns_over(t, from, to))
            continue;
        collapse(t, from, to);
        collapsed++;
    }
    return collapsed;
}

static void drop_pieces(struct simplification *t, double drop_m)
{
    for (uint32_t f = 0; f < t->facets->count; f++)
        if (!t->removed[f] && t->breadth[f] < drop_m) {
            t->removed[f] = true;
            t->remaining--;
        }
}

/* Collapses the cheapest edges first, with rising limits while there are too many facets. */
static void collapse_all(struct simplification *t, double drop_m, uint32_t most)
{
    double coarse = STEP_FIRST;
    for (uint32_t step = 0; step < STEPS_MAX && t->remaining > most; step++) {
        drop_pieces(t, drop_m * coarse);
        while (t->remaining > most && collapse_round(t, coarse * coarse, most) > 0)
            ;
        coarse *= STEP;
    }
}

static void remove_facets(struct simplification *t)
{
    uint32_t kept = 0;
    for (uint32_t f = 0; f < t->facets->count; f++)
        if (!t->removed[f])
            t->facets->facet[kept++] = t->facets->facet[f];
    t->facets->count = kept;
}

int mesh_simplify(struct mesh_facets *facets, double drop_m, double error_m, uint32_t most)
{
    struct simplification t = {.facets = facets, .remaining = facets->count};
    int result = -1;
    t.vertex = mesh_facets_weld(facets, &t.vertices);
    t.quadric = calloc((size_t)t.vertices + 1, sizeof *t.quadric);
    t.at = malloc((t.vertices + 1) * sizeof *t.at);
    t.bound = malloc((t.vertices + 1) * sizeof *t.bound);
    t.cost = malloc((6 * facets->count + 1) * sizeof *t.cost);
    t.breadth = malloc((facets->count + 1) * sizeof *t.breadth);
    t.removed = calloc(facets->count + 1, sizeof *t.removed);
    t.touched = calloc(t.vertices + 1, sizeof *t.touched);
    t.first = malloc((t.vertices + 2) * sizeof *t.first);
    t.at_vertex = malloc((3 * facets->count + 1) * sizeof *t.at_vertex);
    if (t.vertex == NULL || t.quadric == NULL || t.at == NULL || t.bound == NULL ||
        t.cost == NULL || t.breadth == NULL || t.removed == NULL || t.touched == NULL ||
        t.first == NULL || t.at_vertex == NULL)
        goto out;
    for (uint32_t c = 0; c < 3 * facets->count; c++)
        memcpy(t.at[t.vertex[c]], facets->facet[c / 3].corner[c % 3], sizeof t.at[0]);
    add_facets(&t);
    if (add_seams(&t) != 0 || measure_pieces(&t, error_m) != 0)
        goto out;
    for (uint32_t c = 0; c < 3 * facets->count; c++)
        update_cost(&t, c);
    collapse_all(&t, drop_m, most);
    remove_facets(&t);
    result = 0;
out:
    free(t.vertex);
    free(t.quadric);
    free(t.at);
    free(t.bound);
    free(t.cost);
    free(t.breadth);
    free(t.removed);
    free(t.touched);
    free(t.first);
    free(t.at_vertex);
    return result;
}
