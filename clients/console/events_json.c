/* Writes events of the event ring as text. */
#include "clients/console/events_json.h"

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "world/entity/kind.h"
#include "world/event_text.h"

#include <string.h>

#define EVENTS     100u /* by default ... */
#define EVENTS_MAX 500u /* ... and at most */
#define BATCH      128u
#define SCAN_MAX   8192u /* events looked at for one answer */

/* Types of events are bits. Drives that were done have a bit of their own: each player makes
 * several a second, so they are written only on request. */
#define EVENT_WORD(tag, word) #word ", "

#define DRIVE_BIT (1u << EVENT_TYPE_COUNT)

static const char *type_word(uint32_t bit)
{
    return bit == EVENT_TYPE_COUNT ? "drive" : event_type_name((enum event_type)bit);
}

/* Reads types=collision,fire,... */
static bool read_types(const struct world_query *query, uint32_t *types, struct http_answer *answer)
{
    const char *at = query_text(&query->arguments, "types");
    *types = *at ? 0 : DRIVE_BIT - 1;
    while (*at) {
        size_t length = strcspn(at, ",");
        uint32_t bit = EVENT_COLLISION;
        while (bit <= EVENT_TYPE_COUNT &&
               (strlen(type_word(bit)) != length || strncmp(type_word(bit), at, length) != 0))
            bit++;
        if (bit > EVENT_TYPE_COUNT) {
            http_answer_error(answer, HTTP_ANSWER_BAD, "there are " EVENT_TYPES(EVENT_WORD) "drive",
                              "types: \"%.*s\" is no type of event", length < 40 ? (int)length : 40,
                              at);
            return false;
        }
        *types |= 1u << bit;
        at += length + (at[length] == ',');
    }
    return true;
}

static bool wanted(const struct event *event, uint32_t types)
{
    if (event->type == EVENT_COMMAND && event->command.type == COMMAND_DRIVE &&
        event->command.result == COMMAND_DONE)
        return types & DRIVE_BIT;
    return event->type < EVENT_TYPE_COUNT && (types & 1u << event->type);
}

static const char *kind_of(const struct world *world, const struct event_party *party)
{
    if (party->id)
        return party->kind < world->counts.kinds ? world->kinds[party->kind].name : "?";
    return party->fixed ? "ground" : "none";
}

/* Returns the place of the event, or NULL for a type without a place. */
static const double *point_of(const struct event *event)
{
    switch ((enum event_type)event->type) {
    case EVENT_COLLISION:
        return event->collision.point;
    case EVENT_FIRE:
        return event->fire.point;
    case EVENT_DETONATION:
        return event->detonation.point;
    case EVENT_CRATER:
        return event->crater.point;
    case EVENT_NONE:
    case EVENT_AGENT:
    case EVENT_CONTACT_END:
    case EVENT_COMMAND:
    case EVENT_MISSION:
    case EVENT_INPUT:
    case EVENT_TYPE_COUNT:
        break;
    }
    return NULL;
}

static void put_event(struct json_writer *json, const struct world *world,
                      const struct event *event)
{
    const struct event_party *about[EVENT_TEXT_PARTIES];
    const char *kind[EVENT_TEXT_PARTIES] = {NULL};
    const double *point = point_of(event);
    char words[EVENT_TEXT_MAX];
    event_text_parties(event, about);
    for (int i = 0; i < EVENT_TEXT_PARTIES; i++)
        kind[i] = about[i] ? kind_of(world, about[i]) : NULL;
    event_text(words, event, kind);
    json_writer_begin(json, '{');
    json_writer_key_whole(json, "sequence", event->sequence);
    json_writer_key_whole(json, "frame", event->frame);
    json_writer_key_number(json, "time_s", (double)event->tick * world_dt_s(world), 2);
    json_writer_key_word(json, "type", event_type_name((enum event_type)event->type));
    json_writer_key_word(json, "text", words);
    json_writer_key(json, "ids");
    json_writer_begin(json, '[');
    for (int i = 0; i < EVENT_TEXT_MUNITION; i++) {
        if (about[i] && about[i]->id && !about[i]->fixed)
            json_writer_whole(json, about[i]->id);
    }
    if (event->type == EVENT_COMMAND && event->command.entity)
        json_writer_whole(json, event->command.entity);
    json_writer_end(json, ']');
    if (point) {
        json_writer_key(json, "point");
        json_writer_begin(json, '[');
        json_writer_number(json, point[0], 1);
        json_writer_number(json, point[2], 1);
        json_writer_end(json, ']');
    }
    json_writer_end(json, '}');
}

struct event_query {
    uint64_t after, most;
    uint32_t types;
    bool from_now; /* without "after": the newest events */
};

/* Returns the sequence number from which on there are `most` events of the wanted types. */
static uint64_t newest(const struct view *view, const struct event_query *asked, uint64_t end)
{
    struct event batch[BATCH];
    uint64_t place[EVENTS_MAX];
    struct event_cursor cursor = {.next = end > SCAN_MAX ? end - SCAN_MAX : 0};
    uint64_t seen = 0;
    uint32_t count;
    while (cursor.next < end && (count = events_read(view, &cursor, batch, BATCH)) > 0) {
        for (uint32_t i = 0; i < count; i++) {
            if (wanted(&batch[i], asked->types))
                place[seen++ % asked->most] = batch[i].sequence;
        }
    }
    return seen == 0 ? end : place[seen < asked->most ? 0 : seen % asked->most];
}

static void put_events(struct json_writer *json, const struct view *view,
                       const struct event_query *asked, struct event_cursor *cursor)
{
    struct event batch[BATCH];
    uint64_t put = 0, scanned = 0;
    uint32_t count;
    json_writer_key(json, "events");
    json_writer_begin(json, '[');
    while (put < asked->most && scanned < SCAN_MAX) {
        uint64_t from = cursor->next;
        if ((count = events_read(view, cursor, batch, BATCH)) == 0)
            break;
        for (uint32_t i = 0; i < count && put < asked->most; i++) {
            from = batch[i].sequence + 1;
            if (!wanted(&batch[i], asked->types))
                continue;
            put_event(json, &view->world, &batch[i]);
            put++;
        }
        cursor->next = from; /* the rest of the batch is for the next answer */
        scanned += count;
    }
    json_writer_end(json, ']');
}

void events_json(const struct world_query *query, struct http_answer *answer)
{
    struct json_writer *json = &answer->json;
    struct event_query asked = {.from_now = !*query_text(&query->arguments, "after")};
    struct state_head head;
    if (!query_whole(&query->arguments, "after", 0, UINT64_MAX, 0, &asked.after, answer) ||
        !query_whole(&query->arguments, "most", 1, EVENTS_MAX, EVENTS, &asked.most, answer) ||
        !read_types(query, &asked.types, answer) || !world_query_attached(query, answer))
        return;
    const struct view *view = &query->reader->view;
    if (snapshot_head(&head, view) != 0) {
        http_answer_error(answer, HTTP_ANSWER_AWAY, "ask again",
                          "the last frame cannot be read just now");
        return;
    }
    struct event_cursor cursor = {.next = asked.after};
    if (asked.from_now)
        cursor.next = newest(view, &asked, head.event_end);
    else if (asked.after > head.event_end) /* from another run, or from before a repair */
        cursor.next = head.event_end;
    json_writer_begin(json, '{');
    put_events(json, view, &asked, &cursor);
    json_writer_key_whole(json, "next", cursor.next);
    json_writer_key_whole(json, "missed", cursor.gap);
    json_writer_end(json, '}');
}
