/* Lists of a scenario: counted first, then allocated once, then read. */
#include "config/lists.h"

#include "config/schema.h"
#include "world/square.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DOMAIN_BIT(domain) (1u << (domain))
#define DOMAINS_VEHICLE    (DOMAIN_BIT(DOMAIN_LAND) | DOMAIN_BIT(DOMAIN_SEA) | DOMAIN_BIT(DOMAIN_AIR))

/* Leaves room for "-1048576", the largest count. */
#define SHARED_NAME_MAX 15

/* One entry on its way from the file. */
struct entry {
    struct scenario *scenario;
    const config_setting_t *setting;
    struct key_reading keys;
    char path[KEY_PATH_MAX]; /* "vehicles[3]" */
    struct loader_message *message;
};

static bool is_given(const struct entry *entry, uint32_t key)
{
    return (entry->keys.given >> key & 1u) != 0;
}

/* Refuses the value of one of the entry's keys; value NULL: what the file says there. */
static int refuse(const struct entry *entry, uint32_t key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static int refuse(const struct entry *entry, uint32_t key, const char *format, ...)
{
    const char *name = entry->keys.table->keys[key].name;
    const config_setting_t *setting = config_setting_get_member(entry->setting, name);
    struct key_place place = {entry->keys.file, (int)config_setting_source_line(entry->setting)};
    char path[KEY_PATH_MAX + 24], value[80], text[512];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    snprintf(path, sizeof(path), "%s.%s", entry->path, name);
    if (setting != NULL) {
        place.line = (int)config_setting_source_line(setting);
        keys_value_text(setting, value, sizeof(value));
    }
    return keys_refuse(entry->message, place, path, setting != NULL ? value : NULL, "%s", text);
}

/* Names of the kinds of these domains, for messages. */
static void name_kinds(const struct scenario *scenario, unsigned domains, char *text, size_t bytes)
{
    size_t used = 0;

    text[0] = '\0';
    for (uint32_t i = 0; i < scenario->kind_count && used < bytes; i++) {
        const struct kind *kind = &scenario->kinds[i];

        if ((domains & DOMAIN_BIT(kind->domain)) != 0)
            used += (size_t)snprintf(text + used, bytes - used, "%s%s", used > 0 ? ", " : "",
                                     kind->name);
    }
}

/* Index of a kind of one of these domains, KIND_NONE with the message. */
static uint16_t find_kind(const struct entry *entry, uint32_t key, const char *name,
                          unsigned domains)
{
    const struct scenario *scenario = entry->scenario;
    uint16_t kind = kind_find(scenario->kinds, scenario->kind_count, name);
    char names[400];

    if (kind != KIND_NONE && (domains & DOMAIN_BIT(scenario->kinds[kind].domain)) != 0)
        return kind;
    name_kinds(scenario, domains, names, sizeof(names));
    refuse(entry, key, "%s; allowed: %s",
           kind == KIND_NONE ? "unknown kind" : "is not a kind for this list", names);
    return KIND_NONE;
}

/* Prepares the entry, sets defaults and reads what the file gives. */
static int read_entry(struct entry *entry, const struct key_table *table, int index,
                      const config_setting_t *list, void *destination)
{
    const config_setting_t *setting = config_setting_get_elem(list, (unsigned)index);

    entry->setting = setting;
    entry->keys.table = table;
    entry->keys.destination = destination;
    entry->keys.given = 0;
    snprintf(entry->path, sizeof(entry->path), "%s[%d]", table->path, index);
    if (setting->type != CONFIG_TYPE_GROUP) {
        const struct key_place place = {entry->keys.file, (int)config_setting_source_line(setting)};
        char value[80];

        keys_value_text(setting, value, sizeof(value));
        return keys_refuse(entry->message, place, entry->path, value,
                           "is not a group; allowed: { key = value; ... }");
    }
    if (keys_defaults(table, destination, entry->message) != 0)
        return -1;
    return keys_read(&entry->keys, setting, "", entry->path, entry->message);
}

/* How many entries a list has, -1 with the message when it is none or too long. */
static int list_length(const config_setting_t *list, const char *file, int max,
                       struct loader_message *message)
{
    const struct key_place place = {file, (int)config_setting_source_line(list)};
    char value[80];

    keys_value_text(list, value, sizeof(value));
    if (list->type != CONFIG_TYPE_LIST)
        return keys_refuse(message, place, config_setting_name(list), value,
                           "is not a list; allowed: ( { key = value; ... }, ... )");
    if (config_setting_length(list) > max)
        return keys_refuse(message, place, config_setting_name(list), value,
                           "has %d entries; allowed: up to %d", config_setting_length(list), max);
    return config_setting_length(list);
}

/* Space for count items; NULL with the message. At least one, so that NULL means failure. */
static void *allocate(uint32_t count, size_t size, const char *file, struct loader_message *message)
{
    const struct key_place place = {file, 0};
    void *memory = calloc((size_t)count + 1, size);

    if (memory == NULL)
        keys_refuse(message, place, NULL, NULL, "no memory for its lists");
    return memory;
}

/* --- vehicles ----------------------------------------------------------------------------------
 */

static int check_vehicle(const struct entry *entry, const struct vehicle_entry *vehicle,
                         uint64_t total)
{
    bool placed = is_given(entry, VEHICLE_AT);

    if (placed && vehicle->count != 1)
        return refuse(entry, VEHICLE_COUNT, "stands beside at, which places one; allowed: 1");
    total += vehicle->count;
    if (total > entry->scenario->params.capacity)
        return refuse(entry, VEHICLE_COUNT,
                      "makes %llu vehicles in all; allowed: up to world.capacity, %u",
                      (unsigned long long)total, entry->scenario->params.capacity);
    if (vehicle->count > 1 && strlen(vehicle->name) > SHARED_NAME_MAX)
        return refuse(entry, VEHICLE_NAME,
                      "is too long for several vehicles, whose names end in \"-1\" and so on; "
                      "allowed: up to %d characters",
                      SHARED_NAME_MAX);
    return 0;
}

/* patrol roams, a placed vehicle waits, one with a route follows it - unless the entry says. */
static int choose_behaviour(const struct entry *entry, struct vehicle_entry *vehicle)
{
    bool route = is_given(entry, VEHICLE_ROUTE);

    if (!is_given(entry, VEHICLE_BEHAVIOUR))
        vehicle->behaviour = route                         ? BEHAVIOUR_ROUTE
                             : is_given(entry, VEHICLE_AT) ? BEHAVIOUR_IDLE
                                                           : BEHAVIOUR_PATROL;
    if (vehicle->behaviour == BEHAVIOUR_ROUTE && !route)
        return refuse(entry, VEHICLE_BEHAVIOUR,
                      "has no route; right would be: route = ( [x, z], "
                      "[x, z] )");
    if (vehicle->behaviour != BEHAVIOUR_ROUTE && route)
        return refuse(entry, VEHICLE_ROUTE, "is only followed with behaviour = \"route\"");
    return 0;
}

/* The entry's route is appended to the scenario's, whose space was counted before. */
static uint32_t add_route(struct scenario *scenario, const config_setting_t *points)
{
    struct route *route = &scenario->routes[scenario->route_count];

    route->first = scenario->route_point_count;
    route->count = (uint32_t)config_setting_length(points);
    for (uint32_t i = 0; i < route->count; i++) {
        double point[2] = {0, 0};

        keys_point(config_setting_get_elem(points, i), point);
        scenario->route_points[scenario->route_point_count++] =
            (struct route_point){point[0], point[1]};
    }
    return scenario->route_count++;
}

static int add_vehicle(struct entry *entry, struct vehicle_entry *vehicle)
{
    struct scenario *scenario = entry->scenario;
    struct scenario_group *group = &scenario->groups[scenario->group_count];
    uint32_t total = scenario->params.initial_entities;

    if (choose_behaviour(entry, vehicle) != 0 || check_vehicle(entry, vehicle, total) != 0)
        return -1;
    group->kind = find_kind(entry, VEHICLE_KIND, vehicle->kind, DOMAINS_VEHICLE);
    if (group->kind == KIND_NONE)
        return -1;
    memcpy(group->name, vehicle->name, sizeof(group->name));
    group->force = (uint8_t)vehicle->force;
    group->behaviour = (uint8_t)vehicle->behaviour;
    group->fire_at_will = (uint8_t)vehicle->fire_at_will;
    group->placed = is_given(entry, VEHICLE_AT);
    group->turned = is_given(entry, VEHICLE_HEADING);
    group->moving = is_given(entry, VEHICLE_SPEED);
    group->floating = is_given(entry, VEHICLE_ALTITUDE);
    group->count = vehicle->count;
    group->x = vehicle->at[0];
    group->z = vehicle->at[1];
    group->altitude_m = vehicle->altitude_m;
    group->heading_rad =
        vehicle->heading_rad < 0 ? vehicle->heading_rad + TWO_PI : vehicle->heading_rad;
    group->speed_mps = vehicle->speed_mps;
    group->area = 0;
    if (is_given(entry, VEHICLE_AREA)) {
        const double *area = vehicle->area;

        group->area = scenario->area_count++;
        scenario->areas[group->area] = (struct area){area[0], area[1], area[2], area[3]};
    }
    group->route = vehicle->route != NULL ? add_route(scenario, vehicle->route) : UINT32_MAX;
    scenario->params.initial_entities += vehicle->count;
    scenario->group_count++;
    return 0;
}

/* Upper bound of the points of all routes, so that one allocation holds them. */
static uint32_t count_points(const config_setting_t *list)
{
    uint64_t points = 0;

    for (int i = 0; list != NULL && i < config_setting_length(list); i++) {
        const config_setting_t *entry = config_setting_get_elem(list, (unsigned)i);
        const config_setting_t *route =
            entry->type == CONFIG_TYPE_GROUP ? config_setting_get_member(entry, "route") : NULL;

        if (route != NULL && config_setting_length(route) > 0)
            points += (uint64_t)config_setting_length(route);
    }
    return points > SCHEMA_ROUTE_POINTS_MAX ? UINT32_MAX : (uint32_t)points;
}

int lists_vehicles(struct scenario *scenario, const config_setting_t *list, const char *file,
                   struct loader_message *message)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .message = message};
    int length = list != NULL ? list_length(list, file, SCHEMA_GROUPS_MAX, message) : 0;
    uint32_t points = length > 0 ? count_points(list) : 0;

    if (length < 0)
        return -1;
    if (points > SCHEMA_ROUTE_POINTS_MAX) {
        const struct key_place place = {file, (int)config_setting_source_line(list)};

        return keys_refuse(message, place, "vehicles", NULL,
                           "routes have too many points; allowed: up to %u in all",
                           SCHEMA_ROUTE_POINTS_MAX);
    }
    uint32_t count = (uint32_t)length;
    scenario->groups = allocate(count, sizeof(*scenario->groups), file, message);
    scenario->areas = allocate(count + 1, sizeof(*scenario->areas), file, message);
    scenario->routes = allocate(count, sizeof(*scenario->routes), file, message);
    scenario->route_points = allocate(points, sizeof(*scenario->route_points), file, message);
    if (scenario->groups == NULL || scenario->areas == NULL || scenario->routes == NULL ||
        scenario->route_points == NULL)
        return -1;
    scenario->areas[scenario->area_count++] = (struct area){0.0, 0.0, WORLD_SIDE_M, WORLD_SIDE_M};
    scenario->params.initial_entities = 0;
    for (int i = 0; i < length; i++) {
        struct vehicle_entry vehicle;

        memset(&vehicle, 0, sizeof(vehicle));
        if (read_entry(&entry, &schema_vehicle, i, list, &vehicle) != 0 ||
            add_vehicle(&entry, &vehicle) != 0)
            return -1;
    }
    return 0;
}

