/* Reads the phases and the reactions of a mission. */
#include "config/mission_phases.h"

#include "config/missions.h"
#include "config/syntax/schema.h"
#include "world/making/scenario.h"
#include "world/world.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SPREAD_M 150.0 /* where the file has none */

/* Returns true if the mission has aircraft that cannot hover. */
static bool has_wings(const struct scenario *scenario, uint32_t mission)
{
    for (uint32_t g = 0; g < scenario->group_count; g++) {
        if (scenario->groups[g].mission == 1 + mission &&
            scenario->kinds[scenario->groups[g].kind].min_speed_mps > 0.0)
            return true;
    }
    return false;
}

/* Index of the objective that a key names, MISSION_NONE for none. -1 with the message. */
static int look_up(const struct entry *entry, uint32_t key, const char *name, uint32_t *index)
{
    *index = entry_given(entry, key) ? missions_objective(entry->scenario, name) : MISSION_NONE;
    if (entry_given(entry, key) && *index == MISSION_NONE)
        return entry_refuse(entry, key,
                            "is not the name of an objective; allowed: a name of objectives");
    return 0;
}

static bool goes(uint32_t order)
{
    return order == MISSION_MOVE || order == MISSION_BOUND || order == MISSION_ATTACK ||
           order == MISSION_DEFEND || order == MISSION_WITHDRAW || order == MISSION_RESUPPLY;
}

static bool needs_area(uint32_t order)
{
    return order == MISSION_ATTACK || order == MISSION_DEFEND || order == MISSION_PATROL ||
           order == MISSION_STRIKE || order == MISSION_BARRAGE;
}

static int check_places(const struct entry *entry, const struct phase_entry *given)
{
    bool area = entry_given(entry, PHASE_AREA), objective = entry_given(entry, PHASE_OBJECTIVE);
    bool to = entry_given(entry, PHASE_TO), route = entry_given(entry, PHASE_ROUTE);
    if (area && objective)
        return entry_refuse(entry, PHASE_OBJECTIVE, "stands beside area; allowed: one of the two");
    if (to && route)
        return entry_refuse(entry, PHASE_TO, "stands beside route; allowed: one of the two");
    if ((to || route) && !goes(given->order))
        return entry_refuse(entry, to ? PHASE_TO : PHASE_ROUTE,
                            "is not for this order; allowed: move, bound, attack, defend, "
                            "withdraw, resupply");
    if (needs_area(given->order) && !area && !objective)
        return entry_refuse(entry, PHASE_AREA,
                            "is missing; this order needs an area or an objective");
    if (goes(given->order) && !area && !objective && !to && !route)
        return entry_refuse(entry, PHASE_TO,
                            "is missing; this order needs to, a route, an area or an objective");
    if (given->roads && !route)
        return entry_refuse(entry, PHASE_ROADS,
                            "needs a route; right would be: route = ( [x, z], "
                            "[x, z] )");
    return 0;
}

static int check_order(const struct entry *entry, const struct phase_entry *given,
                       const struct scenario_mission *mission, bool wings)
{
    bool sky = entry_given(entry, PHASE_MUNITION);
    if (mission->off_map && given->order != MISSION_HOLD && given->order != MISSION_RESERVE &&
        !(given->order == MISSION_BARRAGE && sky))
        return entry_refuse(entry, PHASE_ORDER,
                            "needs vehicles, and the mission is off the map; allowed: hold, "
                            "reserve, barrage with a munition");
    if (wings && (given->order == MISSION_HOLD || given->order == MISSION_RESERVE))
        return entry_refuse(entry, PHASE_ORDER,
                            "is not for aircraft that cannot hover; right would be: patrol");
    if (sky && given->order != MISSION_BARRAGE)
        return entry_refuse(entry, PHASE_MUNITION, "is only for barrage; allowed: none here");
    if (entry_given(entry, PHASE_BOUND) && given->order != MISSION_BOUND)
        return entry_refuse(entry, PHASE_BOUND, "is only for bound; allowed: none here");
    return check_places(entry, given);
}

