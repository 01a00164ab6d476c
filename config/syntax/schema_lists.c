/* The schema of the entries of a scenario's lists. `make docs` writes these rows into
 * docs/scenario.md. */
#include "config/syntax/schema_internal.h"
#include "world/entity/entity.h"
#include "world/entity/formation.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"
#include "world/terrain/earthwork.h"

static const struct key_choice behaviours[] = {
    {NULL, BEHAVIOUR_IDLE,
     "The vehicle stands still, a helicopter hovers, a jet circles. It reacts when it is "
     "fired upon."},
    {NULL, BEHAVIOUR_HOLD,
     "The vehicle keeps its heading and speed and reacts to nothing. This makes planned "
     "collisions. "
     "At the edge of the world it leaves the world: it is removed, with an `agent` event because "
     "it "
     "has left the world."},
    {NULL, BEHAVIOUR_PATROL, "The vehicle goes from one random goal in its area to the next."},
    {NULL, BEHAVIOUR_ROUTE, "The vehicle goes along its route again and again."},
    {NULL, BEHAVIOUR_FOLLOW,
     "The vehicle keeps its place in the formation of the entry before it, behind that entry's "
     "own vehicles."},
    {NULL, BEHAVIOUR_SCRIPT, "The vehicle does what its script says, and then is idle."}};
static const struct key_choice orders[] = {{.value = BEHAVIOUR_IDLE},
                                           {.value = BEHAVIOUR_HOLD},
                                           {.value = BEHAVIOUR_PATROL},
                                           {.value = BEHAVIOUR_ROUTE},
                                           {.value = BEHAVIOUR_WITHDRAW}};
static const struct key_choice engagements[] = {{"free", ENTITY_FLAG_FIRE_AT_WILL, NULL},
                                                {"return", 0, NULL},
                                                {"hold", ENTITY_FLAG_HOLD_FIRE, NULL}};
static const struct key_choice formations[] = {
    {NULL, FORMATION_COLUMN, "The vehicles are one behind the other."},
    {NULL, FORMATION_LINE,
     "The vehicles are beside the leader, alternately on its right and on its left."},
    {NULL, FORMATION_WEDGE,
     "The vehicles are behind the leader at 45 degrees, alternately on its right and on its "
     "left."},
    {NULL, FORMATION_ECHELON_LEFT,
     "Each vehicle is behind the one before it, at 45 degrees to its left."},
    {NULL, FORMATION_ECHELON_RIGHT,
     "Each vehicle is behind the one before it, at 45 degrees to its right."}};

