/* Reader of the phases and the reactions of one mission. */
#ifndef JOLON_CONFIG_MISSION_PHASES_H
#define JOLON_CONFIG_MISSION_PHASES_H

#include "config/syntax/entry.h"

struct scenario_mission;

/* Appends `length` phases or reactions, those of a list that is called "phases" or "reactions", to
 * the phases of the scenario, which have room for them. of: the entry of the mission. Phases of
 * other missions are not looked up yet. 0; -1 with the message. */
int mission_phases_read(const struct entry *of, const config_setting_t *list, int length,
                        const struct scenario_mission *mission);

#endif
