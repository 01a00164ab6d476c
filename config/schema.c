/* The schema: the tables of keys. A row here is a row in docs/scenario.md. */
#include "config/schema.h"

#include "world/square.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Rows by type, for a destination D and its field. */
#define ROW(key, kind, how, D, field)                                                              \
    .name = key, .type = kind, .store = how, .offset = offsetof(D, field), .scale = 1.0
#define WHOLE32(key, D, field, min, max, value)                                                    \
    {                                                                                              \
        ROW(key, KEY_INTEGER, STORE_U32, D, field), .low = (min), .high = (max),                   \
                                                    .fallback = (value)                            \
    }
#define WHOLE64(key, D, field, min, max, value)                                                    \
    {                                                                                              \
        ROW(key, KEY_INTEGER, STORE_U64, D, field), .low = (min), .high = (max),                   \
                                                    .fallback = (value)                            \
    }
#define SCALED(key, D, field, min, max, factor, value)                                             \
    {                                                                                              \
        .name = (key), .type = KEY_NUMBER, .store = STORE_DOUBLE, .offset = offsetof(D, field),    \
        .low = (min), .high = (max), .scale = (factor), .fallback = (value)                        \
    }
#define NUMBER(key, D, field, min, max, value) SCALED(key, D, field, min, max, 1.0, value)
#define NEEDED(key, D, field, min, max)                                                            \
    {                                                                                              \
        ROW(key, KEY_NUMBER, STORE_DOUBLE, D, field), .low = (min), .high = (max),                 \
                                                      .required = true                             \
    }
#define CHOICE(key, D, field, how, words, value)                                                   \
    {                                                                                              \
        ROW(key, KEY_CHOICE, how, D, field), .choices = (words), .fallback = (value)               \
    }
#define BOOLEAN(key, D, field, how, value)                                                         \
    {                                                                                              \
        ROW(key, KEY_BOOLEAN, how, D, field), .low = 0.0, .high = 1.0, .fallback = (value)         \
    }
#define TEXT(key, D, field, value)                                                                 \
    {                                                                                              \
        ROW(key, KEY_TEXT, STORE_TEXT, D, field), .size = sizeof(((D *)0)->field),                 \
                                                  .fallback = (value)                              \
    }
#define TEXT_NEEDED(key, D, field)                                                                 \
    {                                                                                              \
        ROW(key, KEY_TEXT, STORE_TEXT, D, field), .size = sizeof(((D *)0)->field),                 \
                                                  .required = true                                 \
    }
#define PLACE(key, kind, how, D, field, needed)                                                    \
    {                                                                                              \
        ROW(key, kind, how, D, field), .low = 0.0, .high = WORLD_SIDE_M, .required = (needed)      \
    }

_Static_assert(sizeof(enum terrain_source) == sizeof(uint32_t), "choices store 32-bit words");
_Static_assert(sizeof(enum object_source) == sizeof(uint32_t), "choices store 32-bit words");

static const struct key_choice paces[] = {
    {"real", PACE_REAL, true}, {"max", PACE_MAX, true}, {NULL, 0, false}};
static const struct key_choice terrains[] = {{"generated", TERRAIN_GENERATED, true},
                                             {"flat", TERRAIN_FLAT, true},
                                             {"dem", 0, false},
                                             {NULL, 0, false}};
static const struct key_choice spacings[] = {
    {"125", 0, true}, {"62.5", 0, true}, {"31.25", 0, true}, {NULL, 0, false}};
static const struct key_choice object_sources[] = {
    {"table1", OBJECTS_TABLE1, true}, {"none", OBJECTS_NONE, true}, {NULL, 0, false}};
static const struct key_choice methods[] = {{"swept", METHOD_SWEPT, true},
                                            {"npsnet2", METHOD_NPSNET2, true},
                                            {"mps", METHOD_MPS, true},
                                            {"occupancy", METHOD_OCCUPANCY, true},
                                            {"hopcroft", METHOD_HOPCROFT, true},
                                            {"brute", METHOD_BRUTE, true},
                                            {NULL, 0, false}};
static const struct key_choice shapes[] = {
    {"model", SHAPE_MODEL, true}, {"sphere", SHAPE_SPHERE, true}, {NULL, 0, false}};
