/* Reads a scenario in this order: defaults, the scenario file, overrides, kinds, lists. Then sets
 * the parameters that follow from them. */
#include "config/loader.h"

#include "config/earthworks.h"
#include "config/ground_objects.h"
#include "config/ground_source.h"
#include "config/kinds.h"
#include "config/missions.h"
#include "config/places.h"
#include "config/scripts.h"
#include "config/syntax/lists.h"
#include "config/syntax/schema.h"
#include "config/syntax/source.h"
#include "config/vehicles.h"
#include "world/entity/persistent_contact.h"
#include "world/gateway_lists.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_format.h"

#include <arpa/inet.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define DEFAULT_SCENARIO "hunter-liggett"
#define OVERRIDE_PLACE   "--set"

/* Sizes of the shared tables. A frame fills an eighth of the event ring at most, so that a reader
 * has at least seven frames of time. 16 events an entity are the events of a busy second. */
#define EVENT_SLOTS_MIN    65536u
#define EVENT_SLOTS_MAX    1048576u
#define EVENTS_PER_ENTITY  16u
#define EVENT_FRAME_SHARE  8u
#define INTENTS_PER_ENTITY 2u    /* a shot and a change of behaviour */
#define INTENTS_EXTRA      1024u /* commands' answers, ordered shots */
#define COMMAND_SLOTS      1024u
#define CRATER_SLOTS       65536u
#define DENT_SLOTS         65536u

#define APPLICATION_LAST 65533u /* of DIS; higher numbers are reserved */

/* A scenario while it is read. */
struct load {
    struct scenario *scenario;
    const char *data_dir;
    struct source source;
    config_t config;
    XXH3_state_t *hash;
    struct key_place origin[KEY_TABLE_MAX]; /* where each key of schema_scenario was last set */
    bool objects_chosen;
    struct error_text *error;
};

/* Finds the scenario's file: the path itself, else NAME or NAME.cfg in data_dir/scenarios. */
static int find_scenario(const char *data_dir, const char *path, char *found, size_t bytes,
                         struct error_text *error)
{
    const char *name = path != NULL ? path : DEFAULT_SCENARIO;
    const struct key_place place = {name, 0};
    static const char *const suffixes[] = {"", ".cfg"};
    struct stat status;
    if (path != NULL && (strchr(path, '/') != NULL || stat(path, &status) == 0)) {
        if ((size_t)snprintf(found, bytes, "%s", path) >= bytes)
            return key_table_refuse(error, place, NULL, NULL, "is too long for a path");
        return 0;
    }
    for (size_t i = 0; i < sizeof(suffixes) / sizeof(suffixes[0]); i++) {
        if ((size_t)snprintf(found, bytes, "%s/scenarios/%s%s", data_dir, name, suffixes[i]) >=
            bytes)
            return key_table_refuse(error, place, NULL, NULL, "is too long for a path");
        if (stat(found, &status) == 0)
            return 0;
    }
    return key_table_refuse(error, place, NULL, NULL,
                            "no such scenario; right would be: a file, or a name from %s/scenarios",
                            data_dir);
}

/* Lists have readers of their own (read_lists()). */
static const char *const lists[] = {"vehicles",   "missions", "objectives", "scripts", "fires",
                                    "earthworks", "objects",  "bases",      NULL};

static int read_file(struct load *load)
{
    struct key_reading keys = {.table = &schema_scenario,
                               .destination = load->scenario->settings,
                               .file = load->source.path,
                               .lists = lists};
    const config_setting_t *root = config_root_setting(&load->config);
    const config_setting_t *objects = config_setting_get_member(root, "objects");
    if (key_table_read(&keys, root, "", "", load->error) != 0)
        return -1;
    for (uint32_t i = 0; i < schema_scenario.count; i++) {
        if (keys.given[i])
            load->origin[i] = (struct key_place){load->source.path, keys.line[i]};
        else
            load->origin[i] = (struct key_place){"default", 0};
    }
    if (objects != NULL && objects->type == CONFIG_TYPE_LIST) {
        load->scenario->settings->objects = OBJECTS_LIST;
        load->objects_chosen = true;
    }
    if (keys.given[key_table_find(&schema_scenario, "objects.source")])
        load->objects_chosen = true;
    return 0;
}

