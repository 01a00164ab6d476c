/* The words of every enumeration that people read or write: in scenarios, commands, events and
 * dumps. A value out of range has the word "?". */
#ifndef JOLON_WORLD_ENUM_NAMES_H
#define JOLON_WORLD_ENUM_NAMES_H

#include "world/entity/command.h"
#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/entity/formation.h"
#include "world/entity/kind.h"
#include "world/entity/mission.h"
#include "world/entity/remote.h"
#include "world/terrain/terrain.h"

const char *cover_name(enum cover cover);
const char *domain_name(enum domain domain);
const char *doctrine_name(enum doctrine doctrine);
const char *fuze_name(enum fuze fuze);
const char *object_class_name(enum object_class object_class);
const char *damage_name(enum damage damage);
const char *entity_state_name(enum entity_state state);
const char *behaviour_name(enum behaviour behaviour);
const char *formation_shape_name(enum formation_shape shape);
const char *gear_name(enum gearing gear);
const char *force_name(enum force force);
const char *response_name(enum response response);
const char *struck_name(enum struck struck);
const char *agent_reason_name(enum agent_reason reason);
const char *mission_order_name(enum mission_order order);
const char *mission_news_name(enum mission_news news);
const char *contact_end_reason_name(enum contact_end_reason reason);
const char *command_ring_name(enum command_ring ring);
const char *command_type_name(enum command_type type);
const char *command_result_name(enum command_result result);
const char *remote_refusal_name(enum remote_refusal refusal);

#endif
