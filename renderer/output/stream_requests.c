/* Requested pictures and maps: a request finds or makes its row in a bounded table, or is refused,
 * and waits there for a limited time. */
#include "renderer/output/stream_internal.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"
#include "renderer/output/output_queue.h"
#include "renderer/output/stream_requests.h"

#include <stdio.h>

#define WAIT_NS     1000000000ull /* for a picture, at most */
#define MAP_WAIT_NS 5000000000ull /* for a map: large ones take long, at a low priority */
#define NEW_NS      50000000u     /* a picture of this age answers a request without `after` */
#define STALE_NS    500000000u    /* ... and of this age a request with `after` */

/* --- queries -----------------------------------------------------------------------------------*/

struct reading {
    struct query_picture *picture; /* one of them is NULL */
    struct query_map *map;
    struct error_text error;
    bool failed;
};

static bool take_argument(void *context, const char *key, const char *value)
{
    struct reading *reading = context;
    int result = reading->picture != NULL
                     ? query_picture_take(reading->picture, key, value, &reading->error)
                     : query_map_take(reading->map, key, value, &reading->error);
    reading->failed = result != 0;
    return result == 0;
}

/* Returns false if the query is wrong; then the reply says why. */
static bool read_query(const struct stream_client *client, struct reading *reading,
                       struct http_reply *reply)
{
    char words[sizeof reading->error.text + 2];
    http_arguments(client->request, take_argument, reading);
    if (!reading->failed)
        return true;
    snprintf(words, sizeof words, "%s\n", reading->error.text);
    stream_refuse(reply, 400, words);
    return false;
}

static void reply_numbered(struct http_reply *reply, const struct stream_view *view)
{
    stream_reply_jpeg(reply, view->jpeg);
    if (view->number == 0)
        return;
    http_reply_add(reply, "X-Picture", "%llu", (unsigned long long)view->number);
    http_reply_add(reply, "X-Frame", "%llu", (unsigned long long)view->jpeg->frame);
    http_reply_add(reply, "X-Time", "%.4f", view->jpeg->time_s);
}

/* Empties a view before it is used for another key. */
static void clear_view(struct stream_view *view)
{
    picture_release(view->unencoded);
    stream_release(view->jpeg);
    *view = (struct stream_view){.unencoded = NULL};
}

/* --- pictures ----------------------------------------------------------------------------------*/

/* Finds or makes the request's row. Returns false when all are in use. */
static bool hold_row(struct stream_client *client, const struct picture_requests_key *key,
                     uint64_t now_ns)
{
    struct stream *stream = client->stream;
    uint64_t generations = stream->requests.generations;
    uint32_t row = picture_requests_ask(&stream->requests, key, now_ns);
    if (row == PICTURE_REQUESTS_NONE)
        return false;
    client->row = &stream->requests.row[row];
    client->row->unanswered++;
    client->view = &stream->request_view[row];
    if (stream->requests.generations != generations) {
        clear_view(client->view);
        stream->again[row] = false;
    }
    return true;
}

/* Returns true if the view's present picture answers the query. */
static bool is_enough(const struct stream_view *view, const struct query_picture *query,
                      uint64_t now_ns)
{
    if (view->jpeg == NULL)
        return false;
    return query->after_given ? view->number != query->after && view->unencoded == NULL &&
                                    now_ns < view->shown_ns + STALE_NS
                              : now_ns < view->shown_ns + NEW_NS;
}

/* Answers and leaves the row, so that a client that reads slowly does not occupy it. */
static bool answer_picture(struct stream_client *client, struct http_reply *reply)
{
    const struct stream_view *view = client->view;
    struct picture_requests *row = client->row;
    char words[128];
    stream_requests_end(client);
    if (row->gone) {
        snprintf(words, sizeof words, "there is no vehicle %u, or no more\n", row->key.vehicle);
        picture_requests_forget(row);
        stream_refuse(reply, 404, words);
    } else if (view->jpeg == NULL) {
        stream_refuse(reply, 503, "no picture within a second; ask again\n");
    } else {
        reply_numbered(reply, view);
    }
    return true;
}

bool stream_requests_picture(struct stream_client *client, struct http_reply *reply)
{
    struct stream *stream = client->stream;
    struct query_picture query;
    struct reading reading = {.picture = &query};
    uint64_t now_ns = clock_now_ns();
    if (client->row != NULL) /* it has waited */
        return answer_picture(client, reply);
    query_picture_begin(&query);
    if (!read_query(client, &reading, reply))
        return true;
    if (!hold_row(client, &query.key, now_ns)) {
        stream_refuse(reply, 503,
                      "8 different pictures are drawn already, and no more at a time; ask for one "
                      "of those, or again in 2 s\n");
        return true;
    }
    if (is_enough(client->view, &query, now_ns) || stream->ending)
        return answer_picture(client, reply);
    uint32_t row = (uint32_t)(client->row - stream->requests.row);
    stream->again[row] |= !query.after_given || client->view->number != query.after;
    stream->request_count++;
    client->row->gone = false;
    client->until_ns = now_ns + WAIT_NS;
    pthread_cond_signal(&stream->draw_cond);
    return stream_wait_here(client);
}

/* --- maps --------------------------------------------------------------------------------------*/

static bool is_same_map(const struct query_map *a, const struct query_map *b)
{
    return a->x == b->x && a->z == b->z && a->metres == b->metres && a->width == b->width &&
           a->height == b->height;
}

/* Returns the map of this key, else a free place, else that of the least recently requested map
 * that no client waits for; NULL when there is none. */
