/* The screen: the mirror in a terminal, 80 x 24 or any other size. One a process. */
#ifndef JOLON_MONITOR_SCREEN_H
#define JOLON_MONITOR_SCREEN_H

#include "monitor/desk.h"
#include "monitor/map.h"
#include "monitor/spark.h"
#include "topics/mirror.h"

#define SCREEN_EVENTS    4096u
#define SCREEN_EVENT_MAX 128u

struct screen {
    struct desk desk;
    struct map map;
    struct table table;
    struct spark spark;   /* [ms] the longest frame between two samples of FrameStatus */
    uint64_t spark_frame; /* of the last of them */
    bool begun;           /* the desk knows its world */
    bool utf8;            /* the terminal shows its characters */
    char event[SCREEN_EVENTS][SCREEN_EVENT_MAX]; /* a ring, [event_count % SCREEN_EVENTS] next */
    uint64_t event_count;
};

/* Takes the terminal over; -1 with the reason when its type is not known. */
int screen_open(struct screen *screen, struct reason *reason);

/* Gives it back as it was. */
void screen_close(struct screen *screen);

/* Adds a line to the events; a tail_print with a struct screen as context. */
bool screen_event(void *screen, const char *line);

/* Notes how long frames take now. */
void screen_note(struct screen *screen, const struct mirror *mirror);

void screen_draw(struct screen *screen, const struct mirror *mirror, uint64_t now_ns);

/* Takes the keys that were pressed; true when there were any. desk.quit says the rest. Does not
 * block. */
bool screen_keys(struct screen *screen, const struct mirror *mirror);

#endif
