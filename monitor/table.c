/* Rows of vehicles: filtered, sorted, written. */
#include "monitor/table.h"

#include "world/maths.h"
#include "world/world.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    int width; /* negative: to the left */
} columns[TABLE_COLUMNS] = {
    [TABLE_ID] = {"id", 6},
    [TABLE_KIND] = {"kind", -12},
    [TABLE_FORCE] = {"force", -7},
    [TABLE_BEHAVIOUR] = {"behaviour", -9},
    [TABLE_DAMAGE] = {"damage", -9},
    [TABLE_SPEED] = {"speed", 5},
    [TABLE_HEADING] = {"hdg", 3},
    [TABLE_X] = {"x", 5},
    [TABLE_Z] = {"z", 5},
    [TABLE_ROUNDS] = {"rnds", 4},
    [TABLE_FUEL] = {"fuel", 5},
};

const char *table_column_name(enum table_column column)
{
    return column < TABLE_COLUMNS ? columns[column].name : "?";
}

static double speed_of(const jolon_Entity *entity)
{
    double x = (double)entity->vx_mps, y = (double)entity->vy_mps, z = (double)entity->vz_mps;
    return sqrt(x * x + y * y + z * z);
}

/* What a column of numbers says; NAN of the others. */
static double number_of(const jolon_Entity *entity, enum table_column column)
{
    switch (column) {
    case TABLE_ID:
        return (double)entity->id;
    case TABLE_DAMAGE:
        return (double)entity->damage;
    case TABLE_SPEED:
        return speed_of(entity);
    case TABLE_HEADING:
        return (double)entity->heading_rad * DEG_PER_RAD;
    case TABLE_X:
        return entity->x_m;
    case TABLE_Z:
        return entity->z_m;
    case TABLE_ROUNDS:
        return (double)entity->rounds;
    case TABLE_FUEL:
        return (double)entity->fuel_l;
    default:
        return NAN;
    }
}

static const char *word_of(const struct mirror *mirror, const jolon_Entity *entity,
                           enum table_column column)
{
    switch (column) {
    case TABLE_KIND:
        return mirror_kind_name(mirror, entity->kind);
    case TABLE_FORCE:
        return force_name((enum force)entity->force);
    case TABLE_BEHAVIOUR:
        return behaviour_name((enum behaviour)entity->behaviour);
    case TABLE_DAMAGE:
        return damage_name((enum damage)entity->damage);
    default:
        return "";
    }
}

static bool holds(const char *text, const char *part, size_t length)
{
    size_t room = strlen(text);
    for (size_t at = 0; length <= room && at <= room - length; at++) {
        if (strncasecmp(text + at, part, length) == 0)
            return true;
    }
    return false;
}

/* "speed>10": the sign is at word + sign. A column that there is not, or no number, suits none. */
static bool compares(const jolon_Entity *entity, const char *word, size_t sign, size_t length)
{
    char text[TABLE_FILTER_MAX], *end;
    memcpy(text, word + sign + 1, length - sign - 1);
    text[length - sign - 1] = '\0';
    double limit = strtod(text, &end);
    if (end == text || *end)
        return false;
    for (int i = 0; i < TABLE_COLUMNS; i++) {
        double value = number_of(entity, (enum table_column)i);
        if (strlen(columns[i].name) == sign && strncasecmp(columns[i].name, word, sign) == 0)
            return word[sign] == '<' ? value < limit : value > limit;
    }
    return false;
}

static bool word_suits(const struct mirror *mirror, const jolon_Entity *entity, const char *word,
                       size_t length)
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
    for (int i = TABLE_KIND; i <= TABLE_DAMAGE; i++) {
        if (holds(word_of(mirror, entity, (enum table_column)i), word, length))
            return true;
    }
    return holds(entity_state_name((enum entity_state)entity->state), word, length) ||
           holds(names_of(&mirror->names, entity->id), word, length);
}

bool table_suits(const struct mirror *mirror, const jolon_Entity *entity, const char *filter)
{
    bool flight = entity->behaviour == jolon_BEHAVIOUR_FLIGHT, asked = false;
    while (*filter) {
        size_t length = strcspn(filter, " ");
        if (length >= TABLE_FILTER_MAX ||
            (length > 0 && !word_suits(mirror, entity, filter, length)))
            return false; /* nothing has so long a name */
        asked |= length == 6 && strncasecmp(filter, "flight", length) == 0;
        filter += length;
        filter += strspn(filter, " ");
    }
    return asked || !flight;
}

struct order {
    const struct mirror *mirror;
    enum table_column sort;
    bool descending;
};

static int compare(const void *a, const void *b, void *context)
{
    const struct order *order = context;
    const jolon_Entity *one = &order->mirror->batch.entity[*(const uint32_t *)a];
    const jolon_Entity *other = &order->mirror->batch.entity[*(const uint32_t *)b];
    double x = number_of(one, order->sort), y = number_of(other, order->sort);
    int sign = isnan(x) ? strcmp(word_of(order->mirror, one, order->sort),
                                 word_of(order->mirror, other, order->sort))
                        : (x > y) - (x < y);
    if (sign == 0)
        return (one->id > other->id) - (one->id < other->id);
    return order->descending ? -sign : sign;
}

bool table_build(struct table *table, const struct mirror *mirror, const char *filter,
                 enum table_column sort, bool descending)
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
        if (table_suits(mirror, &mirror->batch.entity[i], filter))
            table->row[table->count++] = i;
    }
    if (table->count > 1)
        qsort_r(table->row, table->count, sizeof *table->row, compare, &order);
    return true;
}

void table_free(struct table *table)
{
    free(table->row);
    *table = (struct table){0};
}

uint32_t table_find(const struct table *table, const struct mirror *mirror, uint32_t id)
{
    uint32_t at = 0;
    while (at < table->count && mirror->batch.entity[table->row[at]].id != id)
        at++;
    return at;
}

void table_head(char line[TABLE_LINE_MAX], enum table_column sort, bool descending)
{
    size_t used = 0;
    for (int i = 0; i < TABLE_COLUMNS; i++) {
        char arrow = (int)sort != i ? ' ' : descending ? 'v' : '^';
        /* Beside a name that leaves room in its column, else in the gap behind it. */
        bool inside = columns[i].width < -(int)strlen(columns[i].name);
        char name[24];
        (void)snprintf(name, sizeof name, "%s%c", columns[i].name, inside ? arrow : '\0');
        used += (size_t)snprintf(line + used, TABLE_LINE_MAX - used, "%*s%c", columns[i].width,
                                 name, inside ? ' ' : arrow);
    }
}

void table_line(char line[TABLE_LINE_MAX], const struct mirror *mirror, const jolon_Entity *entity)
{
    (void)snprintf(
        line, TABLE_LINE_MAX, "%6u %-12.12s %-7s %-9.9s %-9s %5.1f %3.0f %5.0f %5.0f %4u %5.0f %s",
        entity->id, mirror_kind_name(mirror, entity->kind), force_name((enum force)entity->force),
        behaviour_name((enum behaviour)entity->behaviour),
        entity->state == jolon_ENTITY_WRECK ? "wreck" : damage_name((enum damage)entity->damage),
        speed_of(entity), floor((double)entity->heading_rad * DEG_PER_RAD), entity->x_m,
        entity->z_m, entity->rounds > 9999 ? 9999 : entity->rounds, (double)entity->fuel_l,
        names_of(&mirror->names, entity->id));
}
