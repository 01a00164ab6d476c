/* Tables of the Santa Lucia Range around Fort Hunter Liggett, and distances from them. */
#include "world/making/geography.h"

#include <math.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* From The Indians past the Mission and Jolon into the lake; beyond the lake's head the heights are
 * those of the drowned bed. */
static const struct geography_point san_antonio[] = {
    {6200, 6300, 690, 60},     {8200, 8600, 600, 90},     {10800, 11100, 520, 150},
    {14200, 13400, 440, 300},  {18800, 15700, 376, 600},  {22600, 17000, 336, 950},
    {25000, 18150, 317, 1250}, {28300, 20700, 305, 1400}, {31700, 23100, 292, 1500},
    {35400, 25600, 274, 1100}, {38900, 28300, 255, 750},  {42200, 31100, 236, 560},
    {46000, 33900, 221, 540},  {50300, 37300, 207, 620},  {55500, 41200, 194, 600},
};
static const struct geography_point nacimiento[] = {
    {8100, 18700, 650, 40},   {10600, 19500, 545, 80},  {13300, 21300, 470, 150},
    {16200, 24900, 415, 220}, {20100, 28600, 372, 350}, {24800, 31600, 338, 480},
    {29900, 34600, 310, 520}, {35200, 38400, 287, 420}, {40300, 41300, 268, 300},
    {45700, 43900, 254, 260}, {50600, 45600, 246, 260}, {55500, 47000, 238, 300},
};
static const struct geography_point salinas[] = {
    {30500, -9800, 91, 4200}, {36180, -4160, 98, 3600},  {40300, 0, 101, 3300},
    {45660, 5140, 112, 2900}, {50700, 10800, 122, 2600}, {56130, 17120, 133, 2300},
};
static const struct geography_point arroyo_seco[] = {
    {2600, 3900, 610, 40},
    {3300, 500, 500, 60},
    {5200, -2600, 410, 90},
    {9000, -6400, 300, 200},
};

static const struct geography_point coast_ridge[] = {
    {-9500, 1500, 1150, 0},  {-4200, 7600, 1230, 0},  {-400, 11000, 1290, 0},
    {2824, 13782, 1571, 0},  {4700, 16300, 1170, 0},  {6300, 19100, 880, 0},
    {7700, 22600, 1000, 0},  {10300, 26600, 1100, 0}, {12500, 30100, 1010, 0},
    {15500, 33500, 1160, 0}, {18800, 36800, 1090, 0}, {22400, 40300, 980, 0},
    {26800, 44300, 930, 0},  {32000, 48600, 980, 0},  {37400, 54300, 1090, 0},
};
static const struct geography_point junipero_serra_ridge[] = {
    {6800, 700, 1330, 0},   {9780, 3308, 1787, 0},  {12900, 5100, 1330, 0}, {17000, 7400, 1120, 0},
    {21500, 9700, 930, 0},  {26000, 12200, 790, 0}, {30000, 14700, 650, 0}, {34000, 17700, 560, 0},
    {38000, 20300, 600, 0}, {42500, 23500, 660, 0}, {47000, 27000, 700, 0}, {52000, 31000, 640, 0},
};
static const struct geography_point middle_ridge[] = {
    {2824, 13782, 1571, 0}, {8500, 15000, 960, 0},  {13800, 17700, 770, 0}, {18500, 21300, 690, 0},
    {24000, 25600, 650, 0}, {29300, 28600, 640, 0}, {34500, 32300, 600, 0}, {39500, 35700, 560, 0},
    {45000, 39100, 530, 0}, {50500, 42100, 510, 0}, {55500, 44500, 440, 0},
};
static const struct geography_point north_ridge[] = {
    {2824, 13782, 1571, 0}, {1500, 9000, 1240, 0}, {4100, 4900, 1080, 0},
    {6500, 3600, 1130, 0},  {6800, 700, 1330, 0},
};
static const struct geography_point gabilan_foot[] = {
    {41500, -7500, 480, 0},
    {48500, -1200, 460, 0},
    {53500, 4000, 480, 0},
    {59000, 9500, 520, 0},
};

