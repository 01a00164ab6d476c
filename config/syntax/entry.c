/* Reads the entries of a scenario's lists. */
#include "config/syntax/entry.h"

#include "config/syntax/schema.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int entry_refuse(const struct entry *entry, uint32_t key, const char *format, ...)
{
    const char *name = entry->keys.table->keys[key].name;
    const config_setting_t *setting = config_setting_get_member(entry->setting, name);
    struct key_place place = {entry->keys.file, (int)config_setting_source_line(entry->setting)};
    char path[KEY_PATH_MAX + 24], value[80], text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    snprintf(path, sizeof(path), "%s.%s", entry->path, name);
    if (setting != NULL) {
        place.line = (int)config_setting_source_line(setting);
        key_table_value_text(setting, value, sizeof(value));
    }
    return key_table_refuse(entry->error, place, path, setting != NULL ? value : NULL, "%s", text);
}

/* Lists the names of the kinds of these domains, for messages. */
static void name_kinds(const struct scenario *scenario, unsigned domains, char *text, size_t bytes)
{
    size_t used = 0;
    text[0] = '\0';
    for (uint32_t i = 0; i < scenario->kind_count && used < bytes; i++) {
        const struct kind *kind = &scenario->kinds[i];
        if ((domains & DOMAIN_BIT(kind->domain)) != 0)
            used += (size_t)snprintf(text + used, bytes - used, "%s%s", used > 0 ? ", " : "",
                                     kind->name);
    }
}

uint16_t entry_kind(const struct entry *entry, uint32_t key, const char *name, unsigned domains)
{
    const struct scenario *scenario = entry->scenario;
    uint16_t kind = kind_find(scenario->kinds, scenario->kind_count, name);
    char names[400];
    if (kind != KIND_NONE && (domains & DOMAIN_BIT(scenario->kinds[kind].domain)) != 0)
        return kind;
    name_kinds(scenario, domains, names, sizeof(names));
    entry_refuse(entry, key, "%s; allowed: %s",
                 kind == KIND_NONE ? "unknown kind" : "is not a kind for this list", names);
    return KIND_NONE;
}

int entry_read(struct entry *entry, const struct key_table *table, int index,
               const config_setting_t *list, void *destination)
{
    const config_setting_t *setting = config_setting_get_elem(list, (unsigned)index);
    entry->setting = setting;
    entry->keys.table = table;
    entry->keys.destination = destination;
    entry->keys.side_m = entry->scenario->settings->side_m;
    memset(entry->keys.given, 0, sizeof entry->keys.given);
    snprintf(entry->path, sizeof(entry->path), "%s%s[%d]",
             entry->within != NULL ? entry->within : "", table->path, index);
    if (setting->type != CONFIG_TYPE_GROUP) {
        const struct key_place place = {entry->keys.file, (int)config_setting_source_line(setting)};
        char value[80];
        key_table_value_text(setting, value, sizeof(value));
        return key_table_refuse(entry->error, place, entry->path, value,
                                "is not a group; allowed: { key = value; ... }");
    }
    memset(destination, 0, table->size);
    if (key_table_defaults(table, destination, entry->error) != 0)
        return -1;
    return key_table_read(&entry->keys, setting, "", entry->path, entry->error);
}

int entry_count_within(const char *path, const config_setting_t *list, const char *file, int max,
                       struct error_text *error)
{
    const struct key_place place = {file, (int)config_setting_source_line(list)};
    char value[80], shown[KEY_PATH_MAX + 24];
    key_table_value_text(list, value, sizeof(value));
    snprintf(shown, sizeof(shown), "%s%s%s", path, path[0] == '\0' ? "" : ".",
             config_setting_name(list));
    if (list->type != CONFIG_TYPE_LIST)
        return key_table_refuse(error, place, shown, value,
                                "is not a list; allowed: ( { key = value; ... }, ... )");
    if (config_setting_length(list) > max)
        return key_table_refuse(error, place, shown, value, "has %d entries; allowed: up to %d",
                                config_setting_length(list), max);
    return config_setting_length(list);
}

int entry_count(const config_setting_t *list, const char *file, int max, struct error_text *error)
{
    return entry_count_within("", list, file, max, error);
}

void *entry_allocate(uint32_t count, size_t size, const char *file, struct error_text *error)
{
    const struct key_place place = {file, 0};
    void *memory = calloc((size_t)count + 1, size);
    if (memory == NULL)
        key_table_refuse(error, place, NULL, NULL, "no memory for its lists");
    return memory;
}