static const struct key_choice responses[] = {
    {"impulse", MODEL_IMPULSE, true}, {"figure8", MODEL_FIGURE8, true},
    {"spring", MODEL_SPRING, true},   {"mps", MODEL_MPS, true},
    {"none", MODEL_NONE, true},       {NULL, 0, false}};
static const struct key_choice nearnesses[] = {
    {"and", NEARNESS_AND, true}, {"or", NEARNESS_OR, true}, {NULL, 0, false}};
static const struct key_choice measures[] = {
    {"energy", MEASURE_ENERGY, true}, {"mass", MEASURE_MASS, true}, {NULL, 0, false}};
static const struct key_choice views[] = {{"chase", 1u << VIEW_CHASE, true},
                                          {"map", 1u << VIEW_MAP, true},
                                          {"inside", 1u << VIEW_INSIDE, true},
                                          {"orbit", 1u << VIEW_ORBIT, true},
                                          {"free", 1u << VIEW_FREE, true},
                                          {"overhead", 1u << VIEW_OVERHEAD, true},
                                          {"both", 1u << VIEW_CHASE | 1u << VIEW_MAP, true},
                                          {NULL, 0, false}};
static const struct key_choice back_ends[] = {{"auto", BACK_END_AUTO, true},
                                              {"gl", BACK_END_GL, true},
                                              {"soft", BACK_END_SOFT, true},
                                              {NULL, 0, false}};
static const struct key_choice whens_full[] = {
    {"gap", WHEN_FULL_GAP, true}, {"pause", WHEN_FULL_PAUSE, true}, {NULL, 0, false}};
static const struct key_choice forces[] = {{"neutral", FORCE_NEUTRAL, true},
                                           {"blue", FORCE_BLUE, true},
                                           {"red", FORCE_RED, true},
                                           {NULL, 0, false}};
static const struct key_choice behaviours[] = {{"idle", BEHAVIOUR_IDLE, true},
                                               {"hold", BEHAVIOUR_HOLD, true},
                                               {"patrol", BEHAVIOUR_PATROL, true},
                                               {"route", BEHAVIOUR_ROUTE, true},
                                               {"follow", BEHAVIOUR_FOLLOW, true},
                                               {"script", BEHAVIOUR_SCRIPT, true},
                                               {NULL, 0, false}};
static const struct key_choice orders[] = {
    {"idle", BEHAVIOUR_IDLE, true},         {"hold", BEHAVIOUR_HOLD, true},
    {"patrol", BEHAVIOUR_PATROL, true},     {"route", BEHAVIOUR_ROUTE, true},
    {"withdraw", BEHAVIOUR_WITHDRAW, true}, {NULL, 0, false}};
static const struct key_choice engagements[] = {{"free", ENTITY_FLAG_FIRE_AT_WILL, true},
                                                {"return", 0, true},
                                                {"hold", ENTITY_FLAG_HOLD_FIRE, true},
                                                {NULL, 0, false}};
static const struct key_choice formations[] = {{"column", FORMATION_COLUMN, true},
                                               {"line", FORMATION_LINE, true},
                                               {"wedge", FORMATION_WEDGE, true},
                                               {"echelon-left", FORMATION_ECHELON_LEFT, true},
                                               {"echelon-right", FORMATION_ECHELON_RIGHT, true},
                                               {NULL, 0, false}};
static const struct key_choice domains[] = {
    {"land", DOMAIN_LAND, true},         {"sea", DOMAIN_SEA, true},     {"air", DOMAIN_AIR, true},
    {"munition", DOMAIN_MUNITION, true}, {"fixed", DOMAIN_FIXED, true}, {NULL, 0, false}};
static const struct key_choice guidances[] = {
    {"ballistic", GUIDANCE_BALLISTIC, true}, {"homing", GUIDANCE_HOMING, true}, {NULL, 0, false}};
static const struct key_choice doctrines[] = {
    {"armour", DOCTRINE_ARMOUR, true}, {"light", DOCTRINE_LIGHT, true},
    {"soft", DOCTRINE_SOFT, true},     {"helicopter", DOCTRINE_HELICOPTER, true},
    {"jet", DOCTRINE_JET, true},       {"warship", DOCTRINE_WARSHIP, true},
    {"beast", DOCTRINE_BEAST, true},   {NULL, 0, false}};
