/* The words of the enumerations. */
#include "world/enum_names.h"

#include "world/enum_words.h"

WORDS(cover_name, cover, COVER_COUNT, "grass", "chaparral", "forest", "rock", "sand", "road", "sea",
      "lake")
WORDS(domain_name, domain, DOMAIN_COUNT, "land", "sea", "air", "munition", "fixed")
WORDS(object_class_name, object_class, OBJECT_CLASS_COUNT, "tree", "bush", "pole", "building",
      "watertower", "other_manmade", "other_natural")
WORDS(fuze_name, fuze, FUZE_COUNT, "point", "delay", "air")
WORDS(doctrine_name, doctrine, DOCTRINE_COUNT, "armour", "light", "soft", "helicopter", "jet",
      "warship", "beast", "flak")
WORDS(damage_name, damage, DAMAGE_COUNT, "none", "low", "med", "high", "destroyed")
WORDS(entity_state_name, entity_state, ENTITY_STATE_COUNT, "free", "active", "wreck")
WORDS(behaviour_name, behaviour, BEHAVIOUR_COUNT, "idle", "hold", "patrol", "route", "attack",
      "flee", "back_off", "driven", "flight", "follow", "script", "withdraw", "resupply",
      "reposition", "remote")
WORDS(formation_shape_name, formation_shape, FORMATION_SHAPE_COUNT, "column", "line", "wedge",
      "echelon-left", "echelon-right")
WORDS(gear_name, gearing, GEAR_COUNT, "automatic", "reverse", "neutral", "low")
WORDS(force_name, force, FORCE_COUNT, "neutral", "blue", "red")
WORDS(response_name, response, RESPONSE_COUNT, "none", "bounce", "stop", "slow", "destroyed")
WORDS(struck_name, struck, STRUCK_COUNT, "vehicle", "fixed", "ground", "water", "air")
WORDS(agent_reason_name, agent_reason, REASON_COUNT, "fired upon", "target gone", "out of rounds",
      "time over", "collision", "enemy seen", "command", "out of fuel", "lost sight", "hurt",
      "outnumbered", "low fuel", "supplied", "arrived", "leader lost", "script", "lease over",
      "suppressed", "losses", "stuck", "rounds fired", "left the world")
WORDS(mission_order_name, mission_order, MISSION_ORDER_COUNT, "hold", "reserve", "move", "bound",
      "attack", "defend", "withdraw", "patrol", "strike", "barrage", "resupply")
WORDS(mission_news_name, mission_news, MISSION_NEWS_COUNT, "phase", "reaction", "objective",
      "result", "again")
WORDS(contact_end_reason_name, contact_end_reason, CONTACT_END_REASON_COUNT, "parted", "gone",
      "no room")
WORDS(command_ring_name, command_ring, COMMAND_RING_COUNT, "clients", "recorder", "gateway")
WORDS(command_type_name, command_type, COMMAND_TYPE_COUNT, "none", "pause", "resume", "step",
      "scale", "drive", "release", "fire", "spawn", "remove", "quit")
WORDS(command_result_name, command_result, COMMAND_RESULT_COUNT, "done", "no such entity",
      "no such kind", "value out of range", "table full", "cannot do that now", "unknown command",
      "somebody else drives it", "another simulator owns it")
WORDS(remote_refusal_name, remote_refusal, REMOTE_REFUSAL_COUNT, "taken",
      "not a record, or a value out of range", "no such kind", "world.remotes_max are there",
      "table full", "it would jump", "no such entity")
