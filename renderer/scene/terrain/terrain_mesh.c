/* Makes meshes of right triangles. */
#include "renderer/scene/terrain/terrain_mesh.h"

#include <stdlib.h>
#include <string.h>

#define POSTS_MAX (GROUND_CELLS_MAX + 1u)
#define UNUSED    UINT16_MAX
#define LEG_EXACT 2 /* [cells] for longer legs the error is measured */

/* Craters are curved everywhere, so a patch that shows them has this smaller tolerance, as a share
 * of its side. At the deepest level it is 16 mm. */
#define DUG_ERROR (1.0 / 2000.0)

/* Heights on the patch's grid, and values derived from them. */
struct grid {
    int32_t cells;                     /* a side */
    float post[POSTS_MAX * POSTS_MAX]; /* [m] */
    float centre[GROUND_CELLS_MAX *
                 GROUND_CELLS_MAX];         /* [m] true ground in the middle of each cell */
    float error[POSTS_MAX * POSTS_MAX];     /* [m] of the triangles that the post would divide */
    uint16_t vertex[POSTS_MAX * POSTS_MAX]; /* index in the mesh; or UNUSED */
    float tolerance;
};

/* A right triangle between posts: the ends of its hypotenuse and its right angle. */
struct right_triangle {
    int32_t ax, az, bx, bz, cx, cz;
};

static uint32_t post_at(const struct grid *grid, int32_t x, int32_t z)
{
    return (uint32_t)(z * (grid->cells + 1) + x);
}

static bool has_crater(const struct crater_index *craters,
                       const struct terrain_quadtree_patch *patch)
{
    double side = terrain_quadtree_patch_side(patch->level);
    double x0 = patch->column * side, z0 = patch->row * side;
    for (uint32_t i = 0; i < craters->count; i++) {
        const struct crater *crater = &craters->craters[i];
        double reach = CRATER_RIM * (double)crater->radius_m;
        if (crater->x + reach > x0 && crater->x - reach < x0 + side && crater->z + reach > z0 &&
            crater->z - reach < z0 + side)
            return true;
    }
    return false;
}

/* Returns true if an earthwork that changes the height reaches into the patch. */
static bool has_work(const struct terrain *terrain, const struct terrain_quadtree_patch *patch)
{
    double side = terrain_quadtree_patch_side(patch->level);
    double x0 = patch->column * side, z0 = patch->row * side;
    for (uint32_t i = 0; i < terrain->earthworks.count; i++) {
        const struct earthwork *work = &terrain->earthworks.works[i];
        double x = earthwork_reach_x(work), z = earthwork_reach_z(work);
        if (work->height_m != 0.0 && work->x + x > x0 && work->x - x < x0 + side &&
            work->z + z > z0 && work->z - z < z0 + side)
            return true;
    }
    return false;
}

/* The ground, or the water of a ford on it. */
static float height_at(const struct terrain *terrain, const struct crater_index *craters, double x,
                       double z)
{
    terrain_quadtree_beyond(terrain, &x, &z);
    return (float)(terrain_height(terrain, craters, x, z) + terrain_water_depth(terrain, x, z));
}

static void fill_heights(struct grid *grid, const struct terrain *terrain,
                         const struct crater_index *craters,
                         const struct terrain_quadtree_patch *patch)
{
    double side = terrain_quadtree_patch_side(patch->level), step = side / grid->cells;
    double x0 = patch->column * side, z0 = patch->row * side;
    for (int32_t row = 0, n = 0; row <= grid->cells; row++)
        for (int32_t column = 0; column <= grid->cells; column++, n++)
            grid->post[n] = height_at(terrain, craters, x0 + column * step, z0 + row * step);
    for (int32_t row = 0, n = 0; row < grid->cells; row++)
        for (int32_t column = 0; column < grid->cells; column++, n++)
            grid->centre[n] =
                height_at(terrain, craters, x0 + (column + 0.5) * step, z0 + (row + 0.5) * step);
}

/* --- errors ----------------------------------------------------------------------------------- */

