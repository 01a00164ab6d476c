/* Commands as received over DDS: any bytes as a jolon_Command go through the reporter's check, and
 * those that pass go, some at a time, through the mover's step of a small world. Also any bytes as
 * a command in a ring, as a replayed log or a damaged page may hold. */
#include "tests/fuzz/support.h"

#include "ipc/segment/segment.h"
#include "mover/step.h"
#include "reporter/intake/command_check.h"
#include "world/runtime/check.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define COMMANDS_MAX 16

static struct view view;
static struct mover mover;

/* Checks the values that mover and renderer use. */
static void check_checked(const struct command *command)
{
    CHECK(command->type > COMMAND_NONE && command->type < COMMAND_TYPE_COUNT);
    CHECK(command->kind == KIND_NONE || command->kind < view.world.counts.kinds);
    CHECK(command->force < (command->type == COMMAND_DRIVE ? (int)GEAR_COUNT : (int)FORCE_COUNT));
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
        CHECK(e->row[i].state == ENTITY_FREE || e->row[i].kind < view.world.counts.kinds);
        CHECK(isfinite(e->row[i].x) && isfinite(e->row[i].y) && isfinite(e->row[i].z));
        CHECK(isfinite(e->row[i].vx) && isfinite(e->row[i].vy) && isfinite(e->row[i].vz));
        CHECK(isfinite(e->row[i].heading));
    }
}

/* Checks bytes as received over DDS. Returns true when they are a command. */
static bool take_wire(struct command *command, const uint8_t *data)
{
    jolon_Command wire;
    uint8_t bytes[sizeof wire];
    memcpy(bytes, data, sizeof wire);
    bytes[offsetof(jolon_Command, anyway)] &= 1; /* the DDS library rejects other booleans */
    memcpy(&wire, bytes, sizeof wire);
    wire.kind[sizeof wire.kind - 1] = '\0'; /* the DDS library terminates bounded strings */
    enum command_result result = command_check(command, &wire, &view.world);
    CHECK(result < COMMAND_RESULT_COUNT);
    if (result == COMMAND_DONE)
        check_checked(command);
    return result == COMMAND_DONE;
}

/* Reads the next command: a struct command of a ring when its source is above INT64_MAX, otherwise
 * a jolon_Command. Returns the number of bytes, 0 when no whole command is left. good: whether it
 * is to be executed. */
static size_t take_next(struct command *command, const uint8_t *data, size_t size, bool *good)
{
    uint64_t source = 0;
    if (size < sizeof source)
        return 0;
    memcpy(&source, data, sizeof source);
    size_t bytes = source > INT64_MAX ? sizeof *command : sizeof(jolon_Command);
    if (size < bytes)
        return 0;
    if (source > INT64_MAX)
        memcpy(command, data, sizeof *command);
    *good = source > INT64_MAX || take_wire(command, data);
    return bytes;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct command ring[COMMANDS_MAX];
    struct command_source sources[COMMAND_RING_COUNT] = {
        [RING_CLIENTS] = {ring, COMMANDS_MAX, 0}, [RING_RECORDER] = {ring, COMMANDS_MAX, 0}};
    if (!view.base) {
        support_world(&view);
        CHECK(mover_init(&mover, &view.world, view.w[0].craters, NULL) == 0);
    }
    for (int n = 0; n < COMMANDS_MAX; n++) {
        struct command *command = &ring[sources[0].end];
        bool good = false;
        size_t bytes = take_next(command, data, size, &good);
        if (bytes == 0)
            break;
        if (good)
            command->sequence = sources[0].end++;
        data += bytes;
        size -= bytes;
    }
    if (sources[0].end == 0)
        return 0;
    mover_step(&mover, &view.w[0], &view.m, sources);
    check_moved();
    return 0;
}