/* Index of the key that an override sets, and the text of its value; -1 with the message. */
static int find_override(struct load *load, const char *text, const char **value)
{
    const struct key_place place = {OVERRIDE_PLACE, 0};
    const char *equals = strchr(text, '=');
    char name[KEY_PATH_MAX];
    if (equals == NULL || equals == text)
        return key_table_refuse(load->error, place, text, NULL,
                                "is not an override; right would be: group.key=value");
    snprintf(name, sizeof(name), "%.*s", (int)(equals - text), text);
    int index = key_table_find(&schema_scenario, name);
    if (index < 0 || (size_t)(equals - text) >= sizeof(name))
        return key_table_refuse(
            load->error, place, name, equals + 1,
            "unknown key; allowed: a scenario key of one value, such as world.seed "
            "or collision.response");
    load->origin[index] = place;
    *value = equals + 1;
    return index;
}

static int apply_override(struct load *load, const char *text)
{
    const char *value = NULL;
    int index = find_override(load, text, &value);
    if (index < 0)
        return -1;
    if (strcmp(schema_scenario.keys[index].name, "objects.source") == 0)
        load->objects_chosen = true;
    /* The path of a ground file may change: the hash of its ground counts. */
    if (strcmp(schema_scenario.keys[index].name, GROUND_SOURCE_KEY) != 0)
        XXH3_64bits_update(load->hash, text, strlen(text) + 1);
    return key_table_set_text(&schema_scenario.keys[index], load->scenario->settings, value,
                              load->origin[index], load->error);
}

/* Three constants. Each must be above the next. */
struct levels {
    const char *name[3];
    double value[3];
};

static int check_levels(const struct load *load, const struct levels *levels)
{
    for (int i = 1; i < 3; i++) {
        const char *name = levels->name[i];
        char text[32];
        if (levels->value[i - 1] > levels->value[i])
            continue;
        snprintf(text, sizeof(text), "%.15g", levels->value[i]);
        return key_table_refuse(
            load->error, load->origin[key_table_find(&schema_scenario, name)], name, text,
            "is not below the next higher level; allowed: below %.15g", levels->value[i - 1]);
    }
    return 0;
}

/* Says what to write instead of "fe80::1%eth0". */
static int refuse_zone(const struct load *load, const char *name, const char *text)
{
    return key_table_refuse(load->error, load->origin[key_table_find(&schema_scenario, name)], name,
                            text, "an address has no %%zone here; name it by gateway.interface");
}

/* 0.0.0.0 and :: are where one may listen. The system would send to this machine there, which is
 * not what who writes them means. */
static int check_target(const struct load *load, const char *name, const char *text)
{
    static const uint8_t any[16];
    struct internet_address address;
    struct error_text wrong;
    if (internet_address_read(&address, text, 1, &wrong) != 0 ||
        memcmp(address.bytes, any, sizeof any) != 0)
        return 0;
    return key_table_refuse(load->error, load->origin[key_table_find(&schema_scenario, name)], name,
                            text,
                            "is no address to send to; right would be that of a machine, of a "
                            "broadcast such as 10.0.0.255, or of a group such as 239.1.2.3");
}

/* An address in numbers, with or without a port, or "none". */
static int check_endpoint(const struct load *load, const char *name, const char *text)
{
    struct internet_address address;
    struct error_text wrong;
    if (strcmp(text, "none") == 0 || internet_address_read(&address, text, 1, &wrong) == 0)
        return 0;
    if (strchr(text, '%') != NULL)
        return refuse_zone(load, name, text);
    return key_table_refuse(load->error, load->origin[key_table_find(&schema_scenario, name)], name,
                            text, "%s", wrong.text);
}

