/* Commands as they come over DDS: any bytes as jolon_Command, through the reporter's check, and
 * those that pass, some at a time, through the mover's step on a small world. And any bytes as they
 * lie in a ring, whoever wrote them there: a replayed log, a damaged page. */
#include "tests/fuzz/support.h"

#include "ipc/log.h"
#include "ipc/segment.h"
#include "mover/step.h"
#include "reporter/check.h"

#include <math.h>
#include <string.h>

#define COMMANDS_MAX 16

static struct view view;
static struct mover mover;

/* What the mover and the renderer go by. */
static void check_checked(const struct command *command)
{
    CHECK(command->type > COMMAND_NONE && command->type < COMMAND_TYPE_COUNT);
    CHECK(command->kind == KIND_NONE || command->kind < view.world.counts.kinds);
    CHECK(command->force < FORCE_COUNT);
    for (size_t i = 0; i < sizeof command->value / sizeof command->value[0]; i++)
        CHECK(isfinite(command->value[i]));
}

static void check_moved(void)
{
    const struct entities *e = &view.m.entities;
    const struct state_head *head = view.m.head;
    CHECK(head->used <= view.header->capacity &&
          head->intent_count <= view.header->intents_per_frame);
    CHECK(head->time_scale >= 0.01 && head->time_scale <= 100.0);
    for (uint32_t i = 0; i < head->used; i++) {
        CHECK(e->state[i] == ENTITY_FREE || e->kind[i] < view.world.counts.kinds);
        CHECK(isfinite(e->x[i]) && isfinite(e->y[i]) && isfinite(e->z[i]));
        CHECK(isfinite(e->vx[i]) && isfinite(e->vy[i]) && isfinite(e->vz[i]));
        CHECK(isfinite(e->heading[i]));
    }
}

_Static_assert(sizeof(jolon_Command) == sizeof(struct command), "one input for either");

/* Checks bytes as they come over DDS; true when they are a command. */
static bool take_wire(struct command *command, const uint8_t *data)
{
    jolon_Command wire;
    memcpy(&wire, data, sizeof wire);
    wire.kind[sizeof wire.kind - 1] = '\0'; /* as the DDS library leaves a bounded string */
    enum command_result result = check_command(command, &wire, &view.world);
    CHECK(result < COMMAND_RESULT_COUNT);
    if (result == COMMAND_DONE)
        check_checked(command);
    return result == COMMAND_DONE;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct command ring[COMMANDS_MAX];
    struct command_source sources[COMMAND_RING_COUNT] = {
        {ring, COMMANDS_MAX, 0}, {ring, COMMANDS_MAX, 0}, {ring, COMMANDS_MAX, 0}};
    if (!view.base) {
        support_world(&view);
        CHECK(mover_init(&mover, &view.world, view.w[0].craters, NULL) == 0);
    }
    for (int n = 0; n < COMMANDS_MAX && size >= sizeof(struct command); n++) {
        struct command *command = &ring[sources[0].end];
        memcpy(command, data, sizeof *command);
        if (command->source <= INT64_MAX ? take_wire(command, data) : true)
            command->sequence = sources[0].end++;
        data += sizeof *command;
        size -= sizeof *command;
    }
    if (sources[0].end == 0)
        return 0;
    CHECK(mover_step(&mover, &view.w[0], &view.m, sources) == 0);
    check_moved();
    return 0;
}
