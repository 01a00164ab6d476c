/* An object's members into an order. */
#include "ipc/topics/command_json.h"

#include <stdio.h>
#include <string.h>

/* Says what a verb takes. */
static int strange_member(const struct command_text *order, const char *name, struct reason *reason)
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
    return reason_set(reason, "%s: '%.32s': no such argument; it takes %s", order->verb->name, name,
                      used ? all : "none");
}

static int give_member(struct command_text *order, const cJSON *member, struct reason *reason)
{
    struct reason why;
    struct command_text_value value = {.text = cJSON_GetStringValue(member)};
    enum command_text_field field = command_text_field(member->string);
    if (field == COMMAND_TEXT_FIELD_COUNT || !(order->verb->allowed & 1u << field))
        return strange_member(order, member->string, reason);
    value.is_truth = cJSON_IsBool(member);
    value.truth = cJSON_IsTrue(member);
    if (cJSON_IsNumber(member))
        value.number = member->valuedouble;
    else if (!value.text && !value.is_truth)
        return reason_set(reason, "%s: %s: not a number, a text, true or false", order->verb->name,
                          member->string);
    if (command_text_give(order, field, &value, &why) != 0)
        return reason_set(reason, "%s: %s: %.400s", order->verb->name, member->string, why.text);
    return 0;
}

int command_json_give(struct command_text *order, const cJSON *object, struct reason *reason)
{
    if (!cJSON_IsObject(object))
        return reason_set(reason, "not an object like {\"do\":\"pause\"}");
    const cJSON *verb = cJSON_GetObjectItemCaseSensitive(object, "do");
    if (!cJSON_IsString(verb))
        return reason_set(reason, "it has no \"do\", like {\"do\":\"pause\"}");
    if (command_text_begin(order, verb->valuestring, reason) != 0)
        return -1;
    for (const cJSON *member = object->child; member; member = member->next) {
        if (strcmp(member->string, "do") != 0 && strcmp(member->string, "id") != 0 &&
            give_member(order, member, reason) != 0)
            return -1;
    }
    return 0;
}

int command_from_json(struct command_text *order, const cJSON *object, struct reason *reason)
{
    return command_json_give(order, object, reason) != 0 ? -1 : command_text_end(order, reason);
}
