/* The refusals of config/, word for word: file, line, key, value and what is allowed. */
#include "config/loader.h"

#include "config/syntax/schema.h"
#include "tests/support/quick_config.h"
#include "world/collision_models.h"
#include "world/making/scenario.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static struct error_text error;

/* --- refusals ----------------------------------------------------------------------------------*/

struct refusal {
    const char *text;
    int line;
    const char
        *says; /* the message after "file:line: "; with "..." at its end only its beginning */
};

/* The words that a refusal offers for a method or a response, from their registries. Each begins
 * with ", ". */
#define X(name, value, word, ...) ", " #word
static const char method_words[] = METHODS(X);
static const char response_words[] = RESPONSE_MODELS(X);
#undef X
#define METHOD_WORDS   "$methods"
#define RESPONSE_WORDS "$responses"

#define VEHICLE(entry) "vehicles = (\n{ kind = \"tank\"; " entry " } );"

#define WORK(shape, keys, place)                                                                   \
    "earthworks = (\n{ shape = \"" shape "\"; at = [" place ", " place                             \
    "]; length_m = 20.0; width_m = 12.0; " keys " } );"

#define STEPS(list) "scripts = ( { name = \"a\"; steps = (\n" list " ); } );"

static const struct refusal refusals[] = {
    /* Unknown keys. */
    {"world = {\n sede = 7; };", 2,
     "world.sede = 7: unknown key; allowed here: name, seed, hz, capacity, contacts, remotes_max, "
     "cruise, "
     "frames, pace, "
     "wind_mps, wind_from_deg"},
    {"\nwrold = { seed = 7; };", 2,
     "wrold = {...}: unknown key; allowed here: world, terrain, objects, collision, battle, "
     "recorder, renderer, gateway, "
     "vehicles, missions, objectives, scripts, fires, earthworks, bases"},
    {"collision = { figure8 = { damage = 1; }; };", 1,
     "collision.figure8.damage = 1: unknown key; allowed here: fast_vehicle_mps, fast_fixed_mps, "
     "large_fixed_kg, measure, damage_high, damage_med, damage_low, mass_c1_kg, mass_c2_kg, "
     "mass_c3_kg"},
    {"collision = { npsnet2 = { near = 1; }; };", 1,
     "collision.npsnet2.near = 1: unknown key; allowed here: nearness"},
    {"collision = { mps = 3; };", 1,
     "collision.mps = 3: is not a group; allowed: { key = value; ... }"},
    {VEHICLE("colour = \"green\";"), 2,
     "vehicles[0].colour = \"green\": unknown key; allowed here: kind, count, ..."},
    {"fires = ( { at = 1; } );", 1,
     "fires[0].at = 1: unknown key; allowed here: at_s, shooter, target, munition, point, "
     "rounds, adjust, fuze, high, bearing_deg"},
    {"objects = ( { kind = \"tree\"; at = [1, 2]; size = 2; } );", 1,
     "objects[0].size = 2: unknown key; allowed here: kind, at, heading_deg"},
    /* Values that do not fit each other. */
    {"world = { capacity = 64;\n remotes_max = 65; };", 2,
     "world.remotes_max = 65: world.capacity = 64 has no rows for so many; allowed: up to 64, or a "
     "larger world.capacity"},
    {"gateway = { listen = \"[ff02::1%eth0]:3000\"; };", 1,
     "gateway.listen = [ff02::1%eth0]:3000: an address has no %zone here; name it by "
     "gateway.interface"},
    {"gateway = { address = \"0.0.0.0\"; };", 1,
     "gateway.address = 0.0.0.0: is no address to send to; right would be that of a machine, of a "
     "broadcast such as 10.0.0.255, or of a group such as 239.1.2.3"},
    {"gateway = {\n cot = \"[::]:4242\"; };", 2,
     "gateway.cot = [::]:4242: is no address to send to; right would be that of a machine, of a "
     "broadcast such as 10.0.0.255, or of a group such as 239.1.2.3"},
    {"gateway = {\n address = \"fe80::1%eth0\"; };", 2,
     "gateway.address = fe80::1%eth0: an address has no %zone here; name it by "
     "gateway.interface"},
    /* Types. */
    {"world = 7;", 1, "world = 7: is not a group; allowed: { key = value; ... }"},
    {"world = { name = 7; };", 1,
     "world.name = 7: is not text in quotes; allowed: up to 47 characters"},
    {"world = { seed = 7.0; };", 1,
     "world.seed = 7: is not a whole number; allowed: 0..9007199254740991"},
    {"world = { hz = \"60\"; };", 1, "world.hz = \"60\": is not a number; allowed: 1..1000 Hz"},
    {"world = { hz = true; };", 1, "world.hz = true: is not a number; allowed: 1..1000 Hz"},
    {"world = { pace = 1; };", 1, "world.pace = 1: is not text in quotes; allowed: real, max"},
    {"renderer = { fog = 1; };", 1, "renderer.fog = 1: is not a boolean; allowed: true, false"},
    {"vehicles = 3;", 1, "vehicles = 3: is not a list; allowed: ( { key = value; ... }, ... )"},
    {"vehicles = { };", 1,
     "vehicles = {...}: is not a list; allowed: ( { key = value; ... }, ... )"},
    {"vehicles = (\n 3 );", 2, "vehicles[0] = 3: is not a group; allowed: { key = value; ... }"},
    {"objects = \"none\";", 1, "objects = \"none\": is not a group; allowed: { key = value; ... }"},
    {"objects = ( [1, 2] );", 1,
     "objects[0] = [1, 2]: is not a group; allowed: { key = value; ... }"},
    {"fires = \"now\";", 1,
     "fires = \"now\": is not a list; allowed: ( { key = value; ... }, ... )"},
    {VEHICLE("at = 5;"), 2,
     "vehicles[0].at = 5: is not two numbers; allowed: [x, z], each 0..50000 m"},
    {VEHICLE("at = [1, 2, 3];"), 2,
     "vehicles[0].at = [1, 2, 3]: is not two numbers; allowed: [x, z], each 0..50000 m"},
    {VEHICLE("at = (1, \"x\");"), 2,
     "vehicles[0].at = (1, \"x\"): is not two numbers; allowed: [x, z], each 0..50000 m"},
    {VEHICLE("area = [1, 2];"), 2, "vehicles[0].area = [1, 2]: is not four numbers; allowed: ..."},
    {VEHICLE("area = \"none\";"), 2, "vehicles[0].area = \"none\": is not four numbers; ..."},
    {VEHICLE("route = [1, 2];"), 2,
     "vehicles[0].route = [1, 2]: is not a list of points; allowed: ( [x, z], [x, z], ... ), each "
     "0..50000 m"},
    {VEHICLE("route = ( [1, 2], 3 );"), 2,
     "vehicles[0].route = ([1, 2], 3): is not a list of points; ..."},
    /* Ranges. */
    {"world = { hz = 0; };", 1, "world.hz = 0: out of range; allowed: 1..1000 Hz"},
    {"world = { hz = 1001; };", 1, "world.hz = 1001: out of range; allowed: 1..1000 Hz"},
    {"world = { hz = 1e999; };", 1, "world.hz = inf: out of range; allowed: 1..1000 Hz"},
    {"world = { seed = -1; };", 1, "world.seed = -1: out of range; allowed: 0..9007199254740991"},
    {"world = { seed = 9007199254740992L; };", 1,
     "world.seed = 9007199254740992: out of range; allowed: 0..9007199254740991"},
    {"world = { capacity = 15; };", 1, "world.capacity = 15: out of range; allowed: 16..1048576"},
    {"world = { capacity = 1048577; };", 1,
     "world.capacity = 1048577: out of range; allowed: 16..1048576"},
    {"world = { contacts = 0; };", 1, "world.contacts = 0: out of range; allowed: 1..4194304"},
    {"world = { contacts = 4194305; };", 1,
     "world.contacts = 4194305: out of range; allowed: 1..4194304"},
    {"world = { name = \"012345678901234567890123456789012345678901234567\"; };", 1,
     "world.name = \"012345678901234567890123456789012345678901234567\": too long; allowed: up to "
     "47 characters"},
    {"world = { name = \"a\\tb\"; };", 1,
     "world.name = \"a\\x09b\": has a character that is not printable ASCII; allowed: up to 47 "
     "characters"},
    {"terrain = { height_m = 8001; };", 1,
     "terrain.height_m = 8001: out of range; allowed: -400..8000 m"},
    {"terrain = { side_m = 999; };", 1,
     "terrain.side_m = 999: out of range; allowed: 1000..500000 m"},
    {"terrain = { side_m = 500125; };", 1,
     "terrain.side_m = 500125: out of range; allowed: 1000..500000 m"},
    {"terrain = { spacing_m = 100; };", 1,
     "terrain.spacing_m = 100: is not one of these; allowed: 125, 62.5, 31.25 m"},
    {"collision = { threshold_height_m = -1; };", 1,
     "collision.threshold_height_m = -1: out of range; allowed: 0..1000 m"},
    {"collision = { mps = { near_m = 0; }; };", 1,
     "collision.mps.near_m = 0: out of range; allowed: 0.1..1000 m"},
    {"collision = { figure8 = { mass_c1_kg = 2e9; }; };", 1,
     "collision.figure8.mass_c1_kg = 2000000000: out of range; allowed: 0..1000000000 kg"},
    {"renderer = { width = 15; };", 1,
     "renderer.width = 15: out of range; allowed: 16..7680 pixels"},
    {"renderer = { height = 4321; };", 1,
     "renderer.height = 4321: out of range; allowed: 16..4320 pixels"},
    {"renderer = { view = \"chase,, map\"; };", 1,
     "renderer.view = \"chase,, map\": unknown; allowed: chase, map, inside, orbit, free, "
     "overhead, both"},
    {"renderer = { view = \"chas\"; };", 1,
     "renderer.view = \"chas\": unknown; allowed: chase, map, inside, orbit, free, overhead, both"},
    {"renderer = { view = 1; };", 1,
     "renderer.view = 1: is not text in quotes; allowed: chase, map, inside, orbit, free, "
     "overhead, both"},
    {"renderer = { fps = 121; };", 1, "renderer.fps = 121: out of range; allowed: 0..120"},
    {VEHICLE("at = [1, 50001];"), 2,
     "vehicles[0].at = [1, 50001]: out of range; allowed: [x, z], each 0..50000 m"},
    {VEHICLE("area = [0, 0, 10, 60000];"), 2,
     "vehicles[0].area = [0, 0, 10, 60000]: out of range; allowed: [x0, z0, x1, z1] with x0 < x1 "
     "and z0 < z1, each 0..50000 m"},
    {VEHICLE("area = [10, 0, 10, 20];"), 2, "vehicles[0].area = [10, 0, 10, 20]: is empty; ..."},
    {VEHICLE("route = ( [1, 2] );"), 2,
     "vehicles[0].route = ([1, 2]): has fewer than two points; ..."},
    {VEHICLE("route = ( [1, 2], [1, -1] );"), 2,
     "vehicles[0].route = ([1, 2], [1, -1]): has a point out of range; ..."},
    {VEHICLE("count = 0;"), 2, "vehicles[0].count = 0: out of range; allowed: 1..1048576"},
    {VEHICLE("count = -3;"), 2, "vehicles[0].count = -3: out of range; allowed: 1..1048576"},
    {VEHICLE("count = 1048577;"), 2,
     "vehicles[0].count = 1048577: out of range; allowed: 1..1048576"},
    {VEHICLE("heading_deg = 361;"), 2,
     "vehicles[0].heading_deg = 361: out of range; allowed: -360..360 degrees"},
    {VEHICLE("speed_mps = -1;"), 2,
     "vehicles[0].speed_mps = -1: out of range; allowed: 0..3000 m/s"},
    {VEHICLE("altitude_m = 20001;"), 2,
     "vehicles[0].altitude_m = 20001: out of range; allowed: 0..20000 m"},
    {"fires = ( { at_s = -1; munition = \"bomb\"; point = [1, 2]; } );", 1,
     "fires[0].at_s = -1: out of range; allowed: 0..10000000 s"},
    /* Long numbers, which must not be read as others. */
    {"world = { capacity = 4294967312; };", 1,
     "world.capacity = 4294967312: out of range; allowed: 16..1048576"},
    {"world = { capacity = 0x100000010; };", 1,
     "world.capacity = 4294967312: out of range; allowed: 16..1048576"},
    {"world = { seed = 99999999999999999999; };", 1,
     "world.seed = 1e+20: out of range; allowed: 0..9007199254740991"},
    {"world = { seed = -5000000000; };", 1,
     "world.seed = -5000000000: out of range; allowed: 0..9007199254740991"},
    /* Words, and words of later versions. */
    {"world = { pace = \"fast\"; };", 1, "world.pace = \"fast\": unknown; allowed: real, max"},
    {"terrain = { source = \"dem\"; };", 1,
     "terrain.source = \"dem\": not in this version; allowed: generated, flat, file"},
    {"collision = { method = \"best\"; };", 1,
     "collision.method = \"best\": unknown; allowed: " METHOD_WORDS},
    {"collision = { shape = \"box\"; };", 1,
     "collision.shape = \"box\": unknown; allowed: model, sphere"},
    {"collision = { response = \"bounce\"; };", 1,
     "collision.response = \"bounce\": unknown; allowed: " RESPONSE_WORDS},
    {"collision = { npsnet2 = { nearness = \"xor\"; }; };", 1,
     "collision.npsnet2.nearness = \"xor\": unknown; allowed: and, or"},
    {"collision = { figure8 = { measure = \"speed\"; }; };", 1,
     "collision.figure8.measure = \"speed\": unknown; allowed: energy, mass"},
    {VEHICLE("force = \"green\";"), 2,
     "vehicles[0].force = \"green\": unknown; allowed: neutral, blue, red"},
    {VEHICLE("behaviour = \"attack\";"), 2,
     "vehicles[0].behaviour = \"attack\": unknown; allowed: idle, hold, patrol, route, follow, "
     "script"},
    /* Kinds. */
    {"vehicles = ( { kind = \"tonk\"; } );", 1,
     "vehicles[0].kind = \"tonk\": unknown kind; allowed: ..."},
    {"vehicles = ( { kind = \"tree\"; } );", 1,
     "vehicles[0].kind = \"tree\": is not a kind for this list; allowed: ..."},
    {"vehicles = ( { count = 2; } );", 1,
     "vehicles[0].kind: is missing; allowed: 1..23 characters"},
    {"vehicles = ( { kind = \"\"; } );", 1,
     "vehicles[0].kind = \"\": is empty; allowed: 1..23 characters"},
    {"objects = ( { kind = \"tank\"; at = [1, 2]; } );", 1,
     "objects[0].kind = \"tank\": is not a kind for this list; allowed: building, bunker, bush, "
     "pine, pole, rock, tree, watertower"},
    {"objects = ( { kind = \"tree\"; } );", 1,
     "objects[0].at: is missing; allowed: [x, z], each 0..50000 m"},
    {"fires = ( { munition = \"tank\"; point = [1, 2]; } );", 1,
     "fires[0].munition = \"tank\": is not a kind for this list; allowed: anti-tank-missile, "
     "artillery, bomb, bullet, burst, flak-burst, heat, missile, rocket, shell"},
    /* Keys that exclude each other. */
    {VEHICLE("at = [1, 2]; count = 2;"), 2,
     "vehicles[0].count = 2: is not 1, but at places one vehicle; allowed: 1, or a "
     "formation"},
    {"world = { capacity = 20; };\nvehicles = ( { kind = \"tank\"; count = 15; },\n"
     "{ kind = \"jeep\"; count = 6; } );",
     3, "vehicles[1].count = 6: makes 21 vehicles in all; allowed: up to world.capacity, 20"},
    {VEHICLE("behaviour = \"route\";"), 2,
     "vehicles[0].behaviour = \"route\": needs a route; right would be: route = ( [x, z], [x, z] "
     ")"},
    {VEHICLE("behaviour = \"idle\"; route = ( [1, 2], [3, 4] );"), 2,
     "vehicles[0].route = ([1, 2], [3, 4]): is only followed with behaviour = \"route\""},
    {VEHICLE("name = \"0123456789abcdef\"; count = 2;"), 2,
     "vehicles[0].name = \"0123456789abcdef\": is too long for several vehicles, whose names end "
     "in \"-1\" and so on; allowed: up to 15 characters"},
    {VEHICLE("roads = true;"), 2,
     "vehicles[0].roads = true: needs a route; right would be: route = ( [x, z], "
     "[x, z] )"},
    {"vehicles = ( { kind = \"ship\"; roads = true; route = ( [1, 2], [3, 4] ); } );", 1,
     "vehicles[0].roads = true: is not for a ship; allowed: false, or a kind of land or air"},
    {"vehicles = ( { kind = \"tank\"; name = \"T\"; } );\n"
     "fires = ( { at_s = 1; munition = \"bomb\"; target = \"T\"; } );",
     2,
     "fires[0].target = \"T\": needs a shooter, as a munition that falls from the sky falls on a "
     "point; "
     "right "
     "would be: a shooter beside it, or a point"},
    /* Scripts. */
    {VEHICLE("script = \"x\";"), 2,
     "vehicles[0].script = \"x\": is not the name of a script; allowed: a name of scripts"},
    {VEHICLE("behaviour = \"script\";"), 2,
     "vehicles[0].behaviour = \"script\": needs a script; right would be: script = \"NAME\", with "
     "a name of scripts"},
    {"scripts = ( { name = \"a\"; } );", 1,
     "scripts[0].file: a script needs steps or a file of waypoints; allowed: one of the two"},
    {"scripts = ( { name = \"a\"; steps = ( ); } );", 1,
     "scripts[0]: has no steps; right would be: steps = ( { go = [x, z]; }, ... )"},
    {"scripts = ( { name = \"a\"; steps = ( { stop = true; } ); },\n{ name = \"a\"; steps = ( { "
     "stop "
     "= true; } ); } );",
     2, "scripts[1].name = \"a\": is also the name of another script; allowed: each name once"},
    {STEPS("{ go = [1, 2]; },\n{ }"), 3,
     "scripts[0].steps[1].go: is missing, and so is any other action; right would be: one of go, "
     "arrive, face_deg, stop, wait_s, fire, for_s, fire_at, behaviour, altitude_m"},
    {STEPS("{ go = [1, 2]; wait_s = 2; }"), 2,
     "scripts[0].steps[0].wait_s = 2: is a second action beside go; allowed: one action in a step"},
    {STEPS("{ arrive = [1, 2]; }"), 2,
     "scripts[0].steps[0].at_s: is missing; right would be: at_s = SECONDS, the time of the "
     "arrival"},
    {STEPS("{ at_s = 5; stop = true; },\n{ at_s = 4; stop = true; }"), 3,
     "scripts[0].steps[1].at_s = 4: is before the time of an earlier step; allowed: from 5 on"},
    {STEPS("{ at_s = 5; after_s = 2; stop = true; }"), 2,
     "scripts[0].steps[0].after_s = 2: stands beside at_s; allowed: one of the two"},
    {STEPS("{ go = [1, 50001]; }"), 2,
     "scripts[0].steps[0].go = [1, 50001]: out of range; allowed: [x, z], each 0..50000 m"},
    {STEPS("{ stop = false; }"), 2,
     "scripts[0].steps[0].stop = false: does nothing; allowed: true"},
    {STEPS("{ steer = 0.5; stop = true; }"), 2,
     "scripts[0].steps[0].steer = 0.5: needs a duration; right would be: ..."},
    {STEPS("{ wait_s = 1; speed_mps = 5; }"), 2,
     "scripts[0].steps[0].speed_mps = 5: is only for go; right would be: a step without it"},
    {STEPS("{ behaviour = \"attack\"; }"), 2,
     "scripts[0].steps[0].behaviour = \"attack\": unknown; allowed: idle, hold, patrol, route, "
     "withdraw"},
    {STEPS("{ jump = true; }"), 2, "scripts[0].steps[0].jump = true: unknown key; ..."},
    {"earthworks = ( { shape = \"hill\"; at = [9, 9]; } );", 1,
     "earthworks[0].shape = \"hill\": unknown; allowed: ramp, table, trench, washboard, ford, "
     "skid_pan"},
    {WORK("ramp", "height_m = 3.0;", "9.0"), 2,
     "earthworks[0].at = [9, 9]: the earthwork reaches out of the world; allowed: all of it "
     "within 0..50000 m"},
    {WORK("ramp", "", "90.0"), 2, "earthworks[0].height_m: is missing; a ramp needs it"},
    {WORK("ford", "depth_m = 0.5;\nheight_m = 2.0;", "90.0"), 3,
     "earthworks[0].height_m = 2: is no key of a ford; right would be: without it"},
    {WORK("table", "height_m = 8.0; edge_m = 0.5;", "90.0"), 2,
     "earthworks[0].edge_m = 0.5: makes too steep a face; allowed: at least 1 m"},
    {WORK("table", "height_m = 8.0; grade_percent = 20.0;", "90.0"), 2,
     "earthworks[0].length_m = 20: is too short for the slopes of its ends; allowed: at least 80 "
     "m"},
    {WORK("trench", "depth_m = 20.0;", "90.0"), 2,
     "earthworks[0].length_m = 20: is too short for the slopes of its ends; allowed: at least 24 "
     "m"},
    {WORK("ramp", "height_m = 5.0; edge_m = 8.0;", "90.0"), 2,
     "earthworks[0].width_m = 12: is too narrow for the slopes of its sides; allowed: at least 16 "
     "m"},
    {WORK("washboard", "height_m = 2.0; wave_m = 0.5;", "90.0"), 2,
     "earthworks[0].wave_m = 0.5: makes too steep a wave; allowed: at least 0.7854 m"},
    {"bases = ( { force = \"red\"; at = [1, 2]; },\n{ force = \"red\"; at = [1, 2]; } );", 2,
     "bases[1].force = \"red\": has a base already; allowed: one base for each force"},
    {VEHICLE("engage = \"some\";"), 2,
     "vehicles[0].engage = \"some\": unknown; allowed: free, return, hold"},
    {VEHICLE("engage = \"hold\";\nfire_at_will = true;"), 3,
     "vehicles[0].fire_at_will = true: contradicts engage; allowed: false here, or engage alone"},
    {VEHICLE("engage = \"free\"; fire_at_will = false;"), 2,
     "vehicles[0].fire_at_will = false: contradicts engage; allowed: true here, or engage alone"},
    {VEHICLE("formation = \"square\";"), 2,
     "vehicles[0].formation = \"square\": unknown; allowed: column, line, wedge, echelon-left, "
     "echelon-right"},
    {VEHICLE("formation = \"line\"; spacing_m = 0.5;"), 2,
     "vehicles[0].spacing_m = 0.5: out of range; allowed: 1..5000 m"},
    {VEHICLE("spacing_m = 20;"), 2,
     "vehicles[0].spacing_m = 20: is only for a formation; right would be: formation beside it"},
    {VEHICLE("behaviour = \"follow\";"), 2,
     "vehicles[0].behaviour = \"follow\": has no leader to follow; right would be: an entry "
     "directly after one with a formation"},
    {VEHICLE("formation = \"line\"; }, { kind = \"jeep\"; }, { kind = \"jeep\"; behaviour = "
             "\"follow\";"),
     2,
     "vehicles[2].behaviour = \"follow\": has no leader to follow; right would be: an entry "
     "directly after one with a formation"},
    {VEHICLE("formation = \"line\"; },\n{ kind = \"jeep\"; force = \"red\"; behaviour = "
             "\"follow\";"),
     3,
     "vehicles[1].force = \"red\": is not the force of its leader; right would be: the force of "
     "the entry "
     "before"},
    {VEHICLE("formation = \"line\"; },\n{ kind = \"jeep\"; at = [1, 2]; behaviour = \"follow\";"),
     3,
     "vehicles[1].at = [1, 2]: is set by the leader of the formation; right would be: an entry "
     "without it"},
    {VEHICLE("name = \"A\"; }, { kind = \"jeep\"; name = \"A\";"), 2,
     "vehicles[1].name = A: is also the name of another vehicle; allowed: each name once"},
    {VEHICLE("name = \"A\"; count = 12; }, { kind = \"jeep\"; name = \"A-12\";"), 2,
     "vehicles[1].name = A-12: is also the name of another vehicle; allowed: each name once"},
    {"collision = { figure8 = {\ndamage_med = 1; }; };", 2,
     "collision.figure8.damage_med = 1: is not below the next higher level; allowed: below 1"},
    {"collision = { figure8 = {\ndamage_low = 0.5; }; };", 2,
     "collision.figure8.damage_low = 0.5: is not below the next higher level; allowed: below "
     "0.3"},
    {"collision = { figure8 = {\nmass_c2_kg = 20000; }; };", 2,
     "collision.figure8.mass_c2_kg = 20000: is not below the next higher level; allowed: below "
     "20000"},
    {"collision = { figure8 = {\nmass_c3_kg = 8001; }; };", 2,
     "collision.figure8.mass_c3_kg = 8001: is not below the next higher level; allowed: below "
     "8000"},
    {"fires = ( { shooter = \"X\"; point = [1, 2]; } );", 1,
     "fires[0].shooter = \"X\": is not the name of a vehicle; allowed: a name of vehicles"},
    {VEHICLE("name = \"A\"; count = 12; } );\nfires = ( { shooter = \"A-13\"; point = [1, 2];"), 3,
     "fires[0].shooter = \"A-13\": is not the name of a vehicle; allowed: a name of vehicles"},
    {VEHICLE("name = \"A\"; count = 12; } );\nfires = ( { shooter = \"A\"; point = [1, 2];"), 3,
     "fires[0].shooter = \"A\": is not the name of a vehicle; allowed: a name of vehicles"},
    {VEHICLE("name = \"A\"; } );\nfires = ( { shooter = \"A\"; target = \"B\";"), 3,
     "fires[0].target = \"B\": is not the name of a vehicle; allowed: a name of vehicles"},
    {VEHICLE("name = \"A\"; } );\nfires = ( { shooter = \"A\"; "), 3,
     "fires[0].target: a shot needs a target or a point; allowed: one of the two"},
    {"fires = ( { point = [1, 2]; } );", 1,
     "fires[0].munition: is missing; a shot without a shooter needs the munition that falls"},
    {"vehicles = ( { kind = \"truck\"; name = \"A\"; } );\nfires = ( { shooter = \"A\"; point = "
     "[1, 2]; } );",
     2, "fires[0].shooter = \"A\": is a truck, which has no munition; right would be: ..."},
    {"vehicles = (\n{ kind = \"jet\"; behaviour = \"hold\"; at = [25000, 25000];\n speed_mps = 0; "
     "} );",
     3,
     "vehicles[0].speed_mps = 0: is too slow for a jet to fly; allowed: 70 or more, or an entry "
     "without it"},
    {"vehicles = (\n{ kind = \"tank\"; altitude_m = 5; } );", 2,
     "vehicles[0].altitude_m = 5: is not for a tank, which does not fly; right would be: an entry "
     "without it, or an aircraft"},
    {"scripts = (\n{ name = \"a\"; steps = ( { throttle = 1.0; for_s = 0; } ); } );", 2,
     "scripts[0].steps[0].for_s = 0: out of range; allowed: 0.001..10000000 s"},
    {"scripts = (\n{ name = \"a\"; file = \"no.csv\"; } );", 2,
     "scripts[0].file = \"no.csv\": ..."},
    {"vehicles = ( { kind = \"tank\"; name = \"T\"; } );\nfires = ( { shooter = \"T\"; target = "
     "\"T\"; } );",
     2, "fires[0].target = \"T\": is the shooter; allowed: another vehicle"},
    {"terrain = {\n source = \"file\"; };", 2,
     "terrain.source = file: needs a ground file; right would be: terrain.file = \"NAME.ground\" "
     "beside it"},
    {"missions = (\n{ name = \"a\"; phases = 3; } );", 2,
     "missions[0].phases = 3: is not a list; allowed: ( { key = value; ... }, ... )"},
    {"missions = (\n{ name = \"a\"; phase = 3; } );", 2,
     "missions[0].phase = 3: unknown key; allowed here: name, vehicles, off_map, force, phases, "
     "reactions"},
    /* Files in other languages. */
    {"world = {\n seed 7; };", 2,
     "syntax error, at or before `seed 7; };`; right would be: group = { key = value; key = value; "
     "};"},
    {"world = {\n hz = nan; };", 2,
     "syntax error, at or before `hz = nan; };`; right would be: a finite number, as 1.5 or 2e3"},
    {"world = { seed = 1;\n seed = 2; };", 2,
     "a key that its group already has, at or before `seed = 2; };`; right would be: each key once "
     "in a group"},
    {"\n  @include \"/etc/passwd\"\n", 2,
     "@include is not supported; right would be: the included text itself"},
};