static int check_gateway_lists(const struct load *load, const struct gateway_params *gateway)
{
    struct gateway_lists_peers peers;
    struct gateway_lists_control control;
    struct error_text wrong;
    const char *name = "gateway.peers", *text = gateway->peers;
    int result = gateway_lists_peers(&peers, text, &wrong);
    if (result == 0) {
        name = "gateway.control";
        text = gateway->control;
        result = gateway_lists_control(&control, text, &wrong);
    }
    return result == 0
               ? 0
               : key_table_refuse(load->error, load->origin[key_table_find(&schema_scenario, name)],
                                  name, text, "%s", wrong.text);
}

static int check_gateway(const struct load *load)
{
    const struct gateway_params *gateway = &load->scenario->settings->params.gateway;
    struct in6_addr any;
    const char *name = "gateway.address", *address = gateway->address;
    if (strchr(address, '%') != NULL)
        return refuse_zone(load, name, address);
    if (inet_pton(AF_INET, address, &any) != 1 && inet_pton(AF_INET6, address, &any) != 1)
        return key_table_refuse(
            load->error, load->origin[key_table_find(&schema_scenario, name)], name, address,
            "is no address in numbers; right would be: 127.0.0.1, 239.1.2.3 or ::1");
    if (check_target(load, name, address) != 0 ||
        check_target(load, "gateway.cot", gateway->cot) != 0)
        return -1;
    name = "gateway.applications";
    if (gateway->application + gateway->applications - 1 > APPLICATION_LAST) {
        char text[32];
        snprintf(text, sizeof(text), "%u", gateway->applications);
        return key_table_refuse(load->error, load->origin[key_table_find(&schema_scenario, name)],
                                name, text, "goes beyond application %u; allowed: up to %u",
                                APPLICATION_LAST, APPLICATION_LAST + 1 - gateway->application);
    }
    if (check_endpoint(load, "gateway.listen", gateway->listen) != 0)
        return -1;
    if (check_endpoint(load, "gateway.cot", gateway->cot) != 0)
        return -1;
    return check_gateway_lists(load, gateway);
}

/* Settles the side of the world; read_ground() does for a ground file without one. */
static int settle_side(const struct load *load)
{
    struct scenario_settings *settings = load->scenario->settings;
    const char *name = "terrain.side_m", *wrong = NULL;
    const struct key_place place = load->origin[key_table_find(&schema_scenario, name)];
    char text[32];
    snprintf(text, sizeof(text), "%.15g", settings->side_m);
    if (settings->side_m == 0.0 && settings->terrain != TERRAIN_FILE)
        settings->side_m = WORLD_SIDE_DEFAULT_M;
    if (fmod(settings->side_m, WORLD_SIDE_OF_M) != 0.0)
        wrong = "is no multiple of 125 m";
    else if (settings->terrain == TERRAIN_GENERATED && settings->side_m != WORLD_SIDE_DEFAULT_M)
        wrong = "generated ground has 50 km; allowed: 50000, or terrain.source = \"flat\" or "
                "\"file\"";
    else if (settings->terrain == TERRAIN_FLAT &&
             settings->side_m / settings->spacing_m > GROUND_WORLD_POSTS_MAX - 1)
        wrong =
            "has too many posts for terrain.spacing_m; allowed: up to 4,097 along an edge: up to "
            "512 km with spacing_m = 125, 256 km with 62.5, 128 km with 31.25";
    return wrong ? key_table_refuse(load->error, place, name, text, "%s", wrong) : 0;
}

/* Vehicles of other simulators are rows like others. */
static int check_remotes(const struct load *load)
{
    const struct params *params = &load->scenario->settings->params;
    const char *name = "world.remotes_max";
    char text[32];
    if (params->remotes_max <= params->capacity)
        return 0;
    snprintf(text, sizeof(text), "%u", params->remotes_max);
    return key_table_refuse(load->error, load->origin[key_table_find(&schema_scenario, name)], name,
                            text,
                            "world.capacity = %u has no rows for so many; allowed: up to %u, or a "
                            "larger world.capacity",
                            params->capacity, params->capacity);
}

