/* Grids of the undulation. */
#include "gateway/earth/geoid_grid.h"

#include "gateway/pdu/octets.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define HEADER_BYTES 40u
#define NODES_MOST   100000u /* of a row or a column */
#define HIGHEST_M    200.0   /* no undulation is larger; a node without a value is -88.8888 */
#define NO_VALUE_M   (-88.88)

struct grid {
    double south_deg, west_deg, lat_step_deg, lon_step_deg;
    uint32_t rows, columns;
    bool round; /* its rows go around the earth */
};

/* Reads the header. Returns NULL, or what is wrong. */
static const char *read_header(struct grid *grid, FILE *file)
{
    uint8_t bytes[HEADER_BYTES];
    if (fread(bytes, 1, sizeof bytes, file) != sizeof bytes)
        return "is shorter than the header of a GTX grid";
    *grid = (struct grid){.south_deg = octets_f64(bytes),
                          .west_deg = octets_f64(bytes + 8),
                          .lat_step_deg = octets_f64(bytes + 16),
                          .lon_step_deg = octets_f64(bytes + 24),
                          .rows = octets_u32(bytes + 32),
                          .columns = octets_u32(bytes + 36)};
    if (!(fabs(grid->south_deg) <= 90.0 && fabs(grid->west_deg) <= 360.0 &&
          grid->lat_step_deg > 0.0 && grid->lat_step_deg <= 180.0 && grid->lon_step_deg > 0.0 &&
          grid->lon_step_deg <= 180.0 && grid->rows >= 2 && grid->rows <= NODES_MOST &&
          grid->columns >= 2 && grid->columns <= NODES_MOST))
        return "is no GTX grid: its header has no extent of the earth";
    grid->round = fabs(grid->lon_step_deg * grid->columns - 360.0) < 0.5 * grid->lon_step_deg;
    return NULL;
}

static bool read_node(const struct grid *grid, FILE *file, uint32_t row, uint32_t column,
                      double *value_m)
{
    uint8_t bytes[4];
    long at = (long)(HEADER_BYTES + 4u * ((uint64_t)row * grid->columns + column % grid->columns));
    if (fseek(file, at, SEEK_SET) != 0 || fread(bytes, 1, sizeof bytes, file) != sizeof bytes)
        return false;
    *value_m = (double)octets_f32(bytes);
    return fabs(*value_m) <= HIGHEST_M && !(*value_m<NO_VALUE_M && * value_m> NO_VALUE_M - 0.01);
}

/* Returns the node before a coordinate counted in steps, and its share of the way to the next. */
static uint32_t node_before(double steps, uint32_t nodes, double *share)
{
    uint32_t node = (uint32_t)steps;
    if (node > nodes - 2)
        node = nodes - 2;
    *share = steps - node;
    return node;
}

/* Returns NULL, or what is wrong. */
static const char *interpolate(const struct grid *grid, FILE *file, double latitude_deg,
                               double longitude_deg, double *undulation_m)
{
    double node[2][2], up, right;
    double north = (latitude_deg - grid->south_deg) / grid->lat_step_deg;
    double east = longitude_deg - grid->west_deg;
    east = (east - 360.0 * floor(east / 360.0)) / grid->lon_step_deg;
    uint32_t columns = grid->columns + grid->round;
    if (north < 0.0 || north > grid->rows - 1 || east > columns - 1)
        return "does not reach to this place";
    uint32_t row = node_before(north, grid->rows, &up);
    uint32_t column = node_before(east, columns, &right);
    for (uint32_t i = 0; i < 2; i++) {
        for (uint32_t j = 0; j < 2; j++) {
            if (!read_node(grid, file, row + i, column + j, &node[i][j]))
                return "has no undulation at this place";
        }
    }
    double south_m = node[0][0] + right * (node[0][1] - node[0][0]);
    double north_m = node[1][0] + right * (node[1][1] - node[1][0]);
    *undulation_m = south_m + up * (north_m - south_m);
    return NULL;
}

int geoid_grid_read(const char *path, double latitude_deg, double longitude_deg,
                    double *undulation_m, struct error_text *error)
{
    struct grid grid;
    FILE *file = fopen(path, "re");
    if (!file)
        return error_text_set(error, "%s: cannot be read: %s", path, strerror(errno));
    const char *wrong = read_header(&grid, file);
    if (!wrong)
        wrong = interpolate(&grid, file, latitude_deg, longitude_deg, undulation_m);
    (void)fclose(file);
    return wrong ? error_text_set(error, "%s: %s", path, wrong) : 0;
}
