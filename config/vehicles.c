/* Reads the list of vehicles. */
#include "config/vehicles.h"

#include "config/scripts.h"
#include "config/syntax/entry.h"
#include "config/syntax/schema.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stdio.h>
#include <string.h>

/* The rest of the name has room for "-1048576", the largest number of a vehicle. */
#define SHARED_NAME_MAX 15

static int check_vehicle(const struct entry *entry, const struct vehicle_entry *vehicle,
                         uint64_t total)
{
    bool placed = entry_given(entry, VEHICLE_AT);
    if (placed && vehicle->count != 1 && !entry_given(entry, VEHICLE_FORMATION))
        return entry_refuse(entry, VEHICLE_COUNT,
                            "is not 1, but at places one vehicle; allowed: 1, or a formation");
    total += vehicle->count;
    if (total > entry->scenario->settings->params.capacity)
        return entry_refuse(entry, VEHICLE_COUNT,
                            "makes %llu vehicles in all; allowed: up to world.capacity, %u",
                            (unsigned long long)total, entry->scenario->settings->params.capacity);
    if (vehicle->count > 1 && strlen(vehicle->name) > SHARED_NAME_MAX)
        return entry_refuse(
            entry, VEHICLE_NAME,
            "is too long for several vehicles, whose names end in \"-1\" and so on; "
            "allowed: up to %d characters",
            SHARED_NAME_MAX);
    return 0;
}

/* Sets the vehicles' rule of engagement. The key engage and the older key fire_at_will may both be
 * given if they agree. */
static int choose_engagement(const struct entry *entry, const struct vehicle_entry *vehicle,
                             struct scenario_group *group)
{
    bool engage = entry_given(entry, VEHICLE_ENGAGE);
    bool at_will = engage ? vehicle->engage == ENTITY_FLAG_FIRE_AT_WILL : vehicle->fire_at_will;
    if (entry_given(entry, VEHICLE_FIRE_AT_WILL) && at_will != (vehicle->fire_at_will != 0))
        return entry_refuse(entry, VEHICLE_FIRE_AT_WILL,
                            "contradicts engage; allowed: %s here, or engage alone",
                            at_will ? "true" : "false");
    group->flags =
        (uint8_t)((engage ? vehicle->engage : 0) | (at_will ? ENTITY_FLAG_FIRE_AT_WILL : 0) |
                  (vehicle->stand ? ENTITY_FLAG_STAND : 0));
    return 0;
}

/* The first vehicle of an entry with a formation leads it. The entries directly after it may hold
 * its followers. */
static int choose_formation(const struct entry *entry, const struct vehicle_entry *vehicle,
                            struct scenario_group *group)
{
    bool follows = vehicle->behaviour == BEHAVIOUR_FOLLOW;
    bool formation = entry_given(entry, VEHICLE_FORMATION);
    if (follows && (entry->scenario->group_count == 0 || !group[-1].formed))
        return entry_refuse(entry, VEHICLE_BEHAVIOUR,
                            "has no leader to follow; right would be: an entry directly after one "
                            "with a formation");
    if (follows && (formation || entry_given(entry, VEHICLE_AT)))
        return entry_refuse(
            entry, formation ? VEHICLE_FORMATION : VEHICLE_AT,
            "is set by the leader of the formation; right would be: an entry without it");
    if (follows && group[-1].force != vehicle->force)
        return entry_refuse(
            entry, VEHICLE_FORCE,
            "is not the force of its leader; right would be: the force of the entry "
            "before");
    if (entry_given(entry, VEHICLE_SPACING) && !formation)
        return entry_refuse(entry, VEHICLE_SPACING,
                            "is only for a formation; right would be: formation beside it");
    group->formed = formation || follows;
    group->shape = vehicle->formation;
    group->spacing_m = vehicle->spacing_m;
    return 0;
}

/* Sets the behaviour of an entry that names none: script with a script, else route with a route,
 * else idle at a given place, else patrol. */
