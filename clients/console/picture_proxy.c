/* Channels and the requests that wait on them. */
#include "clients/console/picture_proxy.h"

#include "clients/console/renderer_client.h"
#include "ipc/process/clock.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FRESH_NS   25000000ull   /* a younger picture counts as new */
#define LASTING_NS 2000000000ull /* the same for a map, in which only craters appear */
#define AWAY_NS    200000000ull  /* pause before an absent renderer is asked again */
#define FETCHES    2u            /* a request waits for at most so many */
#define VALUE_MAX  24u

/* --- requested pictures ------------------------------------------------------------------------*/

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
                          struct picture_waiter *waiter, struct http_answer *answer)
{
    static const char *const of_picture[] = {"view", "vehicle", "size", "bar"};
    static const char *const of_map[] = {"x", "z", "metres", "size"};
    const char *const *keys = map ? of_map : of_picture;
    (void)snprintf(target, PICTURE_PROXY_TARGET, "%s", map ? "/map.jpg" : "/picture.jpg");
    for (size_t i = 0; i < sizeof of_map / sizeof of_map[0]; i++) {
        if (!put_value(query, keys[i], target, answer))
            return false;
    }
    waiter->has_after = !map && *query_text(query, "after");
    return map || query_whole(query, "after", 0, UINT64_MAX / 16, 0, &waiter->after, answer);
}

/* --- copies ------------------------------------------------------------------------------------*/

void picture_proxy_release(struct picture_copy *copy)
{
    if (!copy || atomic_fetch_sub(&copy->holders, 1) > 1)
        return;
    free(copy->bytes);
    free(copy);
}

static struct picture_copy *retain(struct picture_copy *copy)
{
    atomic_fetch_add(&copy->holders, 1);
    return copy;
}

