/* Reads the lists of fixed objects, bases and ordered shots. Shots name vehicles. */
#include "config/syntax/lists.h"

#include "config/syntax/entry.h"
#include "config/syntax/schema.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/maths/maths.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- fixed objects -----------------------------------------------------------------------------*/

int lists_objects(struct scenario *scenario, const config_setting_t *list, const char *file,
                  struct error_text *error)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .error = error};
    int length = list != NULL ? entry_count(list, file, SCHEMA_OBJECTS_MAX, error) : 0;
    if (length < 0)
        return -1;
    scenario->object_list =
        entry_allocate((uint32_t)length, sizeof(*scenario->object_list), file, error);
    if (scenario->object_list == NULL)
        return -1;
    for (int i = 0; i < length; i++) {
        struct object_entry object;
        if (entry_read(&entry, &schema_object, i, list, &object) != 0)
            return -1;
        uint16_t kind = entry_kind(&entry, OBJECT_KEY_KIND, object.kind, DOMAIN_BIT(DOMAIN_FIXED));
        if (kind == KIND_NONE)
            return -1;
        scenario->object_list[scenario->object_count++] = (struct scenario_object){
            .kind = kind,
            .turn = (uint16_t)(maths_wrap_turn(object.heading_rad) * (65536.0 / TWO_PI)),
            .size = 1.0f,
            .x = object.at[0],
            .z = object.at[1],
        };
    }
    return 0;
}

/* --- bases -------------------------------------------------------------------------------------*/

int lists_bases(struct scenario *scenario, const config_setting_t *list, const char *file,
                struct error_text *error)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .error = error};
    int length = list != NULL ? entry_count(list, file, FORCE_COUNT, error) : 0;
    for (int i = 0; i < length; i++) {
        struct base_entry base;
        if (entry_read(&entry, &schema_base, i, list, &base) != 0)
            return -1;
        if (scenario->based[base.force])
            return entry_refuse(&entry, BASE_FORCE,
                                "has a base already; allowed: one base for each force");
        scenario->based[base.force] = 1;
        scenario->settings->params.base[base.force] = (struct force_base){base.at[0], base.at[1]};
    }
    return length < 0 ? -1 : 0;
}

/* --- names -------------------------------------------------------------------------------------*/

/* The groups that have a name, sorted by it for binary search. */
struct named {
    const struct scenario_group **group;
    uint32_t count;
};

static int compare_groups(const void *a, const void *b)
{
    const struct scenario_group *const *left = a, *const *right = b;
    int order = strcmp((*left)->name, (*right)->name);
    return order != 0 ? order : (*left > *right) - (*left < *right); /* else in file order */
}

