/* Finds keys in the tables of the schema; checks, stores and refuses their values. */
#include "config/syntax/key_table.h"

#include "world/runtime/utf8.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VALUE_TEXT_MAX   80
#define ALLOWED_TEXT_MAX 256

/* A value and the words of its refusal. */
struct given {
    const struct key *key;
    const char *path;
    const char *value;
    struct key_place place;
    struct error_text *error;
};

/* Appends to a text of size bytes, and cuts off what does not fit. */
static void append(char *text, size_t bytes, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void append(char *text, size_t bytes, const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, bytes - used, format, arguments);
    va_end(arguments);
}

/* Control characters are shown as numbers: files may come from others, and a terminal would obey.
 */
static void append_escaped(char *text, size_t bytes, const char *raw)
{
    for (; *raw != '\0'; raw++) {
        unsigned char byte = (unsigned char)*raw;
        if (byte < 0x20 || byte == 0x7f)
            append(text, bytes, "\\x%02x", byte);
        else
            append(text, bytes, "%c", byte);
    }
}

int key_table_refuse(struct error_text *error, struct key_place place, const char *path,
                     const char *value, const char *format, ...)
{
    char text[sizeof(error->text)];
    va_list arguments;
    error->text[0] = '\0';
    append_escaped(error->text, sizeof(error->text), place.file);
    if (place.line > 0)
        append(error->text, sizeof(error->text), ":%d", place.line);
    append(error->text, sizeof(error->text), ": ");
    if (path != NULL)
        append_escaped(error->text, sizeof(error->text), path);
    if (path != NULL && value != NULL) {
        append(error->text, sizeof(error->text), " = ");
        append_escaped(error->text, sizeof(error->text), value);
    }
    if (path != NULL)
        append(error->text, sizeof(error->text), ": ");
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    append_escaped(error->text, sizeof(error->text), text);
    (void)utf8_mend(error->text);
    return -1;
}

int key_table_find(const struct key_table *table, const char *name)
{
    for (uint32_t i = 0; i < table->count; i++) {
        if (strcmp(table->keys[i].name, name) == 0)
            return (int)i;
    }
    return -1;
}

struct key_choice key_table_choice(const struct key *key, uint32_t n)
{
    struct key_choice choice =
        key->choices != NULL ? key->choices[n] : (struct key_choice){.value = n};
    if (choice.name == NULL)
        choice.name = key->word(choice.value);
    return choice;
}

const char *key_type_name(enum key_type type)
{
    static const char *const names[KEY_TYPE_COUNT] = {
        [KEY_BOOLEAN] = "boolean", [KEY_INTEGER] = "integer", [KEY_NUMBER] = "number",
        [KEY_TEXT] = "text",       [KEY_CHOICE] = "choice",   [KEY_CHOICES] = "choices",
        [KEY_POINT] = "point",     [KEY_AREA] = "area",       [KEY_ROUTE] = "route",
        [KEY_NUMBERS] = "numbers",
    };
    return type < KEY_TYPE_COUNT ? names[type] : "?";
}

/* Appends a limit; whole numbers are written in full. */
static void append_limit(char *text, size_t bytes, double limit)
{
    append(text, bytes, floor(limit) == limit && fabs(limit) < 1e16 ? "%.0f" : "%.15g", limit);
}

static void append_range(char *text, size_t bytes, const struct key *key)
{
    append_limit(text, bytes, key->low);
    append(text, bytes, "..");
    append_limit(text, bytes, key->high);
}

static void append_unit(char *text, size_t bytes, const struct key *key)
{
    if (key->unit != NULL)
        append(text, bytes, " %s", key->unit);
}

void key_table_range(const struct key *key, char *text, size_t bytes)
{
    text[0] = '\0';
    append_range(text, bytes, key);
    append_unit(text, bytes, key);
}