/* Fails unless the refusal is want, whose METHOD_WORDS or RESPONSE_WORDS at its end stands for the
 * words of the registry. */
static void check_message(const char *want)
{
    char whole[sizeof(error.text)];
    const char *mark = strchr(want, '$');
    if (mark) {
        const char *words = strcmp(mark, METHOD_WORDS) == 0 ? method_words : response_words;
        snprintf(whole, sizeof(whole), "%.*s%s", (int)(mark - want), want, words + strlen(", "));
        want = whole;
    }
    size_t length = strlen(want);

    if (length > 3 && strcmp(want + length - 3, "...") == 0 && want[length - 4] == ' ') {
        if (strncmp(error.text, want, length - 3) != 0)
            fail_msg("refused as\n  %s\ninstead of\n  %s", error.text, want);
    } else if (strcmp(error.text, want) != 0) {
        fail_msg("refused as\n  %s\ninstead of\n  %s", error.text, want);
    }
}

static void test_refusals(void **state)
{
    static const struct scenario empty;

    (void)state;
    for (size_t i = 0; i < COUNT(refusals); i++) {
        struct scenario s;
        char want[sizeof(error.text)];

        snprintf(want, sizeof(want), "%s:%d: %s", quick_config.scenario_path, refusals[i].line,
                 refusals[i].says);
        memset(&s, 0xa5, sizeof(s));
        if (quick_config_load(&s, refusals[i].text, NULL, &error) == 0)
            fail_msg("accepted: %s", refusals[i].text);
        check_message(want);
        assert_memory_equal(&s, &empty, sizeof(s));
    }
}

