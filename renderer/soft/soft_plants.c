/* Plants of the software back end: their pictures at all sizes, and their lists. */
#include "renderer/soft/soft_plants.h"

#include "renderer/soft/kernel.h"

#include <stdlib.h>

/* --- pictures --------------------------------------------------------------------------------- */

/* A texel, from which smaller pictures are computed. */
struct leaf {
    float colour[3], alpha, facing[3];
};

static void read_picture(struct leaf *to, const struct plant_impostors_picture *picture)
{
    for (uint32_t row = 0; row < PLANT_IMPOSTORS_SIDE; row++)
        for (uint32_t column = 0; column < PLANT_IMPOSTORS_SIDE; column++) {
            struct leaf *leaf = &to[row * PLANT_IMPOSTORS_SIDE + column];
            for (uint32_t i = 0; i < 3; i++) {
                leaf->colour[i] = (float)picture->colour[row][column][i];
                leaf->facing[i] = (float)picture->facing[row][column][i] / 127.5f - 1.0f;
            }
            leaf->alpha = (float)picture->colour[row][column][3];
        }
}

/* Halves a picture in place: the mean of every four texels, weighted by their alpha. */
static void halve(struct leaf *leaves, uint32_t side)
{
    for (uint32_t row = 0; row < side; row++)
        for (uint32_t column = 0; column < side; column++) {
            const struct leaf *a = leaves + (size_t)row * 4 * side + (size_t)column * 2;
            const struct leaf from[4] = {a[0], a[1], a[2 * side], a[2 * side + 1]};
            struct leaf sum = {.alpha = 0.0f};
            float all = 0.0f;
            for (uint32_t k = 0; k < 4; k++) {
                float weight = from[k].alpha + 0.01f;
                all += weight;
                sum.alpha += 0.25f * from[k].alpha;
                for (uint32_t i = 0; i < 3; i++) {
                    sum.colour[i] += weight * from[k].colour[i];
                    sum.facing[i] += weight * from[k].facing[i];
                }
            }
            for (uint32_t i = 0; i < 3; i++) {
                sum.colour[i] /= all;
                sum.facing[i] /= all;
            }
            leaves[row * side + column] = sum;
        }
}

/* Returns how much light reaches a row of the picture: less towards the foot. */
static float open_at(uint32_t row, uint32_t side)
{
    float low = ((float)row + 0.5f) / (float)side, t = (1.0f - low) / (1.0f - 0.35f);
    t = fminf(t, 1.0f);
    return 0.62f + (PLANT_OPEN - 0.62f) * t * t * (3.0f - 2.0f * t);
}

static uint32_t byte_of(float v)
{
    v = v > 0.0f ? v : 0.0f;
    return (uint32_t)(int32_t)((v < 255.0f ? v : 255.0f) + 0.5f);
}

static void write_level(struct soft_leaf *to, const struct leaf *from, uint32_t side)
{
    for (uint32_t row = 0; row < side; row++) {
        float open = open_at(row, side) / PLANT_OPEN;
        for (uint32_t column = 0; column < side; column++) {
            const struct leaf *leaf = &from[row * side + column];
            const float *n = leaf->facing, *c = leaf->colour;
            float scale = 127.5f / sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + 1e-6f);
            to[row * side + column] = (struct soft_leaf){
                byte_of(c[0] * open) | byte_of(c[1] * open) << 8 | byte_of(c[2] * open) << 16 |
                    byte_of(leaf->alpha) << 24,
                byte_of(n[0] * scale + 127.5f) | byte_of(n[1] * scale + 127.5f) << 8 |
                    byte_of(n[2] * scale + 127.5f) << 16 | byte_of(255.0f * open) << 24};
        }
    }
}

static int open_pictures(struct soft_plants *plants)
{
    struct plant_impostors_picture *picture = malloc(sizeof *picture);
    struct leaf *leaves =
        malloc((size_t)PLANT_IMPOSTORS_SIDE * PLANT_IMPOSTORS_SIDE * sizeof *leaves);
    uint32_t all = 0, at = 0;
    for (uint32_t side = PLANT_IMPOSTORS_SIDE; side > 1; side /= 2)
        all += side * side;
    plants->leaves = malloc((size_t)all * PLANT_IMPOSTORS_COUNT * sizeof *plants->leaves);
    int failed = picture == NULL || leaves == NULL || plants->leaves == NULL ? -1 : 0;
    for (uint32_t impostor = 0; failed == 0 && impostor < PLANT_IMPOSTORS_COUNT; impostor++) {
        uint32_t side = PLANT_IMPOSTORS_SIDE;
        plant_impostors_paint(picture, (enum plant_impostors)impostor);
        read_picture(leaves, picture);
        for (uint32_t level = PLANT_LEVELS; level > 0; level--, side /= 2) {
            if (level < PLANT_LEVELS)
                halve(leaves, side);
            write_level(plants->leaves + at, leaves, side);
            plants->first[impostor][level] = at;
            at += side * side;
        }
    }
    free(picture);
    free(leaves);
    return failed;
}

/* --- opening, closing, preparing -------------------------------------------------------------- */

struct soft_plants *soft_plants_open(struct error_text *error)
{
    struct soft_plants *plants = calloc(1, sizeof *plants);
    if (plants != NULL && open_pictures(plants) == 0)
        return plants;
    soft_plants_close(plants);
    error_text_set(error, "no memory for the plants");
    return NULL;
}

void soft_plants_close(struct soft_plants *plants)
{
    if (plants == NULL)
        return;
    band_lists_free(&plants->lists);
    band_lists_free(&plants->shadow_lists);
    free(plants->leaves);
    free(plants->plants);
    free(plants->shadows);
    free(plants->rows);
    free(plants->shadow_rows);
    free(plants);
}

int soft_plants_prepare(struct soft_plants *plants, const struct soft_frame *frame)
{
    size_t count = frame->list->plant_count;
    void *list = plants->plants, *shadows = plants->shadows;
    void *rows = plants->rows, *shadow_rows = plants->shadow_rows;
    int failed = band_lists_reserve(&list, &plants->plant_room, count, sizeof *plants->plants);
    failed |= band_lists_reserve(&shadows, &plants->shadow_room, count, sizeof *plants->shadows);
    failed |= band_lists_reserve(&rows, &plants->row_room, count, sizeof *plants->rows);
    failed |= band_lists_reserve(&shadow_rows, &plants->shadow_row_room, count,
                                 sizeof *plants->shadow_rows);
    plants->plants = list;
    plants->shadows = shadows;
    plants->rows = rows;
    plants->shadow_rows = shadow_rows;
    if (failed != 0)
        return -1;
    frame->kernels->soft_plants_set_up(plants, frame);
    if (band_lists_sort(&plants->lists, plants->rows, plants->count, frame->bands) != 0)
        return -1;
    return band_lists_sort(&plants->shadow_lists, plants->shadow_rows, plants->shadow_count,
                           frame->bands);
}