void key_table_allowed(const struct key *key, char *text, size_t bytes)
{
    text[0] = '\0';
    switch (key->type) {
    case KEY_BOOLEAN:
        append(text, bytes, "true, false");
        break;
    case KEY_TEXT:
        append(text, bytes, "%s%u characters", key->required ? "1.." : "up to ", key->size - 1);
        break;
    case KEY_INTEGER:
    case KEY_NUMBER:
    case KEY_CHOICE:
    case KEY_CHOICES:
        for (uint32_t n = 0; n < key->choice_count; n++) {
            const struct key_choice choice = key_table_choice(key, n);
            if (choice.value != KEY_LATER)
                append(text, bytes, "%s%s", text[0] == '\0' ? "" : ", ", choice.name);
        }
        if (key->choice_count == 0)
            append_range(text, bytes, key);
        break;
    case KEY_POINT:
        append(text, bytes, "[x, z], each ");
        append_range(text, bytes, key);
        break;
    case KEY_AREA:
        append(text, bytes, "[x0, z0, x1, z1] with x0 < x1 and z0 < z1, each ");
        append_range(text, bytes, key);
        break;
    case KEY_NUMBERS:
        append(text, bytes, "%u numbers in [ ], each ", key->size);
        append_range(text, bytes, key);
        break;
    case KEY_ROUTE:
        append(text, bytes, "( [x, z], [x, z], ... ), each ");
        append_range(text, bytes, key);
        break;
    case KEY_TYPE_COUNT:
        break;
    }
    append_unit(text, bytes, key);
}

/* "what is wrong; allowed: ..." */
static int refuse_value(const struct given *given, const char *wrong)
{
    char allowed[ALLOWED_TEXT_MAX];
    key_table_allowed(given->key, allowed, sizeof(allowed));
    return key_table_refuse(given->error, given->place, given->path, given->value,
                            "%s; allowed: %s", wrong, allowed);
}

static int store_number(const struct given *given, void *destination, double value)
{
    const struct key *key = given->key;
    char *to = (char *)destination + key->offset;
    if (!(value >= key->low && value <= key->high)) /* refuses NaN too */
        return refuse_value(given, "out of range");
    switch (key->store) {
    case STORE_U8: {
        uint8_t byte = (uint8_t)value;
        memcpy(to, &byte, sizeof(byte));
        return 0;
    }
    case STORE_U32: {
        uint32_t word = (uint32_t)value;
        memcpy(to, &word, sizeof(word));
        return 0;
    }
    case STORE_U64: {
        uint64_t word = (uint64_t)value;
        memcpy(to, &word, sizeof(word));
        return 0;
    }
    case STORE_DOUBLE: {
        double number = value * key->scale;
        memcpy(to, &number, sizeof(number));
        return 0;
    }
    case STORE_TEXT:
    case STORE_ROUTE:
        break;
    }
    return refuse_value(given, "cannot be a number");
}

static int store_number_choice(const struct given *given, void *destination, double value)
{
    for (uint32_t n = 0; n < given->key->choice_count; n++) {
        if (strtod(key_table_choice(given->key, n).name, NULL) == value)
            return store_number(given, destination, value);
    }
    return refuse_value(given, "is not one of these");
}

/* Finds the choice whose word is the first `length` bytes of text. False: there is none. */
static bool find_choice(const struct key *key, const char *text, size_t length,
                        struct key_choice *choice)
{
    for (uint32_t n = 0; n < key->choice_count; n++) {
        *choice = key_table_choice(key, n);
        if (strncmp(choice->name, text, length) == 0 && choice->name[length] == '\0')
            return true;
    }
    return false;
}

static int store_choice(const struct given *given, void *destination, const char *word)
{
    const struct key *key = given->key;
    char *to = (char *)destination + key->offset;
    struct key_choice choice;
    if (!find_choice(key, word, strlen(word), &choice))
        return refuse_value(given, "unknown");
    if (choice.value == KEY_LATER)
        return refuse_value(given, "not in this version");
    if (key->store == STORE_U8)
        *to = (char)choice.value;
    else
        memcpy(to, &choice.value, sizeof(choice.value));
    return 0;
}

