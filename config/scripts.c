/* Reads the list of scripts. */
#include "config/scripts.h"

#include "config/syntax/entry.h"
#include "config/syntax/schema.h"
#include "config/waypoints.h"
#include "world/earth_location.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The actions of a step, and the key of each. STEP_KEY_ALTITUDE is one when it stands alone. */
static const struct {
    uint32_t key; /* enum step_key */
    enum step_type type;
} actions[] = {
    {STEP_KEY_GO, STEP_GO},
    {STEP_KEY_ARRIVE, STEP_ARRIVE},
    {STEP_KEY_FACE, STEP_FACE},
    {STEP_KEY_STOP, STEP_STOP},
    {STEP_KEY_WAIT, STEP_WAIT},
    {STEP_KEY_FIRE, STEP_FIRE},
    {STEP_KEY_FOR, STEP_CONTROLS},
    {STEP_KEY_FIRE_AT, STEP_FIRE_AT},
    {STEP_KEY_BEHAVIOUR, STEP_BEHAVIOUR},
};

/* Makes room for `more` steps. 0; -1 with the message. */
static int reserve_steps(struct scenario *scenario, uint64_t more, const char *file,
                         struct error_text *error)
{
    const struct key_place place = {file, 0};
    uint64_t count = scenario->step_count + more;
    if (count > SCRIPT_STEPS_MAX)
        return key_table_refuse(error, place, NULL, NULL,
                                "gives the scripts %llu steps; allowed: up to %u in all",
                                (unsigned long long)count, SCRIPT_STEPS_MAX);
    struct scenario_step *steps = realloc(scenario->steps, (count + 1) * sizeof(*steps));
    if (steps == NULL)
        return key_table_refuse(error, place, NULL, NULL, "no memory for its scripts");
    scenario->steps = steps;
    return 0;
}

/* Refuses a step without an action, with the keys of all actions. */
static void refuse_no_action(const struct entry *entry)
{
    char names[256];
    size_t used = 0;
    for (size_t i = 0; i < sizeof(actions) / sizeof(actions[0]) && used < sizeof(names); i++)
        used += (size_t)snprintf(names + used, sizeof(names) - used, "%s, ",
                                 schema_step.keys[actions[i].key].name);
    entry_refuse(entry, STEP_KEY_GO,
                 "is missing, and so is any other action; right would be: one of %s%s", names,
                 schema_step.keys[STEP_KEY_ALTITUDE].name);
}

/* The one action of a step; STEP_TYPE_COUNT with the message when it has none or several. */
static enum step_type find_action(const struct entry *entry)
{
    enum step_type type = STEP_TYPE_COUNT;
    const char *first = NULL;
    for (size_t i = 0; i < sizeof(actions) / sizeof(actions[0]); i++) {
        if (!entry_given(entry, actions[i].key))
            continue;
        if (first != NULL) {
            entry_refuse(entry, actions[i].key,
                         "is a second action beside %s; allowed: one action in a step", first);
            return STEP_TYPE_COUNT;
        }
        first = schema_step.keys[actions[i].key].name;
        type = actions[i].type;
    }
    if (first == NULL && entry_given(entry, STEP_KEY_ALTITUDE))
        return STEP_ALTITUDE;
    if (first == NULL)
        refuse_no_action(entry);
    return type;
}

/* Checks the keys that only some actions may have beside them. */
static int check_beside(const struct entry *entry, enum step_type type)
{
    static const uint32_t controls[] = {STEP_KEY_THROTTLE, STEP_KEY_STEER, STEP_KEY_CLIMB};
    bool moves = type == STEP_GO || type == STEP_ARRIVE || type == STEP_FACE || type == STEP_WAIT ||
                 type == STEP_ALTITUDE;
    for (size_t i = 0; i < sizeof(controls) / sizeof(controls[0]); i++) {
        if (type != STEP_CONTROLS && entry_given(entry, controls[i]))
            return entry_refuse(
                entry, controls[i],
                "needs a duration; right would be: for_s beside it, and no other action");
    }
    if (entry_given(entry, STEP_KEY_SPEED) && type != STEP_GO)
        return entry_refuse(entry, STEP_KEY_SPEED,
                            "is only for go; right would be: a step without it");
    if (entry_given(entry, STEP_KEY_ALTITUDE) && !moves)
        return entry_refuse(
            entry, STEP_KEY_ALTITUDE,
            "is only for go, arrive, face_deg and wait_s, or for a step of its own");
    return 0;
}

