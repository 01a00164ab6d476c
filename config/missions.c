/* Reads objectives, missions, phases and reactions. Phases name phases of other missions, so the
 * entries are read a second time when all names are known. */
#include "config/missions.h"

#include "config/mission_phases.h"
#include "config/syntax/entry.h"
#include "config/syntax/schema.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const mission_lists[] = {"phases", "reactions", NULL};

/* --- objectives --------------------------------------------------------------------------------*/

uint32_t missions_objective(const struct scenario *scenario, const char *name)
{
    for (uint32_t i = 0; i < scenario->objective_count; i++) {
        if (strcmp(scenario->objectives[i].name, name) == 0)
            return i;
    }
    return MISSION_NONE;
}

static int read_objectives(struct scenario *scenario, const config_setting_t *list,
                           const char *file, struct error_text *error)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .error = error};
    int length = list != NULL ? entry_count(list, file, OBJECTIVES_MAX, error) : 0;
    if (length < 0)
        return -1;
    scenario->objectives =
        entry_allocate((uint32_t)length, sizeof(*scenario->objectives), file, error);
    if (scenario->objectives == NULL)
        return -1;
    for (int i = 0; i < length; i++) {
        struct objective_entry given;
        if (entry_read(&entry, &schema_objective, i, list, &given) != 0)
            return -1;
        if (missions_objective(scenario, given.name) != MISSION_NONE)
            return entry_refuse(&entry, OBJECTIVE_NAME,
                                "is also the name of another objective; allowed: each name once");
        struct objective *to = &scenario->objectives[scenario->objective_count++];
        *to = (struct objective){.x0 = given.area[0],
                                 .z0 = given.area[1],
                                 .x1 = given.area[2],
                                 .z1 = given.area[3],
                                 .owner = given.force};
        memcpy(to->name, given.name, sizeof(to->name));
    }
    return 0;
}

/* --- vehicles ----------------------------------------------------------------------------------*/

static bool named_so(const struct scenario_group *group, const char *vehicles, bool by_group)
{
    return by_group
               ? strcmp(group->squad, vehicles) == 0
               : group->squad[0] == '\0' && strncmp(group->name, vehicles, strlen(vehicles)) == 0;
}

static bool is_group(const struct scenario *scenario, const char *vehicles)
{
    for (uint32_t g = 0; g < scenario->group_count; g++) {
        if (strcmp(scenario->groups[g].squad, vehicles) == 0)
            return true;
    }
    return false;
}

/* Gives the entries of vehicles to the mission, and the mission their force. */
static int take_vehicles(const struct entry *entry, struct scenario_mission *mission)
{
    const struct scenario *scenario = entry->scenario;
    bool by_group = is_group(scenario, mission->vehicles);
    uint32_t found = 0;
    for (uint32_t g = 0; g < scenario->group_count; g++) {
        struct scenario_group *group = &scenario->groups[g];
        if (!named_so(group, mission->vehicles, by_group))
            continue;
        if (group->mission != 0)
            return entry_refuse(
                entry, MISSION_KEY_VEHICLES,
                "has vehicles of the mission \"%s\"; allowed: each vehicle in one mission",
                scenario->missions[group->mission - 1].mission.name);
        if (found > 0 && group->force != mission->mission.force)
            return entry_refuse(entry, MISSION_KEY_VEHICLES,
                                "has vehicles of two forces; allowed: of one force");
        mission->mission.force = group->force;
        group->mission = 1 + (uint32_t)(mission - scenario->missions);
        found += group->count;
    }
    return found > 0 ? 0
                     : entry_refuse(entry, MISSION_KEY_VEHICLES,
                                    "is neither a group of vehicles nor the beginning of a name; "
                                    "right would be: group = \"...\" with vehicles, or off_map");
}

/* --- missions ----------------------------------------------------------------------------------*/

static uint32_t find_mission(const struct scenario *scenario, const char *name, size_t length)
{
    for (uint32_t i = 0; i < scenario->mission_count; i++) {
        const char *other = scenario->missions[i].mission.name;
        if (strlen(other) == length && strncmp(other, name, length) == 0)
            return i;
    }
    return MISSION_NONE;
}

