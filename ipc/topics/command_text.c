/* Orders: the tables of verbs and arguments, and the checks. */
#include "ipc/topics/command_text.h"

#include "world/entity/command.h"
#include "world/entity/entity.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"
#include "world/runtime/parse_number.h"
#include "world/terrain/gridsquare.h"

#include <stdio.h>
#include <string.h>

#define LEASE_MIN_S 0.1
#define LEASE_MAX_S 3600.0
#define EVERY_MAX_S 3600.0
#define RADIUS_MAX  5000.0 /* [m] */

enum sort {
    SORT_ENTITY,
    SORT_FLOAT,
    SORT_DOUBLE,
    SORT_WHOLE,
    SORT_TRUTH,
    SORT_KIND,
    SORT_WORD,
    SORT_PLACE
};

typedef const char *word_name(int value);

static const char *gear_word(int value)
{
    return gear_name((enum gearing)value);
}

static const char *force_word(int value)
{
    return force_name((enum force)value);
}

static const char *behaviour_word(int value)
{
    return behaviour_name((enum behaviour)value);
}

#define OFFSET(member)     offsetof(struct command_text, member)
#define FLOAT(member, low) SORT_FLOAT, low, 1.0, OFFSET(command.member), NULL
#define BIT(field)         (1u << (field))

/* For numbers the range is low to high. For words low is the first and high the last of the
 * enumeration. */
static const struct {
    const char *name, *option;
    enum sort sort;
    double low, high;
    size_t at; /* offset in struct command_text */
    word_name *word;
} fields[COMMAND_TEXT_FIELD_COUNT] = {
    [COMMAND_TEXT_VEHICLE] = {"vehicle", "vehicle", SORT_ENTITY, 1, UINT32_MAX, OFFSET(vehicle),
                              NULL},
    [COMMAND_TEXT_TARGET] = {"target", "target", SORT_ENTITY, 1, UINT32_MAX, OFFSET(target), NULL},
    [COMMAND_TEXT_THROTTLE] = {"throttle", "throttle", FLOAT(throttle, -1.0)},
    [COMMAND_TEXT_STEER] = {"steer", "steer", FLOAT(steer, -1.0)},
    [COMMAND_TEXT_CLIMB] = {"climb", "climb", FLOAT(climb, -1.0)},
    [COMMAND_TEXT_TRAVERSE] = {"traverse", "traverse", FLOAT(traverse, -1.0)},
    [COMMAND_TEXT_ELEVATE] = {"elevate", "elevate", FLOAT(elevate, -1.0)},
    [COMMAND_TEXT_BRAKE] = {"brake", "brake", FLOAT(brake, 0.0)},
    [COMMAND_TEXT_GEAR] = {"gear", "gear", SORT_WORD, 0, GEAR_COUNT - 1, OFFSET(command.gear),
                           gear_word},
    [COMMAND_TEXT_LEASE] = {"lease_s", "lease", SORT_DOUBLE, LEASE_MIN_S, LEASE_MAX_S,
                            OFFSET(lease_s), NULL},
    [COMMAND_TEXT_ANYWAY] = {"anyway", "anyway", SORT_TRUTH, 0, 1, OFFSET(command.anyway), NULL},
    [COMMAND_TEXT_KIND] = {"kind", "kind", SORT_KIND, 0, 0, OFFSET(command.kind), NULL},
    [COMMAND_TEXT_MUNITION] = {"munition", "munition", SORT_KIND, 0, 0, OFFSET(command.kind), NULL},
    [COMMAND_TEXT_X] = {"x", "x", SORT_DOUBLE, 0, WORLD_SIDE_MAX_M, OFFSET(command.x_m), NULL},
    [COMMAND_TEXT_Z] = {"z", "z", SORT_DOUBLE, 0, WORLD_SIDE_MAX_M, OFFSET(command.z_m), NULL},
    [COMMAND_TEXT_AT] = {"at", "at", SORT_PLACE, 0, 0, OFFSET(place), NULL},
    [COMMAND_TEXT_FORCE] = {"force", "force", SORT_WORD, 0, FORCE_COUNT - 1, OFFSET(command.force),
                            force_word},
    [COMMAND_TEXT_BEHAVIOUR] = {"behaviour", "behaviour", SORT_WORD, 0, BEHAVIOUR_PATROL,
                                OFFSET(command.behaviour), behaviour_word},
    [COMMAND_TEXT_ALTITUDE] = {"altitude_m", "altitude", SORT_DOUBLE, 0, 20000,
                               OFFSET(command.altitude_m), NULL},
    [COMMAND_TEXT_HEADING] = {"heading_deg", "heading", SORT_DOUBLE, -360, 360,
                              OFFSET(command.heading_rad), NULL},
    [COMMAND_TEXT_SPEED] = {"speed_mps", "speed", SORT_DOUBLE, 0, 2000, OFFSET(command.speed_mps),
                            NULL},
    [COMMAND_TEXT_FRAMES] = {"frames", "frames", SORT_WHOLE, 1, 1000000, OFFSET(command.frames),
                             NULL},
    [COMMAND_TEXT_SCALE] = {"scale", "scale", SORT_DOUBLE, 0.01, 100, OFFSET(command.scale), NULL},
    [COMMAND_TEXT_ROUNDS] = {"rounds", "rounds", SORT_WHOLE, 1, COMMAND_TEXT_ROUNDS_MAX,
                             OFFSET(rounds), NULL},
    [COMMAND_TEXT_EVERY] = {"every_s", "every", SORT_DOUBLE, 0, EVERY_MAX_S, OFFSET(every_s), NULL},
    [COMMAND_TEXT_RADIUS] = {"radius_m", "radius", SORT_DOUBLE, 0, RADIUS_MAX, OFFSET(radius_m),
                             NULL},
    [COMMAND_TEXT_SEED] = {"seed", "seed", SORT_WHOLE, 0, UINT32_MAX, OFFSET(seed), NULL},
};

