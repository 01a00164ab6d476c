/* The schema of a scenario's groups. `make docs` writes these rows into docs/scenario.md. */
#include "config/syntax/schema_internal.h"
#include "world/entity/entity.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/remote.h"
#include "world/gateway_defaults.h"
#include "world/making/scenario_settings.h"
#include "world/param_values.h"
#include "world/view_mode.h"

_Static_assert(sizeof(enum terrain_source) == sizeof(uint32_t), "choices store 32-bit words");
_Static_assert(sizeof(enum object_source) == sizeof(uint32_t), "choices store 32-bit words");

static const struct key_choice paces[] = {{"real", PACE_REAL, NULL}, {"max", PACE_MAX, NULL}};
static const struct key_choice terrains[] = {{"generated", TERRAIN_GENERATED, NULL},
                                             {"flat", TERRAIN_FLAT, NULL},
                                             {"file", TERRAIN_FILE, NULL},
                                             {"dem", KEY_LATER, NULL}};
static const struct key_choice spacings[] = {
    {"125", 0, NULL}, {"62.5", 0, NULL}, {"31.25", 0, NULL}};
static const struct key_choice object_sources[] = {
    {"table1", OBJECTS_TABLE1, NULL}, {"none", OBJECTS_NONE, NULL}, {"file", OBJECTS_FILE, NULL}};
#define X(name, value, word, test, text) {NULL, METHOD_##name, text},
static const struct key_choice methods[] = {METHODS(X)};
#undef X
static const struct key_choice shapes[] = {{.value = SHAPE_MODEL}, {.value = SHAPE_SPHERE}};
#define X(name, value, word, text) {NULL, MODEL_##name, text},
static const struct key_choice responses[] = {RESPONSE_MODELS(X)};
#undef X
static const struct key_choice nearnesses[] = {{"and", NEARNESS_AND, NULL},
                                               {"or", NEARNESS_OR, NULL}};
static const struct key_choice measures[] = {{"energy", MEASURE_ENERGY, NULL},
                                             {"mass", MEASURE_MASS, NULL}};
static const char *view_bit_name(uint32_t bit)
{
    return view_mode_name((enum view_mode)__builtin_ctz(bit));
}
static const struct key_choice views[] = {{.value = 1u << VIEW_CHASE},
                                          {.value = 1u << VIEW_MAP},
                                          {.value = 1u << VIEW_INSIDE},
                                          {.value = 1u << VIEW_ORBIT},
                                          {.value = 1u << VIEW_FREE},
                                          {.value = 1u << VIEW_OVERHEAD},
                                          {"both", 1u << VIEW_CHASE | 1u << VIEW_MAP, NULL}};
static const struct key_choice whens_full[] = {{"gap", WHEN_FULL_GAP, NULL},
                                               {"pause", WHEN_FULL_PAUSE, NULL}};

