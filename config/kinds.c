/* Reads the files of kinds. Each file is checked alone, then the references between kinds. */
#include "config/kinds.h"

#include "config/mesh/model_parts.h"
#include "config/mesh/models.h"
#include "config/syntax/schema.h"
#include "config/syntax/source.h"
#include "world/entity/kind.h"
#include "world/entity/mass_properties.h"
#include "world/enum_names.h"
#include "world/making/scenario.h"
#include "world/maths/maths.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SUFFIX            ".cfg"
#define UNARMED_SIGHT_M   1500.0
#define HELICOPTER_LOAD_G 3.5 /* of the AH-64A */

/* Armour by mass: 12.5 mm and 14 mm for 11 t (M113: 38 and 32), 60 and 300 mm for 50 t (M60). */
#define ARMOUR_SIDE_MMPT   1.2  /* [mm/t] */
#define ARMOUR_FRONT_MMPT2 0.12 /* [mm/t^2] */
#define ARMOUR_NONE_MM     3.0

/* A kind's file while it is read. Its munition is looked up when all kinds are known. */
struct reading {
    char path[PATH_MAX];
    char munition[KIND_NAME_MAX], light_munition[KIND_NAME_MAX];
    int munition_line, light_line;
};

struct names {
    char name[KIND_COUNT_MAX][KIND_NAME_MAX];
    int count;
};

static int compare_names(const void *a, const void *b)
{
    return strcmp(a, b);
}

static int add_name(struct names *names, const char *file, struct key_place place,
                    struct error_text *error)
{
    size_t length = strlen(file);
    if (file[0] == '.' || length <= strlen(SUFFIX) ||
        strcmp(file + length - strlen(SUFFIX), SUFFIX) != 0)
        return 0;
    length -= strlen(SUFFIX);
    if (names->count == KIND_COUNT_MAX)
        return key_table_refuse(error, place, NULL, NULL, "has too many kinds; allowed: up to %d",
                                KIND_COUNT_MAX);
    if (length >= KIND_NAME_MAX)
        return key_table_refuse(
            error, place, NULL, NULL,
            "%s is too long for the name of a kind; allowed: up to %d characters", file,
            KIND_NAME_MAX - 1);
    memset(names->name[names->count], 0, KIND_NAME_MAX);
    memcpy(names->name[names->count++], file, length);
    return 0;
}

static int list_names(struct names *names, const char *data_dir, struct error_text *error)
{
    char path[PATH_MAX];
    const struct key_place place = {path, 0};
    const struct dirent *entry;
    int result = 0;
    snprintf(path, sizeof(path), "%s/kinds", data_dir);
    DIR *dir = opendir(path);
    if (dir == NULL)
        return key_table_refuse(error, place, NULL, NULL, "cannot be opened: %s", strerror(errno));
    names->count = 0;
    while (result == 0 && (entry = readdir(dir)) != NULL)
        result = add_name(names, entry->d_name, place, error);
    closedir(dir);
    if (result != 0)
        return result;
    if (names->count == 0)
        return key_table_refuse(error, place, NULL, NULL,
                                "has no kinds; right would be: files NAME.cfg");
    /* The order of a directory depends on the file system. The numbers of kinds must not. */
    qsort(names->name, (size_t)names->count, KIND_NAME_MAX, compare_names);
    return 0;
}

/* Refuses a value that is in range but does not fit the other values. */
static int refuse_pair(const struct key_reading *keys, const char *name, double value,
                       const char *wrong, struct error_text *error)
{
    int index = key_table_find(keys->table, name);
    struct key_place place = {keys->file, index >= 0 ? keys->line[index] : 0};
    char text[32];
    snprintf(text, sizeof(text), "%.15g", value);
    return key_table_refuse(error, place, name, text, "%s", wrong);
}

static int refuse_no_class(const struct key_reading *keys, struct error_text *error)
{
    const struct key_place place = {keys->file, 1};
    char allowed[128];
    key_table_allowed(&keys->table->keys[key_table_find(keys->table, "class")], allowed,
                      sizeof(allowed));
    return key_table_refuse(error, place, "class", NULL,
                            "is missing; a fixed object needs it; allowed: %s", allowed);
}

/* A rule that values keep together, and the message about the key that breaks it. */
struct rule {
    bool broken;
    const char *key;
    double value; /* in the file's unit */
    const char *wrong;
};