/* Returns the triangle with this number: 1 is the root, 2 and 3 are the halves of the square, and
 * the halves of triangle n are 2n and 2n + 1. */
static struct right_triangle right_triangle_of(uint32_t number, int32_t cells)
{
    uint32_t depth = 31 - (uint32_t)__builtin_clz(number);
    struct right_triangle t = {0, 0, cells, cells, cells, 0};
    if (number >> (depth - 1) & 1)
        t = (struct right_triangle){cells, cells, 0, 0, 0, cells};
    for (uint32_t bit = depth - 1; bit-- > 0;) {
        int32_t mx = (t.ax + t.bx) / 2, mz = (t.az + t.bz) / 2;
        t = number >> bit & 1 ? (struct right_triangle){t.bx, t.bz, t.cx, t.cz, mx, mz}
                              : (struct right_triangle){t.cx, t.cz, t.ax, t.az, mx, mz};
    }
    return t;
}

/* Widens low..high to where the side is at row z, in half cells. */
static void side_at(int32_t x0, int32_t z0, int32_t x1, int32_t z1, int32_t z, int32_t *low,
                    int32_t *high)
{
    if ((z < z0 && z < z1) || (z > z0 && z > z1))
        return;
    /* A side is horizontal, vertical or diagonal. */
    int32_t at = z0 == z1 ? x0 : x0 + (x1 - x0) * (z - z0) / (z1 - z0);
    int32_t other = z0 == z1 ? x1 : at;
    *low = at < *low ? at : *low;
    *low = other < *low ? other : *low;
    *high = at > *high ? at : *high;
    *high = other > *high ? other : *high;
}

static float worst_of(const float *heights, int32_t count, float flat, float rise)
{
    float worst = 0.0f;
    for (int32_t i = 0; i < count; i++) {
        float off = fabsf(flat + rise * (float)i - heights[i]);
        worst = off > worst ? off : worst;
    }
    return worst;
}

/* Returns the largest distance of the ground from the triangle, at the posts and at the middles of
 * cells within it. */
static float measured_error(const struct grid *grid, const struct right_triangle *t)
{
    float a = grid->post[post_at(grid, t->ax, t->az)], b = grid->post[post_at(grid, t->bx, t->bz)];
    float c = grid->post[post_at(grid, t->cx, t->cz)];
    float ux = (float)(t->ax - t->cx), uz = (float)(t->az - t->cz);
    float vx = (float)(t->bx - t->cx), vz = (float)(t->bz - t->cz);
    float area = ux * vz - uz * vx;
    float rise_x = ((a - c) * vz - (b - c) * uz) / area;
    float rise_z = ((b - c) * ux - (a - c) * vx) / area;
    int32_t top = t->az < t->bz ? t->az : t->bz, foot = t->az > t->bz ? t->az : t->bz;
    top = 2 * (t->cz < top ? t->cz : top);
    foot = 2 * (t->cz > foot ? t->cz : foot);
    float worst = 0.0f;
    for (int32_t z = top; z <= foot; z++) {
        int32_t low = INT32_MAX, high = INT32_MIN, centre = z & 1;
        side_at(2 * t->ax, 2 * t->az, 2 * t->bx, 2 * t->bz, z, &low, &high);
        side_at(2 * t->bx, 2 * t->bz, 2 * t->cx, 2 * t->cz, z, &low, &high);
        side_at(2 * t->cx, 2 * t->cz, 2 * t->ax, 2 * t->az, z, &low, &high);
        int32_t first = (low + 1 - centre) / 2, last = (high - centre) / 2;
        const float *heights =
            centre ? grid->centre + (z / 2) * grid->cells : grid->post + post_at(grid, 0, z / 2);
        float middle = 0.5f * (float)centre;
        float flat = c + rise_x * ((float)(first - t->cx) + middle) +
                     rise_z * (0.5f * (float)z - (float)t->cz);
        float off = worst_of(heights + first, last - first + 1, flat, rise_x);
        worst = off > worst ? off : worst;
    }
    return worst;
}