/* Checks values that are in range but may not fit each other. */
static int check_together(const struct load *load)
{
    const struct collision_params *collision = &load->scenario->settings->params.collision;
    const struct levels damage = {
        {"collision.figure8.damage_high", "collision.figure8.damage_med",
         "collision.figure8.damage_low"},
        {collision->damage_high, collision->damage_med, collision->damage_low}};
    const struct levels mass = {
        {"collision.figure8.mass_c1_kg", "collision.figure8.mass_c2_kg",
         "collision.figure8.mass_c3_kg"},
        {collision->mass_c1_kg, collision->mass_c2_kg, collision->mass_c3_kg}};
    if (check_levels(load, &damage) != 0 || check_levels(load, &mass) != 0)
        return -1;
    return check_remotes(load) != 0 || settle_side(load) != 0 ? -1 : check_gateway(load);
}

static int read_lists(struct load *load)
{
    struct scenario *scenario = load->scenario;
    const config_setting_t *root = config_root_setting(&load->config);
    const config_setting_t *vehicles = config_setting_get_member(root, "vehicles");
    const config_setting_t *objects = config_setting_get_member(root, "objects");
    const config_setting_t *fires = config_setting_get_member(root, "fires");
    const char *file = load->source.path;
    if (!load->objects_chosen)
        scenario->settings->objects = scenario->settings->terrain == TERRAIN_GENERATED
                                          ? OBJECTS_TABLE1
                                      : scenario->settings->terrain == TERRAIN_FILE ? OBJECTS_FILE
                                                                                    : OBJECTS_NONE;
    if (objects != NULL && objects->type != CONFIG_TYPE_LIST)
        objects = NULL;
    if (scripts_read(scenario, config_setting_get_member(root, "scripts"), file, load->hash,
                     load->error) != 0 ||
        lists_bases(scenario, config_setting_get_member(root, "bases"), file, load->error) != 0 ||
        earthworks_read(scenario, config_setting_get_member(root, "earthworks"), file,
                        load->error) != 0 ||
        vehicles_read(scenario, vehicles, file, load->error) != 0 ||
        missions_read(scenario, root, file, load->error) != 0 ||
        lists_objects(scenario, objects, file, load->error) != 0 ||
        lists_fires(scenario, fires, vehicles, file, load->error) != 0)
        return -1;
    /* A list is checked even when an override replaces it. */
    if (scenario->settings->objects != OBJECTS_LIST)
        scenario->object_count = 0;
    if (scenario->settings->objects == OBJECTS_FILE) {
        const char *key =
            scenario->settings->terrain == TERRAIN_FILE ? GROUND_SOURCE_KEY : "objects.source";
        return ground_objects_read(scenario, load->origin[key_table_find(&schema_scenario, key)],
                                   load->error);
    }
    return 0;
}

static uint32_t event_slots_for(uint32_t capacity)
{
    uint32_t slots = EVENT_SLOTS_MIN;
    while (slots < EVENT_SLOTS_MAX && slots < (uint64_t)EVENTS_PER_ENTITY * capacity)
        slots *= 2;
    return slots;
}

static uint32_t contact_slots_for(uint32_t capacity)
{
    uint32_t full = capacity < PERSISTENT_CONTACT_ENTITIES ? capacity : PERSISTENT_CONTACT_ENTITIES;
    uint32_t slots = PERSISTENT_CONTACTS_AN_ENTITY * full + (capacity - full);
    return slots > PERSISTENT_CONTACT_SLOTS_MIN ? slots : PERSISTENT_CONTACT_SLOTS_MIN;
}

