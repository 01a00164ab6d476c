/* Reads lines of values with commas between them. Each line is an arrival. */
#include "config/waypoints.h"

#include "config/syntax/schema.h"
#include "world/runtime/parse_number.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#define CELLS_MAX 4
#define ROW_MAX   256

/* How the header says that places are written. */
static const struct place_columns {
    const char *columns;
    int cells;
} place_columns[] = {{"x,z", 2}, {"latitude,longitude", 2}, {"mgrs", 1}};
enum { PLACE_METRES, PLACE_DEGREES, PLACE_MGRS, PLACES };

/* A file while it is read. */
struct reading {
    const struct location_frame *frame;
    struct error_text *error;
    struct key_place place; /* the current line */
    const char *next;       /* the line after it */
    char line[ROW_MAX];
    char cell[CELLS_MAX][ROW_MAX]; /* of the line */
    int places;                    /* of the header */
    bool has_altitude;
};

uint32_t waypoints_lines(const char *text)
{
    uint32_t lines = 0;
    for (const char *at = text; *at != '\0'; lines++) {
        at += strspn(at, "\r\n");
        at += strcspn(at, "\r\n");
    }
    return lines;
}

/* Copies the next line that is not empty, without the blanks at its end. 1; 0 at the end of the
 * file; -1 with the message. */
static int next_line(struct reading *reading)
{
    while (*reading->next != '\0') {
        size_t length = strcspn(reading->next, "\n");
        const char *line = reading->next;
        reading->place.line++;
        reading->next += length + (line[length] == '\n');
        while (length > 0 && strchr(" \t\r", line[length - 1]) != NULL)
            length--;
        if (length >= ROW_MAX)
            return key_table_refuse(reading->error, reading->place, NULL, NULL,
                                    "has %zu characters; allowed: up to %d", length, ROW_MAX - 1);
        if (length == 0)
            continue;
        memcpy(reading->line, line, length);
        reading->line[length] = '\0';
        return 1;
    }
    return 0;
}

static int read_header(struct reading *reading)
{
    int found = next_line(reading);
    if (found < 0)
        return -1;
    for (reading->places = 0; found > 0 && reading->places < PLACES; reading->places++) {
        char plain[64], with_altitude[96];
        snprintf(plain, sizeof plain, "time_s,%s", place_columns[reading->places].columns);
        snprintf(with_altitude, sizeof with_altitude, "%s,altitude_m", plain);
        reading->has_altitude = strcmp(reading->line, with_altitude) == 0;
        if (reading->has_altitude || strcmp(reading->line, plain) == 0)
            return 0;
    }
    return key_table_refuse(reading->error, reading->place, found > 0 ? reading->line : NULL, NULL,
                            "is not the header; right would be: " WAYPOINTS_HEADER);
}

/* Reads a number. key: gives the range, whose end is high. */
static int read_number(struct reading *reading, const char *name, const char *text,
                       const struct key *key, double high, double *value)
{
    struct key ranged = *key;
    char range[64];
    ranged.high = high;
    key_table_range(&ranged, range, sizeof(range));
    if (!parse_real(text, -DBL_MAX, DBL_MAX, value))
        return key_table_refuse(reading->error, reading->place, name, text,
                                "is not a number; allowed: %s", range);
    if (!(*value >= key->low && *value <= high))
        return key_table_refuse(reading->error, reading->place, name, text,
                                "out of range; allowed: %s", range);
    return 0;
}

/* Reads a place on the earth. Degrees may have letters, or signs as positioning systems write. */
static int read_earth(struct reading *reading, double point[2])
{
    struct location place = {.on_earth = true};
    struct error_text reason;
    char text[2 * ROW_MAX];
    snprintf(text, sizeof text, reading->places == PLACE_MGRS ? "%s" : "%s,%s", reading->cell[1],
             reading->cell[2]);
    bool signs = reading->places == PLACE_DEGREES &&
                 parse_real(reading->cell[1], -90.0, 90.0, &place.latitude_deg) &&
                 parse_real(reading->cell[2], -180.0, 180.0, &place.longitude_deg);
    int result = signs ? 0 : location_read(&place, text, &reason);
    if (result == 0 && !place.on_earth)
        result = error_text_set(
            &reason, "'%.64s': not a place as the header says; right would be: %s", text,
            reading->places == PLACE_MGRS ? "19TCK1617404497" : "44.2705,-71.3033");
    if (result == 0)
        result = location_world(&place, reading->frame, &point[0], &point[1], &reason);
    return result == 0
               ? 0
               : key_table_refuse(reading->error, reading->place,
                                  place_columns[reading->places].columns, NULL, "%s", reason.text);
}

