/* The vehicles of an entry have consecutive slots, in the order of the file. */
#include "world/making/mission_build.h"

#include "world/entity/mission.h"
#include "world/making/scenario.h"
#include "world/making/world_build.h"

#include <stdlib.h>

/* Lists the slots of a mission's vehicles. */
static void list_members(struct world_build *built, uint32_t index)
{
    const struct scenario *scenario = built->scenario;
    struct mission *mission = &built->missions[index];
    uint32_t slot = 0;
    mission->first_member = built->counts.mission_members;
    for (uint32_t g = 0; g < scenario->group_count; g++) {
        const struct scenario_group *group = &scenario->groups[g];
        for (uint32_t i = 0; i < group->count && group->mission == 1 + index; i++)
            built->members[built->counts.mission_members++] = slot + i;
        slot += group->count;
    }
    mission->member_count = built->counts.mission_members - mission->first_member;
}

int mission_build_build(struct world_build *built, struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    built->missions = calloc(scenario->mission_count + 1, sizeof *built->missions);
    built->phases = calloc(scenario->phase_count + 1, sizeof *built->phases);
    built->members = calloc(built->used + 1, sizeof *built->members);
    if (!built->missions || !built->phases || !built->members)
        return error_text_memory(error);
    for (uint32_t p = 0; p < scenario->phase_count; p++)
        built->phases[p] = scenario->phases[p].phase;
    for (uint32_t i = 0; i < scenario->mission_count; i++) {
        built->missions[i] = scenario->missions[i].mission;
        list_members(built, i);
    }
    built->counts.missions = scenario->mission_count;
    built->counts.mission_phases = scenario->phase_count;
    return 0;
}
