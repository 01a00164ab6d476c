/* Filters, sorts and writes the rows. */
#include "clients/monitor/vehicle_table.h"

#include "world/entity/entity.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    int width; /* negative: aligned to the left */
} columns[VEHICLE_TABLE_COLUMNS] = {
    [VEHICLE_TABLE_ID] = {"id", 6},
    [VEHICLE_TABLE_KIND] = {"kind", -12},
    [VEHICLE_TABLE_FORCE] = {"force", -7},
    [VEHICLE_TABLE_BEHAVIOUR] = {"behaviour", -9},
    [VEHICLE_TABLE_DAMAGE] = {"damage", -9},
    [VEHICLE_TABLE_SPEED] = {"speed", 5},
    [VEHICLE_TABLE_HEADING] = {"hdg", 3},
    [VEHICLE_TABLE_X] = {"x", 5},
    [VEHICLE_TABLE_Z] = {"z", 5},
    [VEHICLE_TABLE_ROUNDS] = {"rnds", 4},
    [VEHICLE_TABLE_FUEL] = {"fuel", 5},
};

const char *vehicle_table_column_name(enum vehicle_table_column column)
{
    return column < VEHICLE_TABLE_COLUMNS ? columns[column].name : "?";
}

static double speed_of(const jolon_Entity *entity)
{
    double x = (double)entity->vx_mps, y = (double)entity->vy_mps, z = (double)entity->vz_mps;
    return sqrt(x * x + y * y + z * z);
}

/* The value in a column of numbers; NAN for the other columns. */
static double number_of(const jolon_Entity *entity, enum vehicle_table_column column)
{
    switch (column) {
    case VEHICLE_TABLE_ID:
        return (double)entity->id;
    case VEHICLE_TABLE_DAMAGE:
        return (double)entity->damage;
    case VEHICLE_TABLE_SPEED:
        return speed_of(entity);
    case VEHICLE_TABLE_HEADING:
        return (double)entity->heading_rad * DEG_PER_RAD;
    case VEHICLE_TABLE_X:
        return entity->x_m;
    case VEHICLE_TABLE_Z:
        return entity->z_m;
    case VEHICLE_TABLE_ROUNDS:
        return (double)entity->rounds;
    case VEHICLE_TABLE_FUEL:
        return (double)entity->fuel_l;
    default:
        return NAN;
    }
}

static const char *text_of(const struct world_mirror *mirror, const jolon_Entity *entity,
                           enum vehicle_table_column column)
{
    switch (column) {
    case VEHICLE_TABLE_KIND:
        return world_mirror_kind_name(mirror, entity->kind);
    case VEHICLE_TABLE_FORCE:
        return force_name((enum force)entity->force);
    case VEHICLE_TABLE_BEHAVIOUR:
        return behaviour_name((enum behaviour)entity->behaviour);
    case VEHICLE_TABLE_DAMAGE:
        return damage_name((enum damage)entity->damage);
    default:
        return "";
    }
}

static bool contains(const char *text, const char *part, size_t length)
{
    size_t room = strlen(text);
    for (size_t at = 0; length <= room && at <= room - length; at++) {
        if (strncasecmp(text + at, part, length) == 0)
            return true;
    }
    return false;
}

/* A comparison like "speed>10", whose sign is at word + sign. False if there is no such column or
 * no number. */
static bool compares(const jolon_Entity *entity, const char *word, size_t sign, size_t length)
{
    char text[VEHICLE_TABLE_FILTER_MAX], *end;
    memcpy(text, word + sign + 1, length - sign - 1);
    text[length - sign - 1] = '\0';
    double limit = strtod(text, &end);
    if (end == text || *end)
        return false;
    for (int i = 0; i < VEHICLE_TABLE_COLUMNS; i++) {
        double value = number_of(entity, (enum vehicle_table_column)i);
        if (strlen(columns[i].name) == sign && strncasecmp(columns[i].name, word, sign) == 0)
            return word[sign] == '<' ? value < limit : value > limit;
    }
    return false;
}

static bool word_matches(const struct world_mirror *mirror, const jolon_Entity *entity,
                         const char *word, size_t length)
{
    char id[16];
    size_t sign = 0;
    while (sign < length && word[sign] != '<' && word[sign] != '>')
        sign++;
    if (sign < length)
        return compares(entity, word, sign, length);
    int digits = snprintf(id, sizeof id, "%u", entity->id);
    if ((size_t)digits == length && strncmp(id, word, length) == 0)
        return true;
    for (int i = VEHICLE_TABLE_KIND; i <= VEHICLE_TABLE_DAMAGE; i++) {
        if (contains(text_of(mirror, entity, (enum vehicle_table_column)i), word, length))
            return true;
    }
    return contains(entity_state_name((enum entity_state)entity->state), word, length) ||
           contains(name_table_of(&mirror->names, entity->id), word, length);
}