static int count_list(const struct entry *entry, const config_setting_t *list, int max)
{
    return list != NULL ? entry_count_within(entry->path, list, entry->keys.file, max, entry->error)
                        : 0;
}

static int refuse_no_phases(const struct entry *entry)
{
    const struct key_place place = {entry->keys.file,
                                    (int)config_setting_source_line(entry->setting)};
    return key_table_refuse(entry->error, place, entry->path, NULL,
                            "has no phases; right would be: phases = ( { name = \"...\"; order = "
                            "\"...\"; }, ... )");
}

static int add_mission(const struct entry *entry, const struct mission_entry *given)
{
    struct scenario *scenario = entry->scenario;
    const config_setting_t *phases = config_setting_get_member(entry->setting, "phases");
    const config_setting_t *reactions = config_setting_get_member(entry->setting, "reactions");
    struct scenario_mission *mission = &scenario->missions[scenario->mission_count];
    int count = count_list(entry, phases, MISSION_PHASES_MAX - MISSION_REACTIONS_MAX);
    int more = count_list(entry, reactions, MISSION_REACTIONS_MAX);
    if (count < 0 || more < 0)
        return -1;
    if (count == 0)
        return refuse_no_phases(entry);
    if (find_mission(scenario, given->name, strlen(given->name)) != MISSION_NONE)
        return entry_refuse(entry, MISSION_KEY_NAME,
                            "is also the name of another mission; allowed: each name once");
    *mission = (struct scenario_mission){.off_map = (uint8_t)given->off_map,
                                         .line = (int)config_setting_source_line(entry->setting)};
    memcpy(mission->mission.name, given->name, sizeof(given->name));
    memcpy(mission->vehicles,
           entry_given(entry, MISSION_KEY_VEHICLES) ? given->vehicles : given->name,
           sizeof(mission->vehicles));
    mission->mission.force = given->force;
    mission->mission.first_phase = scenario->phase_count;
    mission->mission.phase_count = (uint32_t)count;
    mission->mission.reaction_count = (uint32_t)more;
    if (!given->off_map && take_vehicles(entry, mission) != 0)
        return -1;
    scenario->mission_count++;
    return mission_phases_read(entry, phases, count, mission) == 0
               ? mission_phases_read(entry, reactions, more, mission)
               : -1;
}

/* --- phases of other missions ------------------------------------------------------------------*/

/* Sets the phase that a key names as "mission.phase". */
static int find_after(const struct entry *entry, uint32_t key, const char *name,
                      struct mission_conditions *to)
{
    const struct scenario *scenario = entry->scenario;
    const char *dot = strchr(name, '.');
    uint32_t found =
        dot != NULL ? find_mission(scenario, name, (size_t)(dot - name)) : MISSION_NONE;
    if (!entry_given(entry, key))
        return 0;
    for (uint32_t p = 0; found != MISSION_NONE && p < scenario->missions[found].mission.phase_count;
         p++) {
        uint32_t at = scenario->missions[found].mission.first_phase + p;
        if (strcmp(scenario->phases[at].phase.name, dot + 1) != 0)
            continue;
        to->after_mission = found;
        to->after_phase = p;
        return 0;
    }
    return entry_refuse(entry, key,
                        "is no phase; allowed: \"mission.phase\" with the names of a "
                        "mission and of one of its phases");
}