static void derive(struct load *load)
{
    struct params *params = &load->scenario->settings->params;
    const char *path = load->source.path;
    size_t length = strlen(path);
    uint64_t intents = (uint64_t)INTENTS_PER_ENTITY * params->capacity + INTENTS_EXTRA;
    params->dt_s = 1.0 / params->hz;
    params->event_slots = event_slots_for(params->capacity);
    params->events_per_frame = params->event_slots / EVENT_FRAME_SHARE;
    /* At most half of a frame's events, so that collisions always have room for theirs. */
    params->intents_per_frame =
        intents < params->events_per_frame / 2 ? (uint32_t)intents : params->events_per_frame / 2;
    params->command_slots = COMMAND_SLOTS;
    params->crater_slots = CRATER_SLOTS;
    params->dent_slots = DENT_SLOTS;
    if (params->contact_slots == 0)
        params->contact_slots = contact_slots_for(params->capacity);
    params->scenario_hash = XXH3_64bits_digest(load->hash);
    /* The end of a path that is too long is kept, as it says more than the beginning. */
    if (length < PATH_TEXT_MAX)
        memcpy(params->scenario, path, length + 1);
    else
        snprintf(params->scenario, PATH_TEXT_MAX, "...%s", path + length - (PATH_TEXT_MAX - 4));
}

/* Notes the file and the overrides, from which the same scenario can be read again. */
static int write_recipe(const struct load *load, const char *const *overrides, int override_count)
{
    const struct scenario_settings *settings = load->scenario->settings;
    char *absolute = realpath(load->source.path, NULL);
    int result = provenance_add(&load->scenario->recipe, "scenario",
                                absolute ? absolute : load->source.path);
    free(absolute);
    for (int i = 0; i < override_count && result == 0; i++) {
        char text[sizeof GROUND_SOURCE_KEY + GROUND_FILE_TEXT_MAX];
        bool file = strncmp(overrides[i], GROUND_SOURCE_KEY "=", sizeof GROUND_SOURCE_KEY) == 0;
        snprintf(text, sizeof text, "%s=%s", GROUND_SOURCE_KEY, settings->ground_file);
        result = provenance_add(&load->scenario->recipe, "set", file ? text : overrides[i]);
    }
    if (result == 0 && settings->terrain == TERRAIN_FILE) {
        char text[32 + GROUND_FILE_TEXT_MAX];
        snprintf(text, sizeof text, "%016" PRIx64 " %s", settings->ground_hash,
                 settings->ground_file);
        result = provenance_add(&load->scenario->recipe, "ground", text);
    }
    if (result != 0)
        return key_table_refuse(
            load->error, (struct key_place){load->source.path, 0}, NULL, NULL,
            "no memory to note what it was made from, or overrides that are too long");
    return 0;
}

/* Finds the ground file, and takes its place on the earth for the gateway unless that is given. */
static int read_ground(struct load *load)
{
    struct scenario_settings *settings = load->scenario->settings;
    struct gateway_params *gateway = &settings->params.gateway;
    const char *const places[] = {"gateway.latitude_deg", "gateway.longitude_deg",
                                  "gateway.undulation_m"};
    double *const values[] = {&gateway->latitude_deg, &gateway->longitude_deg,
                              &gateway->undulation_m};
    double found[3];
    bool named = settings->ground_file[0] != '\0';
    struct key_place place = load->origin[key_table_find(
        &schema_scenario, named ? GROUND_SOURCE_KEY : "terrain.source")];
    if (ground_source_read(settings, load->source.path, load->data_dir, place, found,
                           load->error) != 0)
        return -1;
    for (int i = 0; i < 3 && settings->terrain == TERRAIN_FILE; i++) {
        if (strcmp(load->origin[key_table_find(&schema_scenario, places[i])].file, "default") == 0)
            *values[i] = found[i];
    }
    if (settings->terrain == TERRAIN_FILE)
        XXH3_64bits_update(load->hash, &settings->ground_hash, sizeof settings->ground_hash);
    return 0;
}