bool vehicle_table_matches(const struct world_mirror *mirror, const jolon_Entity *entity,
                           const char *filter)
{
    bool flight = entity->behaviour == jolon_BEHAVIOUR_FLIGHT, wants_flight = false;
    while (*filter) {
        size_t length = strcspn(filter, " ");
        if (length >= VEHICLE_TABLE_FILTER_MAX ||
            (length > 0 && !word_matches(mirror, entity, filter, length)))
            return false; /* no text is that long */
        wants_flight |= length == 6 && strncasecmp(filter, "flight", length) == 0;
        filter += length;
        filter += strspn(filter, " ");
    }
    return wants_flight || !flight;
}

struct order {
    const struct world_mirror *mirror;
    enum vehicle_table_column sort;
    bool descending;
};

static int compare(const void *a, const void *b, void *context)
{
    const struct order *order = context;
    const jolon_Entity *one = &order->mirror->batch.entity[*(const uint32_t *)a];
    const jolon_Entity *other = &order->mirror->batch.entity[*(const uint32_t *)b];
    double x = number_of(one, order->sort), y = number_of(other, order->sort);
    int sign = isnan(x) ? strcmp(text_of(order->mirror, one, order->sort),
                                 text_of(order->mirror, other, order->sort))
                        : (x > y) - (x < y);
    if (sign == 0)
        return (one->id > other->id) - (one->id < other->id);
    return order->descending ? -sign : sign;
}

bool vehicle_table_build(struct vehicle_table *table, const struct world_mirror *mirror,
                         const char *filter, enum vehicle_table_column sort, bool descending)
{
    uint32_t most = mirror->has_batch ? mirror->batch.count : 0;
    struct order order = {mirror, sort, descending};
    table->count = 0;
    if (most > table->room) {
        uint32_t *row = realloc(table->row, most * sizeof *row);
        if (!row)
            return false;
        table->row = row;
        table->room = most;
    }
    for (uint32_t i = 0; i < most; i++) {
        if (vehicle_table_matches(mirror, &mirror->batch.entity[i], filter))
            table->row[table->count++] = i;
    }
    if (table->count > 1)
        qsort_r(table->row, table->count, sizeof *table->row, compare, &order);
    return true;
}

void vehicle_table_free(struct vehicle_table *table)
{
    free(table->row);
    *table = (struct vehicle_table){0};
}

uint32_t vehicle_table_find(const struct vehicle_table *table, const struct world_mirror *mirror,
                            uint32_t id)
{
    uint32_t at = 0;
    while (at < table->count && mirror->batch.entity[table->row[at]].id != id)
        at++;
    return at;
}

void vehicle_table_head(char line[VEHICLE_TABLE_LINE_MAX], enum vehicle_table_column sort,
                        bool descending)
{
    size_t used = 0;
    for (int i = 0; i < VEHICLE_TABLE_COLUMNS; i++) {
        char arrow = (int)sort != i ? ' ' : descending ? 'v' : '^';
        /* The arrow stands beside a name that leaves room in its column, or else after the column.
         */
        bool inside = columns[i].width < -(int)strlen(columns[i].name);
        char name[24];
        (void)snprintf(name, sizeof name, "%s%c", columns[i].name, inside ? arrow : '\0');
        used += (size_t)snprintf(line + used, VEHICLE_TABLE_LINE_MAX - used, "%*s%c",
                                 columns[i].width, name, inside ? ' ' : arrow);
    }
}

void vehicle_table_line(char line[VEHICLE_TABLE_LINE_MAX], const struct world_mirror *mirror,
                        const jolon_Entity *entity)
{
    (void)snprintf(
        line, VEHICLE_TABLE_LINE_MAX,
        "%6u %-12.12s %-7s %-9.9s %-9s %5.1f %3.0f %5.0f %5.0f %4u %5.0f %s", entity->id,
        world_mirror_kind_name(mirror, entity->kind), force_name((enum force)entity->force),
        behaviour_name((enum behaviour)entity->behaviour),
        entity->state == jolon_ENTITY_WRECK ? "wreck" : damage_name((enum damage)entity->damage),
        speed_of(entity), floor((double)entity->heading_rad * DEG_PER_RAD), entity->x_m,
        entity->z_m, entity->rounds > 9999 ? 9999 : entity->rounds, (double)entity->fuel_l,
        name_table_of(&mirror->names, entity->id));
}
