/* Channels, and who waits on them. */
#include "clients/console/picture_proxy.h"

#include "clients/console/renderer_client.h"
#include "ipc/process/clock.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FRESH_NS   25000000ull   /* a picture so young is as good as a new one */
#define LASTING_NS 2000000000ull /* the same of a map: craters come, and that is all */
#define AWAY_NS    200000000ull  /* who is away is not asked for again so soon */
#define FETCHES    2u            /* that one who waits sees, at most */
#define VALUE_MAX  24u

/* --- what is asked for -------------------------------------------------------------------------*/

static bool put_value(const struct query *query, const char *key, char target[PICTURE_PROXY_TARGET],
                      struct http_answer *answer)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-";
    const char *value = query_text(query, key);
    size_t used = strlen(target), length = strspn(value, letters);
    if (value[length] != '\0' || length > VALUE_MAX) {
        http_answer_error(answer, HTTP_ANSWER_BAD, "docs/pictures.md says what can be asked for",
                          "%s=%.40s: no such value", key, value);
        return false;
    }
    if (length > 0)
        (void)snprintf(target + used, PICTURE_PROXY_TARGET - used, "%c%s=%s",
                       strchr(target, '?') ? '&' : '?', key, value);
    return true;
}

bool picture_proxy_target(const struct query *query, bool map, char target[PICTURE_PROXY_TARGET],
                          struct gaze *gaze, struct http_answer *answer)
{
    static const char *const of_picture[] = {"view", "vehicle", "size", "bar"};
    static const char *const of_map[] = {"x", "z", "metres", "size"};
    const char *const *keys = map ? of_map : of_picture;
    (void)snprintf(target, PICTURE_PROXY_TARGET, "%s", map ? "/map.jpg" : "/picture.jpg");
    for (size_t i = 0; i < sizeof of_map / sizeof of_map[0]; i++) {
        if (!put_value(query, keys[i], target, answer))
            return false;
    }
    gaze->has_after = !map && *query_text(query, "after");
    return map || query_whole(query, "after", 0, UINT64_MAX / 16, 0, &gaze->after, answer);
}

/* --- copies ------------------------------------------------------------------------------------*/

void picture_proxy_release(struct picture_copy *copy)
{
    if (!copy || atomic_fetch_sub(&copy->holders, 1) > 1)
        return;
    free(copy->bytes);
    free(copy);
}

static struct picture_copy *hold(struct picture_copy *copy)
{
    atomic_fetch_add(&copy->holders, 1);
    return copy;
}

void picture_proxy_explain(const struct picture_copy *copy, struct http_answer *answer)
{
    if (!copy || copy->status == 0) {
        http_answer_error(answer, HTTP_ANSWER_AWAY,
                          "it comes back by itself when it was killed; the process table shows it",
                          "nobody draws pictures of this world just now");
        return;
    }
    int length = copy->body_bytes < 300 ? (int)copy->body_bytes : 300;
    while (length > 0 && copy->body[length - 1] == '\n')
        length--;
    enum http_answer_status status = copy->status == 400   ? HTTP_ANSWER_BAD
                                     : copy->status == 404 ? HTTP_ANSWER_NOT_FOUND
                                                           : HTTP_ANSWER_AWAY;
    http_answer_error(answer, status, "docs/pictures.md says what can be asked for", "%.*s", length,
                      copy->body);
}

/* --- asking ------------------------------------------------------------------------------------*/

/* The target's channel: the one it has, a free one, or the one that was longest not asked for. */
static struct channel *find_channel(struct picture_proxy *pictures, const char *target)
{
    struct channel *found = NULL;
    for (uint32_t i = 0; i < PICTURE_PROXY_CHANNELS; i++) {
        struct channel *channel = &pictures->channel[i];
        if (strcmp(channel->target, target) == 0)
            return channel;
        if (!channel->fetching && !channel->waiting &&
            (!found || channel->asked_ns < found->asked_ns))
            found = channel;
    }
    if (found) {
        picture_proxy_release(found->copy);
        *found = (struct channel){.lasting = strncmp(target, "/map", 4) == 0};
        (void)snprintf(found->target, sizeof found->target, "%s", target);
    }
    return found;
}

/* Will what there is do? */
static bool is_enough(const struct channel *channel, const struct gaze *gaze, uint64_t now_ns)
{
    const struct picture_copy *copy = channel->copy;
    uint64_t age_ns = now_ns - channel->copied_ns;
    if (!copy)
        return false;
    if (copy->status != 200)
        return age_ns < AWAY_NS;
    if (channel->lasting)
        return age_ns < LASTING_NS;
    return gaze->has_after ? copy->number != gaze->after && age_ns < 2 * FRESH_NS
                           : age_ns < FRESH_NS;
}

bool picture_proxy_ask(struct picture_proxy *pictures, const char *target, struct gaze *gaze,
                       struct http_answer *answer)
{
    uint64_t now_ns = clock_now_ns();
    pthread_mutex_lock(&pictures->lock);
    struct channel *channel = pictures->ending ? NULL : find_channel(pictures, target);
    bool now = !channel || is_enough(channel, gaze, now_ns);
    if (!channel) {
        http_answer_error(answer, HTTP_ANSWER_AWAY, "look at what others look at, or ask again",
                          "more than %u different pictures are asked for", PICTURE_PROXY_CHANNELS);
    } else if (now) {
        gaze->copy = hold(channel->copy);
        gaze->done = true;
    } else {
        gaze->next = channel->waiting;
        channel->waiting = gaze;
        pthread_cond_signal(&pictures->come);
    }
    if (channel)
        channel->asked_ns = now_ns;
    pthread_mutex_unlock(&pictures->lock);
    return now;
}

