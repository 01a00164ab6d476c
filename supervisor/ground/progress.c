/* Progress on a terminal. */
#include "supervisor/ground/progress.h"

#include "ipc/process/clock.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static uint64_t shown_ns;
static bool shown;

void progress_show(const char *step, uint32_t done, uint32_t of)
{
    uint64_t now_ns = clock_now_ns();
    if (now_ns - shown_ns < NS_PER_S / 10 || !isatty(STDERR_FILENO))
        return;
    shown_ns = now_ns;
    shown = true;
    (void)fprintf(stderr, "\r%s: %u %%\033[K", step, (uint32_t)((uint64_t)done * 100 / of));
}

void progress_count(const char *map, const char *layer, uint32_t features)
{
    const char *slash = strrchr(map, '/');
    uint64_t now_ns = clock_now_ns();
    if ((features > 0 && now_ns - shown_ns < NS_PER_S / 10) || !isatty(STDERR_FILENO))
        return;
    shown_ns = now_ns;
    shown = true;
    (void)fprintf(stderr, "\r%.40s, %.20s: %u\033[K", slash ? slash + 1 : map, layer, features);
}

void progress_end(void)
{
    if (shown)
        (void)fputs("\r\033[K", stderr);
    shown = false;
}
