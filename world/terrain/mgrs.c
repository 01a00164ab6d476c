/* Zones, bands and letters of the Military Grid Reference System. */
#include "world/terrain/mgrs.h"

#include "world/terrain/projection.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCALE          0.9996
#define MIDDLE_M       500000.0 /* the easting of a zone's middle meridian */
#define SQUARE_M       100000.0 /* the side of the squares that have letters */
#define SQUARE_WHOLE_M 100000u
#define CYCLE_M        2000000.0 /* after which the letters of the northing begin again */
#define CAP_NORTH      84.0
#define CAP_SOUTH      (-80.0)
#define BAND_DEG       8.0
#define BAND_LAST      19 /* X, which goes on to the cap */
#define DIGITS_MAX     5  /* for each direction */
#define ROW_COUNT      20
#define COLUMN_COUNT   8
#define EVEN_ROWS      5 /* by which the letters of even zones are ahead */
#define NOISE_M        1e-6
/* How far a square may reach beyond its band: its own side, and the rise of a parallel towards the
 * edge of a zone. */
#define BEYOND_M 110000.0

static const char bands[] = "CDEFGHJKLMNPQRSTUVWX";
static const char rows[] = "ABCDEFGHJKLMNPQRSTUV";
static const char columns[] = "ABCDEFGHJKLMNPQRSTUVWXYZ"; /* eight for each of three zones */

static int band_of(double latitude_deg)
{
    int band = (int)floor((latitude_deg - CAP_SOUTH) / BAND_DEG);
    return band > BAND_LAST ? BAND_LAST : band;
}

/* The zone of a place: 6 degrees, but wider off Norway and Svalbard. */
static int zone_of(double latitude_deg, double longitude_deg)
{
    int zone = (int)floor((longitude_deg + 180.0) / 6.0) % 60 + 1;
    int band = band_of(latitude_deg);
    if (bands[band] == 'V' && zone == 31 && longitude_deg >= 3.0)
        return 32;
    if (bands[band] == 'X' && longitude_deg >= 0.0 && longitude_deg < 42.0)
        return longitude_deg < 9.0    ? 31
               : longitude_deg < 21.0 ? 33
               : longitude_deg < 33.0 ? 35
                                      : 37;
    return zone;
}

static struct projection projection_of(int zone)
{
    struct projection projection;
    projection_make(&projection, 0.0, 6.0 * zone - 183.0, 0.0);
    return projection;
}

/* The easting and the northing of a place in a zone [m]; south of the equator the northing is
 * negative. */
static void grid_of(int zone, double latitude_deg, double longitude_deg, double *east_m,
                    double *north_m)
{
    const struct projection projection = projection_of(zone);
    double x, z;
    projection_world(&projection, latitude_deg, longitude_deg, &x, &z);
    *east_m = MIDDLE_M + SCALE * x;
    *north_m = -SCALE * z;
}

bool mgrs_write(char text[MGRS_TEXT_MAX], double latitude_deg, double longitude_deg)
{
    double east_m, north_m;
    text[0] = '\0';
    if (!(latitude_deg >= CAP_SOUTH && latitude_deg <= CAP_NORTH && fabs(longitude_deg) <= 180.0))
        return false;
    int zone = zone_of(latitude_deg, longitude_deg);
    grid_of(zone, latitude_deg, longitude_deg, &east_m, &north_m);
    long east = (long)floor(east_m + NOISE_M), north = (long)floor(north_m + NOISE_M);
    north +=
        5 * (long)CYCLE_M; /* 10,000 km, as everywhere in the south; the letters are the same */
    long column = east / (long)SQUARE_M - 1, row = north / (long)SQUARE_M;
    if (column < 0 || column >= COLUMN_COUNT)
        return false;
    (void)snprintf(text, MGRS_TEXT_MAX, "%02u%c%c%c%05u%05u", (unsigned)zone % 100u,
                   bands[band_of(latitude_deg)], columns[(zone - 1) % 3 * COLUMN_COUNT + column],
                   rows[(row + (zone % 2 == 0 ? EVEN_ROWS : 0)) % ROW_COUNT],
                   (unsigned)east % SQUARE_WHOLE_M, (unsigned)north % SQUARE_WHOLE_M);
    return true;
}