void picture_proxy_explain(const struct picture_copy *copy, struct http_answer *answer)
{
    if (!copy || copy->status == 0) {
        http_answer_error(answer, HTTP_ANSWER_AWAY,
                          "it is restarted if it was killed; the process table shows it",
                          "no renderer draws this world now");
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

/* The target's channel: its own one, a free one, or the least recently used one. */
static struct channel *find_channel(struct picture_proxy *proxy, const char *target)
{
    struct channel *found = NULL;
    for (uint32_t i = 0; i < PICTURE_PROXY_CHANNELS; i++) {
        struct channel *channel = &proxy->channel[i];
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

/* Returns true if the channel's copy is new enough for the request. */
static bool is_fresh(const struct channel *channel, const struct picture_waiter *waiter,
                     uint64_t now_ns)
{
    const struct picture_copy *copy = channel->copy;
    uint64_t age_ns = now_ns - channel->copied_ns;
    if (!copy)
        return false;
    if (copy->status != 200)
        return age_ns < AWAY_NS;
    if (channel->lasting)
        return age_ns < LASTING_NS;
    return waiter->has_after ? copy->number != waiter->after && age_ns < 2 * FRESH_NS
                             : age_ns < FRESH_NS;
}

bool picture_proxy_ask(struct picture_proxy *proxy, const char *target,
                       struct picture_waiter *waiter, struct http_answer *answer)
{
    uint64_t now_ns = clock_now_ns();
    pthread_mutex_lock(&proxy->lock);
    struct channel *channel = proxy->ending ? NULL : find_channel(proxy, target);
    bool now = !channel || is_fresh(channel, waiter, now_ns);
    if (!channel) {
        http_answer_error(answer, HTTP_ANSWER_AWAY, "ask for a picture that others see, or again",
                          "more than %u different pictures are asked for", PICTURE_PROXY_CHANNELS);
    } else if (now) {
        waiter->copy = retain(channel->copy);
        waiter->done = true;
    } else {
        waiter->next = channel->waiting;
        channel->waiting = waiter;
        pthread_cond_signal(&proxy->work);
    }
    if (channel)
        channel->asked_ns = now_ns;
    pthread_mutex_unlock(&proxy->lock);
    return now;
}

/* --- fetching ----------------------------------------------------------------------------------*/

static struct channel *next_channel(struct picture_proxy *proxy)
{
    for (uint32_t i = 0; i < PICTURE_PROXY_CHANNELS; i++) {
        struct channel *channel = &proxy->channel[(proxy->turn + i) % PICTURE_PROXY_CHANNELS];
        if (channel->waiting && !channel->fetching) {
            proxy->turn = (uint32_t)(channel - proxy->channel) + 1;
            return channel;
        }
    }
    return NULL;
}

/* Returns the number of the picture that all waiting pages have already, so that they need a newer
 * picture, or 0 if they have no such picture in common. */
static uint64_t common_picture(const struct channel *channel)
{
    uint64_t after = channel->waiting->after;
    for (const struct picture_waiter *waiter = channel->waiting; waiter; waiter = waiter->next) {
        if (!waiter->has_after || waiter->after != after)
            return 0;
    }
    return after;
}

/* Removes the requests that the channel's copy satisfies or that have waited for FETCHES fetches.
 * `begun` and the requests behind it were waiting when the fetch began. For them it counts as
 * `fetches`. */
static struct picture_waiter *take_satisfied(struct channel *channel, struct picture_waiter *begun,
                                             uint32_t fetches)
{
    struct picture_waiter *satisfied = NULL, **at = &channel->waiting;
    bool old = false;
    while (*at) {
        struct picture_waiter *waiter = *at;
        const struct picture_copy *copy = channel->copy;
        old = old || waiter == begun;
        waiter->fetches += old ? fetches : 0;
        bool other = !waiter->has_after || (copy && copy->number != waiter->after);
        if (!copy || copy->status != 200 || waiter->fetches >= FETCHES || (old && other)) {
            *at = waiter->next;
            waiter->copy = copy ? retain(channel->copy) : NULL;
            waiter->done = true;
            waiter->next = satisfied;
            satisfied = waiter;
        } else {
            at = &waiter->next;
        }
    }
    return satisfied;
}

/* Called under the lock, which it releases during the fetch. */
static void serve(struct picture_proxy *proxy, struct channel *channel)
{
    char target[PICTURE_PROXY_TARGET];
    struct picture_waiter *begun = channel->waiting;
    uint64_t after = common_picture(channel);
    memcpy(target, channel->target, sizeof target);
    channel->fetching = true;
    pthread_mutex_unlock(&proxy->lock);
    struct picture_copy *copy =
        renderer_client(proxy->world, target, after, clock_now_ns() + PICTURE_PROXY_FETCH_NS);
    pthread_mutex_lock(&proxy->lock);
    picture_proxy_release(channel->copy);
    channel->copy = copy;
    channel->copied_ns = clock_now_ns();
    channel->fetching = false;
    struct picture_waiter *satisfied = take_satisfied(channel, begun, after ? FETCHES : 1);
    pthread_mutex_unlock(&proxy->lock);
    while (satisfied) {
        struct picture_waiter *waiter = satisfied;
        satisfied = waiter->next; /* ready() gives the waiter away */
        waiter->ready(waiter);
    }
    pthread_mutex_lock(&proxy->lock);
}

static void *run(void *argument)
{
    struct picture_proxy *proxy = argument;
    struct channel *channel;
    pthread_mutex_lock(&proxy->lock);
    for (;;) {
        if ((channel = next_channel(proxy)) != NULL)
            serve(proxy, channel);
        else if (proxy->ending)
            break;
        else
            pthread_cond_wait(&proxy->work, &proxy->lock);
    }
    pthread_mutex_unlock(&proxy->lock);
    return NULL;
}

int picture_proxy_open(struct picture_proxy *proxy, const char *world, struct error_text *error)
{
    sigset_t all, before;
    int cause = 0;
    *proxy = (struct picture_proxy){.world = world};
    pthread_mutex_init(&proxy->lock, NULL);
    pthread_cond_init(&proxy->work, NULL);
    sigfillset(&all); /* the main thread handles signals */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    while (proxy->threads < PICTURE_PROXY_THREADS && cause == 0) {
        cause = pthread_create(&proxy->thread[proxy->threads], NULL, run, proxy);
        proxy->threads += cause == 0;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (cause == 0)
        return 0;
    picture_proxy_close(proxy);
    return error_text_set(error, "cannot start a thread for pictures: %s", strerror(cause));
}

void picture_proxy_close(struct picture_proxy *proxy)
{
    pthread_mutex_lock(&proxy->lock);
    proxy->ending = true;
    pthread_cond_broadcast(&proxy->work);
    pthread_mutex_unlock(&proxy->lock);
    while (proxy->threads > 0)
        pthread_join(proxy->thread[--proxy->threads], NULL);
    for (uint32_t i = 0; i < PICTURE_PROXY_CHANNELS; i++)
        picture_proxy_release(proxy->channel[i].copy);
}
