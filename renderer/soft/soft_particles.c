/* Particles of the software back end: their pictures at all sizes, and their lists. */
#include "renderer/soft/soft_particles.h"

#include "renderer/scene/draw_list/texture.h"
#include "renderer/soft/kernel.h"

#include <stdlib.h>

/* --- pictures --------------------------------------------------------------------------------- */

/* Looks up a picture at a point of the unit square by bilinear interpolation. */
static void sample(const uint8_t (*painted)[2], float x, float y, uint32_t out[2])
{
    float most = (float)(TEXTURE_PARTICLE_SIDE - 1);
    float column = fminf(fmaxf(x * (float)TEXTURE_PARTICLE_SIDE - 0.5f, 0.0f), most);
    float row = fminf(fmaxf(y * (float)TEXTURE_PARTICLE_SIDE - 0.5f, 0.0f), most);
    uint32_t x0 = (uint32_t)column, y0 = (uint32_t)row;
    uint32_t x1 = x0 + (x0 + 1 < TEXTURE_PARTICLE_SIDE), y1 = y0 + (y0 + 1 < TEXTURE_PARTICLE_SIDE);
    float u = column - (float)x0, v = row - (float)y0;
    for (uint32_t i = 0; i < 2; i++) {
        float a = (float)painted[y0 * TEXTURE_PARTICLE_SIDE + x0][i];
        float b = (float)painted[y0 * TEXTURE_PARTICLE_SIDE + x1][i];
        float c = (float)painted[y1 * TEXTURE_PARTICLE_SIDE + x0][i];
        float d = (float)painted[y1 * TEXTURE_PARTICLE_SIDE + x1][i];
        float top = a + (b - a) * u, low = c + (d - c) * u;
        out[i] = (uint32_t)(top + (low - top) * v + 0.5f);
    }
}

static void fill_largest(uint16_t *to, const uint8_t (*painted)[2])
{
    float step = 1.0f / (float)PARTICLE_LARGEST;
    for (uint32_t row = 0; row < PARTICLE_LARGEST; row++)
        for (uint32_t column = 0; column < PARTICLE_LARGEST; column++) {
            uint32_t texel[2];
            sample(painted, ((float)column + 0.5f) * step, ((float)row + 0.5f) * step, texel);
            to[row * PARTICLE_LARGEST + column] = (uint16_t)(texel[0] | texel[1] << 8);
        }
}

/* Halves a picture: the mean of every four texels. */
static void halve(uint16_t *to, const uint16_t *from, uint32_t side)
{
    for (uint32_t row = 0; row < side; row++)
        for (uint32_t column = 0; column < side; column++) {
            const uint16_t *a = from + (size_t)row * 4 * side + (size_t)column * 2;
            const uint16_t *b = a + (size_t)side * 2;
            uint32_t opacity = (a[0] & 255u) + (a[1] & 255u) + (b[0] & 255u) + (b[1] & 255u);
            uint32_t bright = (uint32_t)(a[0] >> 8) + (a[1] >> 8) + (b[0] >> 8) + (b[1] >> 8);
            to[row * side + column] = (uint16_t)(((opacity + 2) >> 2) | ((bright + 2) >> 2) << 8);
        }
}

static float find_reach(const uint8_t (*painted)[2])
{
    float most = 0.0f, half = 0.5f * (float)TEXTURE_PARTICLE_SIDE;
    for (uint32_t row = 0; row < TEXTURE_PARTICLE_SIDE; row++)
        for (uint32_t column = 0; column < TEXTURE_PARTICLE_SIDE; column++) {
            float x = ((float)column + 0.5f - half) / half, y = ((float)row + 0.5f - half) / half;
            if (painted[row * TEXTURE_PARTICLE_SIDE + column][0] > 0)
                most = fmaxf(most, x * x + y * y);
        }
    return sqrtf(most) + 1.0f / half;
}

static int open_pictures(struct soft_particles *particles)
{
    size_t painted_texels = (size_t)TEXTURE_PARTICLE_SIDE * TEXTURE_PARTICLE_SIDE;
    uint8_t(*painted)[2] = malloc(painted_texels * sizeof *painted);
    uint32_t all = 0;
    for (uint32_t side = PARTICLE_LARGEST; side > 1; side /= 2)
        all += side * side;
    /* A look-up loads two bytes more than it uses. */
    particles->texels =
        malloc(((size_t)all * PARTICLE_PICTURE_COUNT + 1) * sizeof *particles->texels);
    if (painted == NULL || particles->texels == NULL) {
        free(painted);
        return -1;
    }
    for (uint32_t picture = 0; picture < PARTICLE_PICTURE_COUNT; picture++) {
        uint32_t at = picture * all, side = PARTICLE_LARGEST;
        texture_particle(painted, (enum particle_picture)picture);
        particles->reach[picture] = find_reach((const uint8_t(*)[2])painted);
        fill_largest(particles->texels + at, (const uint8_t(*)[2])painted);
        for (uint32_t level = PARTICLE_LEVELS; level > 0; level--, side /= 2) {
            particles->first[picture][level] = at;
            if (level > 1)
                halve(particles->texels + at + side * side, particles->texels + at, side / 2);
            at += side * side;
        }
    }
    free(painted);
    return 0;
}

/* --- opening, closing, preparing -------------------------------------------------------------- */

struct soft_particles *soft_particles_open(struct error_text *error)
{
    struct soft_particles *particles = calloc(1, sizeof *particles);
    if (particles != NULL && open_pictures(particles) == 0)
        return particles;
    soft_particles_close(particles);
    error_text_set(error, "no memory for the particles");
    return NULL;
}

void soft_particles_close(struct soft_particles *particles)
{
    if (particles == NULL)
        return;
    band_lists_free(&particles->lists);
    free(particles->texels);
    free(particles->particles);
    free(particles->rows);
    free(particles);
}

int soft_particles_prepare(struct soft_particles *particles, const struct soft_frame *frame)
{
    size_t count = frame->list->particle_count;
    void *list = particles->particles, *rows = particles->rows;
    int failed =
        band_lists_reserve(&list, &particles->particle_room, count, sizeof *particles->particles);
    particles->particles = list;
    failed |= band_lists_reserve(&rows, &particles->row_room, count, sizeof *particles->rows);
    particles->rows = rows;
    if (failed != 0)
        return -1;
    frame->kernels->soft_particles_set_up(particles, frame);
    return band_lists_sort(&particles->lists, particles->rows, particles->count, frame->bands);
}