const struct geography_line geography_rivers[GEOGRAPHY_RIVER_COUNT] = {
    [GEOGRAPHY_SAN_ANTONIO] = {"San Antonio River", san_antonio, COUNT(san_antonio)},
    {"Nacimiento River", nacimiento, COUNT(nacimiento)},
    {"Salinas River", salinas, COUNT(salinas)},
    {"Arroyo Seco", arroyo_seco, COUNT(arroyo_seco)},
};

const struct geography_line geography_ridges[GEOGRAPHY_RIDGE_COUNT] = {
    {"Coast Ridge", coast_ridge, COUNT(coast_ridge)},
    {"Junipero Serra ridge", junipero_serra_ridge, COUNT(junipero_serra_ridge)},
    {"hills between San Antonio and Nacimiento", middle_ridge, COUNT(middle_ridge)},
    {"divide of the Arroyo Seco", north_ridge, COUNT(north_ridge)},
    {"foot of the Gabilan Range", gabilan_foot, COUNT(gabilan_foot)},
};

/* Big Creek, Lopez Point, Limekiln, Kirk Creek, Pacific Valley, Sand Dollar, Cape San Martin,
 * Gorda, Salmon Creek, Ragged Point, San Carpoforo, towards Piedras Blancas. */
static const struct geography_point coast_points[] = {
    {-14700, 590, 0, 0},  {-10200, 6300, 0, 0}, {-6600, 11700, 0, 0}, {-3300, 16000, 0, 0},
    {-2070, 17230, 0, 0}, {730, 18450, 0, 0},   {2850, 20610, 0, 0},  {3500, 24000, 0, 0},
    {4250, 27200, 0, 0},  {5330, 28330, 0, 0},  {5600, 31770, 0, 0},  {7050, 33210, 0, 0},
    {10800, 37000, 0, 0}, {14600, 40500, 0, 0}, {17780, 43640, 0, 0}, {18300, 45400, 0, 0},
    {19000, 48200, 0, 0}, {19590, 50520, 0, 0}, {21930, 56510, 0, 0},
};
const struct geography_line geography_coast = {"Pacific coast", coast_points, COUNT(coast_points)};

const struct geography_place geography_places[GEOGRAPHY_PLACE_COUNT] = {
    {"Junipero Serra Peak", 36.1455, -121.4187, 1787, 1},
    {"Cone Peak", 36.0511, -121.4958, 1571, 1},
    [GEOGRAPHY_MISSION] = {"Mission San Antonio", 36.0153, -121.2503, 320, 0},
    [GEOGRAPHY_JOLON] = {"Jolon", 35.971, -121.176, 296, 0},
};

struct geography_near geography_nearest(const struct geography_line *line, double x, double z)
{
    struct geography_near near = {.distance_m = INFINITY};
    double best = INFINITY;
    for (size_t i = 0; i + 1 < line->count; i++) {
        const struct geography_point *a = &line->points[i], *b = a + 1;
        double dx = b->x_m - a->x_m, dz = b->z_m - a->z_m;
        double t = ((x - a->x_m) * dx + (z - a->z_m) * dz) / (dx * dx + dz * dz);
        t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
        double ox = a->x_m + dx * t - x, oz = a->z_m + dz * t - z, square = ox * ox + oz * oz;
        if (square < best) {
            best = square;
            near.height_m = a->height_m + (b->height_m - a->height_m) * t;
            near.half_width_m = a->half_width_m + (b->half_width_m - a->half_width_m) * t;
        }
    }
    near.distance_m = sqrt(best);
    return near;
}

double geography_inland(double x, double z)
{
    const struct geography_point *p = coast_points;
    size_t i = 0;
    while (i + 2 < COUNT(coast_points) && z > p[i + 1].z_m)
        i++;
    double t = (z - p[i].z_m) / (p[i + 1].z_m - p[i].z_m);
    double shore_x = p[i].x_m + (p[i + 1].x_m - p[i].x_m) * t;
    double distance = geography_nearest(&geography_coast, x, z).distance_m;
    return x < shore_x ? -distance : distance;
}