/* Returns true if the entry has one of the keys first .. last. */
static bool any_given(const struct entry *entry, uint32_t first, uint32_t last)
{
    for (uint32_t key = first; key <= last; key++) {
        if (entry_given(entry, key))
            return true;
    }
    return false;
}

/* A phase ends by a condition, a reaction begins by one. */
static int check_conditions(const struct entry *entry, bool reaction, bool last)
{
    if (reaction && !any_given(entry, PHASE_WHEN_TIME, PHASE_WHEN_AFTER))
        return entry_refuse(entry, PHASE_WHEN_BELOW,
                            "is missing, and so is any other condition; a reaction needs one of "
                            "the keys that begin with when_");
    for (uint32_t key = PHASE_WHEN_ALL; key < PHASE_KEY_COUNT && !reaction; key++) {
        if (entry_given(entry, key))
            return entry_refuse(entry, key,
                                "is only for reactions; allowed: for_s, until_s, "
                                "arrived, taken, lost, below, enemy_in, after");
    }
    if (!any_given(entry, PHASE_FOR, PHASE_AFTER) && !last)
        return entry_refuse(entry, PHASE_FOR,
                            "is missing, and so is any other condition; a phase needs one unless "
                            "it is the last");
    return 0;
}

/* The key of a condition. when: of those that begin a reaction, which have no time since the
 * beginning of the phase and no arrival. */
static uint32_t key_of(enum mission_condition condition, bool when)
{
    if (!when)
        return PHASE_FOR + (uint32_t)condition;
    return condition == MISSION_IF_AT ? PHASE_WHEN_TIME
           : condition >= MISSION_IF_TAKEN
               ? PHASE_WHEN_TAKEN + (uint32_t)condition - (uint32_t)MISSION_IF_TAKEN
               : PHASE_KEY_COUNT;
}

/* Finds the condition whose key has a name of this length. Returns MISSION_CONDITION_COUNT if it is
 * no name of a condition, or the entry does not give the condition. */
static uint32_t find_condition(const struct entry *entry, const char *name, size_t length,
                               bool when)
{
    for (uint32_t n = 0; n < MISSION_CONDITION_COUNT; n++) {
        uint32_t key = key_of((enum mission_condition)n, when);
        const char *word = key < PHASE_KEY_COUNT ? schema_phase.keys[key].name : "";
        if (strlen(word) == length && memcmp(word, name, length) == 0)
            return entry_given(entry, key) ? n : MISSION_CONDITION_COUNT;
    }
    return MISSION_CONDITION_COUNT;
}

/* Reads which conditions must not hold, and whether all are needed. */
static int read_logic(const struct entry *entry, const struct condition_entry *given, bool when,
                      struct mission_conditions *to)
{
    const uint32_t key = when ? PHASE_WHEN_NOT : PHASE_NOT;
    const char *word = entry_given(entry, key) ? given->unless : "";
    to->logic = given->all ? MISSION_ALL : 0;
    for (word += strspn(word, " "); *word != '\0'; word += strspn(word, " ")) {
        size_t length = strcspn(word, " ");
        uint32_t condition = find_condition(entry, word, length, when);
        if (condition == MISSION_CONDITION_COUNT)
            return entry_refuse(entry, key,
                                "does not name conditions of this phase; allowed: the names of "
                                "keys that stand beside it, with spaces between them");
        to->logic |= 1u << condition;
        word += length;
    }
    return 0;
}

static int read_conditions(const struct entry *entry, const struct condition_entry *given,
                           const uint32_t key[4], struct mission_conditions *to)
{
    *to = (struct mission_conditions){.for_s = -1.0,
                                      .at_s = entry_given(entry, key[0]) ? given->at_s : -1.0,
                                      .arrived = given->arrived,
                                      .below = given->below,
                                      .after_mission = MISSION_NONE};
    return look_up(entry, key[1], given->taken, &to->taken) != 0 ||
                   look_up(entry, key[2], given->lost, &to->lost) != 0 ||
                   look_up(entry, key[3], given->enemy_in, &to->enemy_in) != 0
               ? -1
               : 0;
}

