/* The small map about the driven vehicle: square cells of two letters. North is up. Pure.
 *
 * A vehicle is the two letters of its kind: small for blue, CAPITALS for red, Capitalised for
 * neutral, so that no colour is needed to tell them. */
#ifndef JOLON_DRIVE_CHART_H
#define JOLON_DRIVE_CHART_H

#include "topics/mirror.h"

#define CHART_ROWS_MAX    64
#define CHART_COLUMNS_MAX 96

enum chart_mark {
    CHART_GROUND,
    CHART_WATER,
    CHART_WRECK,
    CHART_NEUTRAL,
    CHART_RED,
    CHART_BLUE,
    CHART_MUNITION,
    CHART_TARGET,
    CHART_SELF
};

struct chart {
    int rows, columns;
    double cell_m;
    struct chart_cell {
        char text[3];
        uint8_t mark; /* enum chart_mark */
    } cell[CHART_ROWS_MAX][CHART_COLUMNS_MAX];
};

/* The edge of a cell [m] at a zoom, 0 the nearest. */
double chart_cell_m(uint32_t zoom);

/* Two letters for each kind, no two alike while that can be; code: [kinds]. */
void chart_codes(char code[][3], const struct mirror *mirror);

/* Draws what the mirror has about self; target: id, 0 for none. */
void chart_draw(struct chart *chart, const struct mirror *mirror, const jolon_Entity *self,
                uint32_t target, int rows, int columns, double cell_m);

#endif
