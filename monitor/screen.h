/* The screen: the picture in a terminal, 80 x 24 or any other size. One a process. */
#ifndef JOLON_MONITOR_SCREEN_H
#define JOLON_MONITOR_SCREEN_H

#include "monitor/map.h"
#include "topics/mirror.h"

#define SCREEN_EVENTS    128u
#define SCREEN_EVENT_MAX 128u

struct screen {
    struct map map;
    char event[SCREEN_EVENTS][SCREEN_EVENT_MAX]; /* a ring, [event_count % SCREEN_EVENTS] next */
    uint64_t event_count;
};

/* Takes the terminal over; -1 with the reason when its type is not known. */
int screen_open(struct screen *screen, struct reason *reason);

/* Gives it back as it was. */
void screen_close(void);

/* Adds a line to the events; a tail_print with a struct screen as context. */
bool screen_event(void *screen, const char *line);

void screen_draw(struct screen *screen, const struct mirror *mirror, uint64_t now_ns);

/* Takes the keys that were pressed: true when one of them means quit. Does not block. */
bool screen_quit(void);

#endif
