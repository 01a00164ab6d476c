/* Reads orders from JSON objects. */
#include "ipc/topics/command_json.h"

#include <stdio.h>
#include <string.h>

/* Refuses a member, with the list of arguments that the verb takes. */
static int strange_member(const struct command_text *order, const char *name,
                          struct error_text *error)
{
    char all[256] = "";
    size_t used = 0;
    for (int i = 0; i < COMMAND_TEXT_FIELD_COUNT && used < sizeof all; i++) {
        if (!(order->verb->allowed & 1u << i))
            continue;
        int length = snprintf(all + used, sizeof all - used, "%s%s", used ? ", " : "",
                              command_text_field_name((enum command_text_field)i));
        used += length > 0 ? (size_t)length : 0;
    }
    return error_text_set(error, "%s: '%.32s': no such argument; it takes %s", order->verb->name,
                          name, used ? all : "none");
}

static int give_member(struct command_text *order, const cJSON *member, struct error_text *error)
{
    struct error_text detail;
    struct command_text_value value = {.text = cJSON_GetStringValue(member)};
    enum command_text_field field = command_text_field(member->string);
    if (field == COMMAND_TEXT_FIELD_COUNT || !(order->verb->allowed & 1u << field))
        return strange_member(order, member->string, error);
    value.is_truth = cJSON_IsBool(member);
    value.truth = cJSON_IsTrue(member);
    if (cJSON_IsNumber(member))
        value.number = member->valuedouble;
    else if (!value.text && !value.is_truth)
        return error_text_set(error, "%s: %s: not a number, a text, true or false",
                              order->verb->name, member->string);
    if (command_text_give(order, field, &value, &detail) != 0)
        return error_text_set(error, "%s: %s: %.400s", order->verb->name, member->string,
                              detail.text);
    return 0;
}

int command_json_give(struct command_text *order, const cJSON *object, struct error_text *error)
{
    if (!cJSON_IsObject(object))
        return error_text_set(error, "not an object like {\"do\":\"pause\"}");
    const cJSON *verb = cJSON_GetObjectItemCaseSensitive(object, "do");
    if (!cJSON_IsString(verb))
        return error_text_set(error, "it has no \"do\", like {\"do\":\"pause\"}");
    if (command_text_begin(order, verb->valuestring, error) != 0)
        return -1;
    for (const cJSON *member = object->child; member; member = member->next) {
        if (strcmp(member->string, "do") != 0 && strcmp(member->string, "id") != 0 &&
            give_member(order, member, error) != 0)
            return -1;
    }
    return 0;
}

int command_from_json(struct command_text *order, const cJSON *object, struct error_text *error)
{
    return command_json_give(order, object, error) != 0 ? -1 : command_text_end(order, error);
}