static const struct key_choice classes[] = {{"tree", OBJECT_TREE, true},
                                            {"bush", OBJECT_BUSH, true},
                                            {"pole", OBJECT_POLE, true},
                                            {"building", OBJECT_BUILDING, true},
                                            {"watertower", OBJECT_WATERTOWER, true},
                                            {"other_manmade", OBJECT_OTHER_MANMADE, true},
                                            {"other_natural", OBJECT_OTHER_NATURAL, true},
                                            {NULL, 0, false}};

#define S struct scenario
static const struct key scenario_keys[] = {
    TEXT("world.name", S, params.name, "unnamed"),
    WHOLE64("world.seed", S, params.seed, 0, SCHEMA_WHOLE_MAX, "1991"),
    NUMBER("world.hz", S, params.hz, 1, 1000, "60"),
    WHOLE32("world.capacity", S, params.capacity, CAPACITY_MIN, CAPACITY_MAX, "4096"),
    WHOLE64("world.frames", S, params.frame_limit, 0, SCHEMA_WHOLE_MAX, "0"),
    CHOICE("world.pace", S, params.pace, STORE_U32, paces, "real"),
    CHOICE("terrain.source", S, terrain, STORE_U32, terrains, "generated"),
    NUMBER("terrain.height_m", S, flat_height_m, -400, 8000, "0"),
    {ROW("terrain.spacing_m", KEY_NUMBER, STORE_DOUBLE, S, spacing_m), .low = 31.25, .high = 125,
     .fallback = "31.25", .choices = spacings},
    /* No fallback: what stands on the ground follows from the ground (config/loader.c). */
    CHOICE("objects.source", S, objects, STORE_U32, object_sources, NULL),
    CHOICE("collision.method", S, params.collision.method, STORE_U32, methods, "swept"),
    CHOICE("collision.shape", S, params.collision.shape, STORE_U32, shapes, "model"),
    CHOICE("collision.response", S, params.collision.response, STORE_U32, responses, "impulse"),
    NUMBER("collision.threshold_height_m", S, params.collision.threshold_height_m, 0, 1000, "60"),
    CHOICE("collision.npsnet2.nearness", S, params.collision.nearness, STORE_U32, nearnesses,
           "and"),
    NUMBER("collision.mps.near_m", S, params.collision.mps_near_m, 0.1, 1000, "10"),
    NUMBER("collision.figure8.fast_vehicle_mps", S, params.collision.fast_vehicle_mps, 0, 1000,
           "8"),
    NUMBER("collision.figure8.fast_fixed_mps", S, params.collision.fast_fixed_mps, 0, 1000, "8"),
    NUMBER("collision.figure8.large_fixed_kg", S, params.collision.large_fixed_kg, 0, 1e9, "20000"),
    CHOICE("collision.figure8.measure", S, params.collision.measure, STORE_U32, measures, "energy"),
    NUMBER("collision.figure8.damage_high", S, params.collision.damage_high, 0, 1000, "1"),
    NUMBER("collision.figure8.damage_med", S, params.collision.damage_med, 0, 1000, "0.3"),
    NUMBER("collision.figure8.damage_low", S, params.collision.damage_low, 0, 1000, "0.1"),
    NUMBER("collision.figure8.mass_c1_kg", S, params.collision.mass_c1_kg, 0, 1e9, "20000"),
    NUMBER("collision.figure8.mass_c2_kg", S, params.collision.mass_c2_kg, 0, 1e9, "8000"),
    NUMBER("collision.figure8.mass_c3_kg", S, params.collision.mass_c3_kg, 0, 1e9, "1000"),
    CHOICE("recorder.when_full", S, params.when_full, STORE_U32, whens_full, "gap"),
    WHOLE32("renderer.width", S, params.renderer.width, 16, 7680, "1280"),
    WHOLE32("renderer.height", S, params.renderer.height, 16, 4320, "720"),
    NUMBER("renderer.fps", S, params.renderer.fps, 0, 120, "2"),
    {ROW("renderer.view", KEY_CHOICES, STORE_U32, S, params.renderer.views), .choices = views,
     .fallback = "both"},
    WHOLE32("renderer.follow", S, params.renderer.follow, 0, UINT32_MAX, "0"),
    BOOLEAN("renderer.fog", S, params.renderer.fog, STORE_U32, "true"),
    BOOLEAN("renderer.haze", S, params.renderer.haze, STORE_U32, "true"),
    BOOLEAN("renderer.texture", S, params.renderer.texture, STORE_U32, "true"),
    CHOICE("renderer.backend", S, params.renderer.back_end, STORE_U32, back_ends, "auto"),
    BOOLEAN("renderer.hold", S, params.renderer.hold, STORE_U32, "true"),
};
#undef S
const struct key_table schema_scenario = {"", scenario_keys, COUNT(scenario_keys)};
_Static_assert(COUNT(scenario_keys) <= 64, "key_reading.given is one word");

