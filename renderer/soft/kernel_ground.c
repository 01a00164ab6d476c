/* The ground: sets up its triangles, and fills a band with their depth. */
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_ground.h"
#include "renderer/soft/triangle_raster.h"

/* A patch's vertices in the picture: x, y [pixel] and depth. */
struct projected_vertices {
    float *x, *y, *depth;
};

/* Up to eight triangles that are set up together. */
struct batch {
    struct corners8 corners;
    v8f depth[3];
    uint32_t count, patch;
};

/* Projects a patch's vertices. Those nearer than the near plane get depth 0. Whole vectors are
 * written; beyond the last vertex they contain copies of the first. Returns whether any vertex is
 * too near. */
static bool project(const struct projected_vertices *seen, const float (*vertices)[3],
                    uint32_t count, const float corner[3], const struct soft_frame *frame)
{
    v8i near = simd8_i(0);
    for (uint32_t i = 0; i < count; i += LANES) {
        v8f place[3];
        uint32_t held = count - i < LANES ? count - i : LANES;
        for (uint32_t lane = 0; lane < LANES; lane++) {
            const float *v = vertices[i + (lane < held ? lane : 0)];
            for (uint32_t a = 0; a < 3; a++)
                place[a][lane] = v[a];
        }
        v8f across = simd8_f(0.0f), down = simd8_f(0.0f), ahead = simd8_f(0.0f);
        for (uint32_t a = 0; a < 3; a++) {
            v8f p = place[a] + corner[a];
            across += p * frame->across[a];
            down += p * frame->down[a];
            ahead += p * frame->ahead[a];
        }
        v8i too_near = ahead < frame->near_m;
        near |= too_near;
        v8f depth = 1.0f / simd8_select(too_near, simd8_f(1.0f), ahead);
        simd8_store_f(seen->x + i, frame->centre_x + across * depth);
        simd8_store_f(seen->y + i, frame->centre_y + down * depth);
        simd8_store_f(seen->depth + i, simd8_select(too_near, simd8_f(0.0f), depth));
    }
    return simd8_bits(near) != 0;
}

/* Returns the slope of the depth from pixel to pixel, as stored in the ground code. */
static v8u steepness(const struct plane8 *depth)
{
    v8f steep = simd8_max(simd8_abs(depth->x), simd8_abs(depth->y));
    /* A float's bits approximate its logarithm. */
    v8i halves = (((v8i)steep) >> 22) - 2 * (127 - SOFT_STEEP_LOW);
    halves = simd8_select_i(halves < 0, simd8_i(0), halves);
    int32_t most = (1 << SOFT_STEEP_BITS) - 1;
    return (v8u)simd8_select_i(halves > most, simd8_i(most), halves);
}

static void flush(struct soft_ground *ground, const struct soft_frame *frame, struct batch *batch)
{
    struct edges8 edges;
    v8i drawn = triangle_raster_set_up(&edges, &batch->corners, frame->width, frame->height);
    drawn &= (edges.area < 0.0f) & (simd8_count() < (int32_t)batch->count);
    batch->count = 0;
    uint32_t bits = simd8_bits(drawn);
    if (bits == 0)
        return;
    const v8f *at = batch->depth;
    struct plane8 depth = triangle_raster_plane(&edges, at[0], at[1], at[2]);
    v8f least = simd8_min(simd8_min(at[0], at[1]), at[2]);
    v8f most = simd8_max(simd8_max(at[0], at[1]), at[2]);
    v8u steep = steepness(&depth);
    for (; bits != 0; bits &= bits - 1) {
        int lane = __builtin_ctz(bits);
        uint32_t n = ground->count++;
        ground->list[n] = (struct soft_ground_triangle){
            .edges = triangle_raster_of(&edges, lane),
            .depth = triangle_raster_plane_of(&depth, lane),
            .least = least[lane],
            .most = most[lane],
            .code = batch->patch | steep[lane] << SOFT_PATCH_BITS,
        };
        ground->rows[n] = (struct band_rows){(int16_t)edges.first[lane], (int16_t)edges.end[lane]};
    }
}

static void put(struct batch *batch, uint32_t corner, float x, float y, float depth)
{
    uint32_t lane = batch->count;
    batch->corners.x[corner][lane] = x;
    batch->corners.y[corner][lane] = y;
    batch->depth[corner][lane] = depth;
}

/* Adds a triangle that crosses the near plane. */
static void put_cut(struct soft_ground *ground, const struct soft_frame *frame, struct batch *batch,
                    const float (*vertices)[3], const float corner[3], const uint16_t triangle[3])
{
    struct clip_corner in[3], cut[4];
    for (uint32_t i = 0; i < 3; i++) {
        const float *v = vertices[triangle[i]];
        in[i] = (struct clip_corner){.ahead = 0.0f};
        for (uint32_t a = 0; a < 3; a++) {
            float p = v[a] + corner[a];
            in[i].value[0] += p * frame->across[a];
            in[i].value[1] += p * frame->down[a];
            in[i].ahead += p * frame->ahead[a];
        }
    }
    uint32_t count = triangle_raster_clip(in, 2, frame->near_m, cut);
    for (uint32_t last = 2; last < count; last++) {
        const uint32_t of[3] = {0, last - 1, last};
        for (uint32_t i = 0; i < 3; i++) {
            const struct clip_corner *c = &cut[of[i]];
            float depth = 1.0f / c->ahead;
            put(batch, i, frame->centre_x + c->value[0] * depth,
                frame->centre_y + c->value[1] * depth, depth);
        }
        if (++batch->count == LANES)
            flush(ground, frame, batch);
    }
}

