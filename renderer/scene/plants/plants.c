/* Trees and bushes of the world. Distant woods are thinned out, and the remaining plants become
 * wider, because crowns of a few pixels merge. Plants appear and vanish only by growing and
 * shrinking. */
#include "renderer/scene/plants/plants.h"

#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/plants/grass.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>

#define PLANT_MIN_PIXELS  2.0f /* smaller plants are left out; up to ... */
#define PLANT_FULL_PIXELS 3.0f /* ... this size they grow to full size */
#define PLANT_RANGE_M     7000.0
#define WOOD_WHOLE_PIXELS 14.0f /* below this size a wood is thinned out ... */
#define WOOD_MIN_SHARE    0.30f /* ... but never below this share */
#define WOOD_BAND         0.12f /* range of the share in which a plant shrinks to nothing */
#define LEAN_M            40.0  /* a plant may hang this far over the edge of its gridsquare */
#define DIAGONAL_SHARE    0.75  /* more than half a diagonal of a square over its side */
#define STUMP_M           1.0f  /* width and height */

/* The data that all plants of a picture share. */
struct plant_context {
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

/* Changes the look of a damaged plant. */
static void show_damage(struct draw_list_plant *plant, enum damage damage, uint32_t index)
{
    float side = value_noise_unit((int32_t)index, 3, 9) < 0.5f ? -1.0f : 1.0f;
    bool bush = plant->picture >= (float)PLANT_IMPOSTORS_BUSH_A &&
                plant->picture <= (float)PLANT_IMPOSTORS_BUSH_C;
    switch (damage) {
    case DAMAGE_NONE:
        return;
    case DAMAGE_LOW: /* it stands with damaged leaves */
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
            PLANT_IMPOSTORS_STUMP; /* thesis row 32; the tree lies beside it (fixed_objects.c) */
        plant->height = plant->width = STUMP_M;
        return;
    }
}

/* Returns the share of its size at which a plant is shown; 0: it is left out. Sets spread to the
 * factor on its width that makes up for the plants left out. */
static float shown(const struct plant_context *context, const struct static_scene_plant *fixed,
                   float pixels, float *spread)
{
    float grown = fminf(1.0f, (pixels - PLANT_MIN_PIXELS) / (PLANT_FULL_PIXELS - PLANT_MIN_PIXELS));
    *spread = 1.0f;
    if (fixed->kept_share >= 1.0f || pixels >= context->whole_pixels)
        return grown;
    float share = fmaxf(WOOD_MIN_SHARE, pixels / context->whole_pixels);
    /* Because of the band, a share of 1 shows the whole wood. */
    float left = fixed->rank == 0.0f
                     ? 1.0f
                     : (share * (1.0f + WOOD_BAND) - fixed->rank) * (1.0f / WOOD_BAND);
    *spread = 1.0f / sqrtf(fmaxf(share, fixed->kept_share));
    return grown * fminf(1.0f, left);
}

static void add_plant(const struct plant_context *context, uint32_t index)
{
    struct draw_list *list = context->list;
    const struct fixed_object *object = &context->frame_view->world->fixed[index];
    const struct static_scene_plant *fixed = &context->static_scene->plants[index];
    struct draw_list_plant made;
    draw_list_relative(list, fixed_position(object), made.at);
    if (!frustum_ball(&list->frustum, made.at, 2.2f * fixed->height))
        return;
    float pixels =
              frustum_pixels(&list->frustum, fixed->height, sqrtf(frustum_dot(made.at, made.at))),
          spread;
    if (pixels < PLANT_MIN_PIXELS)
        return;
    float size = shown(context, fixed, pixels, &spread);
    if (size <= 0.0f)
        return;
    struct draw_list_plant *plant = next_plant(list);
    if (plant == NULL)
        return;
    made.at[1] -= fixed->sink;
    made.width = fixed->width * size * spread;
    made.height = fixed->height * size;
    made.lean = 0.0f;
    made.picture = (float)context->static_scene->look[index];
    for (uint32_t i = 0; i < 2; i++)
        made.slope[i] = fixed->slope[i];
    for (uint32_t i = 0; i < 3; i++)
        made.tint[i] = fixed->tint[i];
    *plant = made;
    show_damage(plant, (enum damage)context->frame_view->fixed_damage[index], index);
}

static void add_plants(const struct plant_context *context, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++)
        if (context->static_scene->look[i] != LOOK_MODEL)
            add_plant(context, i);
}