static int read_scenario(struct load *load, const char *const *overrides, int override_count)
{
    if (source_parse(&load->source, &load->config, load->error) != 0)
        return -1;
    XXH3_64bits_update(load->hash, load->source.text, load->source.bytes);
    if (key_table_defaults(&schema_scenario, load->scenario->settings, load->error) != 0 ||
        read_file(load) != 0)
        return -1;
    for (int i = 0; i < override_count; i++) {
        if (apply_override(load, overrides[i]) != 0)
            return -1;
    }
    if (check_together(load) != 0 || read_ground(load) != 0 ||
        places_convert(&load->config, load->source.path, &load->scenario->settings->params,
                       load->scenario->settings->side_m, load->error) != 0 ||
        kinds_read(load->scenario, load->data_dir, load->hash, load->error) != 0 ||
        read_lists(load) != 0)
        return -1;
    derive(load);
    return write_recipe(load, overrides, override_count);
}

int loader_scenario(struct scenario *scenario, const char *data_dir, const char *path,
                    const char *const *overrides, int override_count, struct error_text *error)
{
    struct load load = {.scenario = scenario, .data_dir = data_dir, .error = error};
    char found[PATH_MAX];
    int result = -1;
    memset(scenario, 0, sizeof(*scenario));
    error->text[0] = '\0';
    if (find_scenario(data_dir, path, found, sizeof(found), error) != 0 ||
        source_read(&load.source, found, SCHEMA_SCENARIO_BYTES_MAX, error) != 0)
        return -1;
    scenario->settings = calloc(1, sizeof(*scenario->settings));
    load.hash = XXH3_createState();
    if (scenario->settings == NULL || load.hash == NULL || XXH3_64bits_reset(load.hash) != XXH_OK) {
        key_table_refuse(error, (struct key_place){found, 0}, NULL, NULL, "no memory to read it");
        goto err_source;
    }
    result = read_scenario(&load, overrides, override_count);
    config_destroy(&load.config);
err_source:
    if (result != 0)
        scenario_free(scenario);
    XXH3_freeState(load.hash);
    source_free(&load.source);
    return result;
}

/* Returns true for a key that can change in a world that exists. The counts, the capacities and the
 * objects of the world were made from the other keys. */
static bool changeable(const struct key *key)
{
    _Static_assert(offsetof(struct scenario_settings, params) == 0, "keys of params come first");
    return key->offset < sizeof(struct params) &&
           key->offset != offsetof(struct scenario_settings, params.capacity) &&
           key->offset != offsetof(struct scenario_settings, params.contact_slots) &&
           key->offset != offsetof(struct scenario_settings, params.remotes_max);
}

int loader_branch(struct params *params, const char *const *overrides, int override_count,
                  struct error_text *error)
{
    struct scenario_settings settings = {.params = *params};
    struct scenario scenario = {.settings = &settings};
    struct load load = {.scenario = &scenario, .error = error};
    for (uint32_t i = 0; i < schema_scenario.count; i++)
        load.origin[i] = (struct key_place){OVERRIDE_PLACE, 0};
    for (int i = 0; i < override_count; i++) {
        uint64_t before = XXH3_64bits(&settings.params, sizeof(settings.params));
        const char *value = NULL;
        int index = find_override(&load, overrides[i], &value);
        if (index < 0)
            return -1;
        const struct key *key = &schema_scenario.keys[index];
        if (!changeable(key))
            return key_table_refuse(
                error, load.origin[index], key->name, value,
                "cannot change in a world that exists; allowed: world.seed, hz, frames, pace, "
                "name, "
                "cruise and wind_*, battle.end_s and again_s, recorder.when_full, collision.*, "
                "renderer.*, gateway.*");
        if (key_table_set_text(key, &settings, value, load.origin[index], error) != 0)
            return -1;
        settings.params.dt_s = 1.0 / settings.params.hz;
        if (before != XXH3_64bits(&settings.params, sizeof(settings.params)))
            settings.params.scenario_hash = XXH3_64bits_withSeed(
                overrides[i], strlen(overrides[i]) + 1, settings.params.scenario_hash);
    }
    if (check_together(&load) != 0)
        return -1;
    *params = settings.params;
    return 0;
}