_Static_assert(sizeof(jolon_Gear) == sizeof(int) && sizeof(jolon_Force) == sizeof(int) &&
                   sizeof(jolon_Behaviour) == sizeof(int),
               "words are stored as int");
_Static_assert(sizeof((jolon_Command *)0)->kind == COMMAND_TEXT_NAME_MAX, "names of kinds");
_Static_assert(COMMAND_TEXT_NAME_MAX == ENTITY_NAME_MAX, "names of vehicles");

#define CONTROLS                                                                                   \
    (BIT(COMMAND_TEXT_THROTTLE) | BIT(COMMAND_TEXT_STEER) | BIT(COMMAND_TEXT_CLIMB) |              \
     BIT(COMMAND_TEXT_TRAVERSE) | BIT(COMMAND_TEXT_ELEVATE) | BIT(COMMAND_TEXT_BRAKE) |            \
     BIT(COMMAND_TEXT_GEAR) | BIT(COMMAND_TEXT_LEASE))
#define MISSION_NEEDED (BIT(COMMAND_TEXT_MUNITION) | BIT(COMMAND_TEXT_X) | BIT(COMMAND_TEXT_Z))
#define MISSION                                                                                    \
    (MISSION_NEEDED | BIT(COMMAND_TEXT_AT) | BIT(COMMAND_TEXT_ROUNDS) | BIT(COMMAND_TEXT_EVERY) |  \
     BIT(COMMAND_TEXT_RADIUS) | BIT(COMMAND_TEXT_SEED))
#define SPAWN_NEEDED (BIT(COMMAND_TEXT_KIND) | BIT(COMMAND_TEXT_X) | BIT(COMMAND_TEXT_Z))
#define SPAWN                                                                                      \
    (SPAWN_NEEDED | BIT(COMMAND_TEXT_AT) | BIT(COMMAND_TEXT_FORCE) | BIT(COMMAND_TEXT_BEHAVIOUR) | \
     BIT(COMMAND_TEXT_ALTITUDE) | BIT(COMMAND_TEXT_HEADING) | BIT(COMMAND_TEXT_SPEED))