static void test_override_refusals(void **state)
{
    static const struct {
        const char *override, *says;
    } rows[] = {
        {"world.hz=5000", "--set: world.hz = 5000: out of range; allowed: 1..1000 Hz"},
        {"world.hz=nan", "--set: world.hz = nan: is not a number; allowed: 1..1000 Hz"},
        {"world.hz=inf", "--set: world.hz = inf: is not a number; allowed: 1..1000 Hz"},
        {"world.hz=60x", "--set: world.hz = 60x: is not a number; allowed: 1..1000 Hz"},
        {"world.hz=", "--set: world.hz = : is not a number; allowed: 1..1000 Hz"},
        {"world.seed=1.5",
         "--set: world.seed = 1.5: is not a whole number; allowed: 0..9007199254740991"},
        {"world.seed=-1",
         "--set: world.seed = -1: is not a whole number; allowed: 0..9007199254740991"},
        {"world.seed=99999999999999999999999",
         "--set: world.seed = 99999999999999999999999: out of range; allowed: "
         "0..9007199254740991"},
        {"gateway.address=localhost",
         "--set: gateway.address = localhost: is no address in numbers; right would be: "
         "127.0.0.1, 239.1.2.3 or ::1"},
        {"gateway.applications=65533x",
         "--set: gateway.applications = 65533x: is not a whole number; allowed: 1..65533"},
        {"gateway.application=65533",
         "default: gateway.applications = 16: goes beyond application 65533; allowed: up to 1"},
        {"gateway.cot=tak.example:6969",
         "--set: gateway.cot = tak.example:6969: must be an address in numbers with or without a "
         "port, such as 127.0.0.1, 127.0.0.1:3000, ::1 or [::1]:3000"},
        {"gateway.listen=3000",
         "--set: gateway.listen = 3000: must be an address in numbers with or without a "
         "port, such as 127.0.0.1, 127.0.0.1:3000, ::1 or [::1]:3000"},
        {"gateway.peers=10.0.0.1, all",
         "--set: gateway.peers = 10.0.0.1, all: \"all\" must be an address in numbers or a range, "
         "such as 10.0.0.7, 10.1.0.0/16, ::1 or fd00::/8"},
        {"gateway.control=7",
         "--set: gateway.control = 7: \"7\" must be SITE:APPLICATION with numbers from 1 to 65533, "
         "or SITE:* for all applications of a site"},
        {"gateway.version=5", "--set: gateway.version = 5: out of range; allowed: 6..7"},
        {"renderer.fog=yes", "--set: renderer.fog = yes: is not a boolean; allowed: true, false"},
        {"collision.response=bounce",
         "--set: collision.response = bounce: unknown; allowed: " RESPONSE_WORDS},
        {"terrain.source=dem",
         "--set: terrain.source = dem: not in this version; allowed: generated, flat, file"},
        {"collision.figure8.mass_c3_kg=9000",
         "--set: collision.figure8.mass_c3_kg = 9000: is not below the next higher level; "
         "allowed: below 8000"},
        {"collision.figure8.damage_low=2",
         "--set: collision.figure8.damage_low = 2: is not below the next higher level; allowed: "
         "below 0.3"},
        {"world.sede=7",
         "--set: world.sede = 7: unknown key; allowed: a scenario key of one value, such as "
         "world.seed or collision.response"},
        {"vehicles=7", "--set: vehicles = 7: unknown key; ..."},
        {"world=7", "--set: world = 7: unknown key; ..."},
        {"world.seed", "--set: world.seed: is not an override; right would be: group.key=value"},
        {"=7", "--set: =7: is not an override; right would be: group.key=value"},
        {"world.name=a\x1b[31m",
         "--set: world.name = a\\x1b[31m: has a character that is not printable ASCII; ..."},
    };

    (void)state;
    for (size_t i = 0; i < COUNT(rows); i++) {
        struct scenario s;

        assert_int_equal(quick_config_load(&s, "", rows[i].override, &error), -1);
        check_message(rows[i].says);
    }
}

