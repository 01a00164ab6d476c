/* Records of the command log. */
#include "recorder/log/command_record.h"

#include "ipc/json/world_json.h"
#include "world/entity/command.h"
#include "world/enum_names.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[RECORD_TYPE_COUNT] = {"begin",   "command", "mark",  "end",
                                                     "resumed", "gap",     "inputs"};

const char *record_type_name(enum record_type type)
{
    return (unsigned)type < RECORD_TYPE_COUNT ? names[type] : "?";
}

/* --- writing -----------------------------------------------------------------------------------*/

void record_add_position(cJSON *object, const struct record_position *at)
{
    json_whole(object, "frame", at->frame);
    json_whole(object, "events", at->events);
    json_whole(object, "commands", at->commands);
}

/* 17 digits represent every finite number exactly. Infinities and NaNs, of which there are many,
 * are written as their bits in hex. */
static void put_values(cJSON *object, const double value[6])
{
    cJSON *array = json_array(object, "value");
    for (int i = 0; i < 6; i++) {
        char text[32];
        uint64_t bits;
        memcpy(&bits, &value[i], sizeof bits);
        if (isfinite(value[i]))
            snprintf(text, sizeof text, "%.17g", value[i]);
        else
            snprintf(text, sizeof text, "\"%016llx\"", (unsigned long long)bits);
        cJSON_AddItemToArray(array, cJSON_CreateRaw(text));
    }
}

static void put_command(cJSON *object, const struct event_command *command)
{
    json_text(object, "ring", command_ring_name((enum command_ring)command->ring));
    json_hex(object, "source", command->source);
    json_hex(object, "sequence", command->sequence);
    json_text(object, "command", command_type_name((enum command_type)command->type));
    json_whole(object, "code", command->type);
    json_whole(object, "entity", command->given);
    json_whole(object, "target", command->target);
    json_whole(object, "amount", command->amount);
    json_whole(object, "kind", command->kind);
    json_whole(object, "force", command->force);
    put_values(object, command->value);
    json_text(object, "result", command_result_name((enum command_result)command->result));
}

/* What is written of an input: all but its number in the ring. */
#define INPUT_AT     offsetof(struct command, source)
#define INPUT_BYTES  (sizeof(struct command) - INPUT_AT)
#define INPUT_DIGITS (2 * INPUT_BYTES)

static void put_inputs(cJSON *object, const struct command_record *record)
{
    static const char digit[] = "0123456789abcdef";
    char *text = malloc((size_t)record->input_count * INPUT_DIGITS + 1), *to = text;
    json_text(object, "ring", command_ring_name((enum command_ring)record->input_ring));
    json_whole(object, "count", record->input_count);
    for (uint32_t i = 0; text && i < record->input_count; i++) {
        const unsigned char *bytes = (const unsigned char *)&record->inputs[i];
        for (size_t b = INPUT_AT; b < sizeof(struct command); b++) {
            *to++ = digit[bytes[b] >> 4];
            *to++ = digit[bytes[b] & 15];
        }
    }
    if (text)
        *to = '\0';
    json_text(object, "records", text ? text : "");
    free(text);
}

cJSON *command_record_json(const struct command_record *record)
{
    cJSON *object = cJSON_CreateObject();
    record_add_position(object, &record->at);
    json_text(object, "type", record_type_name(record->type));
    switch (record->type) {
    case RECORD_COMMAND:
        put_command(object, &record->command);
        break;
    case RECORD_MARK:
    case RECORD_END:
        if (record->digested)
            json_hex(object, "digest", record->digest);
        json_hex(object, "event_digest", record->event_digest);
        break;
    case RECORD_GAP:
        json_whole(object, "lost", record->lost);
        break;
    case RECORD_INPUTS:
        put_inputs(object, record);
        break;
    default:
        break;
    }
    return object;
}

/* --- reading -----------------------------------------------------------------------------------*/

static bool hex_of(const cJSON *item, uint64_t *value)
{
    if (!cJSON_IsString(item) || strlen(item->valuestring) != 16 ||
        strspn(item->valuestring, "0123456789abcdef") != 16)
        return false;
    *value = strtoull(item->valuestring, NULL, 16);
    return true;
}

bool record_hex(const cJSON *object, const char *key, uint64_t *value)
{
    return hex_of(cJSON_GetObjectItemCaseSensitive(object, key), value);
}

bool record_whole(const cJSON *object, const char *key, uint64_t most, uint64_t *value)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0.0) ||
        !(item->valuedouble <= (double)most) || item->valuedouble != floor(item->valuedouble))
        return false;
    *value = (uint64_t)item->valuedouble;
    return true;
}

