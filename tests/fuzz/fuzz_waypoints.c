/* Files of waypoints beside a scenario. */
#include "tests/fuzz/support.h"

#include "config/waypoints.h"
#include "ipc/process/log.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"
#include "world/runtime/check.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void check_steps(const struct scenario_step *steps, int count)
{
    double before_s = -1.0;
    for (int i = 0; i < count; i++) {
        const struct script_step *step = &steps[i].step;
        CHECK(step->type == STEP_ARRIVE && steps[i].line > 1);
        CHECK(isfinite(step->at_s) && step->at_s > before_s && step->at_s <= 1e7);
        CHECK(step->x >= 0.0 && step->x <= WORLD_SIDE_DEFAULT_M && step->z >= 0.0 &&
              step->z <= WORLD_SIDE_DEFAULT_M);
        CHECK(step->altitude_m == STEP_SAME_ALTITUDE ||
              (step->altitude_m >= 0.0 && step->altitude_m <= 20000.0));
        before_s = step->at_s;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error_text error;
    char *text = malloc(size + 1);
    CHECK(text);
    memcpy(text, data, size);
    text[size] = '\0';
    struct source source = {.path = "w.csv", .text = text, .bytes = size};
    uint32_t lines = waypoints_lines(text);
    /* Not one step more: the sanitizer detects a step beyond the end. */
    struct scenario_step *steps = malloc(lines * sizeof *steps);
    CHECK(steps || lines == 0);
    struct location_frame frame;
    location_frame_make(&frame, 44.28, -71.28, WORLD_SIDE_DEFAULT_M);
    int count = waypoints_read(&source, &frame, steps, &error);
    if (count < 0)
        support_check_line(&error);
    else
        check_steps(steps, count);
    CHECK(count == -1 || (count > 0 && (uint32_t)count < lines));
    free(steps);
    free(text);
    return 0;
}