#define VEHICLE BIT(COMMAND_TEXT_VEHICLE)
#define NOTHING COMMAND_TEXT_FIELD_COUNT

static const struct command_text_verb verbs[] = {
    {"pause", jolon_COMMAND_PAUSE, 0, 0, NOTHING},
    {"resume", jolon_COMMAND_RESUME, 0, 0, NOTHING},
    {"step", jolon_COMMAND_STEP, BIT(COMMAND_TEXT_FRAMES), BIT(COMMAND_TEXT_FRAMES),
     COMMAND_TEXT_FRAMES},
    {"scale", jolon_COMMAND_SCALE, BIT(COMMAND_TEXT_SCALE), BIT(COMMAND_TEXT_SCALE),
     COMMAND_TEXT_SCALE},
    {"drive", jolon_COMMAND_DRIVE, VEHICLE | CONTROLS, VEHICLE, COMMAND_TEXT_VEHICLE},
    {"release", jolon_COMMAND_RELEASE, VEHICLE | BIT(COMMAND_TEXT_ANYWAY), VEHICLE,
     COMMAND_TEXT_VEHICLE},
    {"fire", jolon_COMMAND_FIRE, VEHICLE | BIT(COMMAND_TEXT_TARGET) | MISSION, 0,
     COMMAND_TEXT_VEHICLE},
    {"mission", jolon_COMMAND_FIRE, MISSION, MISSION_NEEDED, NOTHING},
    {"spawn", jolon_COMMAND_SPAWN, SPAWN, SPAWN_NEEDED, COMMAND_TEXT_KIND},
    {"remove", jolon_COMMAND_REMOVE, VEHICLE, VEHICLE, COMMAND_TEXT_VEHICLE},
    {"quit", jolon_COMMAND_QUIT, 0, 0, NOTHING},
};

#define VERB_COUNT (sizeof verbs / sizeof verbs[0])
/* COMMAND_NONE has no verb; "mission" is a second one of COMMAND_FIRE. */
_Static_assert(VERB_COUNT == COMMAND_TYPE_COUNT, "a verb for each type of command");

const struct command_text_verb *command_text_verb(size_t i)
{
    return i < VERB_COUNT ? &verbs[i] : NULL;
}

const char *command_text_field_name(enum command_text_field field)
{
    return fields[field].name;
}

const char *command_text_field_option(enum command_text_field field)
{
    return fields[field].option;
}

enum command_text_field command_text_field(const char *name)
{
    int i = 0;
    while (i < COMMAND_TEXT_FIELD_COUNT && strcmp(fields[i].name, name) != 0)
        i++;
    return (enum command_text_field)i;
}

bool command_text_field_is_truth(enum command_text_field field)
{
    return fields[field].sort == SORT_TRUTH;
}

/* Returns the number of letters to insert, delete or change (Levenshtein distance) for short
 * words. */
static size_t edit_distance(const char *a, const char *b)
{
    size_t row[COMMAND_TEXT_NAME_MAX + 1];
    size_t width = strnlen(b, COMMAND_TEXT_NAME_MAX);
    for (size_t j = 0; j <= width; j++)
        row[j] = j;
    for (size_t i = 0; a[i] && i < COMMAND_TEXT_NAME_MAX; i++) {
        size_t corner = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < width; j++) {
            size_t change = corner + (a[i] != b[j]);
            size_t least = row[j] < row[j + 1] ? row[j] + 1 : row[j + 1] + 1;
            corner = row[j + 1];
            row[j + 1] = change < least ? change : least;
        }
    }
    return row[width];
}

/* Appends a word to a list "a, b, c". */
static void list(char *text, size_t bytes, const char *word)
{
    size_t used = strlen(text);
    (void)snprintf(text + used, bytes - used, "%s%s", used ? ", " : "", word);
}

