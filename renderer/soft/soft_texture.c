/* Building the textures in their memory layouts. */
#include "renderer/soft/soft_texture.h"

#include "renderer/scene/draw_list/texture.h"

#include <stdlib.h>

_Static_assert(TEXTURE_DETAIL_SIDE == 1u << SOFT_DETAIL_POWER, "its mips are counted by this");

/* Halves a texture in place: the mean of every four texels. */
static void halve(uint8_t (*texels)[2], uint32_t side)
{
    uint32_t half = side / 2;
    for (uint32_t y = 0; y < half; y++)
        for (uint32_t x = 0; x < half; x++)
            for (uint32_t c = 0; c < 2; c++) {
                uint8_t(*row)[2] = texels + (size_t)2 * y * side + 2 * x, (*next)[2] = row + side;
                uint32_t sum = (uint32_t)row[0][c] + row[1][c] + next[0][c] + next[1][c];
                texels[(size_t)y * half + x][c] = (uint8_t)((sum + 2) / 4);
            }
}

static void lay_out(uint8_t *to, uint8_t (*texels)[2], uint32_t side)
{
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side + SOFT_DETAIL_PAD; x++)
            for (uint32_t i = 0; i < 2; i++) {
                const uint8_t *from = texels[(size_t)((y + i) % side) * side + x % side];
                *to++ = from[0];
                *to++ = from[1];
            }
}

int soft_detail_make(struct soft_detail *detail)
{
    size_t whole = (size_t)TEXTURE_DETAIL_SIDE * TEXTURE_DETAIL_SIDE;
    uint8_t(*texels)[2] = malloc(whole * sizeof *texels);
    size_t bytes = 0;
    for (uint32_t side = TEXTURE_DETAIL_SIDE; side > 0; side /= 2)
        bytes += (size_t)4 * side * (side + SOFT_DETAIL_PAD);
    uint8_t *to = malloc(bytes);
    *detail = (struct soft_detail){.mip = {to}};
    if (texels == NULL || to == NULL) {
        free(texels);
        return -1;
    }
    texture_detail(texels);
    for (uint32_t mip = 0; mip < SOFT_DETAIL_MIPS; mip++) {
        uint32_t side = TEXTURE_DETAIL_SIDE >> mip;
        detail->mip[mip] = to;
        lay_out(to, texels, side);
        to += (size_t)4 * side * (side + SOFT_DETAIL_PAD);
        halve(texels, side);
    }
    free(texels);
    return 0;
}

void soft_detail_free(struct soft_detail *detail)
{
    free(detail->mip[0]);
}

uint8_t *soft_clouds_make(void)
{
    const size_t side = TEXTURE_CLOUD_SIDE, row = side + 2;
    uint8_t *flat = malloc(side * side);
    /* A look-up loads two bytes more than it uses. */
    uint8_t *clouds = malloc((side + 1) * row + 2);
    if (flat != NULL && clouds != NULL) {
        texture_clouds(flat);
        for (size_t y = 0; y <= side; y++)
            for (size_t x = 0; x < row; x++)
                clouds[y * row + x] = flat[y % side * side + x % side];
        free(flat);
        return clouds;
    }
    free(flat);
    free(clouds);
    return NULL;
}
