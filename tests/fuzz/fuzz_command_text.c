/* Commands as JSON, as jolon harness and jolon console accept them from any client. */
#include "tests/fuzz/support.h"

#include "ipc/topics/command_json.h"
#include "world/runtime/check.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <string.h>

static void check(struct command_text *order)
{
    struct error_text error;
    const struct name_table none = {.known = true};
    const jolon_Command *c = &order->command;
    CHECK(order->verb && (order->given & ~order->verb->allowed) == 0 &&
          (order->verb->needed & ~order->given) == 0);
    CHECK(memchr(c->kind, '\0', sizeof c->kind) &&
          memchr(order->vehicle, '\0', sizeof order->vehicle) &&
          memchr(order->target, '\0', sizeof order->target));
    CHECK(c->force <= jolon_FORCE_RED && c->behaviour <= jolon_BEHAVIOUR_PATROL &&
          c->gear <= jolon_GEAR_LOW);
    CHECK(c->throttle >= -1.0F && c->throttle <= 1.0F && c->brake >= 0.0F && c->brake <= 1.0F);
    CHECK(isfinite(c->x_m) && isfinite(c->z_m) && isfinite(c->altitude_m) &&
          isfinite(c->heading_rad) && isfinite(c->speed_mps) && isfinite(c->scale));
    CHECK(order->rounds >= 1 && order->rounds <= COMMAND_TEXT_ROUNDS_MAX);
    CHECK(command_text_needs_names(order) ==
          (command_text_resolve(order, &none, 60.0, &error) != 0));
    jolon_Command round = command_text_round(order, 7, order->rounds - 1);
    CHECK(round.x_m >= 0.0 && round.x_m <= WORLD_SIDE_MAX_M && round.z_m >= 0.0 &&
          round.z_m <= WORLD_SIDE_MAX_M);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct command_text order;
    struct error_text error = {.text = ""};
    cJSON *object = cJSON_ParseWithLength((const char *)data, size);
    if (command_from_json(&order, object, &error) == 0)
        check(&order);
    else
        CHECK(error.text[0] && strlen(error.text) < sizeof error.text - 1);
    cJSON_Delete(object);
    return 0;
}