/* The order of the rules is that of the messages when several are broken. */
static int check_values(const struct kind *kind, const struct key_reading *keys, bool armed,
                        struct error_text *error)
{
    const bool vehicle = kind->domain <= DOMAIN_AIR, munition = kind->domain == DOMAIN_MUNITION;
    const bool homing = munition && kind->guidance == GUIDANCE_HOMING;
    const bool ratios = kind->damage_high > 0 || kind->damage_med > 0 || kind->damage_low > 0;
    const bool elevates = kind->gun_low_rad < 0 || kind->gun_high_rad > 0;
    const double degrees = DEG_PER_RAD;
    const struct rule rules[] = {
        {kind->min_speed_mps > kind->max_speed_mps, "min_speed_mps", kind->min_speed_mps,
         "is above max_speed_mps; allowed: up to max_speed_mps"},
        {armed && kind->range_m <= 0, "range_m", 0.0,
         "is needed by an armed vehicle; allowed: above 0"},
        {armed && kind->reload_s <= 0, "reload_s", 0.0,
         "is needed by an armed vehicle; allowed: above 0"},
        {armed && kind->rounds == 0, "rounds", 0.0,
         "is needed by an armed vehicle; allowed: above 0"},
        {ratios && kind->damage_high <= kind->damage_med, "damage_med", kind->damage_med,
         "is not below damage_high; allowed: below it, or none of the three"},
        {ratios && kind->damage_med <= kind->damage_low, "damage_low", kind->damage_low,
         "is not below damage_med; allowed: below it, or none of the three"},
        {ratios && kind->damage_low <= 0, "damage_low", kind->damage_low,
         "is needed beside damage_high; allowed: above 0, or none of the three"},
        {kind->turret_rate_rps > 0 && !armed, "turret_rate_dps", kind->turret_rate_rps * degrees,
         "is only for an armed vehicle; allowed: with munition"},
        {kind->gun_rate_rps > 0 && !armed, "gun_rate_dps", kind->gun_rate_rps * degrees,
         "is only for an armed vehicle; allowed: with munition"},
        {kind->gun_low_rad > 0, "gun_low_deg", kind->gun_low_rad * degrees,
         "is above the level, at which the gun rests; allowed: 0 or below"},
        {kind->gun_high_rad < 0, "gun_high_deg", kind->gun_high_rad * degrees,
         "is below the level, at which the gun rests; allowed: 0 or above"},
        {kind->gun_rate_rps <= 0 && elevates, "gun_rate_dps", 0.0,
         "is needed beside gun_low_deg and gun_high_deg; allowed: above 0"},
        {kind->drag != DRAG_NONE && (!munition || homing), "drag", kind->ballistic_kgpm2,
         "is only for ballistic munitions; allowed: none"},
        {kind->drag != DRAG_NONE && kind->ballistic_kgpm2 <= 0, "ballistic_kgpm2",
         kind->ballistic_kgpm2, "is needed beside drag; allowed: above 0"},
        {kind->delivery != DELIVERY_DIRECT && (!munition || homing), "delivery",
         (double)kind->delivery, "is only for ballistic munitions; allowed: direct"},
        {kind->delivery == DELIVERY_ARC && kind->drag == DRAG_NONE, "drag", 0.0,
         "is needed by a munition on an arc; allowed: g1, g7"},
        {kind->penetration_mm > 0 && !munition, "penetration_mm", kind->penetration_mm,
         "is only for munitions; allowed: 0"},
        {kind->dispersion_moving_rad > 0 && kind->dispersion_moving_rad < kind->dispersion_rad,
         "dispersion_moving_mrad", kind->dispersion_moving_rad * 1000.0,
         "is below dispersion_mrad; allowed: from it on, or 0"},
        {homing && kind->seeker_rad <= 0, "seeker_deg", 0.0,
         "is needed by a homing munition; allowed: above 0"},
        {homing && kind->turn_rate_rps <= 0, "turn_rate_dps", 0.0,
         "is needed by a homing munition; allowed: above 0"},
        {vehicle && kind->max_speed_mps <= 0, "max_speed_mps", kind->max_speed_mps,
         "is needed by a vehicle; allowed: above 0"},
        {vehicle && kind->acceleration_mps2 <= 0, "acceleration_mps2", kind->acceleration_mps2,
         "is needed by a vehicle; allowed: above 0"},
        {vehicle && kind->turn_rate_rps <= 0, "turn_rate_dps", kind->turn_rate_rps * degrees,
         "is needed by a vehicle; allowed: above 0"},
        {kind->domain == DOMAIN_AIR && kind->climb_rate_mps <= 0, "climb_rate_mps",
         kind->climb_rate_mps, "is needed by an aircraft; allowed: above 0"},
        {munition && kind->max_speed_mps <= 0, "max_speed_mps", kind->max_speed_mps,
         "is needed by a munition; allowed: above 0"},
        {munition && kind->life_s <= 0, "life_s", kind->life_s,
         "is needed by a munition; allowed: above 0"},
    };
    for (size_t i = 0; i < sizeof(rules) / sizeof(rules[0]); i++) {
        if (rules[i].broken)
            return refuse_pair(keys, rules[i].key, rules[i].value, rules[i].wrong, error);
    }
    return 0;
}

