/* The ground of the software back end: its tiles, textures and triangles. */
#include "renderer/soft/soft_ground.h"

#include "renderer/soft/kernel.h"

#include <math.h>
#include <stdlib.h>

struct soft_ground *soft_ground_open(const struct static_scene *static_scene,
                                     struct error_text *error)
{
    struct soft_ground *ground = calloc(1, sizeof *ground);
    if (ground != NULL) {
        ground->static_scene = static_scene;
        ground->projected =
            aligned_alloc(SOFT_ALIGN, 3 * SOFT_PATCH_VERTICES * sizeof *ground->projected);
        if (terrain_tiles_init(&ground->tiles) == 0 && ground->projected != NULL &&
            soft_detail_make(&ground->detail) == 0 && (ground->clouds = soft_clouds_make()) != NULL)
            return ground;
        soft_ground_close(ground);
    }
    error_text_set(error, "no memory for the ground");
    return NULL;
}

void soft_ground_close(struct soft_ground *ground)
{
    if (ground == NULL)
        return;
    terrain_tiles_free(&ground->tiles);
    band_lists_free(&ground->lists);
    soft_detail_free(&ground->detail);
    free(ground->clouds);
    free(ground->list);
    free(ground->rows);
    free(ground->projected);
    free(ground);
}

/* Returns the fraction of a period, computed in double precision. */
static float fraction(double v)
{
    return (float)(v - floor(v));
}

const struct soft_detail *soft_ground_detail(const struct soft_ground *ground)
{
    return &ground->detail;
}

void soft_ground_update(struct soft_ground *ground, const struct soft_frame *frame)
{
    const struct draw_list *list = frame->list;
    struct vec3 eye = list->camera.eye;
    terrain_tiles_update(&ground->tiles, list->patches, list->patch_count, frame->frame_view,
                         list->texture_budget);
    ground->fine_at[0] = fraction(eye.x / (double)FINE_M);
    ground->fine_at[1] = fraction(eye.z / (double)FINE_M);
    double east = eye.x + 0.35 * eye.z, south = eye.z - 0.35 * eye.x;
    ground->ripples_at[0] = fraction(east * (double)SOFT_RIPPLES_PER_M);
    ground->ripples_at[1] = fraction(south * (double)SOFT_RIPPLES_PER_M);
    ground->swell_at[0] = fraction(south * (double)SOFT_SWELL_PER_M);
    ground->swell_at[1] = fraction(east * (double)SOFT_SWELL_PER_M);
    for (uint32_t i = 0; i < list->patch_count; i++) {
        const struct tile_view *view = &ground->tiles.views[i];
        double side = terrain_quadtree_patch_side(list->patches[i].level), last = TILE_TEXELS - 1;
        double per_m = (double)view->share / side * last;
        ground->patches[i] = (struct soft_patch){
            .texture = view->texture_tile->texture,
            .at_u = (float)((double)view->at_u * last +
                            (eye.x - list->patches[i].column * side) * per_m),
            .at_v =
                (float)((double)view->at_v * last + (eye.z - list->patches[i].row * side) * per_m),
            .per_m = (float)per_m,
            .wet = view->texture_tile->wet,
            .surf = view->texture_tile->surf,
        };
    }
}

int soft_ground_prepare(struct soft_ground *ground, const struct soft_frame *frame)
{
    size_t most = 0;
    for (uint32_t i = 0; i < frame->list->patch_count; i++)
        most += ground->tiles.views[i].tile->mesh.triangle_count;
    /* The near plane may cut a triangle into two. */
    void *list = ground->list, *rows = ground->rows;
    int full = band_lists_reserve(&list, &ground->list_room, 2 * most, sizeof *ground->list);
    full |= band_lists_reserve(&rows, &ground->rows_room, 2 * most, sizeof *ground->rows);
    ground->list = list;
    ground->rows = rows;
    if (full != 0)
        return -1;
    frame->kernels->soft_ground_set_up(ground, frame);
    return band_lists_sort(&ground->lists, ground->rows, ground->count, frame->bands);
}