static int choose_behaviour(const struct entry *entry, struct vehicle_entry *vehicle)
{
    bool route = entry_given(entry, VEHICLE_ROUTE), script = entry_given(entry, VEHICLE_SCRIPT);
    if (!entry_given(entry, VEHICLE_BEHAVIOUR))
        vehicle->behaviour = script                           ? BEHAVIOUR_SCRIPT
                             : route                          ? BEHAVIOUR_ROUTE
                             : entry_given(entry, VEHICLE_AT) ? BEHAVIOUR_IDLE
                                                              : BEHAVIOUR_PATROL;
    if (vehicle->behaviour == BEHAVIOUR_ROUTE && !route)
        return entry_refuse(entry, VEHICLE_BEHAVIOUR,
                            "needs a route; right would be: route = ( [x, z], [x, z] )");
    if (vehicle->roads && !route)
        return entry_refuse(entry, VEHICLE_ROADS,
                            "needs a route; right would be: route = ( [x, z], [x, z] )");
    if (vehicle->behaviour == BEHAVIOUR_SCRIPT && !script)
        return entry_refuse(
            entry, VEHICLE_BEHAVIOUR,
            "needs a script; right would be: script = \"NAME\", with a name of scripts");
    if (vehicle->behaviour != BEHAVIOUR_SCRIPT && script)
        return entry_refuse(entry, VEHICLE_SCRIPT, "is only followed with behaviour = \"script\"");
    if (vehicle->behaviour != BEHAVIOUR_ROUTE && !script && route)
        return entry_refuse(entry, VEHICLE_ROUTE, "is only followed with behaviour = \"route\"");
    if (script && scripts_find(entry->scenario, vehicle->script) == UINT32_MAX)
        return entry_refuse(entry, VEHICLE_SCRIPT,
                            "is not the name of a script; allowed: a name of scripts");
    return 0;
}

/* Appends the entry's route to the scenario's routes, which have room for it (count_points()).
 * Returns its index. */
static uint32_t add_route(struct scenario *scenario, const config_setting_t *points)
{
    struct route *route = &scenario->routes[scenario->route_count];
    route->first = scenario->route_point_count;
    route->count = (uint32_t)config_setting_length(points);
    for (uint32_t i = 0; i < route->count; i++) {
        double point[2] = {0, 0};
        key_table_point(config_setting_get_elem(points, i), point);
        scenario->route_points[scenario->route_point_count++] =
            (struct route_point){point[0], point[1]};
    }
    return scenario->route_count++;
}

/* Checks what the kind cannot do. */
static int check_kind(const struct entry *entry, const struct vehicle_entry *vehicle,
                      const struct kind *kind)
{
    if (vehicle->roads && kind->domain == DOMAIN_SEA)
        return entry_refuse(entry, VEHICLE_ROADS,
                            "is not for a %s; allowed: false, or a kind of land or air",
                            kind->name);
    if (entry_given(entry, VEHICLE_ALTITUDE) && kind->domain != DOMAIN_AIR)
        return entry_refuse(entry, VEHICLE_ALTITUDE,
                            "is not for a %s, which does not fly; right would be: an entry "
                            "without it, or an aircraft",
                            kind->name);
    if (entry_given(entry, VEHICLE_SPEED) && vehicle->speed_mps < kind->min_speed_mps)
        return entry_refuse(entry, VEHICLE_SPEED,
                            "is too slow for a %s to fly; allowed: %.4g or more, or an entry "
                            "without it",
                            kind->name, kind->min_speed_mps);
    return 0;
}