/* Stores the words of "word, word". Blanks before a word are ignored. */
static int store_choices(const struct given *given, void *destination, const char *words)
{
    uint32_t all = 0;
    for (const char *at = words; at != NULL;) {
        struct key_choice choice;
        at += strspn(at, " ");
        size_t length = strcspn(at, ",");
        if (!find_choice(given->key, at, length, &choice))
            return refuse_value(given, "unknown");
        all |= choice.value;
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    memcpy((char *)destination + given->key->offset, &all, sizeof(all));
    return 0;
}

/* Texts are printable ASCII, so that they look the same in every table, file and topic. */
static int store_text(const struct given *given, void *destination, const char *text)
{
    const struct key *key = given->key;
    if (strlen(text) >= key->size)
        return refuse_value(given, "too long");
    if (key->required && text[0] == '\0')
        return refuse_value(given, "is empty");
    for (const char *c = text; *c != '\0'; c++) {
        if (*c < 0x20 || *c > 0x7e)
            return refuse_value(given, "has a character that is not printable ASCII");
    }
    memset((char *)destination + key->offset, 0, key->size);
    memcpy((char *)destination + key->offset, text, strlen(text));
    return 0;
}

int key_table_set_text(const struct key *key, void *destination, const char *text,
                       struct key_place place, struct error_text *error)
{
    struct given given = {key, key->name, text, place, error};
    char *end = NULL;
    double value;
    switch (key->type) {
    case KEY_BOOLEAN:
        if (strcmp(text, "true") != 0 && strcmp(text, "false") != 0)
            return refuse_value(&given, "is not a boolean");
        return store_number(&given, destination, text[0] == 't' ? 1.0 : 0.0);
    case KEY_INTEGER:
        if (text[0] == '\0' || text[strspn(text, "0123456789")] != '\0')
            return refuse_value(&given, "is not a whole number");
        return store_number(&given, destination, strtod(text, NULL));
    case KEY_NUMBER:
        value = strtod(text, &end);
        if (end == text || *end != '\0' || !isfinite(value))
            return refuse_value(&given, "is not a number");
        return key->choice_count > 0 ? store_number_choice(&given, destination, value)
                                     : store_number(&given, destination, value);
    case KEY_TEXT:
        return store_text(&given, destination, text);
    case KEY_CHOICE:
        return store_choice(&given, destination, text);
    case KEY_CHOICES:
        return store_choices(&given, destination, text);
    case KEY_POINT:
    case KEY_AREA:
    case KEY_NUMBERS:
    case KEY_ROUTE:
    case KEY_TYPE_COUNT:
        break;
    }
    return refuse_value(&given, "cannot be set so");
}

int key_table_defaults(const struct key_table *table, void *destination, struct error_text *error)
{
    const struct key_place place = {"default", 0};
    for (uint32_t i = 0; i < table->count; i++) {
        const struct key *key = &table->keys[i];
        if (key->fallback != NULL &&
            key_table_set_text(key, destination, key->fallback, place, error) != 0)
            return -1;
    }
    return 0;
}

static bool is_number(const config_setting_t *setting)
{
    return setting->type == CONFIG_TYPE_INT || setting->type == CONFIG_TYPE_INT64 ||
           setting->type == CONFIG_TYPE_FLOAT;
}

static double number_of(const config_setting_t *setting)
{
    switch (setting->type) {
    case CONFIG_TYPE_INT:
        return (double)config_setting_get_int(setting);
    case CONFIG_TYPE_INT64:
        return (double)config_setting_get_int64(setting);
    default:
        return config_setting_get_float(setting);
    }
}

/* Reads an array or list of exactly count numbers. Returns false for any other setting. */
static bool numbers_of(const config_setting_t *setting, double *numbers, int count)
{
    if ((setting->type != CONFIG_TYPE_ARRAY && setting->type != CONFIG_TYPE_LIST) ||
        config_setting_length(setting) != count)
        return false;
    for (int i = 0; i < count; i++) {
        const config_setting_t *element = config_setting_get_elem(setting, (unsigned)i);
        if (element == NULL || !is_number(element))
            return false;
        numbers[i] = number_of(element);
    }
    return true;
}

bool key_table_point(const config_setting_t *setting, double point[2])
{
    return numbers_of(setting, point, 2);
}

/* Lists of numbers are shown as arrays: most were arrays before literals_widen(). */
static bool looks_like_array(const config_setting_t *setting)
{
    bool numbers = config_setting_length(setting) > 0;
    for (int i = 0; i < config_setting_length(setting); i++)
        numbers &= is_number(config_setting_get_elem(setting, (unsigned)i));
    return setting->type == CONFIG_TYPE_ARRAY || numbers;
}

void key_table_value_text(const config_setting_t *setting, char *text, size_t bytes)
{
    bool list;
    text[0] = '\0';
    switch (setting->type) {
    case CONFIG_TYPE_INT:
    case CONFIG_TYPE_INT64:
        append(text, bytes, "%lld", config_setting_get_int64(setting));
        break;
    case CONFIG_TYPE_FLOAT:
        append(text, bytes, "%.15g", config_setting_get_float(setting));
        break;
    case CONFIG_TYPE_BOOL:
        append(text, bytes, "%s", config_setting_get_bool(setting) ? "true" : "false");
        break;
    case CONFIG_TYPE_STRING:
        append(text, bytes, "\"%s\"", config_setting_get_string(setting));
        break;
    case CONFIG_TYPE_ARRAY:
    case CONFIG_TYPE_LIST:
        list = !looks_like_array(setting);
        append(text, bytes, list ? "(" : "[");
        for (int i = 0; i < config_setting_length(setting) && i < 4; i++) {
            char element[24];
            const config_setting_t *child = config_setting_get_elem(setting, (unsigned)i);
            key_table_value_text(child, element, sizeof(element));
            append(text, bytes, "%s%s", i > 0 ? ", " : "", element);
        }
        append(text, bytes, "%s%s", config_setting_length(setting) > 4 ? ", ..." : "",
               list ? ")" : "]");
        break;
    default:
        append(text, bytes, "{...}");
        break;
    }
}

static bool in_range(const struct key *key, const double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        if (!(numbers[i] >= key->low && numbers[i] <= key->high))
            return false;
    }
    return true;
}

