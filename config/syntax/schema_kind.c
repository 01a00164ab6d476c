/* The schema of a kind's file. `make docs` writes these rows into docs/scenario.md. */
#include "config/syntax/schema_internal.h"
#include "world/entity/kind.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"

static const struct key_choice guidances[] = {{"ballistic", GUIDANCE_BALLISTIC, NULL},
                                              {"homing", GUIDANCE_HOMING, NULL}};

static const struct key_choice drags[] = {
    {"none", DRAG_NONE, NULL}, {"g1", DRAG_G1, NULL}, {"g7", DRAG_G7, NULL}};

static const struct key_choice deliveries[] = {
    {"direct", DELIVERY_DIRECT, NULL}, {"arc", DELIVERY_ARC, NULL}, {"drop", DELIVERY_DROP, NULL}};

static const struct key_choice air_targets[] = {{"all", AIR_TARGETS_ALL, NULL},
                                                {"slow", AIR_TARGETS_SLOW, NULL},
                                                {"none", AIR_TARGETS_NONE, NULL}};

#define K struct kind_entry
static const struct key kind_keys[] = {
    TEXT("name", K, kind.name, NULL, .required = true,
         .meaning = "The name of the file, without `.cfg`."),
    CHOICE("domain", K, kind.domain, STORE_U8, ALL(domain_name, DOMAIN_COUNT), NULL,
           .required = true, .meaning = "What the kind is, and where it moves."),
    CHOICE("class", K, kind.object_class, STORE_U8, ALL(object_class_name, OBJECT_CLASS_COUNT),
           NULL,
           .meaning = "Fixed objects, which must have it: their row of the thesis's Table 1. Kinds "
                      "of one class are mixed at random. Other kinds must not have it."),
    TEXT("model", K, model, NULL, .required = true,
         .meaning = "The shape: the name of a file of `config/models`, without `.obj`."),
    TEXT("munition", K, munition, NULL,
         .meaning = "Vehicles: the kind that they fire. A vehicle without it is unarmed."),
    TEXT("light_munition", K, light_munition, NULL,
         .meaning =
             "Vehicles with `munition`: the kind that they fire at vehicles on land and water "
             "whose side armour is below 45 mm. Both are counted by `rounds`."),
    CHOICE("guidance", K, kind.guidance, STORE_U8, WORDS(guidances), "ballistic",
           .meaning = "Munitions. `ballistic`: the munition falls freely. `homing`: it follows its "
                      "target."),
    CHOICE("drag", K, kind.drag, STORE_U8, WORDS(drags), "none",
           .meaning = "Ballistic munitions: the standard projectile whose drag they have. `g1` "
                      "has a flat base, `g7` a boat tail; both need `ballistic_kgpm2`. `none`: "
                      "they keep their speed."),
    NUMBER("ballistic_kgpm2", K, kind.ballistic_kgpm2, 0, 100000, "0", .unit = "kg/m^2",
           .meaning = "Munitions with `drag`, above 0: the ballistic coefficient, which is the "
                      "mass over the form factor and the square of the calibre. 1 lb/in^2 is "
                      "703 kg/m^2."),
    CHOICE("air_targets", K, kind.air_targets, STORE_U8, WORDS(air_targets), "all",
           .meaning = "Munitions: the aircraft at which an agent fires them. `slow`: only those "
                      "that can hover, while they fly at less than 15 m/s. Commands and drivers "
                      "fire at anything."),
    BOOLEAN("craters", K, kind.craters, STORE_U8, "false",
            .meaning = "Munitions. true: a munition that strikes the ground digs a crater."),
    CHOICE("delivery", K, kind.delivery, STORE_U8, WORDS(deliveries), "direct",
           .meaning = "Ballistic munitions. `direct`: the gun points at the target. `arc`: the "
                      "munition of howitzers, fired at points over what is in between. `drop`: an "
                      "aircraft releases it with its own velocity."),
    CHOICE("fuze", K, kind.fuze, STORE_U8, ALL(fuze_name, FUZE_COUNT), "point",
           .meaning = "Munitions. `point`: the charge explodes where it strikes. `delay`: it "
                      "explodes below the ground: a wider crater, and less effect around it. "
                      "`air`: a munition on an arc explodes 8 m over the point that it is fired "
                      "at."),
    NUMBER("penetration_mm", K, kind.penetration_mm, 0, 5000, "0", .unit = "mm",
           .meaning = "Munitions: the steel that one penetrates at the muzzle. 0: a vehicle that "
                      "it strikes is damaged by its energy alone."),
    NUMBER("penetration_loss", K, kind.penetration_loss, 0, 5000, "0", .unit = "mm/km",
           .meaning = "Munitions: how much of the penetration is lost in each kilometre. 0: none, "
                      "as with a shaped charge."),
    NUMBERS("armour_mm", K, kind.armour_mm, 0, 5000, .unit = "mm",
            .unset = "by domain and mass ([weapons](weapons.md#armour))",
            .meaning = "Vehicles: the armour of front, side, rear and top, as steel along a line "
                       "square to that side. Below 10 mm the energy of a hit counts."),
    NUMBER("mass_kg", K, kind.mass_kg, 0.001, 1e9, NULL, .required = true, .unit = "kg",
           .meaning = "The mass."),
    NUMBER("radius_m", K, kind.radius_m, 0.01, 500, NULL, .required = true, .unit = "m",
           .meaning = "The radius of a sphere around the position. With `shape = \"sphere\"` this "
                      "sphere is what collides."),
    NUMBER("length_m", K, kind.length_m, 0.01, 1000, NULL, .required = true, .unit = "m",
           .meaning = "The size of the body from rear to front."),
    NUMBER("width_m", K, kind.width_m, 0.01, 1000, NULL, .required = true, .unit = "m",
           .meaning = "The size of the body from left to right."),
    NUMBER("height_m", K, kind.height_m, 0.01, 1000, NULL, .required = true, .unit = "m",
           .meaning = "The size of the body from bottom to top."),
    NUMBER("max_speed_mps", K, kind.max_speed_mps, 0, 3000, "0", .unit = "m/s",
           .meaning = "Vehicles and munitions, above 0: the top speed. A ballistic munition starts "
                      "with it."),
    NUMBER("min_speed_mps", K, kind.min_speed_mps, 0, 3000, "0", .unit = "m/s",
           .meaning = "Aircraft: the speed below which they stall, at most `max_speed_mps`. Agents "
                      "fly at 1.3 times this speed or faster. 0: the aircraft can hover."),
    NUMBER("acceleration_mps2", K, kind.acceleration_mps2, 0, 10000, "0", .unit = "m/s^2",
           .meaning = "Vehicles, above 0: the acceleration. Braking is twice as strong."),
    SCALED("turn_rate_dps", K, kind.turn_rate_rps, 0, 720, RAD_PER_DEG, "0", .unit = "degrees/s",
           .meaning = "Vehicles and homing munitions, above 0: how fast they turn."),
    SCALED("max_slope_deg", K, kind.max_slope_rad, 1, 89, RAD_PER_DEG, "30", .unit = "degrees",
           .meaning = "Land vehicles: the steepest ground that they climb."),
    BOOLEAN("tracked", K, kind.tracked, STORE_U8, "false",
            .meaning = "Land vehicles. true: they have tracks, which turn them on the spot."),
    WHOLE32("axles", K, kind.axles, 0, CHASSIS_AXLES_MAX, "0",
            .meaning = "Land vehicles: pairs of wheels or road wheels. 0: 2, or 5 with tracks."),
    SCALED("power_kw", K, kind.power_w, 0, 100000, 1000.0, "0", .unit = "kW",
           .meaning = "Land vehicles: the power of the engine. 0: what `mass_kg`, "
                      "`acceleration_mps2` and `max_speed_mps` need."),
    NUMBER("track_m", K, kind.track_m, 0, 100, "0", .unit = "m",
           .meaning = "Land vehicles: the distance between the middles of left and right wheels. "
                      "0: 0.84 of the width."),
    NUMBER("centre_height_m", K, kind.centre_height_m, 0, 100, "0", .unit = "m",
           .meaning = "Land vehicles: the height of the centre of mass over the ground. 0: 0.4 of "
                      "the height."),
    NUMBER("travel_m", K, kind.travel_m, 0, 2, "0", .unit = "m",
           .meaning = "Land vehicles: how far a wheel can rise from its place at rest. 0: 0.07 of "
                      "the height."),
    NUMBER("heave_hz", K, kind.heave_hz, 0, 5, "0", .unit = "Hz",
           .meaning = "Land vehicles: how often the body swings on its springs. 0: 1.6, or 1.4 "
                      "with tracks."),
    NUMBER("least_turn_m", K, kind.least_turn_m, 0, 1000, "0", .unit = "m",
           .meaning = "Land vehicles with wheels: the radius of the tightest circle of their "
                      "middle. 0: 1.65 times the length."),
    NUMBER("ford_m", K, kind.ford_m, 0, 10, "0", .unit = "m",
           .meaning = "Land vehicles: the deepest water that they cross. 0: 0.3 of the height."),
    NUMBER("step_m", K, kind.step_m, 0, 10, "0", .unit = "m",
           .meaning =
               "Land vehicles: the highest step that their wheels roll onto. Higher ones are "
               "walls. Tracks climb at most 0.147 of the length. 0: that, or 0.18 of the "
               "height with wheels."),
    NUMBER("trench_m", K, kind.trench_m, 0, 100, "0", .unit = "m",
           .meaning = "Land vehicles: the widest trench that their agents cross. 0: 0.15 of the "
                      "length, or 0.37 with tracks."),
    NUMBER("cruise_altitude_m", K, kind.cruise_altitude_m, 0, 20000, "0", .unit = "m",
           .meaning = "Aircraft: their usual height above the ground."),
    NUMBER("climb_rate_mps", K, kind.climb_rate_mps, 0, 500, "0", .unit = "m/s",
           .meaning = "Aircraft, above 0: how fast they climb."),
    NUMBER("max_load_g", K, kind.max_load, 0, 100, "0", .unit = "g",
           .meaning = "Aircraft and homing munitions: the most load that they bear in a turn, in "
                      "multiples of their weight. 0: 3.5 for aircraft that can hover, else the "
                      "load of a turn at `turn_rate_dps` and top speed (2 to 8 for aircraft)."),
    NUMBER("rigidity", K, kind.rigidity, 0, 1, "0.5",
           .meaning = "The share of an impact's energy that causes damage at once; the rest dents "
                      "the skin. Fixed objects under `impulse` and `spring`: the share of the "
                      "energy that damages the vehicle. A fixed object below 0.1, such as a bush, "
                      "bends aside."),
    NUMBER("moldability", K, kind.moldability, 0, 1, "0.5",
           .meaning = "The share of a dent that stays, and the share of the energy of the dent "
                      "that causes damage."),
    NUMBER("restitution", K, kind.restitution, 0, 1, "0.2",
           .meaning = "The share of the closing speed that is left after a bounce. The lower value "
                      "of the two kinds counts."),
    NUMBER("friction", K, kind.friction, 0, 2, "0.6",
           .meaning = "Coulomb's coefficient of friction of the skin: about 0 for ice, 1 for "
                      "rubber. The geometric mean of the two kinds counts."),
    NUMBER("resistance_j", K, kind.resistance_j, 1, 1e12, NULL, .required = true, .unit = "J",
           .meaning = "The energy that destroys it. The three levels of damage of a fixed object "
                      "are shares of it."),
    NUMBER("stiffness_npm", K, kind.stiffness_npm, 0, 1e12, "0", .unit = "N/m",
           .meaning = "The stiffness of the skin, for `response = \"spring\"`. 0: the skin takes "
                      "up `resistance_j` over a quarter of the body's smallest side."),
    SCALED("severe_deg", K, kind.severe_rad, 0, 45, RAD_PER_DEG, "5", .unit = "degrees",
           .meaning = "Figure 8: an impact is severe when the two headings differ by a multiple of "
                      "90 degrees to within this angle. A severe impact stops or destroys both "
                      "vehicles; after any other they bounce. The wider value of the two kinds "
                      "counts."),
    NUMBER("bounce_keep", K, kind.bounce_keep, 0, 1, "0.6",
           .meaning = "Figure 8: the share of its own speed that the vehicle keeps in a bounce."),
    NUMBER("fast_mps", K, kind.fast_mps, 0, 3000, "0", .unit = "m/s",
           .meaning = "Figure 8: a severe impact destroys both vehicles when this one is faster. "
                      "0: the scenario's `fast_vehicle_mps`."),
    NUMBER("damage_high", K, kind.damage_high, 0, 1000, "0",
           .meaning = "Fixed objects: the ratio of the energy of an impact to `resistance_j` from "
                      "which damage is high. 0: the scenario's. A kind has all three ratios or "
                      "none."),
    NUMBER("damage_med", K, kind.damage_med, 0, 1000, "0",
           .meaning = "Fixed objects: the ratio from which damage is medium, below `damage_high`."),
    NUMBER("damage_low", K, kind.damage_low, 0, 1000, "0",
           .meaning = "Fixed objects: the ratio from which damage is low, below `damage_med`."),
    NUMBER("debris_keep", K, kind.debris_keep, 0, 1, "1",
           .meaning =
               "Fixed objects: the share of the debris that lies firm after the fall. A land "
               "vehicle pushes the rest along, which moves if a vehicle felled the object. Over "
               "what stays where it fell it goes at most at the share of its top speed that its "
               "mass is of both masses. The lowest share counts where several lie."),
    NUMBER("explosive_kg", K, kind.explosive_kg, 0, 100000, "0", .unit = "kg of TNT",
           .meaning = "Munitions: the charge. Vehicles: what explodes when they are destroyed."),
    NUMBER("range_m", K, kind.range_m, 0, 50000, "0", .unit = "m",
           .meaning = "Armed vehicles, above 0: how far they fire."),
    NUMBER("sight_m", K, kind.sight_m, 0, 50000, "0", .unit = "m",
           .meaning = "Vehicles: how far they see enemies. 0: `range_m`, or 1,500 m for an unarmed "
                      "vehicle."),
    SCALED("view_deg", K, kind.view_rad, 1, 360, RAD_PER_DEG, "360", .unit = "degrees",
           .meaning = "Vehicles: the angle of view around the direction of the turret, or of the "
                      "hull where there is no turret. 360: all round, as from the cupola of a "
                      "tank."),
    CHOICE("doctrine", K, kind.doctrine, STORE_U32, ALL(doctrine_name, DOCTRINE_COUNT), NULL,
           .unset = "by domain",
           .meaning = "Vehicles: how they react to what they notice (Minds, below). A land vehicle "
                      "without this key is `light`, or `soft` when it is unarmed; a ship is "
                      "`warship`; an aircraft is `helicopter`, or `jet` with a `min_speed_mps`."),
    NUMBER("reload_s", K, kind.reload_s, 0, 3600, "0", .unit = "s",
           .meaning = "Armed vehicles, above 0: the time from one shot to the next."),
    NUMBER("reaction_s", K, kind.reaction_s, 0, 600, "4", .unit = "s",
           .meaning = "Armed vehicles: the median time from an agent's first sight of a target to "
                      "its shot. None is below 0.7 s."),
    SCALED("turret_rate_dps", K, kind.turret_rate_rps, 0, 360, RAD_PER_DEG, "0",
           .unit = "degrees/s",
           .meaning = "How fast the turret turns, only with `munition`. 0: there is no turret, and "
                      "the vehicle aims with its hull."),
    SCALED("gun_rate_dps", K, kind.gun_rate_rps, 0, 360, RAD_PER_DEG, "0", .unit = "degrees/s",
           .meaning = "How fast the gun moves up and down, only with `munition`. 0: it does not."),
    SCALED("gun_low_deg", K, kind.gun_low_rad, -90, 90, RAD_PER_DEG, "0", .unit = "degrees",
           .meaning = "The lowest elevation of the gun above the plane of the hull: 0 or below."),
    SCALED("gun_high_deg", K, kind.gun_high_rad, -90, 90, RAD_PER_DEG, "0", .unit = "degrees",
           .meaning = "The highest elevation of the gun above the plane of the hull: 0 or above."),
    SCALED("seeker_deg", K, kind.seeker_rad, 0, 180, RAD_PER_DEG, "0", .unit = "degrees",
           .meaning = "Homing munitions, above 0: the half angle of the cone around the direction "
                      "of flight in which they see their target. A target that leaves the cone is "
                      "lost for good."),
    NUMBER("burn_s", K, kind.burn_s, 0, 600, "0", .unit = "s",
           .meaning = "Homing munitions: how long the motor burns, which brings them to top speed. "
                      "Then they coast, and drag slows them. 0: it burns until the end."),
    NUMBER("reliability", K, kind.reliability, 0, 1, "1",
           .meaning = "Homing munitions: the share of them in which motor, seeker and fuze work. "
                      "Any other swerves within two seconds."),
    NUMBER("decoy_chance", K, kind.decoyed, 0, 1, "0",
           .meaning = "Homing munitions: how often the flares of an alert aircraft take the seeker "
                      "from it. The smoke of an alert land vehicle does so a third as often."),
    SCALED("dispersion_mrad", K, kind.dispersion_rad, 0, 500, 0.001, "0", .unit = "mrad",
           .meaning = "Munitions: the standard error of the aim from a vehicle that stands. 1 "
                      "mrad is 1 m at 1 km."),
    SCALED("dispersion_moving_mrad", K, kind.dispersion_moving_rad, 0, 500, 0.001, "0",
           .unit = "mrad",
           .meaning = "Munitions: the standard error from a vehicle at half of its top speed or "
                      "faster, not below `dispersion_mrad`; below that speed it is in between. "
                      "0: as from one that stands."),
    NUMBER("life_s", K, kind.life_s, 0, 600, "0", .unit = "s",
           .meaning = "Munitions, above 0: the flight ends after this time."),
    NUMBER("courage", K, kind.courage, 0, 1, "0.5",
           .meaning = "How often a vehicle that is fired upon fires back instead of fleeing."),
    NUMBER("fuel_l", K, kind.fuel_l, 0, 1e7, "0", .unit = "l",
           .meaning = "The fuel of a full tank. 0: the vehicle needs none."),
    NUMBER("fuel_lps", K, kind.fuel_lps, 0, 1000, "0", .unit = "l/s",
           .meaning = "The fuel burnt at full speed."),
    NUMBER("idle_share", K, kind.idle_share, 0, 1, "0.07",
           .meaning =
               "Land vehicles: the share of `fuel_lps` that the engine burns while the vehicle "
               "stands. A gas turbine burns twice that of a piston engine."),
    WHOLE32("rounds", K, kind.rounds, 0, 1000000, "0",
            .meaning = "The rounds of its munition at the start. An armed vehicle needs some."),
};
#undef K
const struct key_table schema_kind = {"kind", kind_keys, COUNT(kind_keys),
                                      sizeof(struct kind_entry)};
_Static_assert(COUNT(kind_keys) <= KEY_TABLE_MAX, "the keys fit into a table");
