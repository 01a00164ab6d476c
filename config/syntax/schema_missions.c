/* The schema of objectives, missions and their phases. `make docs` writes these rows into
 * docs/scenario.md. */
#include "config/syntax/schema_internal.h"
#include "world/enum_names.h"

static const struct key_choice orders[] = {
    {NULL, MISSION_HOLD, "The vehicles stay where they are."},
    {NULL, MISSION_RESERVE, "The same, until a condition calls them."},
    {NULL, MISSION_MOVE, "The vehicles go along the route, or to `to`, and stay at its end."},
    {NULL, MISSION_BOUND,
     "The same by bounds: of two vehicles one goes and the other one watches, and after `bound_s` "
     "they change."},
    {NULL, MISSION_ATTACK,
     "The vehicles go along the route, if there is one, and then each to a place of its own in the "
     "area. They fire at every enemy that they see."},
    {NULL, MISSION_DEFEND, "The same, for an area that the force holds already."},
    {NULL, MISSION_WITHDRAW,
     "The vehicles break off a fight and go along the route or into the area."},
    {NULL, MISSION_PATROL, "The vehicles go from one random goal in the area to the next."},
    {NULL, MISSION_STRIKE, "The same for aircraft, which attack what they see there."},
    {NULL, MISSION_BARRAGE,
     "Volleys of six rounds fall on random points of the area. The group's howitzers fire them, or "
     "a "
     "battery off the map fires its `munition`. Other munitions fall one by one out of the sky. "
     "Guns that are no howitzers fire directly, as fast as they load."},
    {NULL, MISSION_RESUPPLY,
     "The vehicles break off a fight and go along the route or into the area. There rounds and "
     "fuel fill up within 20 s."}};
static const struct key_choice engagements[] = {{"free", ENTITY_FLAG_FIRE_AT_WILL, NULL},
                                                {"return", 0, NULL},
                                                {"hold", ENTITY_FLAG_HOLD_FIRE, NULL}};

#define O struct objective_entry
static const struct key objective_keys[] = {
    [OBJECTIVE_NAME] = TEXT("name", O, name, NULL, .required = true,
                            .meaning = "The name that phases give. Each name is given once."),
    [OBJECTIVE_AREA] = PLACE("area", KEY_AREA, STORE_DOUBLE, O, area, .required = true,
                             .meaning = "A force takes the objective when it has vehicles on the "
                                        "ground or on the water here, and at least three times as "
                                        "many as its enemy."),
    [OBJECTIVE_FORCE] =
        CHOICE("force", O, force, STORE_U32, ALL(force_name, FORCE_COUNT), "neutral",
               .meaning = "The force that holds it when a battle begins."),
};
KEY_TABLE(schema_objective, "objectives", objective_keys, O, OBJECTIVE_KEY_COUNT);
#undef O

#define M struct mission_entry
static const struct key mission_keys[] = {
    [MISSION_KEY_NAME] = TEXT("name", M, name, NULL, .required = true,
                              .meaning = "The name in events and for `after`. Each name is given "
                                         "once."),
    [MISSION_KEY_VEHICLES] =
        TEXT("vehicles", M, vehicles, NULL, .unset = "the mission's name",
             .meaning = "The vehicles: those with this `group`; when there are none, those whose "
                        "name begins with it. They are of one force, and of no other mission."),
    [MISSION_KEY_OFF_MAP] =
        BOOLEAN("off_map", M, off_map, STORE_U32, "false",
                .meaning = "true: the mission has no vehicles, such as a battery outside of the "
                           "square. Its orders are `hold`, `reserve` and `barrage`."),
    [MISSION_KEY_FORCE] = CHOICE("force", M, force, STORE_U32, ALL(force_name, FORCE_COUNT),
                                 "neutral", .unset = "that of its vehicles",
                                 .meaning = "The force of a mission that is off the map."),
};
KEY_TABLE(schema_mission, "missions", mission_keys, M, MISSION_KEY_COUNT);
#undef M

