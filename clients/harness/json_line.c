/* Parses and executes lines of JSON. */
#include "clients/harness/json_line.h"

#include "ipc/topics/command_json.h"
#include "ipc/json/world_json.h"
#include "world/runtime/utf8.h"

#include <stdio.h>
#include <string.h>

void json_line_error(struct session *session, const char *id, const char *text)
{
    cJSON *object = cJSON_CreateObject();
    json_text(object, "error", text);
    json_whole(object, "line", session->input.line);
    if (id && *id)
        (void)cJSON_AddRawToObject(object, "answer", id);
    output_object(&session->output, OUTPUT_ANSWER, object);
}

void json_line_refuse_length(struct session *session)
{
    char text[64];
    (void)snprintf(text, sizeof text, "longer than %u bytes", INPUT_LINE_MAX - 1);
    json_line_error(session, NULL, text);
}

/* Returns true if the line is UTF-8 without control characters other than blanks. Parts of it are
 * written back in answers, which must be such text too. */
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

/* Reads the program's id of the line as JSON, "null" if it has none. Returns -1 if it is malformed.
 */
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

static void subscribe(struct session *session, const cJSON *want, const char *id)
{
    struct error_text error;
    char line[COMMAND_QUEUE_ID_MAX + 64];
    if (subscription_read(&session->subscription, want, &session->mirror, &error) != 0) {
        json_line_error(session, id, error.text);
        return;
    }
    (void)snprintf(line, sizeof line, "{\"answer\":%s,\"result\":\"done\",\"frame\":%llu}", id,
                   (unsigned long long)session->mirror.frame.frame);
    output_line(&session->output, OUTPUT_ANSWER, line);
}

static void queue_command(struct session *session, const cJSON *object, const char *id)
{
    struct command_text order;
    struct error_text error;
    const struct world_mirror *mirror = &session->mirror;
    struct location_frame frame;
    location_frame_make(&frame, mirror->world.latitude_deg, mirror->world.longitude_deg,
                        mirror->world.side_m);
    if (command_from_json(&order, object, &error) != 0 ||
        command_text_resolve(&order, &mirror->names, mirror->world.hz, &error) != 0 ||
        command_text_place(&order, &frame, &error) != 0)
        json_line_error(session, id, error.text);
    else
        command_queue_add(&session->queue, id, &order);
}

static void execute_object(struct session *session, const cJSON *object)
{
    char id[COMMAND_QUEUE_ID_MAX];
    if (read_id(id, object) != 0) {
        json_line_error(session, NULL, "id: not a number, or a text of at most 64 letters");
        return;
    }
    const cJSON *want = cJSON_GetObjectItemCaseSensitive(object, "want");
    if (want && cJSON_GetObjectItemCaseSensitive(object, "do"))
        json_line_error(session, id, "\"do\" and \"want\" in one line: send two lines");
    else if (want)
        subscribe(session, want, id);
    else
        queue_command(session, object, id);
}

void json_line_execute(struct session *session, const char *line, size_t bytes)
{
    const char *end = NULL;
    if (line[strspn(line, " \t\r")] == '\0' && strlen(line) == bytes)
        return; /* an empty line */
    if (!is_text(line, bytes)) {
        json_line_error(session, NULL, "not text: control characters, or not UTF-8");
        return;
    }
    cJSON *object = cJSON_ParseWithLengthOpts(line, bytes + 1, &end, 1);
    if (object && cJSON_IsObject(object))
        execute_object(session, object);
    else
        json_line_error(session, NULL,
                        "not a JSON object on one line, like "
                        "{\"id\":1,\"do\":\"drive\",\"vehicle\":7,\"throttle\":0.5}");
    cJSON_Delete(object);
}
