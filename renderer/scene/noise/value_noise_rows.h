/* Grain along rows of a picture: the same noise as value_noise_value(), but each lattice point is
 * hashed once for all pixels around it. */
#ifndef JOLON_RENDERER_SCENE_NOISE_VALUE_NOISE_ROWS_H
#define JOLON_RENDERER_SCENE_NOISE_VALUE_NOISE_ROWS_H

#include <stdint.h>

#define VALUE_NOISE_COLUMNS_MAX 128u /* of a row at most */

struct value_noise_rows {
    double wavelength_m;
    uint32_t seed, columns, nodes;
    float held;          /* how much of it the pixels can show; 0: none */
    int32_t west, north; /* the lattice point of the first node; the row of nodes kept */
    int32_t at[VALUE_NOISE_COLUMNS_MAX]; /* the node before each column */
    float past[VALUE_NOISE_COLUMNS_MAX]; /* how much of the next one */
    float nodes_north[VALUE_NOISE_COLUMNS_MAX + 3], nodes_south[VALUE_NOISE_COLUMNS_MAX + 3];
};

/* For columns at x, x + step_m ... Noise fades away where a wavelength is less than three steps. */
void value_noise_rows_begin(struct value_noise_rows *rows, double wavelength_m, uint32_t seed,
                            double x, double step_m, uint32_t columns);

/* Adds scale times the noise, -1..1, to the row at z. Quickest when z rises from call to call. */
void value_noise_rows_add(struct value_noise_rows *rows, double z, float scale, float *row);

#endif