static float middle_error(const struct grid *grid, const struct right_triangle *t, uint32_t middle)
{
    float a = grid->post[post_at(grid, t->ax, t->az)], b = grid->post[post_at(grid, t->bx, t->bz)];
    return fabsf(0.5f * (a + b) - grid->post[middle]);
}

/* Returns the largest error of half cells, which is at the middles of cells, on the hypotenuses.
 * Every second cell of a row is cut from the north-east to the south-west. */
static float half_cells_error(const struct grid *grid)
{
    float worst = 0.0f;
    for (int32_t z = 0; z < grid->cells; z++)
        for (int32_t x = 0; x < grid->cells; x++) {
            int32_t turned = (x + z) & 1;
            float a = grid->post[post_at(grid, x + turned, z)];
            float b = grid->post[post_at(grid, x + 1 - turned, z + 1)];
            float off = fabsf(0.5f * (a + b) - grid->centre[z * grid->cells + x]);
            worst = off > worst ? off : worst;
        }
    return worst;
}

/* Finds for each post the largest error of the triangles that it divides and of all below them. So
 * two triangles with a common hypotenuse are always divided together. */
static void find_errors(struct grid *grid)
{
    memset(grid->error, 0, sizeof grid->error);
    uint32_t halves = 2u * (uint32_t)(grid->cells * grid->cells);
    for (uint32_t number = halves; number-- > 2;) {
        struct right_triangle t = right_triangle_of(number, grid->cells);
        int32_t mx = (t.ax + t.bx) / 2, mz = (t.az + t.bz) / 2;
        uint32_t middle = post_at(grid, mx, mz);
        float below = 0.0f;
        if (2 * number < halves) {
            float left = grid->error[post_at(grid, (t.ax + t.cx) / 2, (t.az + t.cz) / 2)];
            float right = grid->error[post_at(grid, (t.bx + t.cx) / 2, (t.bz + t.cz) / 2)];
            below = left > right ? left : right;
        }
        int32_t leg = abs(t.ax - t.cx) + abs(t.az - t.cz);
        float own =
            leg > LEG_EXACT ? measured_error(grid, &t) : middle_error(grid, &t, middle) + below;
        own = own > below ? own : below;
        grid->error[middle] = own > grid->error[middle] ? own : grid->error[middle];
    }
}

/* --- triangles -------------------------------------------------------------------------------- */

/* Returns the mesh's vertex on a post. Adds it if necessary. */
static uint16_t vertex_on(struct grid *grid, struct terrain_mesh *mesh, double step, int32_t x,
                          int32_t z)
{
    uint32_t post = post_at(grid, x, z);
    if (grid->vertex[post] == UNUSED) {
        float *vertex = mesh->vertices[mesh->vertex_count];
        vertex[0] = (float)(x * step);
        vertex[1] = grid->post[post];
        vertex[2] = (float)(z * step);
        grid->vertex[post] = (uint16_t)mesh->vertex_count++;
    }
    return grid->vertex[post];
}

