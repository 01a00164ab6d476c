/* Reads the pixels that some rows of posts need, and samples them. */
#include "supervisor/ground/raster_internal.h"

#include "world/maths/maths.h"

#include <cpl_error.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Between nodes, at most [m], and posts. */
#define NODES_APART_M   500.0
#define NODES_APART_MAX 16u

/* Heights beyond this are no heights but marks of voids: -32768, 1e38. */
#define VOID_FROM 32000.0

/* A window of more pixels than this is refused [pixel]. */
#define WINDOW_MAX 200000000.0

static int place_nodes(struct raster *r, uint32_t first, uint32_t rows, struct error_text *error)
{
    double apart = floor(NODES_APART_M / r->grid.spacing_m);
    r->node_posts = (uint32_t)maths_clamp(apart, 1.0, NODES_APART_MAX);
    r->first_row = first;
    r->nodes_across = (r->grid.side - 1 + r->node_posts - 1) / r->node_posts + 1;
    r->nodes_down = (rows - 1 + r->node_posts - 1) / r->node_posts + 1;
    size_t count = (size_t)r->nodes_across * r->nodes_down;
    double(*nodes)[2] = realloc(r->nodes, count * sizeof *nodes);
    if (!nodes)
        return error_text_memory(error);
    r->nodes = nodes;
    double east = 0.5 * (r->extent[1] + r->extent[3]);
    double middle =
        east + 360.0 / TWO_PI * maths_wrap_half((r->grid.longitude_deg - east) * RAD_PER_DEG);
    for (size_t i = 0; i < count; i++) {
        double x = (double)(i % r->nodes_across * r->node_posts) * r->grid.spacing_m;
        double z = (double)(first + i / r->nodes_across * r->node_posts) * r->grid.spacing_m;
        double latitude, longitude;
        projection_place(&r->grid.projection, x, z, &latitude, &longitude);
        double u =
            r->geographic
                ? middle + DEG_PER_RAD *
                               maths_wrap_half((longitude - r->grid.longitude_deg) * RAD_PER_DEG)
                : longitude;
        double v = latitude;
        if (!OCTTransform(r->from_earth, 1, &u, &v, NULL))
            u = v = HUGE_VAL;
        /* Datum shifts may wrap the longitude again. */
        if (r->geographic && fabs(u - middle) > 180.0)
            u += u < middle ? 360.0 : -360.0;
        nodes[i][0] = (r->inverse[0] + u * r->inverse[1] + v * r->inverse[2]) / r->coarser;
        nodes[i][1] = (r->inverse[3] + u * r->inverse[4] + v * r->inverse[5]) / r->coarser;
    }
    return 0;
}

/* Returns the column of the file: one beyond a turn is one of the first again. */
static int own_column(const struct raster *r, int column)
{
    return r->turn > 0 ? (column % r->turn + r->turn) % r->turn : column;
}

/* Sets the window of pixels around all nodes, one more on each side. Returns false if it is empty.
 */
static bool place_window(struct raster *r)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    size_t count = (size_t)r->nodes_across * r->nodes_down;
    const int least[2] = {-r->turn, 0};
    const int most[2] = {r->turn > 0 ? 2 * r->turn : r->columns, r->rows};
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 2; k++) {
            if (!isfinite(r->nodes[i][k]))
                continue;
            low[k] = fmin(low[k], r->nodes[i][k]);
            high[k] = fmax(high[k], r->nodes[i][k]);
        }
    }
    int begin[2], end[2];
    for (int k = 0; k < 2; k++) {
        begin[k] = (int)maths_clamp(floor(low[k]) - 2.0, least[k], most[k]);
        end[k] = (int)maths_clamp(floor(high[k]) + 3.0, least[k], most[k]);
    }
    r->west = begin[0];
    r->north = begin[1];
    r->across = end[0] - begin[0];
    r->down = end[1] - begin[1];
    return r->across > 0 && r->down > 0;
}