/* Checks that times do not decrease. last_s: the latest time of the steps before. */
static int check_time(const struct entry *entry, const struct step_entry *given,
                      enum step_type type, double last_s)
{
    if (type == STEP_ARRIVE && !entry_given(entry, STEP_KEY_AT))
        return entry_refuse(entry, STEP_KEY_AT,
                            "is missing; right would be: at_s = SECONDS, the time of the arrival");
    if (entry_given(entry, STEP_KEY_AT) && entry_given(entry, STEP_KEY_AFTER))
        return entry_refuse(entry, STEP_KEY_AFTER, "stands beside at_s; allowed: one of the two");
    if (entry_given(entry, STEP_KEY_AT) && given->at_s < last_s)
        return entry_refuse(entry, STEP_KEY_AT,
                            "is before the time of an earlier step; allowed: from %.15g on",
                            last_s);
    if (type == STEP_STOP && !given->stop)
        return entry_refuse(entry, STEP_KEY_STOP, "does nothing; allowed: true");
    return 0;
}

static void write_step(struct scenario_step *to, const struct step_entry *given,
                       enum step_type type)
{
    const double *point = type == STEP_GO       ? given->go
                          : type == STEP_ARRIVE ? given->arrive
                                                : given->fire_at;
    to->step.type = type;
    to->step.x = point[0];
    to->step.z = point[1];
    to->step.amount = type == STEP_GO     ? given->speed_mps
                      : type == STEP_FACE ? maths_wrap_turn(given->face_rad)
                      : type == STEP_WAIT ? given->wait_s
                                          : given->for_s;
    to->step.throttle = (float)given->throttle;
    to->step.steer = (float)given->steer;
    to->step.climb = (float)given->climb;
    to->step.behaviour = given->behaviour;
    memcpy(to->target, given->fire, sizeof(to->target));
}

static int add_step(struct entry *entry, const struct step_entry *given, double *last_s)
{
    struct scenario *scenario = entry->scenario;
    enum step_type type = find_action(entry);
    int line = (int)config_setting_source_line(entry->setting);
    if (type == STEP_TYPE_COUNT || check_beside(entry, type) != 0 ||
        check_time(entry, given, type, *last_s) != 0)
        return -1;
    if (entry_given(entry, STEP_KEY_AFTER))
        scenario->steps[scenario->step_count++] =
            (struct scenario_step){.step = {.at_s = STEP_AT_ONCE,
                                            .amount = given->after_s,
                                            .altitude_m = STEP_SAME_ALTITUDE,
                                            .type = STEP_WAIT},
                                   .line = line};
    struct scenario_step *to = &scenario->steps[scenario->step_count++];
    *to = (struct scenario_step){.line = line};
    to->step.at_s = entry_given(entry, STEP_KEY_AT) ? given->at_s : STEP_AT_ONCE;
    to->step.altitude_m =
        entry_given(entry, STEP_KEY_ALTITUDE) ? given->altitude_m : STEP_SAME_ALTITUDE;
    write_step(to, given, type);
    if (entry_given(entry, STEP_KEY_AT))
        *last_s = given->at_s;
    return 0;
}

static int read_steps(struct entry *script, const config_setting_t *list)
{
    struct entry entry = {
        .scenario = script->scenario, .keys = {.file = script->keys.file}, .error = script->error};
    char within[KEY_PATH_MAX];
    double last_s = 0.0;
    int length =
        entry_count_within(script->path, list, entry.keys.file, SCRIPT_STEPS_MAX, entry.error);
    if (length < 0)
        return -1;
    snprintf(within, sizeof(within), "%.60s.", script->path);
    entry.within = within;
    if (length == 0) {
        const struct key_place place = {entry.keys.file, (int)config_setting_source_line(list)};
        return key_table_refuse(entry.error, place, script->path, NULL,
                                "has no steps; right would be: steps = ( { go = [x, z]; }, ... )");
    }
    if (reserve_steps(entry.scenario, 2 * (uint64_t)length, entry.keys.file, entry.error) != 0)
        return -1;
    for (int i = 0; i < length; i++) {
        struct step_entry given;
        if (entry_read(&entry, &schema_step, i, list, &given) != 0 ||
            add_step(&entry, &given, &last_s) != 0)
            return -1;
    }
    return 0;
}