/* --- fixed objects -----------------------------------------------------------------------------
 */

int lists_objects(struct scenario *scenario, const config_setting_t *list, const char *file,
                  struct loader_message *message)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .message = message};
    int length = list != NULL ? list_length(list, file, SCHEMA_OBJECTS_MAX, message) : 0;

    if (length < 0)
        return -1;
    scenario->object_list =
        allocate((uint32_t)length, sizeof(*scenario->object_list), file, message);
    if (scenario->object_list == NULL)
        return -1;
    for (int i = 0; i < length; i++) {
        struct object_entry object;

        memset(&object, 0, sizeof(object));
        if (read_entry(&entry, &schema_object, i, list, &object) != 0)
            return -1;
        uint16_t kind = find_kind(&entry, OBJECT_KEY_KIND, object.kind, DOMAIN_BIT(DOMAIN_FIXED));
        if (kind == KIND_NONE)
            return -1;
        scenario->object_list[scenario->object_count++] =
            (struct scenario_object){kind, object.at[0], object.at[1], object.heading_rad};
    }
    return 0;
}

/* --- names -------------------------------------------------------------------------------------
 */

/* Named groups in the order of their names, for looking up. */
struct named {
    const struct scenario_group **group;
    uint32_t count;
};

static int compare_groups(const void *a, const void *b)
{
    const struct scenario_group *const *left = a, *const *right = b;

    int order = strcmp((*left)->name, (*right)->name);

    return order != 0 ? order : (*left > *right) - (*left < *right); /* then the file's order */
}