static int check_kind(const struct kind *kind, const struct key_reading *keys, const char *name,
                      struct error_text *error)
{
    bool has_class = keys->given[key_table_find(keys->table, "class")];
    bool armed = keys->given[key_table_find(keys->table, "munition")];
    struct key_place place = {keys->file, keys->line[key_table_find(keys->table, "name")]};
    struct key_place class_place = {keys->file, keys->line[key_table_find(keys->table, "class")]};
    if (strcmp(kind->name, name) != 0)
        return key_table_refuse(error, place, "name", kind->name,
                                "is not the name of the file; allowed: %s", name);
    if (has_class && kind->domain != DOMAIN_FIXED)
        return key_table_refuse(error, class_place, "class",
                                object_class_name((enum object_class)kind->object_class),
                                "is only for fixed objects; allowed: with domain = \"fixed\"");
    if (kind->domain == DOMAIN_FIXED && !has_class)
        return refuse_no_class(keys, error);
    return check_values(kind, keys, armed, error);
}

/* The stiffness [N/m] of a skin that takes up resistance_j when it is pressed in by d, a quarter of
 * the body's smallest side: k d^2 / 2 = resistance_j. */
double kinds_stiffness(const struct kind *kind)
{
    double depth = 0.25 * fmin(kind->length_m, fmin(kind->width_m, kind->height_m));
    return 2.0 * kind->resistance_j / (depth * depth);
}

/* Sets the sight and the doctrine that the file of a vehicle leaves open. */
static void complete_mind(struct kind *kind, bool has_doctrine)
{
    if (kind->sight_m <= 0)
        kind->sight_m = kind->range_m > 0 ? kind->range_m : UNARMED_SIGHT_M;
    if (has_doctrine)
        return;
    if (kind->domain == DOMAIN_SEA)
        kind->doctrine = DOCTRINE_WARSHIP;
    else if (kind->domain == DOMAIN_AIR)
        kind->doctrine = kind->min_speed_mps > 0 ? DOCTRINE_JET : DOCTRINE_HELICOPTER;
    else
        kind->doctrine = kind->range_m > 0 ? DOCTRINE_LIGHT : DOCTRINE_SOFT;
}

/* Sets the load limit that the file leaves open. An aircraft's follows from its turn rate, and is
 * within what airframes bear. */
static void complete_load(struct kind *kind)
{
    if (kind->max_load > 0)
        return;
    const double turn = kind->max_speed_mps * kind->turn_rate_rps / GRAVITY_MPS2;
    if (kind->domain != DOMAIN_AIR)
        kind->max_load = turn;
    else if (kind->min_speed_mps > 0)
        kind->max_load = fmin(fmax(sqrt(1.0 + turn * turn), 2.0), 8.0);
    else
        kind->max_load = HELICOPTER_LOAD_G;
}

/* Sets the armour that the file of a vehicle leaves open: that of an average vehicle of its mass.
 * Ships and aircraft have none that counts. */
static void complete_armour(struct kind *kind)
{
    const double mass_t = 0.001 * kind->mass_kg;
    const double side = kind->domain == DOMAIN_LAND ? ARMOUR_SIDE_MMPT * mass_t : ARMOUR_NONE_MM;
    const double front = kind->domain == DOMAIN_LAND ? ARMOUR_FRONT_MMPT2 * mass_t * mass_t : 0.0;
    kind->armour_mm[ASPECT_FRONT] = fmax(front, side);
    kind->armour_mm[ASPECT_SIDE] = side;
    kind->armour_mm[ASPECT_REAR] = kind->armour_mm[ASPECT_TOP] = 0.5 * side;
}

