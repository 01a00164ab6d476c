/* Trees and bushes of the world, and near the eye grass and brush that are looks alone: too low to
 * stop anything, they are no objects of the world. */
#include "renderer/scene/scene.h"

#include "renderer/scene/grain.h"
#include "world/square.h"

#include <math.h>

#define PLANT_LEAST_PIXELS 2.0
#define PLANT_RANGE_M      7000.0
#define TUFT_RANGE_M       170.0
#define TUFT_CELL_M        2.6
#define TUFT_FADE          0.35 /* share of the range over which tufts thin out */
#define ROADS_MAX          96   /* pieces of road near the eye */
#define STUMP_M            1.0f /* wide and high */
#define ROAD_CLEAR_M       6.0  /* no tufts within this of a road's middle */

struct road_pieces {
    const struct road_point *from[ROADS_MAX];
    uint32_t count;
};

static void ground_slope(const struct moment *moment, double x, double z, float slope[2])
{
    const struct terrain *terrain = &moment->world->terrain;
    double here = terrain_base_height(terrain, x, z);
    slope[0] = (float)(terrain_base_height(terrain, x + 2.0, z) - here) * 0.5f;
    slope[1] = (float)(terrain_base_height(terrain, x, z + 2.0) - here) * 0.5f;
}

static struct scene_plant *next_plant(struct scene *scene)
{
    if (scene->plant_count == SCENE_PLANTS_MAX) {
        scene->omitted++;
        return NULL;
    }
    return &scene->plants[scene->plant_count++];
}

/* Width of a picture over its height: each fills its square differently. */
static float breadth(uint8_t look)
{
    switch (look) {
    case FOLIAGE_PINE_A:
    case FOLIAGE_PINE_B:
        return 0.85f;
    case FOLIAGE_FIR:
        return 0.60f;
    case FOLIAGE_BUSH_A:
    case FOLIAGE_BUSH_B:
    case FOLIAGE_BUSH_C:
        return 1.45f;
    case FOLIAGE_OAK_A:
    case FOLIAGE_OAK_B:
    case FOLIAGE_OAK_C:
        return 1.25f;
    default:
        return 1.05f;
    }
}

/* A stump (thesis row 32), and beside it the tree that stood on it, lying. */
static void fell(struct scene *scene, struct scene_plant *plant, float side)
{
    struct scene_plant stump = *plant;
    stump.picture = (float)FOLIAGE_STUMP;
    stump.height = stump.width = STUMP_M;
    plant->lean = side * 2.1f;
    plant->height *= 0.30f;
    plant->width *= 0.75f;
    plant->tint[0] *= 1.15f;
    plant = next_plant(scene);
    if (plant != NULL)
        *plant = stump;
}

/* What is left of a plant. */
static void show_damage(struct scene *scene, struct scene_plant *plant, enum damage damage,
                        uint32_t index)
{
    float side = grain_unit((int32_t)index, 3, 9) < 0.5f ? -1.0f : 1.0f;
    bool bush = plant->picture >= (float)FOLIAGE_BUSH_A && plant->picture <= (float)FOLIAGE_BUSH_C;
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
        if (bush)
            plant->height *= 0.35f;
        else
            fell(scene, plant, side);
        return;
    }
}

static void add_plant(struct scene *scene, const struct scenery *scenery,
                      const struct moment *moment, uint32_t index)
{
    const struct fixed_object *object = &moment->world->fixed[index];
    struct vec3 foot = fixed_position(object);
    double high = (double)object->height_m;
    double distance = vec3_length(vec3_sub(foot, scene->camera.eye));
    if (camera_pixels(&scene->camera, high, distance) < PLANT_LEAST_PIXELS ||
        !camera_sees(&scene->camera, foot, 2.2 * high))
        return;
    struct scene_plant *plant = next_plant(scene);
    if (plant == NULL)
        return;
    uint8_t look = scenery->look[index];
    float tone = 0.86f + 0.28f * grain_unit((int32_t)index, 1, 9);
    float dry = grain_unit((int32_t)index, 2, 9);
    *plant = (struct scene_plant){
        .width = (float)high * breadth(look) * (0.9f + 0.2f * dry),
        .height = (float)high,
        .picture = (float)look,
        .tint = {tone * (0.92f + 0.22f * dry), tone, tone * (1.05f - 0.2f * dry)},
    };
    scene_place(scene, foot, plant->at);
    ground_slope(moment, foot.x, foot.z, plant->slope);
    plant->at[1] -= 0.02f * plant->height;
    show_damage(scene, plant, (enum damage)moment->fixed_damage[index], index);
}

/* --- tufts ------------------------------------------------------------------------------------ */

static void find_roads(const struct scene *scene, const struct world *world,
                       struct road_pieces *pieces)
{
    pieces->count = 0;
    for (uint32_t i = 0; i + 1 < world->counts.road_points && pieces->count < ROADS_MAX; i++) {
        const struct road_point *a = &world->road_points[i], *b = a + 1;
        if (a->road != b->road)
            continue;
        double mx = 0.5 * ((double)a->x + (double)b->x) - scene->camera.eye.x;
        double mz = 0.5 * ((double)a->z + (double)b->z) - scene->camera.eye.z;
        double half = 0.5 * hypot((double)b->x - (double)a->x, (double)b->z - (double)a->z);
        if (hypot(mx, mz) < half + TUFT_RANGE_M + ROAD_CLEAR_M)
            pieces->from[pieces->count++] = a;
    }
}

