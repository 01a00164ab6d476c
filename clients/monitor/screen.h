/* Shows the world in a terminal of 80 x 24 characters or any other size. One a process. */
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
    uint64_t spark_frame;       /* frame of the last sample */
    bool begun;                 /* the state is set up for the world */
    bool utf8;                  /* the terminal shows UTF-8 */
    char event[SCREEN_EVENTS][SCREEN_EVENT_MAX]; /* a ring, [event_count % SCREEN_EVENTS] next */
    uint64_t event_count;
};

/* Starts curses. Returns 0, or -1 with the error if the terminal's type is not known. */
int screen_open(struct screen *screen, struct error_text *error);

/* Restores the terminal. */
void screen_close(struct screen *screen);

/* An event_merge_print whose context is a struct screen: adds a line to the events. */
bool screen_event(void *screen, const char *line);

/* Adds the latest frame time to the sparkline. */
void screen_sample(struct screen *screen, const struct world_mirror *mirror);

void screen_draw(struct screen *screen, const struct world_mirror *mirror, uint64_t now_ns);

/* Handles the keys that were pressed and returns true if there were any. Does not block. */
bool screen_keys(struct screen *screen, const struct world_mirror *mirror);

#endif
