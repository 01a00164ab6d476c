/* Lines read as JSON. */
#include "clients/harness/json_line.h"

#include "ipc/topics/command_json.h"
#include "ipc/topics/json_members.h"
#include "world/runtime/utf8.h"

#include <stdio.h>
#include <string.h>

void json_line_complain(struct session *session, const char *id, const char *text)
{
    cJSON *object = cJSON_CreateObject();
    put_word(object, "error", text);
    put_whole(object, "line", session->input.line);
    if (id && *id)
        (void)cJSON_AddRawToObject(object, "answer", id);
    char *line = cJSON_PrintUnformatted(object);
    output_line(&session->output, OUTPUT_ANSWER, line);
    cJSON_free(line);
    cJSON_Delete(object);
}

void json_line_refuse_length(struct session *session)
{
    char text[64];
    (void)snprintf(text, sizeof text, "longer than %u bytes", INPUT_LINE_MAX - 1);
    json_line_complain(session, NULL, text);
}

/* Is it UTF-8 without control characters but blanks? What we echo must be, too. */
static bool is_text(const char *line, size_t bytes)
{
    const char *end = line + bytes;
    while (line < end) {
        uint32_t code;
        size_t length = utf8_read(line, &code);
        if (length == 0 || (code < ' ' && code != '\t' && code != '\r'))
            return false;
        line += length;
    }
    return true;
}

/* The program's id for the line as JSON, "null" when it gave none; -1: it is none. */
static int read_id(char id[COMMAND_QUEUE_ID_MAX], const cJSON *object)
{
    cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "id");
    (void)snprintf(id, COMMAND_QUEUE_ID_MAX, "null");
    if (!item || cJSON_IsNull(item))
        return 0;
    if (!cJSON_IsString(item) && !cJSON_IsNumber(item))
        return -1;
    if (cJSON_PrintPreallocated(item, id, (int)COMMAND_QUEUE_ID_MAX, 0))
        return 0;
    (void)snprintf(id, COMMAND_QUEUE_ID_MAX, "null");
    return -1;
}

static void obey_want(struct session *session, const cJSON *want, const char *id)
{
    struct error_text error;
    char line[COMMAND_QUEUE_ID_MAX + 64];
    if (subscription_read(&session->subscription, want, &session->mirror, &error) != 0) {
        json_line_complain(session, id, error.text);
        return;
    }
    (void)snprintf(line, sizeof line, "{\"answer\":%s,\"result\":\"done\",\"frame\":%llu}", id,
                   (unsigned long long)session->mirror.frame.frame);
    output_line(&session->output, OUTPUT_ANSWER, line);
}

static void obey_order(struct session *session, const cJSON *object, const char *id)
{
    struct command_text order;
    struct error_text error;
    const struct world_mirror *mirror = &session->mirror;
    if (command_from_json(&order, object, &error) != 0 ||
        command_text_resolve(&order, &mirror->names, mirror->world.hz, &error) != 0)
        json_line_complain(session, id, error.text);
    else
        command_queue_add(&session->queue, id, &order);
}

static void obey_object(struct session *session, const cJSON *object)
{
    char id[COMMAND_QUEUE_ID_MAX];
    if (read_id(id, object) != 0) {
        json_line_complain(session, NULL, "id: not a number, or a text of at most 64 letters");
        return;
    }
    const cJSON *want = cJSON_GetObjectItemCaseSensitive(object, "want");
    if (want && cJSON_GetObjectItemCaseSensitive(object, "do"))
        json_line_complain(session, id, "\"do\" and \"want\" in one line; say them in two");
    else if (want)
        obey_want(session, want, id);
    else
        obey_order(session, object, id);
}

void json_line_obey(struct session *session, const char *line, size_t bytes)
{
    const char *end = NULL;
    if (line[strspn(line, " \t\r")] == '\0' && strlen(line) == bytes)
        return; /* an empty line */
    if (!is_text(line, bytes)) {
        json_line_complain(session, NULL, "not text: control characters, or not UTF-8");
        return;
    }
    cJSON *object = cJSON_ParseWithLengthOpts(line, bytes + 1, &end, 1);
    if (object && cJSON_IsObject(object))
        obey_object(session, object);
    else
        json_line_complain(session, NULL,
                           "not a JSON object on one line, like "
                           "{\"id\":1,\"do\":\"drive\",\"vehicle\":7,\"throttle\":0.5}");
    cJSON_Delete(object);
}