static bool read_values(const cJSON *object, double value[6])
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(object, "value");
    if (!cJSON_IsArray(array) || cJSON_GetArraySize(array) != 6)
        return false;
    for (int i = 0; i < 6; i++) {
        const cJSON *item = cJSON_GetArrayItem(array, i);
        uint64_t bits;
        if (cJSON_IsNumber(item))
            value[i] = item->valuedouble;
        else if (hex_of(item, &bits))
            memcpy(&value[i], &bits, sizeof bits);
        else
            return false;
    }
    return true;
}

static bool read_ring(const cJSON *object, uint8_t *ring)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "ring");
    for (uint8_t i = 0; cJSON_IsString(item) && i < COMMAND_RING_COUNT; i++) {
        if (strcmp(item->valuestring, command_ring_name((enum command_ring)i)) == 0) {
            *ring = i;
            return true;
        }
    }
    return false;
}

/* Returns the value of a lower-case hex digit, -1 for another character. */
static int digit_value(char digit)
{
    if (digit >= '0' && digit <= '9')
        return digit - '0';
    return digit >= 'a' && digit <= 'f' ? digit - 'a' + 10 : -1;
}

static bool read_input(struct command *input, const char *text)
{
    unsigned char *bytes = (unsigned char *)input + INPUT_AT;
    input->sequence = 0;
    for (size_t i = 0; i < INPUT_BYTES; i++) {
        int high = digit_value(text[2 * i]), low = digit_value(text[2 * i + 1]);
        if (high < 0 || low < 0)
            return false;
        bytes[i] = (unsigned char)(high << 4 | low);
    }
    return true;
}

static bool read_inputs(struct command_record *record, const cJSON *object)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "records");
    uint64_t count;
    if (!record_whole(object, "count", COMMAND_RECORD_INPUTS_MAX, &count) || count == 0 ||
        !read_ring(object, &record->input_ring) || !cJSON_IsString(item) ||
        strlen(item->valuestring) != count * INPUT_DIGITS)
        return false;
    record->inputs = malloc((size_t)count * sizeof *record->inputs);
    bool good = record->inputs != NULL;
    for (uint32_t i = 0; good && i < count; i++)
        good = read_input(&record->inputs[i], item->valuestring + i * INPUT_DIGITS);
    if (!good) {
        free(record->inputs);
        record->inputs = NULL;
        return false;
    }
    record->input_count = (uint32_t)count;
    return true;
}

static bool read_command(struct event_command *command, const cJSON *object)
{
    uint64_t code, entity, target, amount, kind, force;
    if (!record_hex(object, "source", &command->source) ||
        !record_hex(object, "sequence", &command->sequence) ||
        !record_whole(object, "code", UINT32_MAX, &code) ||
        !record_whole(object, "entity", UINT32_MAX, &entity) ||
        !record_whole(object, "target", UINT32_MAX, &target) ||
        !record_whole(object, "amount", UINT32_MAX, &amount) ||
        !record_whole(object, "kind", UINT16_MAX, &kind) ||
        !record_whole(object, "force", UINT16_MAX, &force) || !read_ring(object, &command->ring) ||
        !read_values(object, command->value))
        return false;
    command->type = (uint32_t)code;
    command->given = (uint32_t)entity;
    command->target = (uint32_t)target;
    command->amount = (uint32_t)amount;
    command->kind = (uint16_t)kind;
    command->force = (uint16_t)force;
    return true;
}

static bool read_type(const cJSON *object, enum record_type *type)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "type");
    for (int i = 0; cJSON_IsString(item) && i < RECORD_TYPE_COUNT; i++) {
        if (strcmp(item->valuestring, names[i]) == 0) {
            *type = (enum record_type)i;
            return true;
        }
    }
    return false;
}

bool command_record_read(struct command_record *record, const cJSON *object)
{
    *record = (struct command_record){0};
    if (!read_type(object, &record->type) ||
        !record_whole(object, "frame", RECORD_WHOLE_MAX, &record->at.frame) ||
        !record_whole(object, "events", RECORD_WHOLE_MAX, &record->at.events) ||
        !record_whole(object, "commands", RECORD_WHOLE_MAX, &record->at.commands))
        return false;
    switch (record->type) {
    case RECORD_COMMAND:
        return read_command(&record->command, object);
    case RECORD_MARK:
    case RECORD_END:
        record->digested = record_hex(object, "digest", &record->digest);
        return record_hex(object, "event_digest", &record->event_digest);
    case RECORD_GAP:
        return record_whole(object, "lost", RECORD_WHOLE_MAX, &record->lost);
    case RECORD_INPUTS:
        return read_inputs(record, object);
    default:
        return true;
    }
}