#define V struct vehicle_entry
static const struct key vehicle_keys[] = {
    [VEHICLE_KIND] = TEXT("kind", V, kind, NULL, .required = true,
                          .meaning = "The name of a kind whose domain is land, sea or air."),
    [VEHICLE_COUNT] =
        WHOLE32("count", V, count, 1, CAPACITY_MAX, "1",
                .meaning = "How many vehicles the entry makes. With `at` it is 1, unless they are "
                           "in formation. All entries together make at most `world.capacity`."),
    [VEHICLE_FORCE] = CHOICE("force", V, force, STORE_U32, ALL(force_name, FORCE_COUNT), "neutral",
                             .meaning = "Blue and red are each other's enemies. Neutral vehicles "
                                        "have no enemies."),
    [VEHICLE_BEHAVIOUR] =
        CHOICE("behaviour", V, behaviour, STORE_U32, SOME(behaviours, behaviour_name), NULL,
               .unset = "patrol; idle with `at`; route with `route`; script with `script`",
               .meaning = "What the vehicles do: see below."),
    [VEHICLE_AREA] = PLACE("area", KEY_AREA, STORE_DOUBLE, V, area, .unset = "the whole square",
                           .meaning = "The vehicles start in this area, and a patrol stays in it. "
                                      "With `at` the area is for the patrol alone."),
    [VEHICLE_ROUTE] = PLACE("route", KEY_ROUTE, STORE_ROUTE, V, route,
                            .meaning = "Two or more points, which the vehicle visits one after the "
                                       "other. After the last point it returns to the first."),
    [VEHICLE_ROADS] = BOOLEAN("roads", V, roads, STORE_U32, "false",
                              .meaning = "true: the route goes along roads, see below."),
    [VEHICLE_SCRIPT] = TEXT("script", V, script, NULL,
                            .meaning = "The name of the vehicle's script, see below. With a script "
                                       "the `route` is for a step that goes back to it."),
    [VEHICLE_NAME] =
        TEXT("name", V, name, NULL,
             .meaning = "The name for `fires` and reports; each name is given once. Several "
                        "vehicles called `alpha` are `alpha-1`, `alpha-2` and so on, and then the "
                        "name has at most 15 characters."),
    [VEHICLE_GROUP] = TEXT("group", V, group, NULL,
                           .meaning = "The vehicles belong to the mission that gives this word as "
                                      "its `vehicles`, see below."),
    [VEHICLE_AT] =
        PLACE("at", KEY_POINT, STORE_DOUBLE, V, at,
              .meaning = "The exact place of one vehicle or of a formation's leader: on water for "
                         "a ship, on land for a land vehicle. Without it the program finds a place "
                         "in the area that suits the kind."),
    [VEHICLE_ALTITUDE] =
        NUMBER("altitude_m", V, altitude_m, 0, 20000, NULL, .unit = "m",
               .unset = "the kind's `cruise_altitude_m`",
               .meaning = "The height of an aircraft above the ground. An aeroplane that does "
                          "not `hold` its course begins higher where the ground "
                          "ahead rises faster than it can climb."),
    [VEHICLE_HEADING] =
        SCALED("heading_deg", V, heading_rad, -360, 360, RAD_PER_DEG, NULL, .unit = "degrees",
               .unset = "random", .meaning = "The heading, clockwise from north."),
    [VEHICLE_SPEED] =
        NUMBER("speed_mps", V, speed_mps, 0, 3000, NULL, .unit = "m/s",
               .unset = "the kind's `min_speed_mps`",
               .meaning = "The speed at the start. With `hold` the vehicle keeps it, "
                          "even above the `max_speed_mps` of its kind. An aeroplane has "
                          "at least its `min_speed_mps`."),
    [VEHICLE_FIRE_AT_WILL] =
        BOOLEAN("fire_at_will", V, fire_at_will, STORE_U32, "false",
                .meaning = "An older spelling: true is `engage = \"free\"`. The two keys must not "
                           "contradict each other."),
    [VEHICLE_ENGAGE] =
        CHOICE("engage", V, engage, STORE_U32, WORDS(engagements), NULL,
               .unset = "free with `fire_at_will`, else return",
               .meaning = "The targets of the vehicle. `free`: every enemy that it sees. `return`: "
                          "only enemies that fire at it. `hold`: none."),
    [VEHICLE_STAND] = BOOLEAN("stand", V, stand, STORE_U32, "false",
                              .meaning = "true: the vehicle never flees or withdraws."),
    [VEHICLE_FORMATION] =
        CHOICE("formation", V, formation, STORE_U32, SOME(formations, formation_shape_name), NULL,
               .meaning = "The vehicles start and move in this formation: see below."),
    [VEHICLE_SPACING] = NUMBER("spacing_m", V, spacing_m, 1, 5000, "50", .unit = "m",
                               .meaning = "The distance between neighbours in a formation."),
};
KEY_TABLE(schema_vehicle, "vehicles", vehicle_keys, V, VEHICLE_KEY_COUNT);
#undef V

#define C struct script_entry
static const struct key script_keys[] = {
    [SCRIPT_NAME] = TEXT("name", C, name, NULL, .required = true,
                         .meaning = "The name that `vehicles[].script` gives. Each name is given "
                                    "once."),
    [SCRIPT_FILE] = TEXT("file", C, file, NULL,
                         .meaning = "The name of a file of waypoints in the scenario's folder. A "
                                    "script has either a file or `steps = ( { ... }, ... )`."),
    [SCRIPT_REPEAT] = BOOLEAN("repeat", C, repeat, STORE_U32, "false",
                              .meaning = "true: the script begins again after its last step. Each "
                                         "pass begins at the last time of the pass before, and its "
                                         "times count from there."),
    [SCRIPT_REACT] =
        BOOLEAN("react", C, react, STORE_U32, "false",
                .meaning = "true: a vehicle that is fired upon, damaged or out of rounds does what "
                           "its kind does, and then goes on with the script. false: only a "
                           "collision, being stuck or an empty fuel tank interrupts the "
                           "script. One that is stuck for minutes ends it: the event `agent` to "
                           "`idle` because `stuck`."),
};
KEY_TABLE(schema_script, "scripts", script_keys, C, SCRIPT_KEY_COUNT);
#undef C