/* Makes one more item of an array; NULL with the message. */
static void *grow(const struct entry *entry, void *array, uint64_t count, size_t size)
{
    const struct key_place place = {entry->keys.file, 0};
    void *grown = realloc(array, (count + 1) * size);
    if (grown == NULL)
        key_table_refuse(entry->error, place, NULL, NULL, "no memory for its missions");
    return grown;
}

static int add_area(const struct entry *entry, const double area[4], uint32_t *index)
{
    struct scenario *scenario = entry->scenario;
    struct area *areas =
        grow(entry, scenario->areas, scenario->area_count + 1, sizeof(*scenario->areas));
    if (areas == NULL)
        return -1;
    scenario->areas = areas;
    *index = scenario->area_count++;
    areas[*index] = (struct area){area[0], area[1], area[2], area[3]};
    return 0;
}

/* The area of the order, given or an objective's. Sets its index to MISSION_NONE for none. */
static int read_area(const struct entry *entry, struct phase_entry *given, uint32_t *index)
{
    uint32_t objective;
    *index = MISSION_NONE;
    if (look_up(entry, PHASE_OBJECTIVE, given->objective, &objective) != 0)
        return -1;
    if (objective != MISSION_NONE) {
        const struct objective *from = &entry->scenario->objectives[objective];
        const double area[4] = {from->x0, from->z0, from->x1, from->z1};
        return add_area(entry, area, index);
    }
    return entry_given(entry, PHASE_AREA) ? add_area(entry, given->area, index) : 0;
}

static int add_point(const struct entry *entry, const double point[2])
{
    struct scenario *scenario = entry->scenario;
    struct route_point *points =
        grow(entry, scenario->route_points, scenario->route_point_count + 1,
             sizeof(*scenario->route_points));
    if (points == NULL)
        return -1;
    scenario->route_points = points;
    points[scenario->route_point_count++] = (struct route_point){point[0], point[1]};
    return 0;
}

/* The points of a route that the file gives. */
static int add_points(const struct entry *entry, const struct phase_entry *given)
{
    unsigned count = given->route != NULL ? (unsigned)config_setting_length(given->route) : 0;
    if (entry_given(entry, PHASE_TO))
        return add_point(entry, given->to);
    for (unsigned i = 0; i < count; i++) {
        double point[2] = {0.0, 0.0};
        key_table_point(config_setting_get_elem(given->route, i), point);
        if (add_point(entry, point) != 0)
            return -1;
    }
    return 0;
}

/* The route of an order that goes somewhere: its points, then the middle of its area. On roads the
 * area is added when the roads have been found, so it is a point of the route here, too. */
static int add_route(const struct entry *entry, const struct phase_entry *given,
                     struct scenario_phase *phase)
{
    struct scenario *scenario = entry->scenario;
    struct route *routes =
        grow(entry, scenario->routes, scenario->route_count + 1, sizeof(*scenario->routes));
    uint32_t area = phase->phase.area, first = scenario->route_point_count;
    if (routes == NULL)
        return -1;
    scenario->routes = routes;
    phase->phase.route = scenario->route_count++;
    struct route *route = &routes[phase->phase.route];
    double spread = entry_given(entry, PHASE_SPREAD) ? given->spread_m
                    : given->roads                   ? 0.0
                                                     : SPREAD_M;
    *route = (struct route){.first = first,
                            .once = 1,
                            .bound_s = given->order == MISSION_BOUND ? (float)given->bound_s : 0.0f,
                            .spread_m = (float)spread,
                            .last_x_m = (float)(spread > 0.0 ? spread : SPREAD_M),
                            .last_z_m = (float)(spread > 0.0 ? spread : SPREAD_M)};
    if (add_points(entry, given) != 0)
        return -1;
    if (area != MISSION_NONE) {
        const struct area *at = &scenario->areas[area];
        const double middle[2] = {0.5 * (at->x0 + at->x1), 0.5 * (at->z0 + at->z1)};
        route->last_x_m = (float)(0.5 * (at->x1 - at->x0));
        route->last_z_m = (float)(0.5 * (at->z1 - at->z0));
        if (add_point(entry, middle) != 0)
            return -1;
    }
    route->count = scenario->route_point_count - first;
    return 0;
}

