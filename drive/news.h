/* The last events that concern the driven vehicle. */
#ifndef JOLON_DRIVE_NEWS_H
#define JOLON_DRIVE_NEWS_H

#include "drive/session.h"
#include "topics/tail.h"

#define NEWS_KEPT 32u
#define NEWS_MAX  120u

struct news {
    const struct session *session;
    char line[NEWS_KEPT][NEWS_MAX]; /* a ring, [count % NEWS_KEPT] next */
    uint64_t count;
};

/* A tail_format that puts the ids before the words, for news_take. */
void news_format(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event);

/* A tail_print with a struct news as context: keeps what concerns the vehicle or its last target.
 */
bool news_take(void *news, const char *line);

#endif