#define NUMBERS_MAX 8

static int store_numbers(const struct given *given, void *destination,
                         const config_setting_t *setting)
{
    double numbers[NUMBERS_MAX];
    int count = (int)given->key->size;
    if (!numbers_of(setting, numbers, count))
        return refuse_value(given, "has another number of numbers");
    if (!in_range(given->key, numbers, count))
        return refuse_value(given, "out of range");
    memcpy((char *)destination + given->key->offset, numbers, (size_t)count * sizeof(*numbers));
    return 0;
}

/* Stores a point (count 2) or an area (count 4). */
static int store_place(const struct given *given, void *destination,
                       const config_setting_t *setting, int count)
{
    double place[4];
    if (!numbers_of(setting, place, count))
        return refuse_value(given, count == 2 ? "is not two numbers" : "is not four numbers");
    if (!in_range(given->key, place, count))
        return refuse_value(given, "out of range");
    if (count == 4 && !(place[0] < place[2] && place[1] < place[3]))
        return refuse_value(given, "is empty");
    memcpy((char *)destination + given->key->offset, place, (size_t)count * sizeof(*place));
    return 0;
}

static int store_route(const struct given *given, void *destination,
                       const config_setting_t *setting)
{
    if (setting->type != CONFIG_TYPE_LIST)
        return refuse_value(given, "is not a list of points");
    if (config_setting_length(setting) < 2)
        return refuse_value(given, "has fewer than two points");
    for (int i = 0; i < config_setting_length(setting); i++) {
        double point[2];
        if (!key_table_point(config_setting_get_elem(setting, (unsigned)i), point))
            return refuse_value(given, "is not a list of points");
        if (!in_range(given->key, point, 2))
            return refuse_value(given, "has a point out of range");
    }
    memcpy((char *)destination + given->key->offset, &setting, sizeof(setting));
    return 0;
}

