/* Events chosen by whom they concern. */
#include "drive/news.h"

#include "topics/tell.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void news_format(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event)
{
    uint32_t ids[TELL_IDS];
    char words[TAIL_LINE_MAX];
    tell_ids(ids, topic, event);
    tell_event(words, topic, event);
    int used = 0;
    for (int i = 0; i < TELL_IDS; i++)
        used += snprintf(line + used, TAIL_LINE_MAX - (size_t)used, "%u ", ids[i]);
    (void)snprintf(line + used, TAIL_LINE_MAX - (size_t)used, "%.*s", (int)NEWS_MAX, words);
}

bool news_take(void *context, const char *line)
{
    struct news *news = context;
    const struct session *session = news->session;
    bool concerns = false;
    for (int i = 0; i < TELL_IDS; i++) {
        char *end;
        unsigned long id = strtoul(line, &end, 10);
        concerns = concerns || (id != 0 && (id == session->vehicle || id == session->aimed));
        line = *end ? end + 1 : end;
    }
    if (concerns)
        (void)snprintf(news->line[news->count++ % NEWS_KEPT], NEWS_MAX, "%s", line);
    return true;
}