static int add_vehicle(struct entry *entry, struct vehicle_entry *vehicle)
{
    struct scenario *scenario = entry->scenario;
    struct scenario_group *group = &scenario->groups[scenario->group_count];
    uint32_t total = scenario->settings->params.initial_entities;
    if (choose_behaviour(entry, vehicle) != 0 || check_vehicle(entry, vehicle, total) != 0 ||
        choose_engagement(entry, vehicle, group) != 0 ||
        choose_formation(entry, vehicle, group) != 0)
        return -1;
    group->kind = entry_kind(entry, VEHICLE_KIND, vehicle->kind, DOMAINS_VEHICLE);
    if (group->kind == KIND_NONE)
        return -1;
    if (check_kind(entry, vehicle, &scenario->kinds[group->kind]) != 0)
        return -1;
    memcpy(group->name, vehicle->name, sizeof(group->name));
    memcpy(group->squad, vehicle->group, sizeof(group->squad));
    group->force = (uint8_t)vehicle->force;
    group->behaviour = (uint8_t)vehicle->behaviour;
    group->script =
        entry_given(entry, VEHICLE_SCRIPT) ? scripts_find(scenario, vehicle->script) : UINT32_MAX;
    group->roads = (uint8_t)vehicle->roads;
    group->line = (int)config_setting_source_line(entry->setting);
    group->placed = entry_given(entry, VEHICLE_AT);
    group->turned = entry_given(entry, VEHICLE_HEADING);
    group->moving = entry_given(entry, VEHICLE_SPEED);
    group->floating = entry_given(entry, VEHICLE_ALTITUDE);
    group->count = vehicle->count;
    group->x = vehicle->at[0];
    group->z = vehicle->at[1];
    group->altitude_m = vehicle->altitude_m;
    group->heading_rad =
        vehicle->heading_rad < 0 ? vehicle->heading_rad + TWO_PI : vehicle->heading_rad;
    group->speed_mps = vehicle->speed_mps;
    group->area = 0;
    if (entry_given(entry, VEHICLE_AREA)) {
        const double *area = vehicle->area;
        group->area = scenario->area_count++;
        scenario->areas[group->area] = (struct area){area[0], area[1], area[2], area[3]};
    }
    group->route = vehicle->route != NULL ? add_route(scenario, vehicle->route) : UINT32_MAX;
    scenario->settings->params.initial_entities += vehicle->count;
    scenario->group_count++;
    return 0;
}

/* An upper bound of the points of all routes, for one allocation; UINT32_MAX for too many. */
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
    return points > ROUTE_POINTS_MAX ? UINT32_MAX : (uint32_t)points;
}

int vehicles_read(struct scenario *scenario, const config_setting_t *list, const char *file,
                  struct error_text *error)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .error = error};
    int length = list != NULL ? entry_count(list, file, SCHEMA_GROUPS_MAX, error) : 0;
    uint32_t points = length > 0 ? count_points(list) : 0;
    if (length < 0)
        return -1;
    if (points > ROUTE_POINTS_MAX) {
        const struct key_place place = {file, (int)config_setting_source_line(list)};
        return key_table_refuse(error, place, "vehicles", NULL,
                                "routes have too many points; allowed: up to %u in all",
                                ROUTE_POINTS_MAX);
    }
    uint32_t count = (uint32_t)length;
    scenario->groups = entry_allocate(count, sizeof(*scenario->groups), file, error);
    scenario->areas = entry_allocate(count + 1, sizeof(*scenario->areas), file, error);
    scenario->routes = entry_allocate(count, sizeof(*scenario->routes), file, error);
    scenario->route_points = entry_allocate(points, sizeof(*scenario->route_points), file, error);
    if (scenario->groups == NULL || scenario->areas == NULL || scenario->routes == NULL ||
        scenario->route_points == NULL)
        return -1;
    const double side_m = scenario->settings->side_m;
    scenario->areas[scenario->area_count++] = (struct area){0.0, 0.0, side_m, side_m};
    scenario->settings->params.initial_entities = 0;
    for (int i = 0; i < length; i++) {
        struct vehicle_entry vehicle;
        if (entry_read(&entry, &schema_vehicle, i, list, &vehicle) != 0 ||
            add_vehicle(&entry, &vehicle) != 0)
            return -1;
    }
    return 0;
}
