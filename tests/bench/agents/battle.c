/* Runs a battle as fast as it goes, reports it, and judges one of half an hour. */
#include "tests/bench/agents/battle_count.h"
#include "tests/bench/agents/battle_report.h"
#include "tests/bench/bench.h"
#include "tests/bench/world.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/frame_stepper.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define JUDGED_S 1800.0 /* a shorter run, or a world without missions, is not judged */

int bench_battle(struct bench_options options)
{
    struct view view;
    struct frame_stepper stepper;
    struct battle_count *count = malloc(sizeof *count);
    bench_world_open(&view, options.file, BENCH_SCENARIO_VEHICLES);
    if (!count || !battle_count_begin(count, &view) ||
        frame_stepper_init(&stepper, &view, options.threads) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    for (uint32_t i = 0; i < options.frames; i++) {
        uint64_t from = view.w[i & 1].head->event_end;
        frame_stepper_step(&stepper, NULL);
        battle_count_frame(count, &view, &view.w[i & 1], &view.w[(i + 1) & 1], from);
    }
    frame_stepper_free(&stepper);
    battle_report(count, &view, options.frames);
    bool judged =
        view.world.counts.missions > 0 && (double)options.frames * count->dt_s >= JUDGED_S;
    uint32_t wrong = judged ? battle_report_wrong(count, &view) : 0;
    battle_count_free(count);
    free(count);
    segment_abandon(&view);
    return wrong > 0 ? EXIT_REFUSED : EXIT_OK;
}
