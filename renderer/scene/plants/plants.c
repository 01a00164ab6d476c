/* Trees and bushes of the world. Far woods are thinned out and those that stay grow wider: below
 * some pixels crowns run into each other. None comes or goes but by its size. */
#include "renderer/scene/plants/plants.h"

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/plants/grass.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>

#define PLANT_MIN_PIXELS  2.0f /* smaller than this nobody sees it; up to ... */
#define PLANT_FULL_PIXELS 3.0f /* ... this it grows into the picture */
#define PLANT_RANGE_M     7000.0
#define WOOD_WHOLE_PIXELS 14.0f /* smaller than this not all of a wood is shown ... */
#define WOOD_MIN_SHARE    0.30f /* ... but never less than so much of it */
#define WOOD_BAND         0.12f /* of the share, in which a plant shrinks to nothing */
#define LEAN_M            40.0  /* so far a plant may hang over the edge of its square */
#define SQUARE_REACH_M                                                                             \
    (float)(0.75 * GRIDSQUARE_SIDE_M + LEAN_M) /* half a diagonal is 0.71 sides */
#define STUMP_M 1.0f                           /* wide and high */

/* What all plants of a picture share. */
struct planting {
    struct draw_list *list;
    const struct static_scene *static_scene;
    const struct frame_view *frame_view;
    float whole_pixels;
};

static struct draw_list_plant *next_plant(struct draw_list *list)
{
    if (list->plant_count == DRAW_LIST_PLANTS_MAX) {
        list->omitted++;
        return NULL;
    }
    return &list->plants[list->plant_count++];
}

/* What is left of a plant. */
static void show_damage(struct draw_list_plant *plant, enum damage damage, uint32_t index)
{
    float side = value_noise_unit((int32_t)index, 3, 9) < 0.5f ? -1.0f : 1.0f;
    bool bush = plant->picture >= (float)PLANT_IMPOSTORS_BUSH_A &&
                plant->picture <= (float)PLANT_IMPOSTORS_BUSH_C;
    switch (damage) {
    case DAMAGE_NONE:
        return;
    case DAMAGE_LOW: /* it stands: its leaves are the worse for it */
        plant->height *= 0.96f;
        plant->tint[0] *= 1.12f;
        return;
    case DAMAGE_MED:
        plant->lean = 0.42f * side;
        plant->height *= 0.9f;
        plant->tint[0] *= 1.18f;
        return;
    default:
        if (bush) {
            plant->height *= 0.35f;
            return;
        }
        plant->picture = (float)
            PLANT_IMPOSTORS_STUMP; /* thesis row 32; the tree lies beside (fixed_objects.c) */
        plant->height = plant->width = STUMP_M;
        return;
    }
}

/* How much of its size a plant shows, 0: it is left out; *spread: how much wider than it is, for
 * those of its wood that are left out. */
static float shown(const struct planting *planting, const struct static_scene_plant *is,
                   float pixels, float *spread)
{
    float grown = fminf(1.0f, (pixels - PLANT_MIN_PIXELS) / (PLANT_FULL_PIXELS - PLANT_MIN_PIXELS));
    *spread = 1.0f;
    if (is->lone >= 1.0f || pixels >= planting->whole_pixels)
        return grown;
    float share = fmaxf(WOOD_MIN_SHARE, pixels / planting->whole_pixels);
    /* With the band added a whole wood is whole. */
    float left =
        is->rank == 0.0f ? 1.0f : (share * (1.0f + WOOD_BAND) - is->rank) * (1.0f / WOOD_BAND);
    *spread = 1.0f / sqrtf(fmaxf(share, is->lone));
    return grown * fminf(1.0f, left);
}