/* A whole number beyond 64 bits is read as a fraction (config/syntax/literals.h). */
static bool too_large(const config_setting_t *setting)
{
    return setting->type == CONFIG_TYPE_FLOAT &&
           fabs(config_setting_get_float(setting)) >= 9223372036854775808.0;
}

static int store_setting(const struct given *given, void *destination,
                         const config_setting_t *setting)
{
    bool whole = setting->type == CONFIG_TYPE_INT || setting->type == CONFIG_TYPE_INT64;
    const struct key *key = given->key;
    switch (key->type) {
    case KEY_BOOLEAN:
        if (setting->type != CONFIG_TYPE_BOOL)
            return refuse_value(given, "is not a boolean");
        return store_number(given, destination, config_setting_get_bool(setting) ? 1.0 : 0.0);
    case KEY_INTEGER:
        if (!whole && !too_large(setting))
            return refuse_value(given, "is not a whole number");
        return store_number(given, destination, number_of(setting));
    case KEY_NUMBER:
        if (!is_number(setting))
            return refuse_value(given, "is not a number");
        return key->choice_count > 0 ? store_number_choice(given, destination, number_of(setting))
                                     : store_number(given, destination, number_of(setting));
    case KEY_TEXT:
    case KEY_CHOICE:
    case KEY_CHOICES:
        if (setting->type != CONFIG_TYPE_STRING)
            return refuse_value(given, "is not text in quotes");
        if (key->type == KEY_TEXT)
            return store_text(given, destination, config_setting_get_string(setting));
        return key->type == KEY_CHOICE
                   ? store_choice(given, destination, config_setting_get_string(setting))
                   : store_choices(given, destination, config_setting_get_string(setting));
    case KEY_POINT:
        return store_place(given, destination, setting, 2);
    case KEY_AREA:
        return store_place(given, destination, setting, 4);
    case KEY_NUMBERS:
        return store_numbers(given, destination, setting);
    case KEY_ROUTE:
        return store_route(given, destination, setting);
    case KEY_TYPE_COUNT:
        break;
    }
    return refuse_value(given, "has no such type");
}

/* Returns true if the table has keys in a group called name. */
static bool is_group(const struct key_table *table, const char *name)
{
    size_t length = strlen(name);
    for (uint32_t i = 0; i < table->count; i++) {
        if (strncmp(table->keys[i].name, name, length) == 0 && table->keys[i].name[length] == '.')
            return true;
    }
    return false;
}

/* Lists the names of the keys and groups directly in the group called prefix. */
static void list_names(const struct key_table *table, const char *prefix, char *text, size_t bytes)
{
    size_t length = strlen(prefix);
    char last[KEY_PATH_MAX] = "";
    text[0] = '\0';
    for (uint32_t i = 0; i < table->count; i++) {
        const char *rest = table->keys[i].name;
        char name[KEY_PATH_MAX];
        if (length > 0 && (strncmp(rest, prefix, length) != 0 || rest[length] != '.'))
            continue;
        rest += length > 0 ? length + 1 : 0;
        snprintf(name, sizeof(name), "%.*s", (int)strcspn(rest, "."), rest);
        if (strcmp(name, last) != 0)
            append(text, bytes, "%s%s", text[0] == '\0' ? "" : ", ", name);
        memcpy(last, name, sizeof(last));
    }
}

/* A key of the table, as it holds in this world. */
static struct key key_of(const struct key_reading *reading, uint32_t index)
{
    struct key key = reading->table->keys[index];
    bool place = key.type == KEY_POINT || key.type == KEY_AREA || key.type == KEY_ROUTE;
    if (place && reading->side_m > 0.0)
        key.high = reading->side_m;
    return key;
}