static uint32_t engagement(const struct entry *entry, const struct phase_entry *given)
{
    if (entry_given(entry, PHASE_ENGAGE))
        return given->engage;
    switch ((enum mission_order)given->order) {
    case MISSION_HOLD:
    case MISSION_RESERVE:
    case MISSION_WITHDRAW:
    case MISSION_RESUPPLY:
    case MISSION_BARRAGE:
        return 0;
    default:
        return ENTITY_FLAG_FIRE_AT_WILL;
    }
}

static int add_phase(const struct entry *entry, struct phase_entry *given)
{
    static const uint32_t until[4] = {PHASE_UNTIL, PHASE_TAKEN, PHASE_LOST, PHASE_ENEMY_IN};
    static const uint32_t when[4] = {PHASE_WHEN_TIME, PHASE_WHEN_TAKEN, PHASE_WHEN_LOST,
                                     PHASE_WHEN_ENEMY_IN};
    struct scenario *scenario = entry->scenario;
    struct scenario_phase *to = &scenario->phases[scenario->phase_count++];
    struct battle_phase *phase = &to->phase;
    *to = (struct scenario_phase){.roads = (uint8_t)given->roads,
                                  .line = (int)config_setting_source_line(entry->setting)};
    memcpy(phase->name, given->name, sizeof(phase->name));
    phase->order = given->order;
    phase->route = MISSION_NONE;
    phase->at_least_s = given->at_least_s;
    phase->rounds_a_minute = given->rounds_a_minute;
    phase->bearing_rad = given->bearing_rad;
    phase->adjusted = given->adjust;
    phase->engage = engagement(entry, given);
    phase->munition = KIND_NONE;
    if (entry_given(entry, PHASE_MUNITION))
        phase->munition =
            entry_kind(entry, PHASE_MUNITION, given->munition, DOMAIN_BIT(DOMAIN_MUNITION));
    if (entry_given(entry, PHASE_MUNITION) && phase->munition == KIND_NONE)
        return -1;
    if (read_conditions(entry, &given->until, until, &phase->until) != 0 ||
        read_conditions(entry, &given->when, when, &phase->when) != 0 ||
        read_logic(entry, &given->until, false, &phase->until) != 0 ||
        read_logic(entry, &given->when, true, &phase->when) != 0 ||
        read_area(entry, given, &phase->area) != 0)
        return -1;
    if (entry_given(entry, PHASE_FOR))
        phase->until.for_s = given->until.for_s;
    return goes(given->order) ? add_route(entry, given, to) : 0;
}

/* Refuses a name that an earlier phase of the mission has. */
static int check_name(const struct entry *entry, const struct phase_entry *given, uint32_t first)
{
    for (uint32_t p = first; p < entry->scenario->phase_count; p++) {
        if (strcmp(entry->scenario->phases[p].phase.name, given->name) == 0)
            return entry_refuse(entry, PHASE_NAME,
                                "is also the name of another phase; allowed: each name once");
    }
    return 0;
}

int mission_phases_read(const struct entry *of, const config_setting_t *list, int length,
                        const struct scenario_mission *mission)
{
    struct entry entry = {
        .scenario = of->scenario, .keys = {.file = of->keys.file}, .error = of->error};
    const bool reaction = list != NULL && strcmp(config_setting_name(list), "reactions") == 0;
    uint32_t index = (uint32_t)(mission - of->scenario->missions);
    bool wings = has_wings(of->scenario, index);
    struct key_table table = schema_phase;
    char within[KEY_PATH_MAX];
    snprintf(within, sizeof(within), "%.60s.", of->path);
    entry.within = within;
    table.path = reaction ? "reactions" : "phases";
    for (int i = 0; i < length; i++) {
        struct phase_entry given;
        if (entry_read(&entry, &table, i, list, &given) != 0 ||
            check_name(&entry, &given, mission->mission.first_phase) != 0 ||
            check_order(&entry, &given, mission, wings) != 0 ||
            check_conditions(&entry, reaction, reaction || i + 1 == length) != 0 ||
            add_phase(&entry, &given) != 0)
            return -1;
    }
    return 0;
}