/* Puts the values of the line into cells, whose number is that of the header. */
static int split(struct reading *reading)
{
    int wanted = 1 + place_columns[reading->places].cells + reading->has_altitude, count = 0;
    const char *at = reading->line;
    for (;; at++) {
        size_t length = strcspn(at, ","), used = length;
        while (used > 0 && at[used - 1] == ' ')
            used--;
        if (count == wanted)
            return key_table_refuse(
                reading->error, reading->place, reading->line, NULL,
                "has more than %d values; right would be: as many as in the header", wanted);
        snprintf(reading->cell[count++], ROW_MAX, "%.*s", (int)used, at);
        at += length;
        if (*at == '\0')
            break;
    }
    if (count < wanted)
        return key_table_refuse(reading->error, reading->place, reading->line, NULL,
                                "has %d values; right would be: %d, as in the header", count,
                                wanted);
    return 0;
}

static int read_line(struct reading *reading, struct script_step *step)
{
    const struct key *keys = schema_step.keys, *arrive = &keys[STEP_KEY_ARRIVE];
    double point[2] = {0.0, 0.0}, side_m = reading->frame->side_m;
    *step = (struct script_step){.altitude_m = STEP_SAME_ALTITUDE, .type = STEP_ARRIVE};
    if (split(reading) != 0 || read_number(reading, "time_s", reading->cell[0], &keys[STEP_KEY_AT],
                                           keys[STEP_KEY_AT].high, &step->at_s) != 0)
        return -1;
    if (reading->places == PLACE_METRES
            ? read_number(reading, "x", reading->cell[1], arrive, side_m, &point[0]) != 0 ||
                  read_number(reading, "z", reading->cell[2], arrive, side_m, &point[1]) != 0
            : read_earth(reading, point) != 0)
        return -1;
    step->x = point[0];
    step->z = point[1];
    return !reading->has_altitude
               ? 0
               : read_number(
                     reading, "altitude_m", reading->cell[1 + place_columns[reading->places].cells],
                     &keys[STEP_KEY_ALTITUDE], keys[STEP_KEY_ALTITUDE].high, &step->altitude_m);
}

static int refuse_time(const struct reading *reading, double time_s, double before_s)
{
    char text[32];
    snprintf(text, sizeof(text), "%.15g", time_s);
    return key_table_refuse(reading->error, reading->place, "time_s", text,
                            "is not after the line before; allowed: above %.15g", before_s);
}

int waypoints_read(const struct source *source, const struct location_frame *frame,
                   struct scenario_step *steps, struct error_text *error)
{
    struct reading reading = {
        .frame = frame, .error = error, .place = {source->path, 0}, .next = source->text};
    double before_s = -1.0;
    int count = 0, found;
    if (strlen(source->text) != source->bytes)
        return key_table_refuse(error, reading.place, NULL, NULL, "is not text: it has a NUL byte");
    if (read_header(&reading) != 0)
        return -1;
    while ((found = next_line(&reading)) > 0) {
        struct script_step *step = &steps[count].step;
        steps[count] = (struct scenario_step){.line = reading.place.line};
        if (read_line(&reading, step) != 0)
            return -1;
        if (!(step->at_s > before_s))
            return refuse_time(&reading, step->at_s, before_s);
        before_s = step->at_s;
        count++;
    }
    if (found == 0 && count == 0)
        return key_table_refuse(error, reading.place, NULL, NULL,
                                "has no waypoint; right would be: a line of values behind the "
                                "header");
    return found < 0 ? -1 : count;
}