#define V struct vehicle_entry
static const struct key vehicle_keys[] = {
    [VEHICLE_KIND] = TEXT_NEEDED("kind", V, kind),
    [VEHICLE_COUNT] = WHOLE32("count", V, count, 1, CAPACITY_MAX, "1"),
    [VEHICLE_FORCE] = CHOICE("force", V, force, STORE_U32, forces, "neutral"),
    /* No fallback: patrol, idle when placed, route when it has one (config/lists.c). */
    [VEHICLE_BEHAVIOUR] = CHOICE("behaviour", V, behaviour, STORE_U32, behaviours, NULL),
    [VEHICLE_AREA] = PLACE("area", KEY_AREA, STORE_DOUBLE, V, area, false),
    [VEHICLE_ROUTE] = PLACE("route", KEY_ROUTE, STORE_ROUTE, V, route, false),
    [VEHICLE_ROADS] = BOOLEAN("roads", V, roads, STORE_U32, "false"),
    [VEHICLE_SCRIPT] = TEXT("script", V, script, NULL),
    [VEHICLE_NAME] = TEXT("name", V, name, NULL),
    [VEHICLE_AT] = PLACE("at", KEY_POINT, STORE_DOUBLE, V, at, false),
    [VEHICLE_ALTITUDE] = NUMBER("altitude_m", V, altitude_m, 0, 20000, NULL),
    [VEHICLE_HEADING] = SCALED("heading_deg", V, heading_rad, -360, 360, RAD_PER_DEG, NULL),
    [VEHICLE_SPEED] = NUMBER("speed_mps", V, speed_mps, 0, 3000, NULL),
    [VEHICLE_FIRE_AT_WILL] = BOOLEAN("fire_at_will", V, fire_at_will, STORE_U32, "false"),
    /* No fallback: what fire_at_will says. */
    [VEHICLE_ENGAGE] = CHOICE("engage", V, engage, STORE_U32, engagements, NULL),
    [VEHICLE_STAND] = BOOLEAN("stand", V, stand, STORE_U32, "false"),
    [VEHICLE_FORMATION] = CHOICE("formation", V, formation, STORE_U32, formations, NULL),
    [VEHICLE_SPACING] = NUMBER("spacing_m", V, spacing_m, 1, 5000, "50"),
};
#undef V
const struct key_table schema_vehicle = {"vehicles", vehicle_keys, COUNT(vehicle_keys)};
_Static_assert(COUNT(vehicle_keys) == VEHICLE_KEY_COUNT, "a row for each vehicle_key");

#define C struct script_entry
static const struct key script_keys[] = {
    [SCRIPT_NAME] = TEXT_NEEDED("name", C, name),
    [SCRIPT_FILE] = TEXT("file", C, file, NULL),
    [SCRIPT_REPEAT] = BOOLEAN("repeat", C, repeat, STORE_U32, "false"),
    [SCRIPT_REACT] = BOOLEAN("react", C, react, STORE_U32, "false"),
};
#undef C
const struct key_table schema_script = {"scripts", script_keys, COUNT(script_keys)};
_Static_assert(COUNT(script_keys) == SCRIPT_KEY_COUNT, "a row for each script_key");