#define T struct step_entry
static const struct key step_keys[] = {
    [STEP_KEY_AT] = NUMBER("at_s", T, at_s, 0, 1e7, NULL, .unit = "s",
                           .unset = "when the step before has ended",
                           .meaning = "The simulated time at which the step begins, even when the "
                                      "step before has not ended. An `arrive` ends at this time. "
                                      "Times must not decrease."),
    [STEP_KEY_AFTER] = NUMBER("after_s", T, after_s, 0, 1e7, NULL, .unit = "s",
                              .meaning = "The step begins this long after the step before has "
                                         "ended."),
    [STEP_KEY_GO] = PLACE("go", KEY_POINT, STORE_DOUBLE, T, go,
                          .meaning = "The vehicle goes to this point, where the step ends."),
    [STEP_KEY_ARRIVE] =
        PLACE("arrive", KEY_POINT, STORE_DOUBLE, T, arrive,
              .meaning = "The vehicle goes to this point to be there at `at_s`. Its speed follows "
                         "from the distance and the time that are left. A vehicle that is late "
                         "goes as fast as it can, and gives the point up when the next is due."),
    [STEP_KEY_FACE] =
        SCALED("face_deg", T, face_rad, -360, 360, RAD_PER_DEG, NULL, .unit = "degrees",
               .meaning = "The vehicle turns to this heading, clockwise from north. One on wheels "
                          "drives to and fro until it heads there, some metres about its place. "
                          "Where it has no room for that it first drives straight on to look for "
                          "room, and gives up the script as `stuck` if there is none."),
    [STEP_KEY_STOP] =
        BOOLEAN("stop", T, stop, STORE_U32, NULL,
                .meaning = "true: the vehicle brakes until it stands. An aeroplane cannot."),
    [STEP_KEY_WAIT] =
        NUMBER("wait_s", T, wait_s, 0, 1e7, NULL, .unit = "s",
               .meaning = "The vehicle stands for this long. An aeroplane flies straight on "
                          "at 1.3 times its `min_speed_mps`."),
    [STEP_KEY_FIRE] =
        TEXT("fire", T, fire, NULL,
             .meaning = "The vehicle fires one shot at the vehicle of this name, as soon as its "
                        "gun is loaded and bears and the target is in range. It gives the shot up "
                        "after 20 s, or when its rounds or the target are gone."),
    [STEP_KEY_FIRE_AT] =
        PLACE("fire_at", KEY_POINT, STORE_DOUBLE, T, fire_at,
              .meaning = "The vehicle fires one shot at this point on the ground."),
    [STEP_KEY_BEHAVIOUR] =
        CHOICE("behaviour", T, behaviour, STORE_U32, SOME(orders, behaviour_name), NULL,
               .meaning = "The script ends, and the vehicle's agent takes over with this order. A "
                          "patrol is in the vehicle's own `area`. `withdraw`: the vehicle goes to "
                          "its base."),
    [STEP_KEY_THROTTLE] = NUMBER("throttle", T, throttle, -1, 1, "0",
                                 .meaning = "The throttle, which is held for `for_s` as a driver "
                                            "would hold it. It is negative backwards."),
    [STEP_KEY_STEER] = NUMBER("steer", T, steer, -1, 1, "0",
                              .meaning = "The steering, also held for `for_s`. It is positive to "
                                         "the right."),
    [STEP_KEY_CLIMB] = NUMBER("climb", T, climb, -1, 1, "0",
                              .meaning = "The climb of an aircraft, also held for `for_s`; above 0 "
                                         "the hand brake of a land vehicle. It is "
                                         "positive upwards."),
    [STEP_KEY_FOR] = NUMBER("for_s", T, for_s, 0.001, 1e7, NULL, .unit = "s",
                            .meaning = "How long the controls are held."),
    [STEP_KEY_SPEED] =
        NUMBER("speed_mps", T, speed_mps, 0.1, 3000, NULL, .unit = "m/s",
               .unset = "three quarters of full speed",
               .meaning = "The speed of `go`. No vehicle goes faster than its kind can, and no "
                          "aeroplane more slowly than it flies."),
    [STEP_KEY_ALTITUDE] =
        NUMBER("altitude_m", T, altitude_m, 0, 20000, NULL, .unit = "m", .unset = "as before",
               .meaning = "The height of an aircraft above the ground from this step on. It stands "
                          "beside `go`, `arrive`, `face_deg` or `wait_s`, or alone in a step that "
                          "ends at that height. A helicopter that leans needs 3.7 m, a `helo-cow` "
                          "2.7 m: less is refused, and 0 sets it down."),
};
KEY_TABLE(schema_step, "steps", step_keys, T, STEP_KEY_COUNT);
#undef T