static const struct scenario_group *find_group(const struct named *named, const char *name)
{
    uint32_t low = 0, high = named->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        int order = strcmp(named->group[middle]->name, name);
        if (order == 0)
            return named->group[middle];
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

/* The group whose member is called name: "tank-3" is the third of three or more called "tank". */
static const struct scenario_group *find_of_many(const struct named *named, const char *name)
{
    const char *dash = strrchr(name, '-');
    char base[ENTITY_NAME_MAX], again[2 * ENTITY_NAME_MAX];
    if (dash == NULL)
        return NULL;
    snprintf(base, sizeof(base), "%.*s", (int)(dash - name), name);
    const struct scenario_group *group = find_group(named, base);
    unsigned long number = strtoul(dash + 1, NULL, 10);
    snprintf(again, sizeof(again), "%s-%lu", base, number);
    if (group == NULL || group->count == 1 || number < 1 || number > group->count ||
        strcmp(again, name) != 0)
        return NULL;
    return group;
}

/* The group of the vehicle called name; NULL when there is no such vehicle. */
static const struct scenario_group *find_vehicle(const struct named *named, const char *name)
{
    const struct scenario_group *group = find_group(named, name);
    return group != NULL && group->count == 1 ? group : find_of_many(named, name);
}

/* Sorts the named groups, and refuses a name that two vehicles would share. */
static int collect_names(struct named *named, const struct scenario *scenario,
                         const config_setting_t *vehicles, const char *file,
                         struct error_text *error)
{
    named->count = 0;
    named->group = entry_allocate(scenario->group_count, sizeof(*named->group), file, error);
    if (named->group == NULL)
        return -1;
    for (uint32_t i = 0; i < scenario->group_count; i++) {
        if (scenario->groups[i].name[0] != '\0')
            named->group[named->count++] = &scenario->groups[i];
    }
    qsort(named->group, named->count, sizeof(*named->group), compare_groups);
    for (uint32_t i = 0; i < named->count; i++) {
        const struct scenario_group *group = named->group[i];
        uint32_t index = (uint32_t)(group - scenario->groups);
        char path[KEY_PATH_MAX];
        if (!(i > 0 && strcmp(named->group[i - 1]->name, group->name) == 0) &&
            !(group->count == 1 && find_of_many(named, group->name) != NULL))
            continue;
        const config_setting_t *name =
            config_setting_get_member(config_setting_get_elem(vehicles, index), "name");
        const struct key_place place = {file, (int)config_setting_source_line(name)};
        snprintf(path, sizeof(path), "vehicles[%u].name", index);
        return key_table_refuse(error, place, path, group->name,
                                "is also the name of another vehicle; allowed: each name once");
    }
    return 0;
}

/* --- ordered shots -----------------------------------------------------------------------------*/

static int check_fire(const struct entry *entry, const struct fire_entry *fire,
                      const struct named *named, uint16_t *munition)
{
    const struct kind *kinds = entry->scenario->kinds;
    const struct scenario_group *shooter = find_vehicle(named, fire->shooter);
    *munition = KIND_NONE;
    if (entry_given(entry, FIRE_SHOOTER) && shooter == NULL)
        return entry_refuse(entry, FIRE_SHOOTER,
                            "is not the name of a vehicle; allowed: a name of vehicles");
    if (entry_given(entry, FIRE_TARGET) && find_vehicle(named, fire->target) == NULL)
        return entry_refuse(entry, FIRE_TARGET,
                            "is not the name of a vehicle; allowed: a name of vehicles");
    if (entry_given(entry, FIRE_TARGET) && strcmp(fire->target, fire->shooter) == 0)
        return entry_refuse(entry, FIRE_TARGET, "is the shooter; allowed: another vehicle");
    if (entry_given(entry, FIRE_TARGET) == entry_given(entry, FIRE_POINT))
        return entry_refuse(entry, FIRE_TARGET,
                            "a shot needs a target or a point; allowed: one of the two");
    if (entry_given(entry, FIRE_TARGET) && shooter == NULL)
        return entry_refuse(
            entry, FIRE_TARGET,
            "needs a shooter, as a munition that falls from the sky falls on a point; "
            "right would be: a shooter beside it, or a point");
    if (fire->rounds > 0 && !entry_given(entry, FIRE_POINT))
        return entry_refuse(entry, FIRE_ROUNDS,
                            "is only for fire at a point; right would be: a point");
    if (fire->rounds > 0 && shooter != NULL &&
        (kinds[shooter->kind].munition == KIND_NONE ||
         kinds[kinds[shooter->kind].munition].delivery != DELIVERY_ARC))
        return entry_refuse(entry, FIRE_SHOOTER,
                            "has no gun that fires along an arc; right would be: a howitzer");
    if (entry_given(entry, FIRE_MUNITION)) {
        *munition = entry_kind(entry, FIRE_MUNITION, fire->munition, DOMAIN_BIT(DOMAIN_MUNITION));
        return *munition == KIND_NONE ? -1 : 0;
    }
    if (shooter == NULL)
        return entry_refuse(entry, FIRE_MUNITION,
                            "is missing; a shot without a shooter needs the munition that falls");
    if (kinds[shooter->kind].munition == KIND_NONE)
        return entry_refuse(
            entry, FIRE_SHOOTER,
            "is a %s, which has no munition; right would be: an armed vehicle, or a "
            "munition here",
            kinds[shooter->kind].name);
    return 0;
}

int lists_fires(struct scenario *scenario, const config_setting_t *list,
                const config_setting_t *vehicles, const char *file, struct error_text *error)
{
    struct entry entry = {.scenario = scenario, .keys = {.file = file}, .error = error};
    int length = list != NULL ? entry_count(list, file, SCHEMA_FIRES_MAX, error) : 0;
    struct named named = {NULL, 0};
    int result = -1;
    if (length < 0)
        return -1;
    scenario->fires = entry_allocate((uint32_t)length, sizeof(*scenario->fires), file, error);
    if (scenario->fires == NULL || collect_names(&named, scenario, vehicles, file, error) != 0)
        goto err_names;
    for (int i = 0; i < length; i++) {
        struct fire_entry fire;
        uint16_t munition;
        if (entry_read(&entry, &schema_fire, i, list, &fire) != 0 ||
            check_fire(&entry, &fire, &named, &munition) != 0)
            goto err_names;
        struct scenario_fire *to = &scenario->fires[scenario->fire_count++];
        memcpy(to->shooter, fire.shooter, sizeof(to->shooter));
        memcpy(to->target, fire.target, sizeof(to->target));
        to->at_s = fire.at_s;
        to->munition = munition;
        to->x = fire.point[0];
        to->z = fire.point[1];
        to->rounds = (uint16_t)fire.rounds;
        to->fuze = (uint8_t)fire.fuze;
        to->adjusted = (uint8_t)fire.adjust;
        to->high = (uint8_t)fire.high;
        to->turned = entry_given(&entry, FIRE_BEARING);
        to->bearing_rad = fire.bearing_rad;
        to->line = (int)config_setting_source_line(entry.setting);
    }
    result = 0;
err_names:
    free(named.group);
    return result;
}