/* of: mission `index`. member: phases or reactions, of which the first is phase `first`. */
static int link_phases(const struct entry *of, int index, const char *member, uint32_t first)
{
    const config_setting_t *list = config_setting_get_member(of->setting, member);
    const struct mission *own = &of->scenario->missions[index].mission;
    struct key_table table = schema_phase;
    char within[KEY_PATH_MAX];
    struct entry entry = {.scenario = of->scenario,
                          .keys = {.file = of->keys.file},
                          .within = within,
                          .error = of->error};
    snprintf(within, sizeof(within), "missions[%d].", index);
    table.path = member;
    int length = list != NULL ? config_setting_length(list) : 0;
    for (int i = 0; i < length; i++) {
        struct phase_entry given;
        struct battle_phase *phase = &of->scenario->phases[first + (uint32_t)i].phase;
        if (entry_read(&entry, &table, i, list, &given) != 0 ||
            find_after(&entry, PHASE_AFTER, given.until.after, &phase->until) != 0 ||
            find_after(&entry, PHASE_WHEN_AFTER, given.when.after, &phase->when) != 0)
            return -1;
        if (phase->until.after_mission == (uint32_t)index &&
            own->first_phase + phase->until.after_phase >= first + (uint32_t)i)
            return entry_refuse(&entry, PHASE_AFTER,
                                "is this phase, or one that comes after it, and so never ends "
                                "before it; allowed: a phase of another mission");
    }
    return 0;
}

static uint32_t count_phases(const config_setting_t *list)
{
    uint32_t count = 0;
    for (int i = 0; list != NULL && i < config_setting_length(list); i++) {
        const config_setting_t *entry = config_setting_get_elem(list, (unsigned)i);
        const config_setting_t *of[2] = {NULL, NULL};
        if (entry->type == CONFIG_TYPE_GROUP) {
            of[0] = config_setting_get_member(entry, "phases");
            of[1] = config_setting_get_member(entry, "reactions");
        }
        for (int n = 0; n < 2; n++)
            count += of[n] != NULL && of[n]->type == CONFIG_TYPE_LIST
                         ? (uint32_t)config_setting_length(of[n])
                         : 0;
    }
    return count;
}

static int check_battle(const struct entry *entry, const config_setting_t *root)
{
    const struct battle_params *battle = &entry->scenario->settings->params.battle;
    const config_setting_t *group = config_setting_get_member(root, "battle");
    const config_setting_t *in_file =
        group != NULL ? config_setting_get_member(group, "again_s") : NULL;
    if (in_file == NULL)
        in_file = group;
    const struct key_place place = {entry->keys.file,
                                    in_file != NULL ? (int)config_setting_source_line(in_file) : 0};
    char value[32];
    if (battle->again_s == 0.0 || battle->again_s > battle->end_s)
        return 0;
    snprintf(value, sizeof(value), "%.15g", battle->again_s);
    return key_table_refuse(entry->error, place, "battle.again_s", value,
                            "is not after battle.end_s; allowed: 0, or above %.15g", battle->end_s);
}

int missions_read(struct scenario *scenario, const config_setting_t *root, const char *file,
                  struct error_text *error)
{
    const config_setting_t *list = config_setting_get_member(root, "missions");
    struct entry entry = {
        .scenario = scenario, .keys = {.file = file, .lists = mission_lists}, .error = error};
    int length = list != NULL ? entry_count(list, file, MISSIONS_MAX, error) : 0;
    if (length < 0 || check_battle(&entry, root) != 0 ||
        read_objectives(scenario, config_setting_get_member(root, "objectives"), file, error) != 0)
        return -1;
    scenario->missions = entry_allocate((uint32_t)length, sizeof(*scenario->missions), file, error);
    scenario->phases = entry_allocate(count_phases(list), sizeof(*scenario->phases), file, error);
    if (scenario->missions == NULL || scenario->phases == NULL)
        return -1;
    for (int i = 0; i < length; i++) {
        struct mission_entry given;
        if (entry_read(&entry, &schema_mission, i, list, &given) != 0 ||
            add_mission(&entry, &given) != 0)
            return -1;
    }
    for (int i = 0; i < length; i++) {
        const struct mission *mission = &scenario->missions[i].mission;
        entry.setting = config_setting_get_elem(list, (unsigned)i);
        if (link_phases(&entry, i, "phases", mission->first_phase) != 0 ||
            link_phases(&entry, i, "reactions", mission->first_phase + mission->phase_count) != 0)
            return -1;
    }
    return 0;
}