#define E struct earthwork_entry
static const struct key_choice shapes[] = {
    {"ramp", EARTHWORK_RAMP,
     "The ground rises along the length and ends in a lip: a jump, or a side slope for a vehicle "
     "that drives across it."},
    {"table", EARTHWORK_TABLE,
     "The ground rises, is level and falls again: a step, or with `grade_percent` a hill."},
    {"trench", EARTHWORK_TRENCH, "The same, dug `depth_m` deep."},
    {"washboard", EARTHWORK_WASHBOARD,
     "Waves lie across the way, `wave_m` from crest to crest and `height_m` high."},
    {"ford", EARTHWORK_FORD,
     "A trench with water in it, `depth_m` deep in the middle. Its bed is 0.25 m lower than that "
     "below the ground, and its ends have a grade of 10 % unless `grade_percent` says otherwise."},
    {"skid_pan", EARTHWORK_SKID_PAN,
     "The ground is not changed, but has only the share `grip` of its grip."}};
static const struct key earthwork_keys[] = {
    [EARTHWORK_KEY_SHAPE] = CHOICE("shape", E, shape, STORE_U32, WORDS(shapes), NULL,
                                   .required = true, .meaning = "What it is: see below."),
    [EARTHWORK_KEY_AT] = PLACE("at", KEY_POINT, STORE_DOUBLE, E, at, .required = true,
                               .meaning = "The middle of the earthwork."),
    [EARTHWORK_KEY_HEADING] =
        SCALED("heading_deg", E, heading_rad, -360, 360, RAD_PER_DEG, "0", .unit = "degrees",
               .meaning = "The heading of its length, clockwise from north. A ramp rises in this "
                          "direction."),
    [EARTHWORK_KEY_LENGTH] = NUMBER("length_m", E, length_m, 1, 2000, NULL, .unit = "m",
                                    .required = true, .meaning = "The length, slopes included."),
    [EARTHWORK_KEY_WIDTH] = NUMBER("width_m", E, width_m, 1, 2000, NULL, .unit = "m",
                                   .required = true, .meaning = "The width, slopes included."),
    [EARTHWORK_KEY_HEIGHT] =
        NUMBER("height_m", E, height_m, 0.02, 100, NULL, .unit = "m",
               .meaning = "The height over the ground of a ramp, a table or a washboard, which "
                          "must have it."),
    [EARTHWORK_KEY_DEPTH] = NUMBER("depth_m", E, depth_m, 0.02, 50, NULL, .unit = "m",
                                   .meaning = "The depth of a trench, or of the water of a ford, "
                                              "which must have it."),
    [EARTHWORK_KEY_EDGE] = NUMBER(
        "edge_m", E, edge_m, 0.01, 500, NULL, .unit = "m", .unset = "0.6 of the height or depth",
        .meaning = "How far the sides, the lip and the ends without a `grade_percent` "
                   "slope, on the map. An eighth of the height is the least."),
    [EARTHWORK_KEY_GRADE] =
        SCALED("grade_percent", E, grade, 1, 800, 0.01, NULL, .unit = "%",
               .meaning = "The grade of both ends of a table, a trench or a ford."),
    [EARTHWORK_KEY_WAVE] = NUMBER("wave_m", E, wave_m, 0.2, 100, NULL, .unit = "m",
                                  .meaning = "The length of a washboard's waves, which must have "
                                             "it."),
    [EARTHWORK_KEY_GRIP] = NUMBER("grip", E, grip, 0.01, 1, NULL,
                                  .meaning = "The share of the ground's grip that is left on a "
                                             "skid pan, which must have it."),
};
KEY_TABLE(schema_earthwork, "earthworks", earthwork_keys, E, EARTHWORK_KEY_COUNT);
#undef E