/* --- fetching ----------------------------------------------------------------------------------*/

static struct channel *next_channel(struct picture_proxy *pictures)
{
    for (uint32_t i = 0; i < PICTURE_PROXY_CHANNELS; i++) {
        struct channel *channel = &pictures->channel[(pictures->turn + i) % PICTURE_PROXY_CHANNELS];
        if (channel->waiting && !channel->fetching) {
            pictures->turn = (uint32_t)(channel - pictures->channel) + 1;
            return channel;
        }
    }
    return NULL;
}

/* The picture that all who wait have already: a newer one than that is wanted. 0: any will do. */
static uint64_t all_have(const struct channel *channel)
{
    uint64_t after = channel->waiting->after;
    for (const struct gaze *gaze = channel->waiting; gaze; gaze = gaze->next) {
        if (!gaze->has_after || gaze->after != after)
            return 0;
    }
    return after;
}

/* Takes those out for whom the channel's copy will do, or who have waited long enough: `begun` and
 * those behind it waited when the fetch began, which counts as so many. */
static struct gaze *take_satisfied(struct channel *channel, struct gaze *begun, uint32_t fetches)
{
    struct gaze *satisfied = NULL, **at = &channel->waiting;
    bool old = false;
    while (*at) {
        struct gaze *gaze = *at;
        const struct picture_copy *copy = channel->copy;
        old = old || gaze == begun;
        gaze->fetches += old ? fetches : 0;
        bool other = !gaze->has_after || (copy && copy->number != gaze->after);
        if (!copy || copy->status != 200 || gaze->fetches >= FETCHES || (old && other)) {
            *at = gaze->next;
            gaze->copy = copy ? hold(channel->copy) : NULL;
            gaze->done = true;
            gaze->next = satisfied;
            satisfied = gaze;
        } else {
            at = &gaze->next;
        }
    }
    return satisfied;
}

/* Under the lock, which it leaves meanwhile. */
static void serve(struct picture_proxy *pictures, struct channel *channel)
{
    char target[PICTURE_PROXY_TARGET];
    struct gaze *begun = channel->waiting;
    uint64_t after = all_have(channel);
    memcpy(target, channel->target, sizeof target);
    channel->fetching = true;
    pthread_mutex_unlock(&pictures->lock);
    struct picture_copy *copy =
        renderer_client(pictures->world, target, after, clock_now_ns() + PICTURE_PROXY_FETCH_NS);
    pthread_mutex_lock(&pictures->lock);
    picture_proxy_release(channel->copy);
    channel->copy = copy;
    channel->copied_ns = clock_now_ns();
    channel->fetching = false;
    struct gaze *satisfied = take_satisfied(channel, begun, after ? FETCHES : 1);
    pthread_mutex_unlock(&pictures->lock);
    while (satisfied) {
        struct gaze *gaze = satisfied;
        satisfied = gaze->next; /* it is another's as soon as it is ready */
        gaze->ready(gaze);
    }
    pthread_mutex_lock(&pictures->lock);
}

static void *run(void *argument)
{
    struct picture_proxy *pictures = argument;
    struct channel *channel;
    pthread_mutex_lock(&pictures->lock);
    for (;;) {
        if ((channel = next_channel(pictures)) != NULL)
            serve(pictures, channel);
        else if (pictures->ending)
            break;
        else
            pthread_cond_wait(&pictures->come, &pictures->lock);
    }
    pthread_mutex_unlock(&pictures->lock);
    return NULL;
}

int picture_proxy_open(struct picture_proxy *pictures, const char *world, struct reason *reason)
{
    sigset_t all, before;
    int cause = 0;
    *pictures = (struct picture_proxy){.world = world};
    pthread_mutex_init(&pictures->lock, NULL);
    pthread_cond_init(&pictures->come, NULL);
    sigfillset(&all); /* signals are the first thread's */
    sigdelset(&all, SIGSYS);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    while (pictures->threads < PICTURE_PROXY_THREADS && cause == 0) {
        cause = pthread_create(&pictures->thread[pictures->threads], NULL, run, pictures);
        pictures->threads += cause == 0;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (cause == 0)
        return 0;
    picture_proxy_close(pictures);
    return reason_set(reason, "cannot start a thread for pictures: %s", strerror(cause));
}

void picture_proxy_close(struct picture_proxy *pictures)
{
    pthread_mutex_lock(&pictures->lock);
    pictures->ending = true;
    pthread_cond_broadcast(&pictures->come);
    pthread_mutex_unlock(&pictures->lock);
    while (pictures->threads > 0)
        pthread_join(pictures->thread[--pictures->threads], NULL);
    for (uint32_t i = 0; i < PICTURE_PROXY_CHANNELS; i++)
        picture_proxy_release(pictures->channel[i].copy);
}