/* Returns true if another function reads a top-level setting, as a list. */
static bool is_list(const struct key_reading *reading, const config_setting_t *setting)
{
    const char *name = config_setting_name(setting);
    for (uint32_t i = 0; reading->lists != NULL && reading->lists[i] != NULL; i++) {
        if (strcmp(name, reading->lists[i]) == 0)
            return setting->type == CONFIG_TYPE_LIST || !is_group(reading->table, name);
    }
    return false;
}

static int read_setting(struct key_reading *reading, const config_setting_t *setting,
                        const char *name, const char *shown, struct error_text *error)
{
    const struct key_place place = {reading->file, (int)config_setting_source_line(setting)};
    char value[VALUE_TEXT_MAX];
    int index = key_table_find(reading->table, name);
    key_table_value_text(setting, value, sizeof(value));
    if (index >= 0) {
        const struct key key = key_of(reading, (uint32_t)index);
        struct given given = {&key, shown, value, place, error};
        reading->given[index] = true;
        reading->line[index] = place.line;
        return store_setting(&given, reading->destination, setting);
    }
    if (!is_group(reading->table, name)) {
        char names[512];
        const char *dot = strrchr(name, '.');
        char parent[KEY_PATH_MAX] = "";
        if (dot != NULL)
            snprintf(parent, sizeof(parent), "%.*s", (int)(dot - name), name);
        list_names(reading->table, parent, names, sizeof(names));
        for (uint32_t i = 0; dot == NULL && reading->lists != NULL && reading->lists[i]; i++) {
            if (!is_group(reading->table, reading->lists[i]))
                append(names, sizeof(names), ", %s", reading->lists[i]);
        }
        return key_table_refuse(error, place, shown, value, "unknown key; allowed here: %s", names);
    }
    if (setting->type != CONFIG_TYPE_GROUP)
        return key_table_refuse(error, place, shown, value,
                                "is not a group; allowed: { key = value; ... }");
    return key_table_read(reading, setting, name, shown, error);
}

/* libconfig gives the group of the whole file no line; it begins on line 1. */
static int group_line(const config_setting_t *group)
{
    int line = (int)config_setting_source_line(group);
    return line > 0 ? line : 1;
}

int key_table_read(struct key_reading *reading, const config_setting_t *group, const char *prefix,
                   const char *shown, struct error_text *error)
{
    const char *dot = prefix[0] == '\0' ? "" : ".";
    const char *shown_dot = shown[0] == '\0' ? "" : ".";
    for (int i = 0; i < config_setting_length(group); i++) {
        const config_setting_t *child = config_setting_get_elem(group, (unsigned)i);
        const char *own = config_setting_name(child);
        char name[KEY_PATH_MAX], path[KEY_PATH_MAX + KEY_PATH_MAX];
        if (prefix[0] == '\0' && is_list(reading, child))
            continue;
        snprintf(name, sizeof(name), "%s%s%.40s", prefix, dot, own);
        snprintf(path, sizeof(path), "%s%s%.40s", shown, shown_dot, own);
        if (read_setting(reading, child, name, path, error) != 0)
            return -1;
    }
    for (uint32_t i = 0; prefix[0] == '\0' && i < reading->table->count; i++) {
        const struct key key = key_of(reading, i);
        const struct key_place place = {reading->file, group_line(group)};
        char allowed[ALLOWED_TEXT_MAX], path[KEY_PATH_MAX + KEY_PATH_MAX];
        if (!key.required || reading->given[i])
            continue;
        key_table_allowed(&key, allowed, sizeof(allowed));
        snprintf(path, sizeof(path), "%s%s%s", shown, shown_dot, key.name);
        return key_table_refuse(error, place, path, NULL, "is missing; allowed: %s", allowed);
    }
    return 0;
}
