/* The screen: the mirror in a terminal, 80 x 24 or any other size. One a process. */
#ifndef JOLON_CLIENTS_MONITOR_SCREEN_H
#define JOLON_CLIENTS_MONITOR_SCREEN_H

#include "clients/monitor/screen_state.h"
#include "clients/monitor/character_map.h"
#include "clients/monitor/sparkline.h"
#include "ipc/topics/world_mirror.h"

#define SCREEN_EVENTS    4096u
#define SCREEN_EVENT_MAX 128u

struct screen {
    struct screen_state state;
    struct character_map map;
    struct vehicle_table table;
    struct sparkline sparkline; /* [ms] the longest frame between two samples of FrameStatus */
    uint64_t spark_frame;       /* of the last of them */
    bool begun;                 /* the desk knows its world */
    bool utf8;                  /* the terminal shows its characters */
    char event[SCREEN_EVENTS][SCREEN_EVENT_MAX]; /* a ring, [event_count % SCREEN_EVENTS] next */
    uint64_t event_count;
};

/* Takes the terminal over; -1 with the reason when its type is not known. */
int screen_open(struct screen *screen, struct error_text *error);

/* Gives it back as it was. */
void screen_close(struct screen *screen);

/* Adds a line to the events; a event_merge_print with a struct screen as context. */
bool screen_event(void *screen, const char *line);

/* Notes how long frames take now. */
void screen_sample(struct screen *screen, const struct world_mirror *mirror);

void screen_draw(struct screen *screen, const struct world_mirror *mirror, uint64_t now_ns);

/* Takes the keys that were pressed; true when there were any. desk.quit says the rest. Does not
 * block. */
bool screen_keys(struct screen *screen, const struct world_mirror *mirror);

#endif