#define T struct step_entry
static const struct key step_keys[] = {
    [STEP_KEY_AT] = NUMBER("at_s", T, at_s, 0, 1e7, NULL),
    [STEP_KEY_AFTER] = NUMBER("after_s", T, after_s, 0, 1e7, NULL),
    [STEP_KEY_GO] = PLACE("go", KEY_POINT, STORE_DOUBLE, T, go, false),
    [STEP_KEY_ARRIVE] = PLACE("arrive", KEY_POINT, STORE_DOUBLE, T, arrive, false),
    [STEP_KEY_FACE] = SCALED("face_deg", T, face_rad, -360, 360, RAD_PER_DEG, NULL),
    [STEP_KEY_STOP] = BOOLEAN("stop", T, stop, STORE_U32, NULL),
    [STEP_KEY_WAIT] = NUMBER("wait_s", T, wait_s, 0, 1e7, NULL),
    [STEP_KEY_FIRE] = TEXT("fire", T, fire, NULL),
    [STEP_KEY_FIRE_AT] = PLACE("fire_at", KEY_POINT, STORE_DOUBLE, T, fire_at, false),
    [STEP_KEY_BEHAVIOUR] = CHOICE("behaviour", T, behaviour, STORE_U32, orders, NULL),
    [STEP_KEY_THROTTLE] = NUMBER("throttle", T, throttle, -1, 1, "0"),
    [STEP_KEY_STEER] = NUMBER("steer", T, steer, -1, 1, "0"),
    [STEP_KEY_CLIMB] = NUMBER("climb", T, climb, -1, 1, "0"),
    [STEP_KEY_FOR] = NUMBER("for_s", T, for_s, 0, 1e7, NULL),
    [STEP_KEY_SPEED] = NUMBER("speed_mps", T, speed_mps, 0.1, 3000, NULL),
    [STEP_KEY_ALTITUDE] = NUMBER("altitude_m", T, altitude_m, 0, 20000, NULL),
};
#undef T
const struct key_table schema_step = {"steps", step_keys, COUNT(step_keys)};
_Static_assert(COUNT(step_keys) == STEP_KEY_COUNT, "a row for each step_key");

#define B struct base_entry
static const struct key base_keys[] = {
    [BASE_FORCE] = {ROW("force", KEY_CHOICE, STORE_U32, B, force), .choices = forces,
                    .required = true},
    [BASE_AT] = PLACE("at", KEY_POINT, STORE_DOUBLE, B, at, true),
};
#undef B
const struct key_table schema_base = {"bases", base_keys, COUNT(base_keys)};
_Static_assert(COUNT(base_keys) == BASE_KEY_COUNT, "a row for each base_key");

#define O struct object_entry
static const struct key object_keys[] = {
    [OBJECT_KEY_KIND] = TEXT_NEEDED("kind", O, kind),
    [OBJECT_KEY_AT] = PLACE("at", KEY_POINT, STORE_DOUBLE, O, at, true),
    [OBJECT_KEY_HEADING] = SCALED("heading_deg", O, heading_rad, -360, 360, RAD_PER_DEG, "0"),
};
#undef O
const struct key_table schema_object = {"objects", object_keys, COUNT(object_keys)};
_Static_assert(COUNT(object_keys) == OBJECT_KEY_COUNT, "a row for each object_key");

#define F struct fire_entry
static const struct key fire_keys[] = {
    [FIRE_AT] = NUMBER("at_s", F, at_s, 0, 1e7, "0"),
    [FIRE_SHOOTER] = TEXT("shooter", F, shooter, NULL),
    [FIRE_TARGET] = TEXT("target", F, target, NULL),
    [FIRE_MUNITION] = TEXT("munition", F, munition, NULL),
    [FIRE_POINT] = PLACE("point", KEY_POINT, STORE_DOUBLE, F, point, false),
};
#undef F
const struct key_table schema_fire = {"fires", fire_keys, COUNT(fire_keys)};
_Static_assert(COUNT(fire_keys) == FIRE_KEY_COUNT, "a row for each fire_key");

