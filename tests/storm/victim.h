/* What is done to whom, and when: drawn from the seed, but that victims are those who live then. */
#ifndef JOLON_TESTS_STORM_VICTIM_H
#define JOLON_TESTS_STORM_VICTIM_H

#include "tests/storm/band.h"
#include "tests/storm/watcher.h"

#define PENDING_MAX 32

struct victims {
    struct band *band;
    struct watcher *watcher;
    struct chance chance;
    uint64_t struck[STRUCK_ROLES + 1][DEED_COUNT];
    enum deed last;
    uint64_t done;      /* strikes that met a living process */
    uint64_t pairs;     /* rounds with two at once */
    uint64_t chased;    /* replacements struck within their first millisecond */
    uint64_t unborn;    /* ... before they held the role */
    uint64_t stand_bys; /* struck while another held the role */
    struct {
        int pidfd; /* -1: none */
        uint64_t due_ns;
    } pending[PENDING_MAX]; /* stopped ones, to be continued */
    struct {
        uint64_t commit; /* at the role's last strike */
        uint32_t count;  /* its strikes since a frame was committed */
    } fruitless[STRUCK_ROLES];
    int killed[STRUCK_ROLES]; /* the last one: dying takes a moment in which it cannot be told */
    struct error_text error;  /* why a round failed */
};

void victims_begin(struct victims *victims, struct band *band, struct watcher *watcher,
                   uint64_t seed);

/* One strike, or a few that belong together. -1 with the reason when the set is broken: nobody to
 * strike for 20 s, or it does not start again. */
int victims_round(struct victims *victims);

/* Waits until then; continues those whose time has come. */
void victims_wait(struct victims *victims, uint64_t until_ns);

/* Waits as long as it is until the next round. */
void victims_gap(struct victims *victims);

/* Continues or forgets all that are stopped. */
void victims_end(struct victims *victims);

#endif
