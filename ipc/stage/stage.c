/* Start and end of mover and collider. */
#include "ipc/stage/stage.h"

#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment.h"
#include "ipc/segment/segment_attach.h"
#include "world/entity/table_touch.h"
#include "world/params.h"
#include "world/runtime/thread_pool.h"
#include "world/runtime/work_done.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static struct stage_options read_options(int argc, char **argv, enum role role)
{
    static struct stage_options given = {.world = "default", .threads = 1};
    static const struct option_row rows[] = {
        OPTION_ROW_WORLD(given, NULL),
        {"threads", "N", "1 to 16 (default 1)", .u32 = &given.threads, .least = 1,
         .most = THREAD_POOL_MAX},
        OPTION_ROW_PARENT(given),
        {"stand-by", NULL, "take the role over when the process that has it dies",
         .flag = &given.stand_by},
        OPTION_ROW_NO_SANDBOX(given),
        OPTION_ROWS_END};
    char program[32];
    snprintf(program, sizeof program, "jolon-%s", role_name(role));
    const struct option_table table = {.program = program, .usage = "[options]", .rows = rows};
    option_table_read(&table, argc, argv);
    return given;
}

void stage_open(struct stage *stage, int argc, char **argv, enum role role)
{
    struct error_text error;
    stage->options = read_options(argc, argv, role);
    const struct stage_options *options = &stage->options;
    log_open(role_name(role));
    process_begin(options->parent);
    if (sandbox_begin(&stage->sandbox, role, options->sandbox_off, &error) != 0 ||
        (options->stand_by ? segment_stand_by : segment_attach)(&stage->view, options->world, role,
                                                                &error) != 0)
        die_refused("%s", error.text);
    segment_prefault(&stage->view);
    work_done_into(&stage->view.slot[role]->work);
    stage->workers = thread_pool_create(options->threads);
    if (!stage->workers)
        die_refused("cannot start %u threads: %s", options->threads, strerror(errno));
}

void stage_refuse_memory(const struct stage *stage)
{
    die_refused("cannot take the memory of the steps of a world of capacity %u: %s; allow more "
                "address space (ulimit -v; vm.overcommit_ratio where vm.overcommit_memory is 2) "
                "or lower world.capacity",
                stage->view.world.params->capacity, strerror(errno));
}

uint32_t stage_rows(const struct view *view)
{
    uint64_t commit = segment_load(&view->commit->commit);
    return table_touch_rows(view->w[commit & 1].head->used, view->header->capacity);
}

bool stage_enter(struct stage *stage)
{
    struct error_text error;
    if (sandbox_enter(&stage->sandbox, &error) != 0)
        die_refused("%s", error.text);
    /* A stand-by process may be asked to stop, or the run may end, before it gets the role. */
    if (segment_take(&stage->view) != 0 ||
        (stage->options.stand_by && frame_protocol_finished(&stage->view)))
        return false;
    segment_ready(&stage->view);
    return true;
}

void stage_close(struct stage *stage)
{
    thread_pool_destroy(stage->workers);
    segment_detach(&stage->view);
}