/* A reference without its blanks, in capital letters, and its parts. */
struct reference {
    char text[5 + 2 * DIGITS_MAX + 1];
    int zone, band, column, row;
    const char *digits;
};

static int refuse(struct error_text *error, const char *text, const char *wrong)
{
    return error_text_set(error,
                          "'%.32s': %s; a reference of the grid is like 19TCK1617404497: zone 1 to "
                          "60, band C to X, two letters of a square of 100 km, none to ten digits",
                          text, wrong);
}

/* Returns the index of a letter in a list of them, or -1. */
static int index_of(const char *letters, size_t count, char letter)
{
    const char *at = letter ? memchr(letters, letter, count) : NULL;
    return at ? (int)(at - letters) : -1;
}

static int read_parts(struct reference *r, const char *text, struct error_text *error)
{
    size_t length = 0;
    for (const char *at = text; *at; at++) {
        if (*at == ' ')
            continue;
        if (length + 1 >= sizeof r->text)
            return refuse(error, text, "it has more than ten digits");
        r->text[length++] = (char)toupper((unsigned char)*at);
    }
    r->text[length] = '\0';
    size_t digits = strspn(r->text, "0123456789");
    if (digits < 1 || digits > 2 || length < digits + 3)
        return refuse(error, text, "it has no zone with three letters behind");
    r->zone = atoi(r->text);
    const char *letter = r->text + digits;
    r->band = index_of(bands, sizeof bands - 1, letter[0]);
    if (r->zone < 1 || r->zone > 60)
        return refuse(error, text, "there is no such zone");
    if (r->band < 0)
        return refuse(error, text,
                      strchr("ABYZ", letter[0]) ? "the caps of the poles have no zones"
                                                : "there is no such band");
    if (bands[r->band] == 'X' && (r->zone == 32 || r->zone == 34 || r->zone == 36))
        return refuse(error, text, "off Svalbard there are the zones 31, 33, 35 and 37 alone");
    r->column = index_of(columns + (r->zone - 1) % 3 * COLUMN_COUNT, COLUMN_COUNT, letter[1]);
    r->row = index_of(rows, sizeof rows - 1, letter[2]);
    if (r->column < 0 || r->row < 0)
        return refuse(error, text, "its zone has no square of these letters");
    r->digits = letter + 3;
    if (r->digits[strspn(r->digits, "0123456789")] != '\0' || strlen(r->digits) % 2 != 0)
        return refuse(error, text, "behind the letters are not as many digits east as north");
    return 0;
}

/* Reads half of the digits as metres into the square. */
static double metres_of(const char *digits, size_t count, double side_m)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum = 10.0 * sum + (digits[i] - '0');
    return (sum + 0.5) * side_m; /* the middle */
}

int mgrs_read(const char *text, double *latitude_deg, double *longitude_deg,
              struct error_text *error)
{
    struct reference r = {.digits = ""};
    if (read_parts(&r, text, error) != 0)
        return -1;
    const struct projection projection = projection_of(r.zone);
    size_t count = strlen(r.digits) / 2;
    double side_m = SQUARE_M, low_m, high_m, none;
    for (size_t i = 0; i < count; i++)
        side_m /= 10.0;
    double east_m = SQUARE_M * (r.column + 1) + metres_of(r.digits, count, side_m);
    int row = (r.row + ROW_COUNT - (r.zone % 2 == 0 ? EVEN_ROWS : 0)) % ROW_COUNT;
    double bottom_deg = CAP_SOUTH + BAND_DEG * r.band;
    double top_deg = r.band == BAND_LAST ? CAP_NORTH : bottom_deg + BAND_DEG;
    grid_of(r.zone, bottom_deg, 6.0 * r.zone - 183.0, &none, &low_m);
    grid_of(r.zone, top_deg, 6.0 * r.zone - 183.0, &none, &high_m);
    double square_m = SQUARE_M * row - 5 * CYCLE_M;
    while (square_m < low_m - BEYOND_M)
        square_m += CYCLE_M;
    if (square_m > high_m + BEYOND_M - SQUARE_M)
        return refuse(error, text, "its band has no square of these letters");
    double north_m = square_m + metres_of(r.digits + count, count, side_m);
    projection_place(&projection, (east_m - MIDDLE_M) / SCALE, -north_m / SCALE, latitude_deg,
                     longitude_deg);
    return 0;
}