#define P struct phase_entry
static const struct key phase_keys[] = {
    [PHASE_NAME] = TEXT("name", P, name, NULL, .required = true,
                        .meaning = "The name in events and for `after`; once in a mission."),
    [PHASE_ORDER] = CHOICE("order", P, order, STORE_U32, SOME(orders, mission_order_name), NULL,
                           .required = true, .meaning = "What the vehicles do: see below."),
    [PHASE_TO] = PLACE("to", KEY_POINT, STORE_DOUBLE, P, to,
                       .meaning = "Where the vehicles go: a route of one point."),
    [PHASE_ROUTE] = PLACE("route", KEY_ROUTE, STORE_ROUTE, P, route,
                          .meaning = "Two or more points, which the vehicles pass once."),
    [PHASE_ROADS] = BOOLEAN("roads", P, roads, STORE_U32, "false",
                            .meaning = "true: the route goes along roads."),
    [PHASE_AREA] = PLACE("area", KEY_AREA, STORE_DOUBLE, P, area,
                         .meaning = "The area of the order. Behind a route it is the route's end."),
    [PHASE_OBJECTIVE] = TEXT("objective", P, objective, NULL,
                             .meaning = "The name of an objective, whose area is meant."),
    [PHASE_SPREAD] =
        NUMBER("spread_m", P, spread_m, 0, 5000, NULL, .unit = "m", .unset = "150; 0 on roads",
               .meaning = "Each vehicle passes a point of the route at a place of its "
                          "own, which is within this distance east and south of it."),
    [PHASE_BOUND] = NUMBER("bound_s", P, bound_s, 5, 600, "25", .unit = "s",
                           .meaning = "How long a bound lasts; for `bound`."),
    [PHASE_ENGAGE] = CHOICE("engage", P, engage, STORE_U32, WORDS(engagements), NULL,
                            .unset = "return with `hold`, `reserve`, `withdraw`, `resupply` and "
                                     "`barrage`, else free",
                            .meaning = "The targets of the vehicles from now on, as for "
                                       "`vehicles[].engage`."),
    [PHASE_MUNITION] =
        TEXT("munition", P, munition, NULL,
             .meaning = "The kind of munition of a `barrage`, instead of that of the "
                        "group's own guns."),
    [PHASE_RATE] =
        NUMBER("rounds_a_minute", P, rounds_a_minute, 0.1, 600, "6",
               .meaning = "How many rounds of a `barrage` are fired in a minute. A volley "
                          "is left out while the guns still fire the last one."),
    [PHASE_ADJUST] = BOOLEAN("adjust", P, adjust, STORE_U32, "false",
                             .meaning = "true: one howitzer fires first, and any vehicle of the "
                                        "force that sees the point corrects it."),
    [PHASE_BEARING] =
        SCALED("bearing_deg", P, bearing_rad, 0, 360, RAD_PER_DEG, "0", .unit = "degrees",
               .meaning = "Where a battery off the map stands: the bearing from the "
                          "area, clockwise from north."),
    [PHASE_AT_LEAST] = NUMBER("at_least_s", P, at_least_s, 0, 1e6, "0", .unit = "s",
                              .meaning = "The phase does not end earlier, whatever holds."),
    [PHASE_ALL] = BOOLEAN("all", P, until.all, STORE_U32, "false",
                          .meaning = "false: the phase ends when one of the conditions below "
                                     "holds. true: when all that are given hold."),
    [PHASE_FOR] = NUMBER("for_s", P, until.for_s, 0, 1e6, NULL, .unit = "s",
                         .meaning = "The phase ends after this time."),
    [PHASE_UNTIL] = NUMBER("until_s", P, until.at_s, 0, 1e6, NULL, .unit = "s",
                           .meaning = "It ends at this time after the beginning of the battle."),
    [PHASE_ARRIVED] = NUMBER("arrived", P, until.arrived, 0.01, 1, NULL,
                             .meaning = "It ends when this share of the group is at the end of its "
                                        "route or in its area, within 150 m."),
    [PHASE_TAKEN] = TEXT("taken", P, until.taken, NULL,
                         .meaning = "It ends when the force holds this objective."),
    [PHASE_LOST] = TEXT("lost", P, until.lost, NULL,
                        .meaning = "It ends when the force does not hold this objective."),
    [PHASE_BELOW] = NUMBER("below", P, until.below, 0.01, 1, NULL,
                           .meaning = "It ends when less than this share of the group that began "
                                      "the battle is active."),
    [PHASE_ENEMY_IN] = TEXT("enemy_in", P, until.enemy_in, NULL,
                            .meaning = "It ends when enemies are in this objective."),
    [PHASE_AFTER] = TEXT("after", P, until.after, NULL,
                         .meaning = "It ends when the phase of another mission has ended, written "
                                    "`\"mission.phase\"`."),
    [PHASE_NOT] = TEXT("not", P, until.unless, NULL,
                       .meaning = "The names of those conditions that must not hold, with spaces "
                                  "between them, such as `\"enemy_in arrived\"`."),
    [PHASE_WHEN_ALL] =
        BOOLEAN("when_all", P, when.all, STORE_U32, "false",
                .meaning = "true: a reaction begins when all of the conditions below "
                           "that are given hold, and not when one of them does."),
    [PHASE_WHEN_NOT] = TEXT("when_not", P, when.unless, NULL,
                            .meaning = "The names of those that must not hold, such as "
                                       "`\"when_enemy_in\"`."),
    [PHASE_WHEN_TIME] = NUMBER("when_s", P, when.at_s, 0, 1e6, NULL, .unit = "s",
                               .meaning = "A reaction begins at this time after the beginning of "
                                          "the battle."),
    [PHASE_WHEN_TAKEN] = TEXT("when_taken", P, when.taken, NULL,
                              .meaning = "A reaction begins when the force holds this objective."),
    [PHASE_WHEN_LOST] = TEXT("when_lost", P, when.lost, NULL,
                             .meaning = "A reaction begins when the force does not hold it."),
    [PHASE_WHEN_BELOW] = NUMBER("when_below", P, when.below, 0.01, 1, NULL,
                                .meaning = "A reaction begins when less than this share of the "
                                           "group is active."),
    [PHASE_WHEN_ENEMY_IN] = TEXT("when_enemy_in", P, when.enemy_in, NULL,
                                 .meaning = "A reaction begins when enemies are in this "
                                            "objective."),
    [PHASE_WHEN_AFTER] = TEXT("when_after", P, when.after, NULL,
                              .meaning = "A reaction begins when the phase of another mission has "
                                         "ended."),
};
KEY_TABLE(schema_phase, "phases", phase_keys, P, PHASE_KEY_COUNT);
#undef P