/* Adds all triangles of a patch that lies wholly beyond the near plane. */
static void put_all(struct soft_ground *ground, const struct soft_frame *frame, struct batch *batch,
                    const struct projected_vertices *seen, const uint16_t (*triangles)[3],
                    uint32_t count)
{
    for (uint32_t i = 0; i < count; i += LANES) {
        uint32_t held = count - i < LANES ? count - i : LANES;
        for (uint32_t corner = 0; corner < 3; corner++) {
            v8i at = simd8_i(0);
            for (uint32_t lane = 0; lane < held; lane++)
                at[lane] = triangles[i + lane][corner];
            batch->corners.x[corner] = simd8_gather_f(seen->x, at);
            batch->corners.y[corner] = simd8_gather_f(seen->y, at);
            batch->depth[corner] = simd8_gather_f(seen->depth, at);
        }
        batch->count = held;
        flush(ground, frame, batch);
    }
}

static void put_near(struct soft_ground *ground, const struct soft_frame *frame,
                     struct batch *batch, const struct projected_vertices *seen,
                     const struct tile *tile, const float corner[3])
{
    const uint16_t(*triangles)[3] = (const uint16_t(*)[3])tile->mesh.triangles;
    const float(*vertices)[3] = (const float(*)[3])tile->mesh.vertices;
    for (uint32_t i = 0; i < tile->mesh.triangle_count; i++) {
        uint32_t behind = 0;
        for (uint32_t c = 0; c < 3; c++) {
            uint16_t v = triangles[i][c];
            put(batch, c, seen->x[v], seen->y[v], seen->depth[v]);
            behind += seen->depth[v] == 0.0f;
        }
        if (behind == 3)
            continue;
        if (behind > 0)
            put_cut(ground, frame, batch, vertices, corner, triangles[i]);
        else if (++batch->count == LANES)
            flush(ground, frame, batch);
    }
    if (batch->count > 0)
        flush(ground, frame, batch);
}

void KERNEL(soft_ground_set_up)(struct soft_ground *ground, const struct soft_frame *frame)
{
    const struct draw_list *list = frame->list;
    size_t room = SOFT_PATCH_VERTICES;
    struct projected_vertices seen = {ground->projected, ground->projected + room,
                                      ground->projected + 2 * room};
    struct batch batch = {.count = 0};
    ground->count = 0;
    for (uint32_t i = 0; i < list->patch_count; i++) {
        const struct terrain_quadtree_patch *patch = &list->patches[i];
        const struct tile *tile = ground->tiles.views[i].tile;
        const struct terrain_mesh *mesh = &tile->mesh;
        double side = terrain_quadtree_patch_side(patch->level);
        float corner[3];
        draw_list_relative(list, (struct vec3){patch->column * side, 0.0, patch->row * side},
                           corner);
        batch.patch = i;
        if (project(&seen, (const float(*)[3])mesh->vertices, mesh->vertex_count, corner, frame))
            put_near(ground, frame, &batch, &seen, tile, corner);
        else
            put_all(ground, frame, &batch, &seen, (const uint16_t(*)[3])mesh->triangles,
                    mesh->triangle_count);
    }
}

/* --- a band ------------------------------------------------------------------------------------
 */

struct depth_pass {
    const struct soft_ground_triangle *triangle;
    const struct soft_target *target;
};

SIMD8 void depth_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside)
{
    const struct depth_pass *pass = context;
    const struct soft_ground_triangle *t = pass->triangle;
    float *depth = pass->target->depth + at;
    uint32_t *colour = pass->target->colour + at;
    v8f here = triangle_raster_value(&t->edges, &t->depth, x, y), old = simd8_load_f(depth);
    here = simd8_clamp(here, t->least, t->most);
    v8i seen = inside & (here > old);
    if (simd8_bits(seen) == 0)
        return;
    simd8_store_f(depth, simd8_select(seen, here, old));
    simd8_store_u(colour, simd8_select_u(seen, simd8_u(t->code), simd8_load_u(colour)));
}

void KERNEL(soft_ground_fill)(const struct soft_ground *ground, const struct soft_frame *frame,
                              const struct soft_target *target)
{
    (void)frame;
    struct depth_pass pass = {.target = target};
    const struct band_lists *lists = &ground->lists;
    for (uint32_t i = lists->start[target->band]; i < lists->start[target->band + 1]; i++) {
        pass.triangle = &ground->list[lists->item[i]];
        triangle_raster_walk(&pass.triangle->edges, target, depth_pixels, &pass);
    }
}
