/* Describes a battle: who holds what, and in which phase each mission is. */
#include "supervisor/worldctl/battle.h"

#include "world/enum_names.h"
#include "world/world.h"

#include <stdio.h>

static double since_s(const struct world *world, const struct state_head *head, uint32_t tick)
{
    return (double)((uint32_t)head->tick - tick) * world_dt_s(world);
}

static const char *winner_name(const struct battle_state *battle)
{
    return battle->winner == FORCE_NEUTRAL ? "nobody" : force_name((enum force)battle->winner);
}

static const char *phase_name(const struct world *world, const struct state_head *head,
                              uint32_t index)
{
    uint32_t phase = head->battle.mission[index].phase;
    return world->mission_phases[world->missions[index].first_phase + phase].name;
}

static void add_objectives(cJSON *battle, const struct world *world, const struct state_head *head)
{
    cJSON *list = json_array(battle, "objectives");
    for (uint32_t o = 0; o < world->counts.objectives; o++) {
        const struct objective_state *state = &head->battle.objective[o];
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddItemToArray(list, entry);
        json_text(entry, "name", world->objectives[o].name);
        json_text(entry, "owner", force_name((enum force)state->owner));
        json_whole(entry, "blue", state->present[FORCE_BLUE]);
        json_whole(entry, "red", state->present[FORCE_RED]);
    }
}

static void add_missions(cJSON *battle, const struct world *world, const struct state_head *head)
{
    cJSON *list = json_array(battle, "missions");
    for (uint32_t i = 0; i < world->counts.missions; i++) {
        const struct mission_state *state = &head->battle.mission[i];
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddItemToArray(list, entry);
        json_text(entry, "name", world->missions[i].name);
        json_text(entry, "force", force_name((enum force)world->missions[i].force));
        json_text(entry, "phase", phase_name(world, head, i));
        json_number(entry, "since_s", since_s(world, head, state->since_tick));
        json_whole(entry, "able", state->able);
        json_whole(entry, "begun", state->begun);
    }
}

void battle_json(cJSON *object, const struct world *world, const struct state_head *head)
{
    const struct battle_state *battle = &head->battle;
    if (world->counts.missions == 0 || battle->round == 0)
        return;
    cJSON *entry = json_object(object, "battle");
    json_whole(entry, "round", battle->round);
    json_number(entry, "time_s", since_s(world, head, battle->round_tick));
    json_bool(entry, "ended", battle->ended_tick != 0);
    if (battle->ended_tick != 0)
        json_text(entry, "winner", winner_name(battle));
    add_objectives(entry, world, head);
    add_missions(entry, world, head);
}

void battle_print(const struct world *world, const struct state_head *head)
{
    const struct battle_state *battle = &head->battle;
    if (world->counts.missions == 0 || battle->round == 0)
        return;
    printf("  battle %u, %.0f s", battle->round, since_s(world, head, battle->round_tick));
    if (battle->ended_tick != 0)
        printf("; it has ended: %s wins", winner_name(battle));
    printf("\n");
    for (uint32_t o = 0; o < world->counts.objectives; o++)
        printf("  objective  %-23s %s\n", world->objectives[o].name,
               force_name((enum force)battle->objective[o].owner));
    for (uint32_t i = 0; i < world->counts.missions; i++)
        printf("  mission    %-23s %s, %u of %u vehicles\n", world->missions[i].name,
               phase_name(world, head, i), battle->mission[i].able, battle->mission[i].begun);
}