static const struct scenario_group *find_group(const struct named *named, const char *name)
{
    uint32_t low = 0, high = named->count;

    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        int order = strcmp(named->group[middle]->name, name);

        if (order == 0)
            return named->group[middle];
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

/* The group of several whose member is called name: "tank-3" of three or more "tank". */
static const struct scenario_group *find_of_many(const struct named *named, const char *name)
{
    const char *dash = strrchr(name, '-');
    char base[ENTITY_NAME_MAX], again[2 * ENTITY_NAME_MAX];

    if (dash == NULL)
        return NULL;
    snprintf(base, sizeof(base), "%.*s", (int)(dash - name), name);
    const struct scenario_group *group = find_group(named, base);
    unsigned long number = strtoul(dash + 1, NULL, 10);
    snprintf(again, sizeof(again), "%s-%lu", base, number);
    if (group == NULL || group->count == 1 || number < 1 || number > group->count ||
        strcmp(again, name) != 0)
        return NULL;
    return group;
}

/* The group that the vehicle called name comes from, NULL when no vehicle is. */
static const struct scenario_group *find_vehicle(const struct named *named, const char *name)
{
    const struct scenario_group *group = find_group(named, name);

    return group != NULL && group->count == 1 ? group : find_of_many(named, name);
}

/* Sorts the named groups and refuses a name that two vehicles would have. */
static int collect_names(struct named *named, const struct scenario *scenario,
                         const config_setting_t *vehicles, const char *file,
                         struct loader_message *message)
{
    named->count = 0;
    named->group = allocate(scenario->group_count, sizeof(*named->group), file, message);
    if (named->group == NULL)
        return -1;
    for (uint32_t i = 0; i < scenario->group_count; i++) {
        if (scenario->groups[i].name[0] != '\0')
            named->group[named->count++] = &scenario->groups[i];
    }
    qsort(named->group, named->count, sizeof(*named->group), compare_groups);
    for (uint32_t i = 0; i < named->count; i++) {
        const struct scenario_group *group = named->group[i];
        uint32_t index = (uint32_t)(group - scenario->groups);
        char path[KEY_PATH_MAX];

        if (!(i > 0 && strcmp(named->group[i - 1]->name, group->name) == 0) &&
            !(group->count == 1 && find_of_many(named, group->name) != NULL))
            continue;
        const config_setting_t *name =
            config_setting_get_member(config_setting_get_elem(vehicles, index), "name");
        const struct key_place place = {file, (int)config_setting_source_line(name)};
        snprintf(path, sizeof(path), "vehicles[%u].name", index);
        return keys_refuse(message, place, path, group->name,
                           "is another vehicle's name too; allowed: each name once");
    }
    return 0;
}

/* --- ordered shots -----------------------------------------------------------------------------
 */

static int check_fire(const struct entry *entry, const struct fire_entry *fire,
                      const struct named *named, uint16_t *munition)
{
    const struct kind *kinds = entry->scenario->kinds;
    const struct scenario_group *shooter = find_vehicle(named, fire->shooter);

    *munition = KIND_NONE;
    if (is_given(entry, FIRE_SHOOTER) && shooter == NULL)
        return refuse(entry, FIRE_SHOOTER, "is no vehicle's name; allowed: a name of vehicles");
    if (is_given(entry, FIRE_TARGET) && find_vehicle(named, fire->target) == NULL)
        return refuse(entry, FIRE_TARGET, "is no vehicle's name; allowed: a name of vehicles");
    if (is_given(entry, FIRE_TARGET) == is_given(entry, FIRE_POINT))
        return refuse(entry, FIRE_TARGET,
                      "a shot goes to a target or to a point; allowed: one of "
                      "target and point");
    if (is_given(entry, FIRE_MUNITION)) {
        *munition = find_kind(entry, FIRE_MUNITION, fire->munition, DOMAIN_BIT(DOMAIN_MUNITION));
        return *munition == KIND_NONE ? -1 : 0;
    }
    if (shooter == NULL)
        return refuse(entry, FIRE_MUNITION,
                      "is missing; a shot without a shooter needs the munition that falls");
    if (kinds[shooter->kind].munition == KIND_NONE)
        return refuse(entry, FIRE_SHOOTER,
                      "is a %s, which has no munition; right would be: one "
                      "that has, or a munition here",
                      kinds[shooter->kind].name);
    return 0;
}

int lists_fires(struct scenario *scenario, const config_setting_t *list,
                const config_setting_t *vehicles, const char *file, struct loader_message *message)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .message = message};
    int length = list != NULL ? list_length(list, file, SCHEMA_FIRES_MAX, message) : 0;
    struct named named = {NULL, 0};
    int result = -1;

    if (length < 0)
        return -1;
    scenario->fires = allocate((uint32_t)length, sizeof(*scenario->fires), file, message);
    if (scenario->fires == NULL || collect_names(&named, scenario, vehicles, file, message) != 0)
        goto err_names;
    for (int i = 0; i < length; i++) {
        struct fire_entry fire;
        uint16_t munition;

        memset(&fire, 0, sizeof(fire));
        if (read_entry(&entry, &schema_fire, i, list, &fire) != 0 ||
            check_fire(&entry, &fire, &named, &munition) != 0)
            goto err_names;
        struct scenario_fire *to = &scenario->fires[scenario->fire_count++];
        memcpy(to->shooter, fire.shooter, sizeof(to->shooter));
        memcpy(to->target, fire.target, sizeof(to->target));
        to->at_s = fire.at_s;
        to->munition = munition;
        to->x = fire.point[0];
        to->z = fire.point[1];
        to->line = (int)config_setting_source_line(entry.setting);
    }
    result = 0;
err_names:
    free(named.group);
    return result;
}