int command_text_begin(struct command_text *order, const char *verb, struct error_text *error)
{
    char all[160] = "";
    size_t best = 0;
    *order = (struct command_text){
        .rounds = 1, .side_m = WORLD_SIDE_MAX_M, .command = {.altitude_m = -1.0}};
    for (size_t i = 0; i < VERB_COUNT; i++) {
        if (strcmp(verbs[i].name, verb) == 0) {
            order->verb = &verbs[i];
            order->command.type = verbs[i].type;
            return 0;
        }
        if (edit_distance(verb, verbs[i].name) < edit_distance(verb, verbs[best].name))
            best = i;
        list(all, sizeof all, verbs[i].name);
    }
    if (edit_distance(verb, verbs[best].name) <= 2)
        return error_text_set(error, "'%.32s': no such command; did you mean %s?", verb,
                              verbs[best].name);
    return error_text_set(error, "'%.32s': no such command; there are %s", verb, all);
}

static int wrong(const struct command_text_value *value, struct error_text *error,
                 const char *right)
{
    if (value->text)
        return error_text_set(error, "'%.32s': not %s", value->text, right);
    if (value->is_truth)
        return error_text_set(error, "%s: not %s", value->truth ? "true" : "false", right);
    return error_text_set(error, "%g: not %s", value->number, right);
}

/* Reads a number in the field's range, which must be whole for some fields. */
static int take_number(double *number, enum command_text_field field,
                       const struct command_text_value *value, struct error_text *error)
{
    char right[96];
    double low = fields[field].low, high = fields[field].high;
    bool whole = fields[field].sort == SORT_WHOLE || fields[field].sort == SORT_ENTITY;
    bool good = false;
    if (value->text) {
        good = value->loose && parse_real(value->text, low, high, number);
    } else if (!value->is_truth) {
        *number = value->number;
        good = *number >= low && *number <= high;
    }
    if (good && whole)
        good = *number == (double)(uint32_t)*number;
    if (good)
        return 0;
    (void)snprintf(right, sizeof right, "a %snumber from %.10g to %.10g", whole ? "whole " : "",
                   low, high);
    return wrong(value, error, right);
}

static int take_name(char *to, const struct command_text_value *value, const char *what,
                     struct error_text *error)
{
    char right[64];
    size_t length = value->text ? strlen(value->text) : 0;
    if (length == 0 || length >= COMMAND_TEXT_NAME_MAX) {
        (void)snprintf(right, sizeof right, "%s, of 1 to %u letters", what,
                       COMMAND_TEXT_NAME_MAX - 1);
        return wrong(value, error, right);
    }
    memcpy(to, value->text, length + 1);
    return 0;
}

static bool is_digits(const char *text)
{
    return *text && text[strspn(text, "0123456789")] == '\0';
}

/* Reads an id, or a name that is resolved later. */
static int take_entity(struct command_text *order, enum command_text_field field,
                       const struct command_text_value *value, struct error_text *error)
{
    double number;
    char *name = (char *)order + fields[field].at;
    uint32_t *id = field == COMMAND_TEXT_VEHICLE ? &order->command.entity : &order->command.target;
    if (value->is_truth)
        return wrong(value, error, "the id or the name of a vehicle");
    if (value->text && !(value->loose && is_digits(value->text)))
        return take_name(name, value, "the id or the name of a vehicle", error);
    if (take_number(&number, field, value, error) != 0)
        return -1;
    *id = (uint32_t)number;
    return 0;
}

static int take_word(void *to, enum command_text_field field,
                     const struct command_text_value *value, struct error_text *error)
{
    char all[96] = "";
    for (int i = (int)fields[field].low; i <= (int)fields[field].high; i++) {
        const char *name = fields[field].word(i);
        if (value->text && strcmp(name, value->text) == 0) {
            memcpy(to, &i, sizeof i);
            return 0;
        }
        list(all, sizeof all, name);
    }
    char right[112];
    (void)snprintf(right, sizeof right, "one of %s", all);
    return wrong(value, error, right);
}