static void set_open(double *value, double otherwise)
{
    if (*value <= 0.0)
        *value = otherwise;
}

/* Sets what the file of a land vehicle leaves open about its chassis. At top speed on dirt a
 * vehicle needs about a quarter of the power of its acceleration. */
static void complete_chassis(struct kind *kind)
{
    const bool tracked = kind->tracked != 0;
    const double efficiency = tracked ? 0.55 : 0.7;
    if (kind->domain != DOMAIN_LAND)
        return;
    if (kind->axles < 2)
        kind->axles = tracked ? 5 : 2;
    set_open(&kind->power_w,
             0.25 * kind->mass_kg * kind->acceleration_mps2 * kind->max_speed_mps / efficiency);
    set_open(&kind->track_m, 0.84 * kind->width_m);
    set_open(&kind->centre_height_m, 0.4 * kind->height_m);
    set_open(&kind->travel_m, 0.07 * kind->height_m);
    set_open(&kind->heave_hz, tracked ? 1.4 : 1.6);
    set_open(&kind->ford_m, 0.3 * kind->height_m);
    set_open(&kind->step_m, tracked ? 0.147 * kind->length_m : 0.18 * kind->height_m);
    set_open(&kind->trench_m, (tracked ? 0.37 : 0.15) * kind->length_m);
    set_open(&kind->least_turn_m, 1.65 * kind->length_m);
    if (tracked)
        kind->least_turn_m = 0.0;
}

void kinds_take_hulls(struct kind *kind, const struct scenario *scenario, const struct hulls *hulls)
{
    kind->first_hull = hulls->first;
    kind->hull_count = hulls->count;
    kind->outer_hull = hulls->outer;
    kind->first_part_hull = hulls->first_part;
    kind->part_count = hulls->parts;
    kind->body_hulls = hulls->body;
    kind->turret_pivot = hulls->turret_pivot;
    kind->gun_pivot = hulls->gun_pivot;
    kind->bound_m = hulls->bound_m;
    kind->reach_m = model_parts_reach(hulls, scenario, kind->gun_low_rad, kind->gun_high_rad);
    kind->level_m = hulls->level_m;
    kind->low_m = hulls->low_m;
    kind->high_m = hulls->high_m;
}