static bool on_road(const struct road_pieces *pieces, double x, double z)
{
    for (uint32_t i = 0; i < pieces->count; i++) {
        const struct road_point *a = pieces->from[i], *b = a + 1;
        double dx = (double)b->x - (double)a->x, dz = (double)b->z - (double)a->z;
        double px = x - (double)a->x, pz = z - (double)a->z, squared = dx * dx + dz * dz;
        double t = squared > 0.0 ? maths_clamp((px * dx + pz * dz) / squared, 0.0, 1.0) : 0.0;
        if (hypot(px - t * dx, pz - t * dz) < ROAD_CLEAR_M)
            return true;
    }
    return false;
}

/* Share of the places that bear a tuft, by cover. */
static float tuft_share(enum cover cover, float luck)
{
    switch (cover) {
    case COVER_GRASS:
    case COVER_ROAD: /* a post near a road; the road itself is kept clear by its line */
        return 0.22f + 0.40f * luck;
    case COVER_CHAPARRAL:
        return 0.75f;
    case COVER_FOREST:
        return 0.55f;
    default:
        return 0.0f;
    }
}

static void add_tuft(struct scene *scene, const struct moment *moment,
                     const struct road_pieces *roads, int32_t column, int32_t row)
{
    double x = (column + (double)grain_unit(column, row, 21)) * TUFT_CELL_M;
    double z = (row + (double)grain_unit(column, row, 22)) * TUFT_CELL_M;
    double away = hypot(x - scene->camera.eye.x, z - scene->camera.eye.z);
    double thin = maths_clamp((TUFT_RANGE_M - away) / (TUFT_FADE * TUFT_RANGE_M), 0.0, 1.0);
    enum cover cover = terrain_cover(&moment->world->terrain, x, z);
    float luck = grain_value(x / 23.0, z / 23.0, 23);
    float draw = grain_unit(column, row, 24);
    if (draw >= tuft_share(cover, luck) * (float)thin)
        return;
    struct vec3 foot = {x, 0.0, z};
    foot.y = terrain_height(&moment->world->terrain, moment->craters, x, z);
    if (!camera_sees(&scene->camera, foot, 2.0) || on_road(roads, x, z) ||
        crater_offset(moment->craters, x, z) < -0.05)
        return;
    struct scene_plant *plant = next_plant(scene);
    if (plant == NULL)
        return;
    bool woody = cover == COVER_CHAPARRAL || cover == COVER_FOREST;
    bool brush = grain_unit(column, row, 25) < (woody ? 0.6f : 0.06f);
    float size = 0.6f + 0.6f * grain_unit(column, row, 26);
    float tone = 0.80f + 0.25f * grain_unit(column, row, 28);
    float green = brush ? 0.0f : cover == COVER_FOREST ? 0.30f : 0.10f * (1.0f + luck);
    uint32_t which = grain_hash(column, row, 27);
    *plant = (struct scene_plant){
        .width = size * (brush ? 1.5f : 0.9f),
        .height = size * (brush ? 0.85f : 0.50f),
        .picture = (float)(brush ? FOLIAGE_BUSH_A + which % 3 : FOLIAGE_GRASS_A + which % 2),
        .tint = {tone * (1.0f - green), tone, tone * (0.95f - 0.5f * green)},
    };
    scene_place(scene, foot, plant->at);
    ground_slope(moment, x, z, plant->slope);
}

void scene_plants(struct scene *scene, const struct scenery *scenery, const struct moment *moment)
{
    struct vec3 eye = scene->camera.eye;
    struct square_box box = square_box_of(eye.x - PLANT_RANGE_M, eye.z - PLANT_RANGE_M,
                                          eye.x + PLANT_RANGE_M, eye.z + PLANT_RANGE_M);
    for (int32_t row = box.z0; row <= box.z1; row++)
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t square = square_index(column, row);
            for (uint32_t i = scenery->square_start[square]; i < scenery->square_start[square + 1];
                 i++)
                if (scenery->look[i] != LOOK_MODEL)
                    add_plant(scene, scenery, moment, i);
        }

    double above = eye.y - terrain_base_height(&moment->world->terrain, eye.x, eye.z);
    if (above > TUFT_RANGE_M || !scene->texture)
        return;
    struct road_pieces roads;
    find_roads(scene, moment->world, &roads);
    int32_t reach = (int32_t)(TUFT_RANGE_M / TUFT_CELL_M);
    int32_t middle_column = (int32_t)floor(eye.x / TUFT_CELL_M);
    int32_t middle_row = (int32_t)floor(eye.z / TUFT_CELL_M);
    for (int32_t row = middle_row - reach; row <= middle_row + reach; row++)
        for (int32_t column = middle_column - reach; column <= middle_column + reach; column++)
            add_tuft(scene, moment, &roads, column, row);
}