#define B struct base_entry
static const struct key base_keys[] = {
    [BASE_FORCE] =
        CHOICE("force", B, force, STORE_U32, ALL(force_name, FORCE_COUNT), NULL, .required = true,
               .meaning = "The force whose base it is. A force has one base at most."),
    [BASE_AT] = PLACE("at", KEY_POINT, STORE_DOUBLE, B, at, .required = true,
                      .meaning = "Where the vehicles of the force withdraw to. The base of a force "
                                 "without an entry is where its land vehicle starts that is "
                                 "nearest to the middle of the force."),
};
KEY_TABLE(schema_base, "bases", base_keys, B, BASE_KEY_COUNT);
#undef B

#define O struct object_entry
static const struct key object_keys[] = {
    [OBJECT_KEY_KIND] = TEXT("kind", O, kind, NULL, .required = true,
                             .meaning = "The name of a kind with `domain = \"fixed\"`."),
    [OBJECT_KEY_AT] = PLACE("at", KEY_POINT, STORE_DOUBLE, O, at, .required = true,
                            .meaning = "Where the object stands."),
    [OBJECT_KEY_HEADING] =
        SCALED("heading_deg", O, heading_rad, -360, 360, RAD_PER_DEG, "0", .unit = "degrees",
               .meaning = "The heading of the object, clockwise from north."),
};
KEY_TABLE(schema_object, "objects", object_keys, O, OBJECT_KEY_COUNT);
#undef O

static const struct key_choice fire_fuzes[] = {{"own", FUZE_COUNT, NULL},
                                               {"point", FUZE_POINT, NULL},
                                               {"delay", FUZE_DELAY, NULL},
                                               {"air", FUZE_AIR, NULL}};

#define F struct fire_entry
static const struct key fire_keys[] = {
    [FIRE_AT] = NUMBER("at_s", F, at_s, 0, 1e7, "0", .unit = "s",
                       .meaning = "The simulated time of the shot."),
    [FIRE_SHOOTER] =
        TEXT("shooter", F, shooter, NULL,
             .meaning = "The name of the vehicle that fires. Without a shooter, shells "
                        "come along an arc from a battery that is off the map, and "
                        "other munitions fall out of the sky."),
    [FIRE_TARGET] = TEXT("target", F, target, NULL,
                         .meaning = "The name of the vehicle that a shooter fires at. A shot has "
                                    "either a target or a point."),
    [FIRE_MUNITION] = TEXT("munition", F, munition, NULL, .unset = "the shooter's own",
                           .meaning = "The name of a kind with `domain = \"munition\"`. A shot "
                                      "without a shooter must have it."),
    [FIRE_POINT] = PLACE("point", KEY_POINT, STORE_DOUBLE, F, point,
                         .meaning = "The point on the ground that the shot is aimed at."),
    [FIRE_ROUNDS] = WHOLE32("rounds", F, rounds, 0, 1000, "0",
                            .meaning = "Makes the shot a fire mission of so many rounds for "
                                       "effect. The shooter is then a howitzer, and its battery "
                                       "fires: up to 8 howitzers of its force within 300 m. "
                                       "0: a single shot."),
    [FIRE_ADJUST] = BOOLEAN("adjust", F, adjust, STORE_U32, "false",
                            .meaning = "true: one gun of the mission fires first, and observers "
                                       "who see the point correct its fire before the others "
                                       "join."),
    [FIRE_FUZE] = CHOICE("fuze", F, fuze, STORE_U32, WORDS(fire_fuzes), "own",
                         .meaning = "The fuze of the rounds. `own`: that of the munition."),
    [FIRE_HIGH] = BOOLEAN("high", F, high, STORE_U32, "false",
                          .meaning = "true: shells take the higher of the two arcs that meet the "
                                     "point, over mountains and walls."),
    [FIRE_BEARING] = SCALED("bearing_deg", F, bearing_rad, 0, 360, RAD_PER_DEG, NULL,
                            .unit = "degrees", .unset = "by seed and entry",
                            .meaning = "Shells without a shooter: the bearing from the point, "
                                       "clockwise from north, from which they come."),
};
KEY_TABLE(schema_fire, "fires", fire_keys, F, FIRE_KEY_COUNT);
#undef F
