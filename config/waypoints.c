/* Reads lines of numbers with commas between them. Each line is an arrival. */
#include "config/waypoints.h"

#include "config/syntax/schema.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COLUMNS_MAX 4
#define ROW_MAX     256

/* The columns. A value has the range of a step's key. */
static const struct {
    const char *name;
    enum step_key key;
} columns[COLUMNS_MAX] = {{"time_s", STEP_KEY_AT},
                          {"x", STEP_KEY_ARRIVE},
                          {"z", STEP_KEY_ARRIVE},
                          {"altitude_m", STEP_KEY_ALTITUDE}};

/* A file while it is read. */
struct reading {
    const struct source *source;
    struct error_text *error;
    struct key_place place; /* the current line */
    const char *next;       /* the line after it */
    char line[ROW_MAX];
    int columns; /* of the header */
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
    if (found > 0 && strcmp(reading->line, "time_s,x,z") == 0)
        reading->columns = 3;
    else if (found > 0 && strcmp(reading->line, "time_s,x,z,altitude_m") == 0)
        reading->columns = 4;
    else
        return key_table_refuse(reading->error, reading->place, found > 0 ? reading->line : NULL,
                                NULL, "is not the header; right would be: " WAYPOINTS_HEADER);
    return 0;
}

/* Reads the value of one column at *at, and moves *at behind it. */
static int read_value(struct reading *reading, int column, const char **at, double *value)
{
    size_t length = strcspn(*at, ",");
    const struct key *key = &schema_step.keys[columns[column].key];
    char text[ROW_MAX], range[64], *end = NULL;
    key_table_range(key, range, sizeof(range));
    snprintf(text, sizeof(text), "%.*s", (int)length, *at);
    *value = strtod(text, &end);
    if (end == text || end[strspn(end, " ")] != '\0' || !isfinite(*value))
        return key_table_refuse(reading->error, reading->place, columns[column].name, text,
                                "is not a number; allowed: %s", range);
    if (!(*value >= key->low && *value <= key->high))
        return key_table_refuse(reading->error, reading->place, columns[column].name, text,
                                "out of range; allowed: %s", range);
    *at += length;
    return 0;
}

static int read_line(struct reading *reading, double values[COLUMNS_MAX])
{
    const char *at = reading->line;
    for (int column = 0; column < reading->columns; column++) {
        if (column > 0 && *at != ',')
            return key_table_refuse(reading->error, reading->place, reading->line, NULL,
                                    "has %d numbers; right would be: %d, as in the header", column,
                                    reading->columns);
        at += column > 0;
        if (read_value(reading, column, &at, &values[column]) != 0)
            return -1;
    }
    if (*at != '\0')
        return key_table_refuse(
            reading->error, reading->place, reading->line, NULL,
            "has more than %d numbers; right would be: as many as in the header", reading->columns);
    return 0;
}

static int refuse_time(const struct reading *reading, double time_s, double before_s)
{
    char text[32];
    snprintf(text, sizeof(text), "%.15g", time_s);
    return key_table_refuse(reading->error, reading->place, columns[0].name, text,
                            "is not after the line before; allowed: above %.15g", before_s);
}

int waypoints_read(const struct source *source, struct scenario_step *steps,
                   struct error_text *error)
{
    struct reading reading = {
        .source = source, .error = error, .place = {source->path, 0}, .next = source->text};
    double values[COLUMNS_MAX] = {0}, before_s = -1.0;
    int count = 0, found;
    if (strlen(source->text) != source->bytes)
        return key_table_refuse(error, reading.place, NULL, NULL, "is not text: it has a NUL byte");
    if (read_header(&reading) != 0)
        return -1;
    while ((found = next_line(&reading)) > 0) {
        if (read_line(&reading, values) != 0)
            return -1;
        if (!(values[0] > before_s))
            return refuse_time(&reading, values[0], before_s);
        before_s = values[0];
        steps[count++] = (struct scenario_step){
            .step = {.at_s = values[0],
                     .x = values[1],
                     .z = values[2],
                     .altitude_m = reading.columns > 3 ? values[3] : STEP_SAME_ALTITUDE,
                     .type = STEP_ARRIVE},
            .line = reading.place.line};
    }
    if (found == 0 && count == 0)
        return key_table_refuse(error, reading.place, NULL, NULL,
                                "has no waypoint; right would be: a line of " WAYPOINTS_HEADER
                                " behind the header");
    return found < 0 ? -1 : count;
}
