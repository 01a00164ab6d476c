/* Parses commands as all clients write them, and the requests of the console alone. */
#include "clients/console/request_body.h"

#include "ipc/topics/command_json.h"

#include <string.h>

#define BIT(field) (1u << (field))

static const char format_hint[] = "docs/console.md describes the commands";

/* Parses a body that is one JSON object. Returns NULL, with the answer, if it is malformed. */
static cJSON *parse(const char *body, size_t bytes, struct http_answer *answer)
{
    const char *end = NULL;
    cJSON *object = memchr(body, '\0', bytes) || bytes == 0
                        ? NULL
                        : cJSON_ParseWithLengthOpts(body, bytes, &end, 0);
    while (object && end < body + bytes && strchr(" \t\r\n", *end))
        end++;
    if (object && cJSON_IsObject(object) && end == body + bytes)
        return object;
    cJSON_Delete(object);
    http_answer_error(answer, HTTP_ANSWER_BAD, format_hint, "the body is no JSON object");
    return NULL;
}

static const char *string_of(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsString(item) ? item->valuestring : "";
}

static bool read_cancel(uint32_t *cancel, const cJSON *object, struct http_answer *answer)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "mission");
    double number = cJSON_IsNumber(item) ? item->valuedouble : 0.0;
    *cancel = number >= 1.0 && number <= UINT32_MAX ? (uint32_t)number : 0;
    if (*cancel && !((double)*cancel < number) && cJSON_GetArraySize(object) == 2)
        return true;
    http_answer_error(answer, HTTP_ANSWER_BAD, "send {\"do\": \"cancel\", \"mission\": NUMBER}",
                      "cancel: it takes the number of a mission, and nothing else");
    return false;
}

/* Fills in what a page may leave out: the player's own vehicle, one step, a round a second. */
static void apply_defaults(struct command_text *order)
{
    enum command_text_field operand = order->verb->operand;
    if (order->command.type == jolon_COMMAND_STEP && !(order->given & BIT(COMMAND_TEXT_FRAMES)))
        order->command.frames = 1;
    if (!(order->given & BIT(COMMAND_TEXT_EVERY)))
        order->every_s = 1.0;
    if (order->command.type == jolon_COMMAND_STEP ||
        (order->command.type != jolon_COMMAND_REMOVE && operand == COMMAND_TEXT_VEHICLE &&
         !(order->given & BIT(COMMAND_TEXT_MUNITION))))
        order->given |= BIT(operand);
}

/* Refuses the commands and members that other clients may send, but not a page. */
static bool is_allowed(const struct command_text *order, struct http_answer *answer)
{
    if (order->command.type == jolon_COMMAND_QUIT)
        http_answer_error(answer, HTTP_ANSWER_BAD, "use jolon ctl quit",
                          "quit: a page cannot end a world");
    else if (order->given & BIT(COMMAND_TEXT_LEASE))
        http_answer_error(answer, HTTP_ANSWER_BAD, "leave it out",
                          "drive: lease_s: the console renews the leases of its players");
    else
        return true;
    return false;
}

static bool read_order(struct command_text *order, const cJSON *object, struct http_answer *answer)
{
    struct error_text error;
    if (command_json_give(order, object, &error) == 0) {
        apply_defaults(order);
        if (command_text_end(order, &error) == 0)
            return is_allowed(order, answer);
    }
    http_answer_error(answer, HTTP_ANSWER_BAD, format_hint, "%s", error.text);
    return false;
}

bool request_body_order(struct command_text *order, uint32_t *cancel, const char *body,
                        size_t bytes, struct http_answer *answer)
{
    cJSON *object = parse(body, bytes, answer);
    *cancel = 0;
    if (!object)
        return false;
    bool good = strcmp(string_of(object, "do"), "cancel") == 0 ? read_cancel(cancel, object, answer)
                                                               : read_order(order, object, answer);
    cJSON_Delete(object);
    return good;
}

bool request_body_join(char name[PLAYERS_NAME_MAX], const char *body, size_t bytes,
                       struct http_answer *answer)
{
    cJSON *object = parse(body, bytes, answer);
    if (!object)
        return false;
    const char *given = string_of(object, "name");
    bool good = players_name_is_valid(given);
    if (good)
        memcpy(name, given, strlen(given) + 1);
    else
        http_answer_error(answer, HTTP_ANSWER_BAD, "choose another, as Ann",
                          "a player's name has 1 to %u characters that can be seen",
                          PLAYERS_NAME_CHARACTERS);
    cJSON_Delete(object);
    return good;
}

bool request_body_process(bool *restart, char role[REQUEST_BODY_ROLE_MAX], const char *body,
                          size_t bytes, struct http_answer *answer)
{
    cJSON *object = parse(body, bytes, answer);
    if (!object)
        return false;
    const char *word = string_of(object, "do"), *named = string_of(object, "role");
    *restart = strcmp(word, "restart") == 0;
    bool good = (*restart || strcmp(word, "kill") == 0) && strlen(named) < REQUEST_BODY_ROLE_MAX;
    if (good)
        memcpy(role, named, strlen(named) + 1);
    else
        http_answer_error(answer, HTTP_ANSWER_BAD,
                          "send {\"do\": \"kill\" or \"restart\", \"role\": ROLE}",
                          "the body does not say what to do with which role");
    cJSON_Delete(object);
    return good;
}