static void add_triangle(struct terrain_mesh *mesh, uint16_t a, uint16_t b, uint16_t c)
{
    uint16_t *triangle = mesh->triangles[mesh->triangle_count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

/* Adds the triangle or, if its error is too large, its halves. */
static void add_right_triangle(struct grid *grid, struct terrain_mesh *mesh, double step,
                               struct right_triangle t)
{
    int32_t mx = (t.ax + t.bx) / 2, mz = (t.az + t.bz) / 2;
    bool half_cell = abs(t.ax - t.bx) + abs(t.az - t.bz) == 2 && t.ax != t.bx && t.az != t.bz;
    if (!half_cell && grid->error[post_at(grid, mx, mz)] > grid->tolerance) {
        add_right_triangle(grid, mesh, step,
                           (struct right_triangle){t.cx, t.cz, t.ax, t.az, mx, mz});
        add_right_triangle(grid, mesh, step,
                           (struct right_triangle){t.bx, t.bz, t.cx, t.cz, mx, mz});
        return;
    }
    uint16_t a = vertex_on(grid, mesh, step, t.ax, t.az);
    uint16_t b = vertex_on(grid, mesh, step, t.bx, t.bz);
    add_triangle(mesh, a, b, vertex_on(grid, mesh, step, t.cx, t.cz));
}

/* Divides every cell in two, like the world's own ground. */
static void add_cells(struct grid *grid, struct terrain_mesh *mesh, double step)
{
    for (int32_t z = 0; z < grid->cells; z++)
        for (int32_t x = 0; x < grid->cells; x++) {
            uint16_t north_west = vertex_on(grid, mesh, step, x, z);
            uint16_t south_east = vertex_on(grid, mesh, step, x + 1, z + 1);
            add_triangle(mesh, north_west, south_east, vertex_on(grid, mesh, step, x + 1, z));
            add_triangle(mesh, south_east, north_west, vertex_on(grid, mesh, step, x, z + 1));
        }
}

/* Adds a skirt below the vertices of one edge, from one corner to the next with the outside on the
 * right. */
static void add_skirt(const struct grid *grid, struct terrain_mesh *mesh, float drop, int32_t x,
                      int32_t z, int32_t dx, int32_t dz)
{
    uint16_t before = UNUSED, low_before = UNUSED;
    for (int32_t i = 0; i <= grid->cells; i++, x += dx, z += dz) {
        uint16_t here = grid->vertex[post_at(grid, x, z)];
        if (here == UNUSED)
            continue;
        uint16_t low = (uint16_t)mesh->vertex_count++;
        memcpy(mesh->vertices[low], mesh->vertices[here], sizeof mesh->vertices[low]);
        mesh->vertices[low][1] -= drop;
        if (before != UNUSED) {
            add_triangle(mesh, before, low_before, here);
            add_triangle(mesh, here, low_before, low);
        }
        before = here;
        low_before = low;
    }
}

void terrain_mesh(const struct terrain *terrain, const struct crater_index *craters,
                  const struct terrain_quadtree_patch *patch, struct terrain_mesh *mesh)
{
    struct grid grid; /* too large to be cleared for each patch */
    grid.cells = 1;
    grid.tolerance = (float)terrain_quadtree_tolerance(patch->level);
    double side = terrain_quadtree_patch_side(patch->level);
    bool dug = patch->level >= TERRAIN_QUADTREE_DIG_LEVEL &&
               ((craters != NULL && has_crater(craters, patch)) || has_work(terrain, patch));
    while (grid.cells < (int32_t)GROUND_CELLS && grid.cells * terrain->spacing_m < side)
        grid.cells *= 2;
    if (dug) {
        grid.cells = (int32_t)GROUND_CELLS_MAX;
        grid.tolerance = (float)(DUG_ERROR * side);
    }
    fill_heights(&grid, terrain, dug ? craters : NULL, patch);
    memset(grid.vertex, 0xff, sizeof grid.vertex);
    mesh->vertex_count = mesh->triangle_count = 0;

    double step = side / grid.cells;
    int32_t last = grid.cells;
    /* The deepest level may be directly in front of the eye. */
    bool true_ground = patch->level == TERRAIN_QUADTREE_LEVEL_MAX && !dug;
    bool of_posts = step <= terrain->spacing_m && !dug;
    if (true_ground || (of_posts && half_cells_error(&grid) > grid.tolerance)) {
        add_cells(&grid, mesh, step);
    } else {
        find_errors(&grid);
        add_right_triangle(&grid, mesh, step, (struct right_triangle){0, 0, last, last, last, 0});
        add_right_triangle(&grid, mesh, step, (struct right_triangle){last, last, 0, 0, 0, last});
    }
    mesh->top_vertices = mesh->vertex_count;
    mesh->top_triangles = mesh->triangle_count;
    float drop = (float)terrain_quadtree_skirt(patch->level);
    add_skirt(&grid, mesh, drop, last, 0, -1, 0);
    add_skirt(&grid, mesh, drop, 0, 0, 0, 1);
    add_skirt(&grid, mesh, drop, 0, last, 1, 0);
    add_skirt(&grid, mesh, drop, last, last, 0, -1);
}