static void check_file(const char *path, const char *says)
{
    struct scenario s;
    char want[sizeof(error.text)];

    assert_int_equal(loader_scenario(&s, QUICK_CONFIG_SHIPPED, path, NULL, 0, &error), -1);
    snprintf(want, sizeof(want), "%s%s", path, says);
    check_message(want);
}

static void test_file_refusals(void **state)
{
    char path[128];

    (void)state;
    snprintf(path, sizeof(path), "%s/none.cfg", quick_config.folder);
    check_file(path, ": cannot be opened: No such file or directory");
    check_file("no-such-battle", ": no such scenario; right would be: a file, or a name from "
                                 "config/scenarios");
    check_file(quick_config.folder, ": is a directory; allowed: a regular file");
    check_file("/dev/zero", ": is a device; allowed: a regular file");
    snprintf(path, sizeof(path), "%s/pipe", quick_config.folder);
    assert_int_equal(mkfifo(path, 0600), 0);
    check_file(path, ": is a pipe; allowed: a regular file");
    snprintf(path, sizeof(path), "%s/large", quick_config.folder);
    quick_config_write(path, "");
    assert_int_equal(truncate(path, (off_t)SCHEMA_SCENARIO_BYTES_MAX + 1), 0);
    check_file(path, ": has 4194305 bytes; allowed: up to 4194304");
    assert_int_equal(truncate(path, 100), 0);
    check_file(path, ":1: has a NUL byte; right would be: text");
}