/* Turns what the file marks as void into NaN, and the rest into metres. */
static int clean_window(struct raster *r, struct error_text *error)
{
    size_t count = (size_t)r->across * (size_t)r->down;
    for (size_t i = 0; i < count; i++) {
        double value = (double)r->window[i];
        bool void_here =
            !(fabs(value) < VOID_FROM) ||
            (r->has_nodata && (value == r->nodata || r->window[i] == (float)r->nodata));
        double metres = value * r->factor + r->offset;
        r->window[i] = void_here ? NAN : (float)metres;
        if (void_here || (metres <= 9000.0 && metres >= -1000.0))
            continue;
        return error_text_set(error,
                              "%s: has the height %g m in column %d, row %d; the earth has -430 to "
                              "8,849. %s",
                              r->path, metres,
                              own_column(r, r->west + (int)(i % (size_t)r->across)) * r->coarser,
                              (r->north + (int)(i / (size_t)r->across)) * r->coarser,
                              metres > 9000.0 && metres < 30000.0 ? "If these are feet, give --feet"
                                                                  : "Is it a raster of heights?");
    }
    return 0;
}

/* Reads rows of the window from a band, in parts where they go beyond a turn. row: of the window.
 */
static CPLErr read_rows(const struct raster *r, GDALRasterBandH band, int row, int rows, float *to)
{
    GDALRasterIOExtraArg extra;
    INIT_RASTERIO_EXTRA_ARG(extra);
    extra.eResampleAlg = r->coarser > 1 ? GRIORA_Average : GRIORA_NearestNeighbour;
    CPLErr result = CE_None;
    int k = r->coarser, end = r->turn > 0 ? r->turn : r->columns;
    for (int done = 0, count; done < r->across && result == CE_None; done += count) {
        int column = own_column(r, r->west + done);
        count = r->across - done < end - column ? r->across - done : end - column;
        result = GDALRasterIOEx(band, GF_Read, column * k, (r->north + row) * k, count * k,
                                rows * k, to + done, count, rows, GDT_Float32, 0,
                                (GSpacing)sizeof *to * r->across, &extra);
    }
    return result;
}

static int refuse_reading(const struct raster *r, struct error_text *error)
{
    return error_text_set(error, "%s: cannot be read: %s", r->path, CPLGetLastErrorMsg());
}

/* Makes voids of the pixels of the window under the file's mask. */
static int mask_window(struct raster *r, struct error_text *error)
{
    int result = 0;
    float *mask = calloc((size_t)r->across, sizeof *mask);
    if (!mask)
        return error_text_memory(error);
    for (int row = 0; row < r->down && result == 0; row++) {
        float *pixels = r->window + (size_t)row * (size_t)r->across;
        if (read_rows(r, r->mask, row, 1, mask) != CE_None)
            result = refuse_reading(r, error);
        for (int i = 0; i < r->across; i++)
            pixels[i] = mask[i] > 0.0f ? pixels[i] : NAN;
    }
    free(mask);
    return result;
}

int raster_read(struct raster *r, uint32_t first, uint32_t rows, struct error_text *error)
{
    r->across = r->down = 0;
    if (place_nodes(r, first, rows, error) != 0)
        return -1;
    if (!place_window(r))
        return 0;
    if ((double)r->across * r->down > WINDOW_MAX)
        return error_text_set(error,
                              "%s: too many pixels lie in one strip of the square; right "
                              "would be a coarser raster, by: gdalwarp -tr",
                              r->path);
    size_t count = (size_t)r->across * (size_t)r->down;
    float *window = realloc(r->window, count * sizeof *window);
    if (!window)
        return error_text_memory(error);
    r->window = window;
    CPLErrorReset();
    if (read_rows(r, r->band, 0, r->down, r->window) != CE_None)
        return refuse_reading(r, error);
    if (r->mask != NULL && mask_window(r, error) != 0)
        return -1;
    return clean_window(r, error);
}

