/* Puffs of the software back end: their pictures and lists. */
#include "renderer/soft/soft_particles.h"

#include "renderer/scene/draw_list/texture.h"
#include "renderer/soft/kernel.h"

#include <stdlib.h>

/* --- pictures --------------------------------------------------------------------------------- */

/* The painted picture at a place of the unit square, between its four nearest texels. */
static void sample(const uint8_t (*painted)[2], float x, float y, uint32_t out[2])
{
    float most = (float)(TEXTURE_PUFF_SIDE - 1);
    float column = fminf(fmaxf(x * (float)TEXTURE_PUFF_SIDE - 0.5f, 0.0f), most);
    float row = fminf(fmaxf(y * (float)TEXTURE_PUFF_SIDE - 0.5f, 0.0f), most);
    uint32_t x0 = (uint32_t)column, y0 = (uint32_t)row;
    uint32_t x1 = x0 + (x0 + 1 < TEXTURE_PUFF_SIDE), y1 = y0 + (y0 + 1 < TEXTURE_PUFF_SIDE);
    float u = column - (float)x0, v = row - (float)y0;
    for (uint32_t i = 0; i < 2; i++) {
        float a = (float)painted[y0 * TEXTURE_PUFF_SIDE + x0][i];
        float b = (float)painted[y0 * TEXTURE_PUFF_SIDE + x1][i];
        float c = (float)painted[y1 * TEXTURE_PUFF_SIDE + x0][i];
        float d = (float)painted[y1 * TEXTURE_PUFF_SIDE + x1][i];
        float top = a + (b - a) * u, low = c + (d - c) * u;
        out[i] = (uint32_t)(top + (low - top) * v + 0.5f);
    }
}

static void fill_largest(uint16_t *to, const uint8_t (*painted)[2])
{
    float step = 1.0f / (float)PUFF_LARGEST;
    for (uint32_t row = 0; row < PUFF_LARGEST; row++)
        for (uint32_t column = 0; column < PUFF_LARGEST; column++) {
            uint32_t texel[2];
            sample(painted, ((float)column + 0.5f) * step, ((float)row + 0.5f) * step, texel);
            to[row * PUFF_LARGEST + column] = (uint16_t)(texel[0] | texel[1] << 8);
        }
}

/* Four texels into one. */
static void halve(uint16_t *to, const uint16_t *from, uint32_t side)
{
    for (uint32_t row = 0; row < side; row++)
        for (uint32_t column = 0; column < side; column++) {
            const uint16_t *a = from + (size_t)row * 4 * side + (size_t)column * 2;
            const uint16_t *b = a + (size_t)side * 2;
            uint32_t much = (a[0] & 255u) + (a[1] & 255u) + (b[0] & 255u) + (b[1] & 255u);
            uint32_t bright = (uint32_t)(a[0] >> 8) + (a[1] >> 8) + (b[0] >> 8) + (b[1] >> 8);
            to[row * side + column] = (uint16_t)(((much + 2) >> 2) | ((bright + 2) >> 2) << 8);
        }
}

static float find_reach(const uint8_t (*painted)[2])
{
    float most = 0.0f, half = 0.5f * (float)TEXTURE_PUFF_SIDE;
    for (uint32_t row = 0; row < TEXTURE_PUFF_SIDE; row++)
        for (uint32_t column = 0; column < TEXTURE_PUFF_SIDE; column++) {
            float x = ((float)column + 0.5f - half) / half, y = ((float)row + 0.5f - half) / half;
            if (painted[row * TEXTURE_PUFF_SIDE + column][0] > 0)
                most = fmaxf(most, x * x + y * y);
        }
    return sqrtf(most) + 1.0f / half;
}

static int open_pictures(struct soft_particles *puffs)
{
    size_t painted_texels = (size_t)TEXTURE_PUFF_SIDE * TEXTURE_PUFF_SIDE;
    uint8_t(*painted)[2] = malloc(painted_texels * sizeof *painted);
    uint32_t all = 0;
    for (uint32_t side = PUFF_LARGEST; side > 1; side /= 2)
        all += side * side;
    /* Four bytes are loaded where two are wanted. */
    puffs->texels = malloc(((size_t)all * PUFF_PICTURES + 1) * sizeof *puffs->texels);
    if (painted == NULL || puffs->texels == NULL) {
        free(painted);
        return -1;
    }
    for (uint32_t picture = 0; picture < PUFF_PICTURES; picture++) {
        uint32_t at = picture * all, side = PUFF_LARGEST;
        texture_puff(painted, (enum puff_picture)picture);
        puffs->reach[picture] = find_reach((const uint8_t(*)[2])painted);
        fill_largest(puffs->texels + at, (const uint8_t(*)[2])painted);
        for (uint32_t level = PUFF_LEVELS; level > 0; level--, side /= 2) {
            puffs->first[picture][level] = at;
            if (level > 1)
                halve(puffs->texels + at + side * side, puffs->texels + at, side / 2);
            at += side * side;
        }
    }
    free(painted);
    return 0;
}

/* --- opening, closing, preparing -------------------------------------------------------------- */

struct soft_particles *soft_particles_open(struct error_text *error)
{
    struct soft_particles *puffs = calloc(1, sizeof *puffs);
    if (puffs != NULL && open_pictures(puffs) == 0)
        return puffs;
    soft_particles_close(puffs);
    error_text_set(error, "no memory for the puffs");
    return NULL;
}

void soft_particles_close(struct soft_particles *puffs)
{
    if (puffs == NULL)
        return;
    band_lists_free(&puffs->lists);
    free(puffs->texels);
    free(puffs->puffs);
    free(puffs->rows);
    free(puffs);
}

int soft_particles_prepare(struct soft_particles *puffs, const struct soft_frame *frame)
{
    size_t count = frame->scene->puff_count;
    void *list = puffs->puffs, *rows = puffs->rows;
    int failed = band_lists_room(&list, &puffs->puff_room, count, sizeof *puffs->puffs);
    puffs->puffs = list;
    failed |= band_lists_room(&rows, &puffs->row_room, count, sizeof *puffs->rows);
    puffs->rows = rows;
    if (failed != 0)
        return -1;
    frame->kernels->soft_particles_set_up(puffs, frame);
    return band_lists_sort(&puffs->lists, puffs->rows, puffs->count, frame->bands);
}