#define S struct scenario_settings
static const struct key scenario_keys[] = {
    TEXT("world.name", S, params.name, "unnamed",
         .meaning = "The name of the ground in titles and reports."),
    WHOLE64("world.seed", S, params.seed, 0, SCHEMA_WHOLE_MAX, "1991",
            .meaning = "All random choices follow from this number: the ground, places, goals and "
                       "aim. The same seed gives the same run."),
    NUMBER("world.hz", S, params.hz, 1, 1000, "60", .unit = "Hz",
           .meaning = "Frames per second of simulated time. A frame lasts 1/hz seconds."),
    WHOLE32("world.capacity", S, params.capacity, CAPACITY_MIN, CAPACITY_MAX, "4096",
            .meaning = "How many vehicles and munitions the world can hold at one time."),
    WHOLE32("world.contacts", S, params.contact_slots, 1, PERSISTENT_CONTACT_SLOTS_MAX, NULL,
            .unset = "4 times `world.capacity` up to 16384, 1 for each further slot, at least 256",
            .meaning = "How many pairs of bodies can press on each other at one time. The world "
                       "counts the contacts for which there is no room, as `contacts_refused`."),
    WHOLE32("world.remotes_max", S, params.remotes_max, 0, REMOTE_ROWS_MAX,
            GATEWAY_DEFAULT_REMOTES_MAX,
            .meaning = "How many vehicles of other simulators the world takes in at most "
                       "([dis.md](dis.md)). They need room in `world.capacity`, which has to be as "
                       "large at least."),
    BOOLEAN("world.cruise", S, params.cruise, STORE_U32, "true",
            .meaning =
                "true: vehicles whose agents go on as they did are moved by half a second or more "
                "at once, unless something comes near ([decision "
                "049](decisions/049-cruising.md)). A frame of many vehicles costs less. "
                "false: each vehicle is moved in each frame, as with every "
                "`collision.method` but \"swept\"."),
    WHOLE64("world.frames", S, params.frame_limit, 0, SCHEMA_WHOLE_MAX, "0",
            .meaning = "The run ends with this frame. 0: the run has no last frame."),
    CHOICE("world.pace", S, params.pace, STORE_U32, WORDS(paces), "real",
           .meaning = "`real`: a second of simulated time takes a second of the clock. `max`: the "
                      "run goes as fast as it can."),
    NUMBER("world.wind_mps", S, params.wind_mps, 0, 50, "0", .unit = "m/s",
           .meaning =
               "The speed of the wind, the same everywhere. It acts on rounds in flight, and "
               "crews take it into account."),
    SCALED("world.wind_from_deg", S, params.wind_from_rad, 0, 360, RAD_PER_DEG, "0",
           .unit = "degrees", .meaning = "From where the wind blows, clockwise from north."),
    CHOICE("terrain.source", S, terrain, STORE_U32, WORDS(terrains), "generated",
           .meaning = "`generated`: Fort Hunter Liggett, made from its real places, with hills "
                      "that follow from the seed. `flat`: level grass. `file`: a ground file, made "
                      "from maps of any place on Earth ([ground.md](ground.md))."),
    TEXT("terrain.file", S, ground_file, NULL, .unset = "none",
         .meaning = "The ground file of `file`: a path, from the scenario's folder or the current "
                    "one, or the name of one of `grounds/` in the folder of the data. Its hash is "
                    "a part of the scenario, so a log is not replayed on another ground."),
    NUMBER("terrain.height_m", S, flat_height_m, -400, 8000, "0", .unit = "m",
           .meaning = "The height of `flat` ground."),
    ROW("terrain.side_m", KEY_NUMBER, STORE_DOUBLE, S, side_m, .scale = 1.0,
        .low = WORLD_SIDE_MIN_M, .high = WORLD_SIDE_MAX_M, .unit = "m",
        .unset = "50000, or the side of a ground file that does not fit into 50 km",
        .meaning =
            "The side of the world, a multiple of 125 m. Places are from 0 to it, where this "
            "page says 50000. A smaller ground file lies in the middle. Generated ground has "
            "50 km."),
    ROW("terrain.spacing_m", KEY_NUMBER, STORE_DOUBLE, S, spacing_m, .scale = 1.0, .low = 31.25,
        .high = 125, .fallback = "31.25", WORDS(spacings), .unit = "m",
        .meaning = "The distance between neighbouring posts, the points whose height is known. A "
                   "ground file has its own."),
    CHOICE("objects.source", S, objects, STORE_U32, WORDS(object_sources), NULL,
           .unset = "table1 on generated ground, file on that of a file, else none",
           .meaning = "`table1`: the objects of the thesis's Table 1. `none`: no objects. `file`: "
                      "the buildings, woods and poles of the ground file. `objects` is either this "
                      "group or a list of objects."),
    CHOICE("collision.method", S, params.collision.method, STORE_U32, SOME(methods, method_name),
           "swept", .meaning = "How collisions are found: see below."),
    CHOICE("collision.shape", S, params.collision.shape, STORE_U32, SOME(shapes, shape_name),
           "model",
           .meaning = "The shape of bodies. `model`: the convex hulls of their model. `sphere`: a "
                      "sphere with the `radius_m` of their kind."),
    CHOICE("collision.response", S, params.collision.response, STORE_U32,
           SOME(responses, response_model_name), "impulse",
           .meaning = "What a collision does to vehicles: see below."),
    NUMBER("collision.threshold_height_m", S, params.collision.threshold_height_m, 0, 1000, "60",
           .unit = "m",
           .meaning = "A height above the ground. An aircraft that stays higher during the whole "
                      "frame is not tested against fixed objects."),
    CHOICE("collision.npsnet2.nearness", S, params.collision.nearness, STORE_U32, WORDS(nearnesses),
           "and",
           .meaning = "The first test of method `npsnet2` keeps pairs of bodies that are within "
                      "100 m. `and`: both in x and in z, as the thesis surely meant. `or`: in x "
                      "or in z, as it is printed."),
    NUMBER("collision.mps.near_m", S, params.collision.mps_near_m, 0.1, 1000, "10", .unit = "m",
           .meaning = "Method `mps`: two vehicles collide when their positions on the map are this "
                      "near; the sizes of their bodies do not count. The thesis says only \"within "
                      "a certain range\"."),
    NUMBER("collision.figure8.fast_vehicle_mps", S, params.collision.fast_vehicle_mps, 0, 1000, "8",
           .unit = "m/s",
           .meaning = "A severe impact (see `severe_deg`) destroys both vehicles when either is "
                      "faster than this. Otherwise both stop. A kind can have its own value, "
                      "`fast_mps`."),
    NUMBER("collision.figure8.fast_fixed_mps", S, params.collision.fast_fixed_mps, 0, 1000, "8",
           .unit = "m/s",
           .meaning = "A vehicle that is faster than this is destroyed by a large fixed object. "
                      "Every other vehicle goes on, and its speed is multiplied by its share of "
                      "both masses."),
    NUMBER("collision.figure8.large_fixed_kg", S, params.collision.large_fixed_kg, 0, 1e9, "20000",
           .unit = "kg", .meaning = "A fixed object of this mass or more is large."),
    CHOICE("collision.figure8.measure", S, params.collision.measure, STORE_U32, WORDS(measures),
           "energy",
           .meaning = "What the damage of a fixed object follows from. `energy`: the energy of the "
                      "impact, compared with the three `damage_` constants. `mass`: the mass of "
                      "the vehicle alone, as printed, compared with the three `mass_` constants."),
    NUMBER("collision.figure8.damage_high", S, params.collision.damage_high, 0, 1000, "1",
           .meaning = "The ratio of the energy of the impact to the fixed object's `resistance_j` "
                      "from which its damage is high. A kind can have its own three ratios."),
    NUMBER("collision.figure8.damage_med", S, params.collision.damage_med, 0, 1000, "0.3",
           .meaning = "The ratio from which damage is medium. It must be below `damage_high`."),
    NUMBER("collision.figure8.damage_low", S, params.collision.damage_low, 0, 1000, "0.1",
           .meaning = "The ratio from which damage is low; below it there is none. It must be "
                      "below `damage_med`."),
    NUMBER("collision.figure8.mass_c1_kg", S, params.collision.mass_c1_kg, 0, 1e9, "20000",
           .unit = "kg",
           .meaning = "The thesis's c1, for `measure = \"mass\"`: a vehicle of this mass or more "
                      "does high damage."),
    NUMBER("collision.figure8.mass_c2_kg", S, params.collision.mass_c2_kg, 0, 1e9, "8000",
           .unit = "kg",
           .meaning = "The thesis's c2: a vehicle of this mass or more does medium damage. It must "
                      "be below `mass_c1_kg`."),
    NUMBER("collision.figure8.mass_c3_kg", S, params.collision.mass_c3_kg, 0, 1e9, "1000",
           .unit = "kg",
           .meaning = "The thesis's c3: a vehicle of this mass or more does low damage, a lighter "
                      "one none. It must be below `mass_c2_kg`."),
    NUMBER("battle.end_s", S, params.battle.end_s, 0, 1e6, "0", .unit = "s",
           .meaning = "The battle of the missions ends at this time after its beginning, and its "
                      "result is told. 0: it has no end."),
    NUMBER("battle.again_s", S, params.battle.again_s, 0, 1e6, "0", .unit = "s",
           .meaning = "All missions begin again with their first phase at this time after the "
                      "beginning of the battle; it must be after `battle.end_s`. 0: never."),
    CHOICE("recorder.when_full", S, params.when_full, STORE_U32, WORDS(whens_full), "gap",
           .meaning = "What happens when the recorder cannot write, because the disk is full or "
                      "time is short, and the event ring fills up. `gap`: new events overwrite old "
                      "ones, and the log counts the lost events as a gap. `pause`: the world is "
                      "paused when half of the ring is unwritten, and resumed when all of it is "
                      "written."),
    WHOLE32("renderer.width", S, params.renderer.width, 16, 7680, "1280", .unit = "pixels",
            .meaning = "The width of a picture."),
    WHOLE32("renderer.height", S, params.renderer.height, 16, 4320, "720", .unit = "pixels",
            .meaning = "The height of a picture."),
    NUMBER("renderer.fps", S, params.renderer.fps, 0, 120, "2",
           .meaning = "Pictures per second of the clock. 0: one picture at the end."),
    ROW("renderer.view", KEY_CHOICES, STORE_U32, S, params.renderer.views,
        SOME(views, view_bit_name), .fallback = "both",
        .meaning = "The views that are drawn of each frame, with commas between them "
                   "([pictures.md](pictures.md)). `both`: `chase` and `map`."),
    WHOLE32("renderer.follow", S, params.renderer.follow, 0, UINT32_MAX, "0",
            .meaning = "The id of the vehicle that the camera follows. 0: the renderer chooses "
                       "one."),
    BOOLEAN("renderer.fog", S, params.renderer.fog, STORE_U32, "true",
            .meaning = "true: distant ground fades into fog."),
    BOOLEAN("renderer.haze", S, params.renderer.haze, STORE_U32, "true",
            .meaning = "true: the horizon is hazy."),
    BOOLEAN("renderer.texture", S, params.renderer.texture, STORE_U32, "true",
            .meaning = "true: the ground has texture."),
    CHOICE("renderer.backend", S, params.renderer.back_end, STORE_U32,
           ALL(back_end_name, BACK_END_COUNT), "auto",
           .meaning = "What draws. `gl`: OpenGL. `soft`: the project's own rasteriser. `auto`: "
                      "OpenGL on a machine with graphics hardware, the rasteriser on any other."),
    BOOLEAN("renderer.hold", S, params.renderer.hold, STORE_U32, "true",
            .meaning = "true: a renderer that cannot keep its rate draws less detail, then smaller "
                       "pictures, and reports it. false: it draws fewer pictures."),
    BOOLEAN("gateway.enabled", S, params.gateway.enabled, STORE_U32, "false",
            .meaning = "true: the set has a gateway, which shows the world to other simulators by "
                       "DIS ([dis.md](dis.md))."),
    TEXT("gateway.address", S, params.gateway.address, GATEWAY_DEFAULT_ADDRESS,
         .meaning = "Where PDUs are sent, in numbers: the address of a machine, of a multicast "
                    "group or of a broadcast."),
    WHOLE32("gateway.port", S, params.gateway.port, 1, 65535, GATEWAY_DEFAULT_PORT,
            .meaning = "The port of UDP."),
    TEXT("gateway.listen", S, params.gateway.listen, GATEWAY_DEFAULT_LISTEN,
         .meaning =
             "Where PDUs are received: an address of this machine, of a multicast group or of a "
             "broadcast in numbers, with a port if it is not 3000; \"0.0.0.0\" is any address of "
             "this machine and its broadcasts. \"none\": nowhere."),
    TEXT("gateway.interface", S, params.gateway.interface, GATEWAY_DEFAULT_INTERFACE,
         .meaning = "The interface of multicast and of link-local addresses: its name, such as "
                    "\"eth0\", or an address that it has. \"any\": the system's choice."),
    WHOLE32("gateway.exercise", S, params.gateway.exercise, 1, 255, GATEWAY_DEFAULT_EXERCISE,
            .meaning = "The exercise, by which simulators on one network tell theirs from others."),
    WHOLE32("gateway.site", S, params.gateway.site, 1, 65533, GATEWAY_DEFAULT_SITE,
            .meaning = "The site in the identifiers of our entities."),
    WHOLE32("gateway.application", S, params.gateway.application, 1, 65533,
            GATEWAY_DEFAULT_APPLICATION,
            .meaning = "The first application in the identifiers of our entities."),
    WHOLE32("gateway.applications", S, params.gateway.applications, 1, 65533,
            GATEWAY_DEFAULT_APPLICATIONS,
            .meaning = "How many applications our identifiers may use, from `gateway.application` "
                       "on. Each has room for 65,533 of the ids that a world gives."),
    WHOLE32("gateway.version", S, params.gateway.version, 6, 7, GATEWAY_DEFAULT_VERSION,
            .meaning = "The version of DIS: 6 is IEEE 1278.1A-1998, 7 is 1278.1-2012."),
    WHOLE32("gateway.rate", S, params.gateway.rate_ps, 1, 1000000, GATEWAY_DEFAULT_RATE,
            .meaning = "How many PDUs a second are sent at most. Those that are put off are sent "
                       "later, as they are then."),
    BOOLEAN("gateway.clamp", S, params.gateway.clamp, STORE_U32, GATEWAY_DEFAULT_CLAMP,
            .meaning = "true: a land vehicle of another simulator is set on our ground where that "
                       "is within 30 m of its place."),
    NUMBER("gateway.timeout_s", S, params.gateway.timeout_s, 1, 3600, GATEWAY_DEFAULT_TIMEOUT_S,
           .unit = "s",
           .meaning = "An entity of another simulator is removed when no Entity State of it came "
                      "for so long."),
    NUMBER("gateway.latitude_deg", S, params.gateway.latitude_deg, -89.9, 89.9, "35.95",
           .unit = "degrees", .meaning = "The latitude of the middle of the square, on WGS 84."),
    NUMBER("gateway.longitude_deg", S, params.gateway.longitude_deg, -180, 180, "-121.25",
           .unit = "degrees", .meaning = "The longitude of the middle of the square."),
    NUMBER("gateway.undulation_m", S, params.gateway.undulation_m, -200, 200, "-33.7", .unit = "m",
           .meaning = "The height of the sea level above the ellipsoid at the middle of the "
                      "square. DIS has heights above the ellipsoid."),
    BOOLEAN("gateway.undulation_grid", S, params.gateway.undulation_grid, STORE_U32,
            GATEWAY_DEFAULT_UNDULATION_GRID,
            .meaning =
                "true: the height of the sea level at each place, from PROJ's grid of EGM96, "
                "instead of `gateway.undulation_m` for the whole square. Where the grid is "
                "missing the log says so, and it is as with false."),
    TEXT("gateway.cot", S, params.gateway.cot, GATEWAY_DEFAULT_COT,
         .meaning = "Where events of Cursor on Target are sent: an address in numbers, with a port "
                    "if it is not 6969, such as \"239.2.3.1:6969\". \"none\": nowhere."),
    TEXT("gateway.peers", S, params.gateway.peers, GATEWAY_DEFAULT_PEERS,
         .meaning = "From whom packets are taken: addresses, and ranges such as \"10.1.0.0/16\", "
                    "with commas between them. \"none\": from nobody."),
    TEXT("gateway.control", S, params.gateway.control, GATEWAY_DEFAULT_CONTROL,
         .meaning =
             "Whose Start/Resume and Stop/Freeze are obeyed: SITE:APPLICATION, or SITE:* for "
             "all of a site, with commas between them. \"none\": nobody's."),
};
#undef S
const struct key_table schema_scenario = {"", scenario_keys, COUNT(scenario_keys),
                                          sizeof(struct scenario_settings)};
_Static_assert(COUNT(scenario_keys) <= KEY_TABLE_MAX, "the keys fit into a table");