/* The file's folder, "." where it has none. */
static void folder_of(const char *file, char *folder, size_t bytes)
{
    const char *slash = strrchr(file, '/');
    if (slash == NULL)
        snprintf(folder, bytes, ".");
    else
        snprintf(folder, bytes, "%.*s", (int)(slash - file + (slash == file)), file);
}

static int read_file(struct entry *entry, const char *name, XXH3_state_t *hash)
{
    struct scenario *scenario = entry->scenario;
    struct source source;
    struct location_frame frame;
    char folder[PATH_MAX];
    int count = -1;
    earth_location_frame(&frame, &scenario->settings->params, scenario->settings->side_m);
    folder_of(entry->keys.file, folder, sizeof(folder));
    struct error_text reason;
    if (source_read_in(&source, folder, name, WAYPOINTS_BYTES_MAX, &reason) != 0)
        return entry_refuse(entry, SCRIPT_FILE, "%s; right would be: a file beside the scenario",
                            reason.text);
    XXH3_64bits_update(hash, source.text, source.bytes);
    if (reserve_steps(scenario, waypoints_lines(source.text), source.path, entry->error) == 0)
        count =
            waypoints_read(&source, &frame, &scenario->steps[scenario->step_count], entry->error);
    source_free(&source);
    if (count < 0)
        return -1;
    scenario->step_count += (uint32_t)count;
    return 0;
}

static const char *const script_lists[] = {"steps", NULL};

static int add_script(struct entry *entry, const struct script_entry *given, XXH3_state_t *hash)
{
    struct scenario *scenario = entry->scenario;
    const config_setting_t *steps = config_setting_get_member(entry->setting, "steps");
    struct scenario_script *script = &scenario->scripts[scenario->script_count];
    if (scripts_find(scenario, given->name) != UINT32_MAX)
        return entry_refuse(entry, SCRIPT_NAME,
                            "is also the name of another script; allowed: each name once");
    if ((steps != NULL) == entry_given(entry, SCRIPT_FILE))
        return entry_refuse(entry, SCRIPT_FILE,
                            "a script needs steps or a file of waypoints; allowed: one of the two");
    memcpy(script->name, given->name, sizeof(script->name));
    memcpy(script->file, given->file, sizeof(script->file));
    script->reacts = (uint8_t)given->react;
    script->repeats = (uint8_t)given->repeat;
    script->line = (int)config_setting_source_line(entry->setting);
    script->first = scenario->step_count;
    if ((steps != NULL ? read_steps(entry, steps) : read_file(entry, given->file, hash)) != 0)
        return -1;
    script->count = scenario->step_count - script->first;
    scenario->script_count++;
    return 0;
}

uint32_t scripts_find(const struct scenario *scenario, const char *name)
{
    for (uint32_t i = 0; i < scenario->script_count; i++) {
        if (strcmp(scenario->scripts[i].name, name) == 0)
            return i;
    }
    return UINT32_MAX;
}

int scripts_read(struct scenario *scenario, const config_setting_t *list, const char *file,
                 XXH3_state_t *hash, struct error_text *error)
{
    struct entry entry = {
        .scenario = scenario, .keys = {.file = file, .lists = script_lists}, .error = error};
    int length = list != NULL ? entry_count(list, file, SCHEMA_SCRIPTS_MAX, error) : 0;
    if (length < 0)
        return -1;
    scenario->scripts = entry_allocate((uint32_t)length, sizeof(*scenario->scripts), file, error);
    if (scenario->scripts == NULL)
        return -1;
    for (int i = 0; i < length; i++) {
        struct script_entry given;
        if (entry_read(&entry, &schema_script, i, list, &given) != 0 ||
            add_script(&entry, &given, hash) != 0)
            return -1;
    }
    return 0;
}