static struct stream_map *find_map(struct stream *stream, const struct query_map *key)
{
    struct stream_map *found = NULL;
    for (uint32_t i = 0; i < STREAM_MAPS; i++) {
        struct stream_map *map = &stream->map[i];
        if (map->used && is_same_map(&map->key, key))
            return map;
        if (map->unanswered > 0 || map->to_paint)
            continue;
        if (found == NULL || !map->used || (found->used && map->requested_ns < found->requested_ns))
            found = map;
    }
    if (found != NULL) {
        clear_view(&found->view);
        *found = (struct stream_map){.key = *key, .used = true, .view = found->view};
    }
    return found;
}

static bool answer_map(struct stream_client *client, struct http_reply *reply)
{
    stream_requests_end(client);
    if (client->view->jpeg == NULL)
        stream_refuse(reply, 503, "the map is not ready; ask again\n");
    else
        reply_numbered(reply, client->view);
    return true;
}

bool stream_requests_map(struct stream_client *client, struct http_reply *reply)
{
    struct stream *stream = client->stream;
    struct query_map query;
    struct reading reading = {.map = &query};
    if (client->map != NULL) /* it has waited */
        return answer_map(client, reply);
    query_map_begin(&query, stream->painter.side_m);
    if (!read_query(client, &reading, reply))
        return true;
    struct stream_map *map = find_map(stream, &query);
    if (map == NULL) {
        stream_refuse(reply, 503, "16 maps are being painted already; ask again\n");
        return true;
    }
    map->requested_ns = clock_now_ns();
    map->unanswered++;
    client->map = map;
    client->view = &map->view;
    if (map->view.jpeg != NULL || stream->ending)
        return answer_map(client, reply);
    map->to_paint = true;
    client->until_ns = map->requested_ns + MAP_WAIT_NS;
    pthread_cond_signal(&stream->paint_cond);
    return stream_wait_here(client);
}

/* Returns the map whose last request is the oldest; NULL: none. Under the lock. */
static struct stream_map *next_map(struct stream *stream)
{
    struct stream_map *next = NULL;
    for (uint32_t i = 0; i < STREAM_MAPS; i++)
        if (stream->map[i].to_paint &&
            (next == NULL || stream->map[i].requested_ns < next->requested_ns))
            next = &stream->map[i];
    return next;
}

/* Paints and encodes a map. Without the lock. Returns NULL when there is no memory. */
static struct stream_jpeg *make_map(const struct stream_painter *painter,
                                    const struct query_map *key)
{
    struct image image;
    struct stream_jpeg *jpeg = NULL;
    if (image_init(&image, key->width, key->height) != 0)
        return NULL;
    if (painter->paint(painter->self, key, &image) == 0)
        jpeg = stream_encode(&image, 0, 0.0);
    image_free(&image);
    return jpeg;
}

void *stream_paint(void *argument)
{
    struct stream *stream = argument;
    process_lower_priority(OUTPUT_QUEUE_NICENESS); /* this thread's alone */
    pthread_mutex_lock(&stream->lock);
    while (!stream->ending) {
        struct stream_map *map = next_map(stream);
        if (map == NULL) {
            pthread_cond_wait(&stream->paint_cond, &stream->lock);
            continue;
        }
        struct query_map key = map->key; /* its place is not reused meanwhile */
        pthread_mutex_unlock(&stream->lock);
        struct stream_jpeg *jpeg = make_map(&stream->painter, &key);
        pthread_mutex_lock(&stream->lock);
        map->to_paint = false;
        map->view.jpeg = jpeg;
        stream_http_wake(stream, &map->view);
    }
    pthread_mutex_unlock(&stream->lock);
    return NULL;
}

/* --- the end of a request ----------------------------------------------------------------------*/

void stream_requests_end(struct stream_client *client)
{
    if (client->row != NULL)
        client->row->unanswered--;
    if (client->map != NULL)
        client->map->unanswered--;
    client->row = NULL;
    client->map = NULL;
}

/* --- the drawing thread's side -----------------------------------------------------------------*/

uint32_t stream_requests_read(struct stream *stream, struct stream_request *requests)
{
    uint64_t now_ns = clock_now_ns();
    uint32_t waiting = 0;
    pthread_mutex_lock(&stream->lock);
    stream->request_count_seen = stream->request_count;
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++) {
        const struct picture_requests *row = &stream->requests.row[i];
        requests[i] = (struct stream_request){.generation = 0};
        if (!picture_requests_lives(row, now_ns))
            continue;
        requests[i] = (struct stream_request){.key = row->key,
                                              .generation = row->generation,
                                              .waiting = stream->request_view[i].waiters > 0,
                                              .again = stream->again[i]};
        waiting += requests[i].waiting ? 1 : 0;
    }
    pthread_mutex_unlock(&stream->lock);
    return waiting;
}

void stream_requests_answer(struct stream *stream, uint32_t row, uint64_t generation,
                            struct picture *picture)
{
    pthread_mutex_lock(&stream->lock);
    struct stream_view *view = &stream->request_view[row];
    if (stream->requests.row[row].generation == generation) {
        stream->again[row] = false;
        stream->requests.row[row].gone = picture == NULL;
        picture_release(view->unencoded);
        view->unencoded = picture != NULL ? picture_hold(picture) : NULL;
        if (picture == NULL)
            stream_http_wake(stream, view);
        else if (view->waiters > 0)
            pthread_cond_signal(&stream->encode_cond);
    }
    pthread_mutex_unlock(&stream->lock);
}

void stream_requests_wait(struct stream *stream, uint64_t until_ns)
{
    const struct timespec at = {.tv_sec = (time_t)(until_ns / NS_PER_S),
                                .tv_nsec = (long)(until_ns % NS_PER_S)};
    pthread_mutex_lock(&stream->lock);
    if (stream->request_count == stream->request_count_seen)
        pthread_cond_timedwait(&stream->draw_cond, &stream->lock, &at);
    pthread_mutex_unlock(&stream->lock);
}