/* --- kinds -------------------------------------------------------------------------------------*/

#define KIND_BEGIN                                                                                 \
    "name = \"k\"; model = \"k\"; mass_kg = 1; radius_m = 1; resistance_j = 1; "                   \
    "length_m = 1; width_m = 1; height_m = 1;\n"
#define KIND_LAND  KIND_BEGIN "domain = \"land\"; max_speed_mps = 9; acceleration_mps2 = 1; "
#define KIND_FIXED KIND_BEGIN "domain = \"fixed\"; class = \"tree\"; "
#define KIND_MODEL "mtllib k.mtl\no body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"

static const struct refusal kind_refusals[] = {
    {"name = \"k\";", 1, "domain: is missing; allowed: land, sea, air, munition, fixed"},
    {KIND_BEGIN "domain = \"space\";", 2,
     "domain = \"space\": unknown; allowed: land, sea, air, munition, fixed"},
    {KIND_BEGIN "domain = \"land\"; weight = 3;", 2, "weight = 3: unknown key; allowed here: ..."},
    {KIND_BEGIN "domain = \"land\"; rigidity = 1.5;", 2,
     "rigidity = 1.5: out of range; allowed: 0..1"},
    {KIND_BEGIN "domain = \"land\"; friction = 2.5;", 2,
     "friction = 2.5: out of range; allowed: 0..2"},
    {KIND_BEGIN "domain = \"land\"; stiffness_npm = -1;", 2,
     "stiffness_npm = -1: out of range; allowed: 0..1000000000000 N/m"},
    {KIND_BEGIN "domain = \"land\"; severe_deg = 46;", 2,
     "severe_deg = 46: out of range; allowed: 0..45 degrees"},
    {KIND_BEGIN "domain = \"land\"; bounce_keep = 1.1;", 2,
     "bounce_keep = 1.1: out of range; allowed: 0..1"},
    {KIND_BEGIN "domain = \"land\"; fast_mps = 3001;", 2,
     "fast_mps = 3001: out of range; allowed: 0..3000 m/s"},
    {KIND_BEGIN "domain = \"land\"; damage_high = 1001;", 2,
     "damage_high = 1001: out of range; allowed: 0..1000"},
    {KIND_BEGIN "domain = \"land\"; debris_keep = -0.5;", 2,
     "debris_keep = -0.5: out of range; allowed: 0..1"},
    {KIND_FIXED "damage_high = 1; damage_med = 1; damage_low = 0.5;", 2,
     "damage_med = 1: is not below damage_high; allowed: below it, or none of the three"},
    {KIND_FIXED "damage_high = 1; damage_med = 0.5; damage_low = 0.5;", 2,
     "damage_low = 0.5: is not below damage_med; allowed: below it, or none of the three"},
    {KIND_FIXED "damage_high = 1; damage_med = 0.5; damage_low = 0;", 2,
     "damage_low = 0: is needed beside damage_high; allowed: above 0, or none of the three"},
    {KIND_FIXED "damage_high = 0; damage_med = 0.5; damage_low = 0.1;", 2,
     "damage_med = 0.5: is not below damage_high; allowed: below it, or none of the three"},
    {KIND_BEGIN "domain = \"land\"; craters = 1;", 2,
     "craters = 1: is not a boolean; allowed: true, false"},
    {KIND_BEGIN "domain = \"land\"; max_speed_mps = 0;", 2,
     "max_speed_mps = 0: is needed by a vehicle; allowed: above 0"},
    {KIND_BEGIN "domain = \"land\"; max_speed_mps = 9; acceleration_mps2 = 0;", 2,
     "acceleration_mps2 = 0: is needed by a vehicle; allowed: above 0"},
    {KIND_LAND "turn_rate_dps = 0;", 2,
     "turn_rate_dps = 0: is needed by a vehicle; allowed: above 0"},
    {KIND_LAND "turn_rate_dps = 9; min_speed_mps = 10;", 2,
     "min_speed_mps = 10: is above max_speed_mps; allowed: up to max_speed_mps"},
    {KIND_LAND "turn_rate_dps = 9; class = \"tree\";", 2,
     "class = tree: is only for fixed objects; allowed: with domain = \"fixed\""},
    {KIND_LAND "turn_rate_dps = 9; munition = \"k\"; range_m = 5; reload_s = 1; rounds = 1;", 2,
     "munition = k: is not a munition; allowed: a kind with domain = \"munition\""},
    {KIND_LAND "turn_rate_dps = 9; munition = \"x\"; range_m = 5; reload_s = 1; rounds = 1;", 2,
     "munition = x: unknown kind; allowed: a kind with domain = \"munition\""},
    {KIND_LAND "turn_rate_dps = 9; munition = \"k\"; range_m = 5; reload_s = 1; rounds = 0;", 2,
     "rounds = 0: is needed by an armed vehicle; allowed: above 0"},
    {KIND_LAND "turn_rate_dps = 9; munition = \"k\"; range_m = 0;", 2,
     "range_m = 0: is needed by an armed vehicle; allowed: above 0"},
    {KIND_BEGIN "domain = \"air\"; max_speed_mps = 9; acceleration_mps2 = 1; turn_rate_dps = 9;\n"
                "climb_rate_mps = 0;",
     3, "climb_rate_mps = 0: is needed by an aircraft; allowed: above 0"},
    {KIND_BEGIN "domain = \"munition\"; max_speed_mps = 9;\nlife_s = 0;", 3,
     "life_s = 0: is needed by a munition; allowed: above 0"},
    {KIND_BEGIN "domain = \"fixed\";", 1,
     "class: is missing; a fixed object needs it; allowed: tree, ..."},
    {"name = \"other\"; domain = \"land\"; model = \"k\"; mass_kg = 1; radius_m = 1; resistance_j "
     "= "
     "1; length_m = 1; width_m = 1; height_m = 1;",
     1, "name = other: is not the name of the file; allowed: k"},
    {"model = \"../k\"; name = \"k\"; domain = \"fixed\"; class = \"tree\"; mass_kg = 1; radius_m "
     "= "
     "1; resistance_j = 1; length_m = 1; width_m = 1; height_m = 1;",
     1, "model = ../k: is not the name of a model; allowed: a-z 0-9 - _"},
};