/* Returns true if any plant of the block may be in the picture. Plants may lean over its edge. */
static bool sees_block(const struct camera *camera, const struct static_scene_block *block,
                       double square_m, int32_t column, int32_t row)
{
    const double side = STATIC_SCENE_BLOCK * square_m;
    if (block->low > block->high)
        return false;
    struct vec3 low = {column * side - LEAN_M, (double)block->low - 1.0, row * side - LEAN_M};
    struct vec3 high = {(column + 1) * side + LEAN_M, (double)block->high,
                        (row + 1) * side + LEAN_M};
    return camera_sees_box(camera, low, high);
}

/* The same for one gridsquare of the block. */
static bool sees_square(const struct draw_list *list, const struct static_scene_block *block,
                        double square_m, int32_t column, int32_t row)
{
    struct vec3 middle = {(column + 0.5) * square_m,
                          0.5 * ((double)block->low + (double)block->high), (row + 0.5) * square_m};
    float at[3], high = 0.5f * (block->high - block->low);
    draw_list_relative(list, middle, at);
    return frustum_ball(&list->frustum, at, (float)(DIAGONAL_SHARE * square_m + LEAN_M) + high);
}

static void add_block(const struct plant_context *context, const struct gridsquare_box *box,
                      int32_t column, int32_t row)
{
    const int32_t side = (int32_t)STATIC_SCENE_BLOCK;
    const struct static_scene *static_scene = context->static_scene;
    const struct gridsquares *squares = &static_scene->world->terrain.squares;
    const struct static_scene_block *block =
        &static_scene->blocks[(uint32_t)row * static_scene->blocks_a_side + (uint32_t)column];
    if (!sees_block(&context->list->camera, block, squares->side_m, column, row))
        return;
    int32_t last_row = row * side + side - 1 < box->z1 ? row * side + side - 1 : box->z1;
    int32_t last_column = column * side + side - 1 < box->x1 ? column * side + side - 1 : box->x1;
    for (int32_t r = row * side > box->z0 ? row * side : box->z0; r <= last_row; r++)
        for (int32_t c = column * side > box->x0 ? column * side : box->x0; c <= last_column; c++) {
            const uint32_t *start = &static_scene->square_start[gridsquare_index(squares, c, r)];
            if (start[0] < start[1] && sees_square(context->list, block, squares->side_m, c, r))
                add_plants(context, start[0], start[1]);
        }
}

void plants_add(struct draw_list *list, const struct static_scene *static_scene,
                const struct frame_view *frame_view)
{
    struct plant_context context = {.list = list,
                                    .static_scene = static_scene,
                                    .frame_view = frame_view,
                                    .whole_pixels = WOOD_WHOLE_PIXELS / list->detail};
    struct vec3 eye = list->camera.eye;
    const int32_t side = (int32_t)STATIC_SCENE_BLOCK;
    struct gridsquare_box box =
        gridsquare_box_of(&static_scene->world->terrain.squares, eye.x - PLANT_RANGE_M,
                          eye.z - PLANT_RANGE_M, eye.x + PLANT_RANGE_M, eye.z + PLANT_RANGE_M);
    for (int32_t row = box.z0 / side; row <= box.z1 / side; row++)
        for (int32_t column = box.x0 / side; column <= box.x1 / side; column++)
            add_block(&context, &box, column, row);
    if (!list->texture)
        return;
    list->plant_count += grass_show(list->grass, list, static_scene->world, &static_scene->roads,
                                    frame_view->craters, &list->plants[list->plant_count],
                                    DRAW_LIST_PLANTS_MAX - list->plant_count);
}