/* Reads a place in any of its forms. x and z count as given by it. */
static int take_place(struct command_text *order, const struct command_text_value *value,
                      struct error_text *error)
{
    const uint32_t both = BIT(COMMAND_TEXT_X) | BIT(COMMAND_TEXT_Z);
    struct location *place = &order->place;
    if (order->given & both)
        return error_text_set(error, "x and z are given beside it; right would be: one of the two");
    if (!value->text)
        return wrong(value, error, "a text, as \"44.2705N,71.3033W\"");
    if (location_read(place, value->text, error) != 0)
        return -1;
    const struct command_text_value x = {.number = place->x}, z = {.number = place->z};
    if (!place->on_earth && (take_number(&order->command.x_m, COMMAND_TEXT_X, &x, error) != 0 ||
                             take_number(&order->command.z_m, COMMAND_TEXT_Z, &z, error) != 0))
        return -1;
    order->given |= both;
    return 0;
}

static int take(struct command_text *order, enum command_text_field field,
                const struct command_text_value *value, struct error_text *error)
{
    char *to = (char *)order + fields[field].at;
    double number = 0.0;
    float single;
    uint32_t whole;
    switch (fields[field].sort) {
    case SORT_ENTITY:
        return take_entity(order, field, value, error);
    case SORT_KIND:
        return take_name(to, value, "the name of a kind", error);
    case SORT_WORD:
        return take_word(to, field, value, error);
    case SORT_PLACE:
        return take_place(order, value, error);
    case SORT_TRUTH:
        if (!value->is_truth)
            return wrong(value, error, "true or false");
        memcpy(to, &value->truth, sizeof value->truth);
        return 0;
    case SORT_FLOAT:
    case SORT_DOUBLE:
    case SORT_WHOLE:
        break;
    }
    if (take_number(&number, field, value, error) != 0)
        return -1;
    single = (float)number;
    if (field == COMMAND_TEXT_HEADING)
        number *= RAD_PER_DEG;
    if (fields[field].sort == SORT_FLOAT) {
        memcpy(to, &single, sizeof single);
    } else if (fields[field].sort == SORT_WHOLE) {
        whole = (uint32_t)number;
        memcpy(to, &whole, sizeof whole);
    } else {
        memcpy(to, &number, sizeof number);
    }
    return 0;
}

int command_text_give(struct command_text *order, enum command_text_field field,
                      const struct command_text_value *value, struct error_text *error)
{
    if (!(order->verb->allowed & BIT(field)))
        return error_text_set(error, "%s does not take it", order->verb->name);
    if (order->given & BIT(field))
        return error_text_set(error, "it is given twice");
    if (take(order, field, value, error) != 0)
        return -1;
    order->given |= BIT(field);
    return 0;
}

/* Checks that FIRE is either a vehicle's or a mission's. */
static int check_fire(const struct command_text *order, struct error_text *error)
{
    uint32_t by_vehicle = order->given & (VEHICLE | BIT(COMMAND_TEXT_TARGET));
    uint32_t by_sky = order->given & MISSION;
    if (by_vehicle & VEHICLE ? by_sky != 0
                             : by_vehicle != 0 || (by_sky & MISSION_NEEDED) != MISSION_NEEDED)
        return error_text_set(error,
                              "%s: either a vehicle, and a target or none; or a munition and a "
                              "place x, z or at, and rounds, every, radius and seed or none",
                              order->verb->name);
    return 0;
}

int command_text_end(struct command_text *order, struct error_text *error)
{
    uint32_t missing = order->verb->needed & ~order->given;
    if (missing)
        return error_text_set(error, "%s: %s is missing", order->verb->name,
                              fields[__builtin_ctz(missing)].name);
    return order->command.type == jolon_COMMAND_FIRE ? check_fire(order, error) : 0;
}

bool command_text_needs_names(const struct command_text *order)
{
    return order->vehicle[0] || order->target[0];
}

bool command_text_needs_hz(const struct command_text *order)
{
    return order->lease_s > 0.0;
}

bool command_text_needs_place(const struct command_text *order)
{
    return order->place.on_earth;
}