#define K struct kind_entry
static const struct key kind_keys[] = {
    TEXT_NEEDED("name", K, kind.name),
    {ROW("domain", KEY_CHOICE, STORE_U8, K, kind.domain), .choices = domains, .required = true},
    CHOICE("class", K, kind.object_class, STORE_U8, classes, NULL),
    TEXT_NEEDED("model", K, model),
    TEXT("munition", K, munition, NULL),
    CHOICE("guidance", K, kind.guidance, STORE_U8, guidances, "ballistic"),
    BOOLEAN("craters", K, kind.craters, STORE_U8, "false"),
    NEEDED("mass_kg", K, kind.mass_kg, 0.001, 1e9),
    NEEDED("radius_m", K, kind.radius_m, 0.01, 500),
    NEEDED("length_m", K, kind.length_m, 0.01, 1000),
    NEEDED("width_m", K, kind.width_m, 0.01, 1000),
    NEEDED("height_m", K, kind.height_m, 0.01, 1000),
    NUMBER("max_speed_mps", K, kind.max_speed_mps, 0, 3000, "0"),
    NUMBER("min_speed_mps", K, kind.min_speed_mps, 0, 3000, "0"),
    NUMBER("acceleration_mps2", K, kind.acceleration_mps2, 0, 10000, "0"),
    SCALED("turn_rate_dps", K, kind.turn_rate_rps, 0, 720, RAD_PER_DEG, "0"),
    SCALED("max_slope_deg", K, kind.max_slope_rad, 1, 89, RAD_PER_DEG, "30"),
    NUMBER("cruise_altitude_m", K, kind.cruise_altitude_m, 0, 20000, "0"),
    NUMBER("climb_rate_mps", K, kind.climb_rate_mps, 0, 500, "0"),
    NUMBER("rigidity", K, kind.rigidity, 0, 1, "0.5"),
    NUMBER("moldability", K, kind.moldability, 0, 1, "0.5"),
    NUMBER("restitution", K, kind.restitution, 0, 1, "0.2"),
    NUMBER("friction", K, kind.friction, 0, 2, "0.6"),
    NEEDED("resistance_j", K, kind.resistance_j, 1, 1e12),
    /* 0: follows from resistance_j and the size (config/kinds.c). */
    NUMBER("stiffness_npm", K, kind.stiffness_npm, 0, 1e12, "0"),
    SCALED("severe_deg", K, kind.severe_rad, 0, 45, RAD_PER_DEG, "5"),
    NUMBER("bounce_keep", K, kind.bounce_keep, 0, 1, "0.6"),
    NUMBER("fast_mps", K, kind.fast_mps, 0, 3000, "0"),
    NUMBER("damage_high", K, kind.damage_high, 0, 1000, "0"),
    NUMBER("damage_med", K, kind.damage_med, 0, 1000, "0"),
    NUMBER("damage_low", K, kind.damage_low, 0, 1000, "0"),
    NUMBER("debris_keep", K, kind.debris_keep, 0, 1, "1"),
    NUMBER("explosive_kg", K, kind.explosive_kg, 0, 100000, "0"),
    NUMBER("range_m", K, kind.range_m, 0, 50000, "0"),
    /* 0: follows from range_m (config/kinds.c). */
    NUMBER("sight_m", K, kind.sight_m, 0, 50000, "0"),
    SCALED("view_deg", K, kind.view_rad, 1, 360, RAD_PER_DEG, "360"),
    /* No fallback: follows from the domain (config/kinds.c). */
    CHOICE("doctrine", K, kind.doctrine, STORE_U32, doctrines, NULL),
    NUMBER("reload_s", K, kind.reload_s, 0, 3600, "0"),
    SCALED("turret_rate_dps", K, kind.turret_rate_rps, 0, 360, RAD_PER_DEG, "0"),
    SCALED("gun_rate_dps", K, kind.gun_rate_rps, 0, 360, RAD_PER_DEG, "0"),
    SCALED("gun_low_deg", K, kind.gun_low_rad, -90, 90, RAD_PER_DEG, "0"),
    SCALED("gun_high_deg", K, kind.gun_high_rad, -90, 90, RAD_PER_DEG, "0"),
    SCALED("seeker_deg", K, kind.seeker_rad, 0, 180, RAD_PER_DEG, "0"),
    SCALED("dispersion_mrad", K, kind.dispersion_rad, 0, 500, 0.001, "0"),
    NUMBER("life_s", K, kind.life_s, 0, 600, "0"),
    NUMBER("courage", K, kind.courage, 0, 1, "0.5"),
    NUMBER("fuel_l", K, kind.fuel_l, 0, 1e7, "0"),
    NUMBER("fuel_lps", K, kind.fuel_lps, 0, 1000, "0"),
    WHOLE32("rounds", K, kind.rounds, 0, 1000000, "0"),
};
#undef K
const struct key_table schema_kind = {"kind", kind_keys, COUNT(kind_keys)};
_Static_assert(COUNT(kind_keys) <= 64, "key_reading.given is one word");
