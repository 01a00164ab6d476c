/* Replaces places that are texts by metres. */
#include "config/places.h"

#include "config/syntax/key_table.h"
#include "config/syntax/schema.h"
#include "world/earth_location.h"
#include "world/maths/maths.h"

#include <stdio.h>
#include <string.h>

/* A scenario while its places are replaced. */
struct conversion {
    const char *file;
    struct location_frame frame;
    struct error_text *error;
};

/* The lists of a scenario, at its top and within entries, and the keys of their entries. */
static const struct {
    const char *name;
    const struct key_table *keys;
} lists[] = {
    {"vehicles", &schema_vehicle},     {"scripts", &schema_script},   {"steps", &schema_step},
    {"objectives", &schema_objective}, {"missions", &schema_mission}, {"phases", &schema_phase},
    {"earthworks", &schema_earthwork}, {"bases", &schema_base},       {"objects", &schema_object},
    {"fires", &schema_fire},
};

static int refuse(const struct conversion *c, const config_setting_t *setting, const char *path,
                  const char *reason)
{
    const struct key_place place = {c->file, (int)config_setting_source_line(setting)};
    return key_table_refuse(c->error, place, path, NULL, "%s", reason);
}

static bool is_text(const config_setting_t *setting)
{
    return setting && config_setting_type(setting) == CONFIG_TYPE_STRING;
}

/* Appends [x, z] to a list. The number of the line stays that of the text. */
static int add_point(config_setting_t *list, const double point[2])
{
    for (int i = 0; i < 2; i++) {
        config_setting_t *number = config_setting_add(list, NULL, CONFIG_TYPE_FLOAT);
        if (!number || !config_setting_set_float(number, point[i]))
            return -1;
    }
    return 0;
}

static int read_point(const struct conversion *c, const config_setting_t *setting, const char *path,
                      double point[2])
{
    struct location place;
    struct error_text reason;
    if (location_read(&place, config_setting_get_string(setting), &reason) != 0 ||
        location_world(&place, &c->frame, &point[0], &point[1], &reason) != 0)
        return refuse(c, setting, path, reason.text);
    return 0;
}

/* Puts a list in the place of a member of a group. */
static config_setting_t *replace(config_setting_t *group, const char *name, unsigned line)
{
    if (!config_setting_remove(group, name))
        return NULL;
    config_setting_t *list = config_setting_add(group, name, CONFIG_TYPE_LIST);
    if (list)
        list->line = line;
    return list;
}

static int convert_point(const struct conversion *c, config_setting_t *group, const char *name,
                         const char *path)
{
    config_setting_t *setting = config_setting_get_member(group, name);
    double point[2];
    if (!is_text(setting))
        return 0;
    if (read_point(c, setting, path, point) != 0)
        return -1;
    config_setting_t *list = replace(group, name, config_setting_source_line(setting));
    return list && add_point(list, point) == 0 ? 0 : refuse(c, group, path, "no memory");
}

/* Two corners of an area, in any order. */
static int convert_area(const struct conversion *c, config_setting_t *group, const char *name,
                        const char *path)
{
    config_setting_t *setting = config_setting_get_member(group, name);
    double one[2], other[2];
    if (!setting || !config_setting_is_aggregate(setting) || config_setting_length(setting) != 2 ||
        !is_text(config_setting_get_elem(setting, 0)) ||
        !is_text(config_setting_get_elem(setting, 1)))
        return 0;
    if (read_point(c, config_setting_get_elem(setting, 0), path, one) != 0 ||
        read_point(c, config_setting_get_elem(setting, 1), path, other) != 0)
        return -1;
    const double low[2] = {maths_min(one[0], other[0]), maths_min(one[1], other[1])};
    const double high[2] = {maths_max(one[0], other[0]), maths_max(one[1], other[1])};
    config_setting_t *list = replace(group, name, config_setting_source_line(setting));
    return list && add_point(list, low) == 0 && add_point(list, high) == 0
               ? 0
               : refuse(c, group, path, "no memory");
}

/* A route may have places of both sorts. The list is written again behind its own end, where a
 * point is a list of its own. */
static int convert_route(const struct conversion *c, config_setting_t *group, const char *name,
                         const char *path)
{
    config_setting_t *route = config_setting_get_member(group, name);
    int count = route && config_setting_is_aggregate(route) ? config_setting_length(route) : 0;
    bool texts = false;
    for (int i = 0; i < count; i++)
        texts |= is_text(config_setting_get_elem(route, (unsigned)i));
    if (!texts)
        return 0;
    if (config_setting_is_array(route))
        route->type = CONFIG_TYPE_LIST; /* an array of texts takes no points */
    for (int i = 0; i < count; i++) {
        const config_setting_t *element = config_setting_get_elem(route, (unsigned)i);
        char element_path[KEY_PATH_MAX + 40];
        double point[2];
        (void)snprintf(element_path, sizeof element_path, "%s[%d]", path, i);
        if (is_text(element) ? read_point(c, element, element_path, point) != 0
                             : !key_table_point(element, point))
            return is_text(element) ? -1
                                    : refuse(c, element, element_path,
                                             "is neither [x, z] nor a place in quotes");
        config_setting_t *list = config_setting_add(route, NULL, CONFIG_TYPE_LIST);
        if (!list || add_point(list, point) != 0)
            return refuse(c, route, path, "no memory");
        list->line = config_setting_source_line(element);
    }
    for (int i = 0; i < count; i++)
        (void)config_setting_remove_elem(route, 0);
    return 0;
}

static int convert_list(const struct conversion *c, config_setting_t *list,
                        const struct key_table *keys, const char *within);

/* Converts the keys of an entry, then those of the lists in it. */
static int convert_entry(const struct conversion *c, config_setting_t *entry,
                         const struct key_table *keys, const char *within)
{
    for (uint32_t i = 0; i < keys->count; i++) {
        const struct key *key = &keys->keys[i];
        char path[KEY_PATH_MAX + 24];
        int result = 0;
        (void)snprintf(path, sizeof path, "%.90s.%.24s", within, key->name);
        if (key->type == KEY_POINT)
            result = convert_point(c, entry, key->name, path);
        else if (key->type == KEY_AREA)
            result = convert_area(c, entry, key->name, path);
        else if (key->type == KEY_ROUTE)
            result = convert_route(c, entry, key->name, path);
        if (result != 0)
            return -1;
    }
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        config_setting_t *list = config_setting_get_member(entry, lists[i].name);
        char path[KEY_PATH_MAX];
        (void)snprintf(path, sizeof path, "%.60s%s%.24s", within, *within ? "." : "",
                       lists[i].name);
        if (list && convert_list(c, list, lists[i].keys, path) != 0)
            return -1;
    }
    return 0;
}

static int convert_list(const struct conversion *c, config_setting_t *list,
                        const struct key_table *keys, const char *within)
{
    int count = config_setting_is_list(list) ? config_setting_length(list) : 0;
    for (int i = 0; i < count; i++) {
        config_setting_t *entry = config_setting_get_elem(list, (unsigned)i);
        char path[KEY_PATH_MAX];
        (void)snprintf(path, sizeof path, "%.80s[%d]", within, i);
        if (config_setting_is_group(entry) && convert_entry(c, entry, keys, path) != 0)
            return -1;
    }
    return 0;
}

int places_convert(config_t *config, const char *file, const struct params *params, double side_m,
                   struct error_text *error)
{
    struct conversion c = {.file = file, .error = error};
    static const struct key_table none = {.path = ""};
    earth_location_frame(&c.frame, params, side_m);
    return convert_entry(&c, config_root_setting(config), &none, "");
}
