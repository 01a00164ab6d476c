/* Value noise along rows of texels. The values equal value_noise_value(), but each lattice point is
 * hashed only once for all texels around it. */
#ifndef JOLON_RENDERER_SCENE_NOISE_VALUE_NOISE_ROWS_H
#define JOLON_RENDERER_SCENE_NOISE_VALUE_NOISE_ROWS_H

#include <stdint.h>

#define VALUE_NOISE_COLUMNS_MAX 128u /* of a row */

struct value_noise_rows {
    double wavelength_m;
    uint32_t seed, columns, nodes;
    float held; /* strength, 0..1, because texels cannot show short wavelengths; 0: no noise */
    int32_t west, north; /* lattice column of the first node; lattice row of nodes_north */
    int32_t at[VALUE_NOISE_COLUMNS_MAX]; /* index of the node west of each column */
    float past[VALUE_NOISE_COLUMNS_MAX]; /* weight of the next node, 0..1 */
    float nodes_north[VALUE_NOISE_COLUMNS_MAX + 3], nodes_south[VALUE_NOISE_COLUMNS_MAX + 3];
};

/* Begins rows of texels at x, x + step_m, and so on. The noise fades out for wavelengths below
 * three steps. */
void value_noise_rows_begin(struct value_noise_rows *rows, double wavelength_m, uint32_t seed,
                            double x, double step_m, uint32_t columns);

/* Adds scale times the noise, which is -1..1, to the row at z. Fastest when z rises from call to
 * call. */
void value_noise_rows_add(struct value_noise_rows *rows, double z, float scale, float *row);

#endif