int command_text_place(struct command_text *order, const struct location_frame *frame,
                       struct error_text *error)
{
    struct error_text reason;
    if (!order->place.on_earth)
        return 0;
    if (location_world(&order->place, frame, &order->command.x_m, &order->command.z_m, &reason) !=
        0)
        return error_text_set(error, "at: %s", reason.text);
    order->place.on_earth = false;
    return 0;
}

static int resolve_name(uint32_t *id, const char *name, const struct name_table *names,
                        struct error_text *error)
{
    const char *nearest = "";
    if (!name[0])
        return 0;
    *id = name_table_find(names, name);
    if (*id)
        return 0;
    for (uint32_t i = 0; i < names->count; i++) {
        if (!*nearest || edit_distance(name, names->entry[i].name) < edit_distance(name, nearest))
            nearest = names->entry[i].name;
    }
    if (!*nearest)
        return error_text_set(error, "'%s': no vehicle has a name in this world; say its id", name);
    return error_text_set(error, "'%s': no vehicle has that name; the nearest is %s", name,
                          nearest);
}

int command_text_resolve(struct command_text *order, const struct name_table *names, double hz,
                         struct error_text *error)
{
    jolon_Command *command = &order->command;
    if (command_text_needs_names(order) &&
        (resolve_name(&command->entity, order->vehicle, names, error) != 0 ||
         resolve_name(&command->target, order->target, names, error) != 0))
        return -1;
    if (command_text_needs_hz(order)) {
        double frames = order->lease_s * hz;
        command->lease_frames = frames < COMMAND_LEASE_MAX ? (uint32_t)frames : COMMAND_LEASE_MAX;
        if (!command->lease_frames)
            command->lease_frames = 1;
    }
    return 0;
}

jolon_Command command_text_round(const struct command_text *order, uint64_t seed, uint32_t round)
{
    jolon_Command command = order->command;
    if (order->radius_m > 0.0) {
        double sine, cosine;
        double away_m = order->radius_m * sqrt(random_unit(seed, 0, round, RANDOM_MISSION_RANGE));
        maths_sincos(TWO_PI * random_unit(seed, 0, round, RANDOM_MISSION_AZIMUTH), &sine, &cosine);
        command.x_m = maths_clamp(command.x_m + away_m * sine, 0.0, order->side_m);
        command.z_m = maths_clamp(command.z_m + away_m * cosine, 0.0, order->side_m);
    }
    return command;
}

const char *command_text_advice(const struct command_text *order, jolon_CommandResult result)
{
    switch (result) {
    case jolon_RESULT_NO_SUCH_ENTITY:
        return "; it may have been removed: jolon monitor shows the vehicles";
    case jolon_RESULT_TAKEN:
        return order->command.type == jolon_COMMAND_RELEASE
                   ? "; release it anyway, or wait until its driver lets go"
                   : "; wait until its driver lets go, or take it from him: release anyway";
    case jolon_RESULT_REMOTE:
        return "; it came by the gateway, and only its owner moves, fires or removes it";
    case jolon_RESULT_OUT_OF_RANGE:
        return order->command.type == jolon_COMMAND_SPAWN
                   ? "; a ship needs water, what drives needs land, and all of them a place on the "
                     "map"
                   : "";
    case jolon_RESULT_TABLE_FULL:
        return "; remove something, or give the scenario a larger world.capacity";
    case jolon_RESULT_CANNOT:
        switch (order->command.type) {
        case jolon_COMMAND_STEP:
            return "; pause first";
        case jolon_COMMAND_RELEASE:
            return "; no client drives it";
        case jolon_COMMAND_FIRE:
            return "; it still lays its gun on the target or reloads: say it again; or it has "
                   "no rounds, or is a wreck";
        case jolon_COMMAND_DRIVE:
            return "; it is a wreck: take another";
        case jolon_COMMAND_SPAWN:
            return "; too many vehicles stand on that spot already: name a place 10 m away";
        default:
            return "";
        }
    default:
        return "";
    }
}
