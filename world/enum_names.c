/* The words of the enumerations. */
#include "world/enum_names.h"

#include <stddef.h>

/* Defines a function that returns the word of each of an enumeration's count values, from 0 on. */
#define WORDS(function, type, count, ...)                                                          \
    const char *function(enum type value)                                                          \
    {                                                                                              \
        static const char *const words[] = {__VA_ARGS__};                                          \
        _Static_assert(sizeof words / sizeof words[0] == (count), "a word for each value");        \
        return (size_t)value < (count) ? words[value] : "?";                                       \
    }

WORDS(cover_name, cover, COVER_COUNT, "grass", "chaparral", "forest", "rock", "sand", "road", "sea",
      "lake")
WORDS(domain_name, domain, DOMAIN_COUNT, "land", "sea", "air", "munition", "fixed")
WORDS(object_class_name, object_class, OBJECT_CLASS_COUNT, "tree", "bush", "pole", "building",
      "watertower", "other_manmade", "other_natural")
WORDS(doctrine_name, doctrine, DOCTRINE_COUNT, "armour", "light", "soft", "helicopter", "jet",
      "warship", "beast")
WORDS(damage_name, damage, DAMAGE_COUNT, "none", "low", "med", "high", "destroyed")
WORDS(entity_state_name, entity_state, ENTITY_STATE_COUNT, "free", "active", "wreck")
WORDS(behaviour_name, behaviour, BEHAVIOUR_COUNT, "idle", "hold", "patrol", "route", "attack",
      "flee", "back_off", "driven", "flight", "follow", "script", "withdraw", "resupply")
WORDS(formation_shape_name, formation_shape, FORMATION_SHAPE_COUNT, "column", "line", "wedge",
      "echelon-left", "echelon-right")
WORDS(gear_name, gearing, GEAR_COUNT, "automatic", "reverse", "neutral", "low")
WORDS(force_name, force, FORCE_COUNT, "neutral", "blue", "red")
WORDS(response_name, response, RESPONSE_COUNT, "none", "bounce", "stop", "slow", "destroyed")
WORDS(struck_name, struck, STRUCK_COUNT, "vehicle", "fixed", "ground", "water", "air")
WORDS(agent_reason_name, agent_reason, REASON_COUNT, "fired upon", "target gone", "out of rounds",
      "time over", "collision", "enemy seen", "command", "out of fuel", "lost sight", "hurt",
      "outnumbered", "low fuel", "supplied", "arrived", "leader lost", "script", "lease over")
WORDS(command_ring_name, command_ring, COMMAND_RING_COUNT, "clients", "recorder")
WORDS(command_type_name, command_type, COMMAND_TYPE_COUNT, "none", "pause", "resume", "step",
      "scale", "drive", "release", "fire", "spawn", "remove", "quit")
WORDS(command_result_name, command_result, COMMAND_RESULT_COUNT, "done", "no such entity",
      "no such kind", "value out of range", "table full", "cannot do that now", "unknown command",
      "somebody else drives it")
#define X(name, value, word, test, text) [METHOD_##name] = #word,
WORDS(method_name, method, METHOD_COUNT, METHODS(X))
#undef X
WORDS(shape_name, shape, SHAPE_COUNT, "sphere", "model")
#define X(name, value, word, text) [MODEL_##name] = #word,
WORDS(response_model_name, response_model, MODEL_COUNT, RESPONSE_MODELS(X))
#undef X
WORDS(view_mode_name, view_mode, VIEW_COUNT, "chase", "map", "inside", "orbit", "free", "overhead")
WORDS(back_end_name, back_end, BACK_END_COUNT, "auto", "gl", "soft")