static void add_plant(const struct planting *planting, uint32_t index)
{
    struct draw_list *list = planting->list;
    const struct fixed_object *object = &planting->frame_view->world->fixed[index];
    const struct static_scene_plant *is = &planting->static_scene->plants[index];
    struct draw_list_plant made;
    draw_list_relative(list, fixed_position(object), made.at);
    if (!frustum_ball(&list->frustum, made.at, 2.2f * is->height))
        return;
    float pixels = frustum_pixels(&list->frustum, is->height, sqrtf(frustum_dot(made.at, made.at))),
          spread;
    if (pixels < PLANT_MIN_PIXELS)
        return;
    float size = shown(planting, is, pixels, &spread);
    if (size <= 0.0f)
        return;
    struct draw_list_plant *plant = next_plant(list);
    if (plant == NULL)
        return;
    made.at[1] -= is->sink;
    made.width = is->width * size * spread;
    made.height = is->height * size;
    made.lean = 0.0f;
    made.picture = (float)planting->static_scene->look[index];
    for (uint32_t i = 0; i < 2; i++)
        made.slope[i] = is->slope[i];
    for (uint32_t i = 0; i < 3; i++)
        made.tint[i] = is->tint[i];
    *plant = made;
    show_damage(plant, (enum damage)planting->frame_view->fixed_damage[index], index);
}

static void add_plants(const struct planting *planting, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++)
        if (planting->static_scene->look[i] != LOOK_MODEL)
            add_plant(planting, i);
}

/* Can any plant of the block be in the picture? They may lean over its edge. */
static bool sees_block(const struct camera *camera, const struct static_scene_block *block,
                       int32_t column, int32_t row)
{
    const double side = STATIC_SCENE_BLOCK * GRIDSQUARE_SIDE_M;
    if (block->low > block->high)
        return false;
    struct vec3 low = {column * side - LEAN_M, (double)block->low - 1.0, row * side - LEAN_M};
    struct vec3 high = {(column + 1) * side + LEAN_M, (double)block->high,
                        (row + 1) * side + LEAN_M};
    return camera_sees_box(camera, low, high);
}

/* And of one gridsquare of it? */
static bool sees_square(const struct draw_list *list, const struct static_scene_block *block,
                        int32_t column, int32_t row)
{
    struct vec3 middle = {(column + 0.5) * GRIDSQUARE_SIDE_M,
                          0.5 * ((double)block->low + (double)block->high),
                          (row + 0.5) * GRIDSQUARE_SIDE_M};
    float at[3], high = 0.5f * (block->high - block->low);
    draw_list_relative(list, middle, at);
    return frustum_ball(&list->frustum, at, SQUARE_REACH_M + high);
}

static void add_block(const struct planting *planting, const struct gridsquare_box *box,
                      int32_t column, int32_t row)
{
    const int32_t side = (int32_t)STATIC_SCENE_BLOCK;
    const struct static_scene *static_scene = planting->static_scene;
    const struct static_scene_block *block =
        &static_scene->blocks[(uint32_t)row * STATIC_SCENE_BLOCKS + (uint32_t)column];
    if (!sees_block(&planting->list->camera, block, column, row))
        return;
    int32_t last_row = row * side + side - 1 < box->z1 ? row * side + side - 1 : box->z1;
    int32_t last_column = column * side + side - 1 < box->x1 ? column * side + side - 1 : box->x1;
    for (int32_t r = row * side > box->z0 ? row * side : box->z0; r <= last_row; r++)
        for (int32_t c = column * side > box->x0 ? column * side : box->x0; c <= last_column; c++) {
            const uint32_t *start = &static_scene->square_start[gridsquare_index(c, r)];
            if (start[0] < start[1] && sees_square(planting->list, block, c, r))
                add_plants(planting, start[0], start[1]);
        }
}

void plants_add(struct draw_list *list, const struct static_scene *static_scene,
                const struct frame_view *frame_view)
{
    struct planting planting = {.list = list,
                                .static_scene = static_scene,
                                .frame_view = frame_view,
                                .whole_pixels = WOOD_WHOLE_PIXELS / list->detail};
    struct vec3 eye = list->camera.eye;
    const int32_t side = (int32_t)STATIC_SCENE_BLOCK;
    struct gridsquare_box box = gridsquare_box_of(eye.x - PLANT_RANGE_M, eye.z - PLANT_RANGE_M,
                                                  eye.x + PLANT_RANGE_M, eye.z + PLANT_RANGE_M);
    for (int32_t row = box.z0 / side; row <= box.z1 / side; row++)
        for (int32_t column = box.x0 / side; column <= box.x1 / side; column++)
            add_block(&planting, &box, column, row);
    if (!list->texture)
        return;
    list->plant_count +=
        grass_show(list->grass, list, static_scene->world, frame_view->craters,
                   &list->plants[list->plant_count], DRAW_LIST_PLANTS_MAX - list->plant_count);
}