/* Index of the kind's model; -1 with a message that names the kind as well as the model. */
static int find_model(struct models *models, const struct key_reading *keys, const char *name,
                      struct error_text *error)
{
    const struct key_place place = {keys->file, keys->line[key_table_find(keys->table, "model")]};
    struct error_text detail;
    int model;
    if (name[strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-_")] != '\0')
        return key_table_refuse(error, place, "model", name,
                                "is not the name of a model; allowed: a-z 0-9 - _");
    model = models_find(models, name, &detail);
    if (model < 0)
        return key_table_refuse(error, place, "model", name, "%s", detail.text);
    return model;
}

static int read_kind(struct reading *reading, struct kind *kind, const char *name,
                     struct models *models, struct error_text *error)
{
    char folder[PATH_MAX], file[KIND_NAME_MAX + sizeof(SUFFIX)];
    struct kind_entry entry;
    struct source source;
    config_t config;
    struct key_reading keys = {.table = &schema_kind, .destination = &entry, .file = reading->path};
    int result = -1, model;
    memset(&entry, 0, sizeof(entry));
    snprintf(folder, sizeof(folder), "%s/kinds", models->data_dir);
    snprintf(file, sizeof(file), "%s" SUFFIX, name);
    if (source_read_in(&source, folder, file, SCHEMA_KIND_BYTES_MAX, error) != 0)
        return -1;
    XXH3_64bits_update(models->hash, name, strlen(name) + 1);
    XXH3_64bits_update(models->hash, source.text, source.bytes);
    memset(&config, 0, sizeof(config));
    if (source_parse(&source, &config, error) != 0 ||
        key_table_defaults(&schema_kind, &entry, error) != 0 ||
        key_table_read(&keys, config_root_setting(&config), "", "", error) != 0 ||
        check_kind(&entry.kind, &keys, name, error) != 0)
        goto err_config;
    model = find_model(models, &keys, entry.model, error);
    if (model < 0)
        goto err_config;
    *kind = entry.kind;
    kind->model = (uint16_t)model;
    if (kind->stiffness_npm <= 0)
        kind->stiffness_npm = kinds_stiffness(kind);
    complete_load(kind);
    if (kind->domain <= DOMAIN_AIR && !keys.given[key_table_find(&schema_kind, "armour_mm")])
        complete_armour(kind);
    complete_chassis(kind);
    complete_mind(kind, keys.given[key_table_find(&schema_kind, "doctrine")]);
    kinds_take_hulls(kind, models->scenario, &models->hulls[model]);
    kind->munition = KIND_NONE;
    memcpy(reading->munition, entry.munition, sizeof(entry.munition));
    reading->munition_line = keys.line[key_table_find(&schema_kind, "munition")];
    memcpy(reading->light_munition, entry.light_munition, sizeof(entry.light_munition));
    reading->light_line = keys.line[key_table_find(&schema_kind, "light_munition")];
    result = 0;
err_config:
    config_destroy(&config);
    source_free(&source);
    return result;
}

/* Looks up a munition that a kind's file names. Returns KIND_NONE with the message. */
static uint16_t find_munition(const struct scenario *scenario, struct key_place place,
                              const char *key, const char *name, struct error_text *error)
{
    uint16_t found = kind_find(scenario->kinds, scenario->kind_count, name);
    if (found != KIND_NONE && scenario->kinds[found].domain == DOMAIN_MUNITION)
        return found;
    key_table_refuse(error, place, key, name, "%s; allowed: a kind with domain = \"munition\"",
                     found == KIND_NONE ? "unknown kind" : "is not a munition");
    return KIND_NONE;
}

/* Looks up the kind's munitions, which may be kinds with later names. */
static int resolve_munition(struct scenario *scenario, uint32_t index,
                            const struct reading *reading, struct error_text *error)
{
    const struct key_place place = {reading->path, reading->munition_line};
    const struct key_place light_place = {reading->path, reading->light_line};
    struct kind *kind = &scenario->kinds[index];
    if (reading->munition[0] != '\0')
        kind->munition = find_munition(scenario, place, "munition", reading->munition, error);
    if (reading->munition[0] != '\0' && kind->munition == KIND_NONE)
        return -1;
    if (reading->light_munition[0] == '\0')
        return 0;
    if (kind->munition == KIND_NONE)
        return key_table_refuse(error, light_place, "light_munition", reading->light_munition,
                                "is only for an armed vehicle; allowed: with munition");
    uint16_t light =
        find_munition(scenario, light_place, "light_munition", reading->light_munition, error);
    kind->light_munition = light == KIND_NONE ? 0 : light + 1u;
    return light == KIND_NONE ? -1 : 0;
}

int kinds_read(struct scenario *scenario, const char *data_dir, XXH3_state_t *hash,
               struct error_text *error)
{
    const struct key_place place = {data_dir, 0};
    struct names names = {0};
    struct models *models = malloc(sizeof(*models));
    struct reading *readings = calloc(KIND_COUNT_MAX, sizeof(*readings));
    int result = -1;
    if (models == NULL || readings == NULL) {
        key_table_refuse(error, place, NULL, NULL, "no memory for the kinds");
        goto err_memory;
    }
    models_open(models, scenario, data_dir, hash);
    if (list_names(&names, data_dir, error) != 0)
        goto err_models;
    scenario->kinds = calloc(KIND_COUNT_MAX, sizeof(*scenario->kinds));
    if (scenario->kinds == NULL) {
        key_table_refuse(error, place, NULL, NULL, "no memory for the kinds");
        goto err_models;
    }
    for (int i = 0; i < names.count; i++) {
        snprintf(readings[i].path, sizeof(readings[i].path), "%s/kinds/%s" SUFFIX, data_dir,
                 names.name[i]);
        if (read_kind(&readings[i], &scenario->kinds[i], names.name[i], models, error) != 0)
            goto err_models;
        scenario->kind_count++;
    }
    result = 0;
    for (uint32_t i = 0; result == 0 && i < scenario->kind_count; i++)
        result = resolve_munition(scenario, i, &readings[i], error);
err_models:
    models_close(models);
err_memory:
    free(readings);
    free(models);
    return result;
}