/* Returns where a post lies [pixels from the corner], between the nodes. */
static bool post_place(const struct raster *r, uint32_t column, uint32_t row, double place[2])
{
    if (r->across == 0)
        return false;
    uint32_t c = column / r->node_posts, w = (row - r->first_row) / r->node_posts;
    double u = (double)(column % r->node_posts) / r->node_posts;
    double v = (double)((row - r->first_row) % r->node_posts) / r->node_posts;
    /* The last nodes have none behind them, and need none. */
    uint32_t east = u > 0.0 ? 1 : 0;
    size_t south = v > 0.0 ? r->nodes_across : 0;
    const double(*node)[2] = (const double(*)[2])r->nodes + (size_t)w * r->nodes_across + c;
    for (int k = 0; k < 2; k++) {
        double above = node[0][k] + (node[east][k] - node[0][k]) * u;
        double below = node[south][k] + (node[south + east][k] - node[south][k]) * u;
        place[k] = above + (below - above) * v;
    }
    bool within = r->turn > 0 ? isfinite(place[0]) : place[0] >= 0.0 && place[0] <= r->columns;
    return within && place[1] >= 0.0 && place[1] <= r->rows;
}

static bool own_pixel(const struct raster *r, int column, int row, double *value)
{
    int c = own_column(r, column - r->west), w = row - r->north;
    if (c < 0 || w < 0 || c >= r->across || w >= r->down)
        return false;
    *value = (double)r->window[(size_t)w * (size_t)r->across + (size_t)c];
    return true;
}

/* Finds a pixel that lies beyond the edge, in the raster that continues there; else the edge's. */
static double pixel(const struct raster *r, int column, int row)
{
    double value, c = (column + 0.5) * r->coarser, w = (row + 0.5) * r->coarser;
    if (own_pixel(r, column, row, &value))
        return value;
    double x = r->transform[0] + c * r->transform[1] + w * r->transform[2];
    double y = r->transform[3] + c * r->transform[4] + w * r->transform[5];
    for (uint32_t i = 0; i < r->neighbour_count; i++) {
        const struct raster *n = r->neighbours[i];
        /* Neighbours beyond the date line have longitudes that differ by a whole turn. */
        double turn = r->geographic ? 360.0 * floor((n->transform[0] - x) / 360.0 + 0.5) : 0.0;
        for (int k = 0; k < (r->geographic ? 2 : 1); k++) {
            double at = x + (k == 0 ? 0.0 : turn);
            double u = (n->inverse[0] + at * n->inverse[1] + y * n->inverse[2]) / n->coarser;
            double v = (n->inverse[3] + at * n->inverse[4] + y * n->inverse[5]) / n->coarser;
            if (fabs(u) < 1e6 && fabs(v) < 1e6 &&
                own_pixel(n, (int)floor(u), (int)floor(v), &value))
                return value;
        }
    }
    int last = r->columns - 1;
    int inside_column = r->turn > 0 ? column : column < 0 ? 0 : column < last ? column : last;
    int inside_row = row < 0 ? 0 : row < r->rows ? row : r->rows - 1;
    return own_pixel(r, inside_column, inside_row, &value) ? value : NAN;
}

double raster_height(const struct raster *r, uint32_t column, uint32_t row)
{
    double place[2];
    if (!post_place(r, column, row, place))
        return NAN;
    double west = floor(place[0] - 0.5), north = floor(place[1] - 0.5);
    double u = place[0] - 0.5 - west, v = place[1] - 0.5 - north;
    int c = (int)west, w = (int)north;
    double above = pixel(r, c, w), below = pixel(r, c, w + 1);
    above += (pixel(r, c + 1, w) - above) * u;
    below += (pixel(r, c + 1, w + 1) - below) * u;
    return above + (below - above) * v;
}

int raster_class(const struct raster *r, uint32_t column, uint32_t row)
{
    double place[2], value;
    if (!post_place(r, column, row, place) ||
        !own_pixel(r, (int)(r->turn > 0 ? floor(place[0]) : fmin(place[0], r->columns - 1)),
                   (int)fmin(place[1], r->rows - 1), &value) ||
        !(value >= 0.0 && value < 1000.0))
        return -1;
    return (int)value;
}
