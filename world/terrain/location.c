/* Reads and writes places. */
#include "world/terrain/location.h"

#include "world/maths/maths.h"
#include "world/runtime/parse_number.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define FORMS                                                                                      \
    "right would be: 25000,24000 (metres east, metres south), 44.2705N,71.3033W or "               \
    "19TCK1617404497 (MGRS)"

#define NUMBER_MAX 40

void location_frame_make(struct location_frame *frame, double latitude_deg, double longitude_deg,
                         double side_m)
{
    *frame = (struct location_frame){
        .latitude_deg = latitude_deg, .longitude_deg = longitude_deg, .side_m = side_m};
    projection_make(&frame->projection, latitude_deg, longitude_deg, side_m);
}

/* Copies the trimmed part of a text up to end. Returns false if it is empty or too long. */
static bool part_of(char part[NUMBER_MAX], const char *text, const char *end)
{
    while (text < end && *text == ' ')
        text++;
    while (end > text && end[-1] == ' ')
        end--;
    if (end == text || end - text >= NUMBER_MAX)
        return false;
    memcpy(part, text, (size_t)(end - text));
    part[end - text] = '\0';
    return true;
}

/* Reads "44.27N" or "71.3w": degrees with one of two letters, the second of which is negative.
 * Returns false if the last letter is none of the two, or the number is none of 0 to most. */
static bool read_degrees(char *text, const char letters[2], double most, double *degrees)
{
    size_t length = strlen(text);
    char letter = (char)toupper((unsigned char)text[length - 1]);
    if (letter != letters[0] && letter != letters[1])
        return false;
    text[length - 1] = '\0';
    if (!isdigit((unsigned char)text[0]) || !parse_real(text, 0.0, most, degrees))
        return false;
    *degrees = letter == letters[1] ? -*degrees : *degrees;
    return true;
}

/* Returns true if a text ends in a letter, as degrees do. */
static bool ends_in_letter(const char *text)
{
    return isalpha((unsigned char)text[strlen(text) - 1]);
}

/* Refuses metres below 0, which may be meant for degrees. */
static int refuse_negative(const struct location *place, const char *text, struct error_text *error)
{
    char meant[2 * NUMBER_MAX] = "44.2705N,71.3033W";
    if (fabs(place->x) <= 90.0 && fabs(place->z) <= 180.0)
        (void)snprintf(meant, sizeof meant, "%.10g%c,%.10g%c", fabs(place->x),
                       place->x < 0.0 ? 'S' : 'N', fabs(place->z), place->z < 0.0 ? 'W' : 'E');
    return error_text_set(error,
                          "'%.64s': metres east and south of the north-west corner are not below "
                          "0; degrees need letters, as %s",
                          text, meant);
}

int location_read(struct location *place, const char *text, struct error_text *error)
{
    const char *comma = strchr(text, ','), *zone = text + strspn(text, " ");
    size_t digits = strspn(zone, "0123456789");
    char first[NUMBER_MAX], second[NUMBER_MAX];
    *place = (struct location){.on_earth = true};
    if (!comma && digits >= 1 && digits <= 2 && isalpha((unsigned char)zone[digits]))
        return mgrs_read(text, &place->latitude_deg, &place->longitude_deg, error);
    if (!comma || !part_of(first, text, comma) || !part_of(second, comma + 1, text + strlen(text)))
        return error_text_set(error, "'%.64s': not a place; " FORMS, text);
    if (ends_in_letter(first) || ends_in_letter(second)) {
        if (!read_degrees(first, "NS", 90.0, &place->latitude_deg) ||
            !read_degrees(second, "EW", 180.0, &place->longitude_deg))
            return error_text_set(error,
                                  "'%.64s': not a latitude of 0 to 90 degrees with N or S and a "
                                  "longitude of 0 to 180 with E or W; right would be: "
                                  "44.2705N,71.3033W",
                                  text);
        return 0;
    }
    place->on_earth = false;
    if (!parse_real(first, -1e9, 1e9, &place->x) || !parse_real(second, -1e9, 1e9, &place->z))
        return error_text_set(error, "'%.64s': not a place; " FORMS, text);
    return place->x < 0.0 || place->z < 0.0 ? refuse_negative(place, text, error) : 0;
}

/* The distance of two places on a sphere [km], good to 1 %. */
static double distance_km(const struct location *place, const struct location_frame *frame)
{
    double sine, cosine, middle_sine, middle_cosine, turn_sine, turn_cosine;
    maths_sincos(place->latitude_deg * RAD_PER_DEG, &sine, &cosine);
    maths_sincos(frame->latitude_deg * RAD_PER_DEG, &middle_sine, &middle_cosine);
    maths_sincos((place->longitude_deg - frame->longitude_deg) * RAD_PER_DEG, &turn_sine,
                 &turn_cosine);
    double east = cosine * turn_sine;
    double north = middle_cosine * sine - middle_sine * cosine * turn_cosine;
    double along = middle_sine * sine + middle_cosine * cosine * turn_cosine;
    return 6371.0 * maths_atan2(sqrt(east * east + north * north), along);
}

int location_world(const struct location *place, const struct location_frame *frame, double *x,
                   double *z, struct error_text *error)
{
    double side_m = frame->side_m;
    *x = place->x;
    *z = place->z;
    if (!place->on_earth) {
        if (*x >= 0.0 && *z >= 0.0 && *x <= side_m && *z <= side_m)
            return 0;
        return error_text_set(error, "%.10g,%.10g: outside of the world; allowed: 0..%.10g m each",
                              *x, *z, side_m);
    }
    double away_km = distance_km(place, frame);
    if (away_km * 1000.0 < side_m)
        projection_world(&frame->projection, place->latitude_deg, place->longitude_deg, x, z);
    if (away_km * 1000.0 < side_m && *x >= 0.0 && *z >= 0.0 && *x <= side_m && *z <= side_m)
        return 0;
    return error_text_set(
        error,
        "that place is %.0f km from the middle of the world, which is at %.4f%c,%.4f%c, and "
        "outside of its square of %.0f km",
        away_km, fabs(frame->latitude_deg), frame->latitude_deg < 0.0 ? 'S' : 'N',
        fabs(frame->longitude_deg), frame->longitude_deg < 0.0 ? 'W' : 'E', side_m / 1000.0);
}

void location_earth(struct location_earth *earth, const struct location_frame *frame, double x,
                    double z)
{
    projection_place(&frame->projection, x, z, &earth->latitude_deg, &earth->longitude_deg);
    (void)snprintf(earth->degrees, sizeof earth->degrees, "%.6f%c,%.6f%c",
                   fabs(earth->latitude_deg), earth->latitude_deg < 0.0 ? 'S' : 'N',
                   fabs(earth->longitude_deg), earth->longitude_deg < 0.0 ? 'W' : 'E');
    (void)mgrs_write(earth->mgrs, earth->latitude_deg, earth->longitude_deg);
}
