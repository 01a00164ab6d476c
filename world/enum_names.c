/* The words for every enumeration: one table each, one look-up. */
#include "world/enum_names.h"

#include <stddef.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const char *word(const char *const *words, size_t count, size_t index)
{
    return index < count && words[index] ? words[index] : "?";
}

#define WORDS(function, type, ...)                                                                 \
    const char *function(enum type value)                                                          \
    {                                                                                              \
        static const char *const words[] = {__VA_ARGS__};                                          \
        return word(words, COUNT(words), (size_t)value);                                           \
    }

WORDS(cover_name, cover, "grass", "chaparral", "forest", "rock", "sand", "road", "sea", "lake")
WORDS(domain_name, domain, "land", "sea", "air", "munition", "fixed")
WORDS(object_class_name, object_class, "tree", "bush", "pole", "building", "watertower",
      "other_manmade", "other_natural")
WORDS(doctrine_name, doctrine, "armour", "light", "soft", "helicopter", "jet", "warship", "beast")
WORDS(damage_name, damage, "none", "low", "med", "high", "destroyed")
WORDS(entity_state_name, entity_state, "free", "active", "wreck")
WORDS(behaviour_name, behaviour, "idle", "hold", "patrol", "route", "attack", "flee", "back_off",
      "driven", "flight", "follow", "script", "withdraw", "resupply")
WORDS(formation_shape_name, formation_shape, "column", "line", "wedge", "echelon-left",
      "echelon-right")
WORDS(gear_name, gearing, "automatic", "reverse", "neutral", "low")
WORDS(force_name, force, "neutral", "blue", "red")
WORDS(event_type_name, event_type, "none", "collision", "fire", "detonation", "crater", "agent",
      "command")
WORDS(response_name, response, "none", "bounce", "stop", "slow", "destroyed")
WORDS(struck_name, struck, "vehicle", "fixed", "ground", "water", "air")
WORDS(agent_reason_name, agent_reason, "fired upon", "target gone", "out of rounds", "time over",
      "collision", "enemy seen", "command", "out of fuel", "lost sight", "hurt", "outnumbered",
      "low fuel", "supplied", "arrived", "leader lost", "script", "lease over")
WORDS(command_ring_name, command_ring, "clients", "gateway", "console", "recorder")
WORDS(command_type_name, command_type, "none", "pause", "resume", "step", "scale", "drive",
      "release", "fire", "spawn", "remove", "quit")
WORDS(command_result_name, command_result, "done", "no such entity", "no such kind",
      "value out of range", "table full", "cannot do that now", "unknown command",
      "somebody else drives it")
#define X(name, value, word, test, text) [METHOD_##name] = #word,
WORDS(method_name, method, METHODS(X))
#undef X
WORDS(shape_name, shape, "sphere", "model")
#define X(name, value, word, text) [MODEL_##name] = #word,
WORDS(response_model_name, response_model, RESPONSE_MODELS(X))
#undef X
WORDS(view_mode_name, view_mode, "chase", "map", "inside", "orbit", "free", "overhead")
WORDS(back_end_name, back_end, "auto", "gl", "soft")