static void test_kind_refusals(void **state)
{
    char kinds[96], models[96], kind[128], model[128], material[128];

    (void)state;
    snprintf(kinds, sizeof(kinds), "%s/kinds", quick_config.folder);
    snprintf(models, sizeof(models), "%s/models", quick_config.folder);
    snprintf(kind, sizeof(kind), "%s/k.cfg", kinds);
    snprintf(model, sizeof(model), "%s/k.obj", models);
    snprintf(material, sizeof(material), "%s/k.mtl", models);
    assert_int_equal(mkdir(kinds, 0700), 0);
    assert_int_equal(mkdir(models, 0700), 0);
    quick_config_write(model, KIND_MODEL);
    quick_config_write(material, "newmtl red\nKd 1 0 0\n");
    quick_config_write(quick_config.scenario_path, "");
    for (size_t i = 0; i < COUNT(kind_refusals); i++) {
        struct scenario s;
        char want[sizeof(error.text)];

        quick_config_write(kind, kind_refusals[i].text);
        if (loader_scenario(&s, quick_config.folder, quick_config.scenario_path, NULL, 0, &error) ==
            0)
            fail_msg("accepted: %s", kind_refusals[i].text);
        snprintf(want, sizeof(want), "%s:%d: %s", kind, kind_refusals[i].line,
                 kind_refusals[i].says);
        check_message(want);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_override_refusals),
        cmocka_unit_test(test_file_refusals),
        cmocka_unit_test(test_kind_refusals),
    };

    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
