/* jolon-renderer: draws a running world off-screen. It copies committed frames at its own rate and
 * runs at a low priority. The simulation never waits for it. */
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "renderer/timing.h"
#include "renderer/back_end.h"
#include "renderer/options.h"
#include "renderer/heartbeat.h"
#include "renderer/render_session.h"
#include "renderer/base_map_service.h"
#include "renderer/draw_schedule.h"
#include "ipc/sandbox/sandbox.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define NICENESS 12 /* far behind the frame loop */

static int run(struct render_session *session, struct view *view, struct error_text *error)
{
    bool last = false;
    if (render_session_update(session, error) != 0)
        return -1;
    if (render_session_check_vehicles(session, error) != 0)
        log_warn("%s; follows another vehicle until it exists", error->text);
    while (!last) {
        last = process_stopping() || frame_protocol_finished(view);
        if (!last) {
            if (draw_schedule_wait(session, view, error) != 0)
                return -1;
            last = process_stopping() || frame_protocol_finished(view);
        }
        /* The last picture shows the last frame: update again after the end was seen. */
        if (last && render_session_update(session, error) != 0)
            return -1;
        uint64_t begun_ns = clock_now_ns();
        if (view_pictures_draw(session, last, error) != 0)
            return -1;
        timing_picture(view, session, begun_ns);
        if (!last && draw_schedule_share(session, error) != 0)
            return -1;
    }
    return 0;
}

/* Opens the outputs and begins the sandbox, before any thread starts. Afterwards files can be made
 * only in the folder of pictures. The graphics driver's shader cache moves into it as well: cached
 * shaders are programs, and a cache in the home folder is shared with other processes. Returns 0,
 * or -1 with the reason. */
static int confine(struct sandbox *sandbox, struct output_set *outputs,
                   const struct options *options, struct error_text *error)
{
    char cache[1024];
    if (output_set_open(outputs, &options->outputs, error) != 0)
        return -1;
    if (picture_folder_cache(&outputs->output, cache, sizeof cache) == 0)
        setenv("MESA_SHADER_CACHE_DIR", cache, 1);
    if (sandbox_begin(sandbox, options->role, options->sandbox_off, error) != 0)
        return -1;
    return sandbox_files(sandbox, &outputs->output.folder, 1, error);
}

/* Looks up the vehicle of --follow NAME. A vehicle keeps its name. */
static void find_followed(struct options *options, const struct view *view)
{
    if (options->follow_name == NULL)
        return;
    options->follow = world_entity_named(&view->world, options->follow_name);
    if (options->follow == 0)
        die_refused("vehicle \"%s\": world \"%s\" has none of that name; jolon world dump -w %s "
                    "lists them, and a number is good too",
                    options->follow_name, view->name, view->name);
}

/* Draws the present frame into the file of --snap. Returns 0, or -1 with the reason. */
static int snap(struct render_session *session, struct error_text *error)
{
    return render_session_update(session, error) == 0 &&
                   render_session_check_vehicles(session, error) == 0 &&
                   view_pictures_draw(session, true, error) == 0
               ? 0
               : -1;
}

int main(int argc, char **argv)
{
    static struct render_session session;
    static struct output_set outputs;
    static struct base_map base;
    struct options options;
    struct view view;
    struct sandbox sandbox = {.on = false};
    struct heartbeat heartbeat;
    struct error_text error, second;

    log_open("renderer");
    options_read(&options, NULL, argc, argv);
    if (options.list_devices)
        return back_end_list();
    bool snapping = options.snap != NULL;
    log_open(snapping ? "renderer" : role_name(options.role));
    process_begin(options.parent);
    if (segment_attach(&view, options.world, snapping ? ROLE_NONE : options.role, &error) != 0)
        die_refused("%s", error.text);
    find_followed(&options, &view);
    if (options.pose.given && !world_holds(&view.world, options.pose.x, options.pose.z))
        die_usage("--eye: X and Z are from 0 to %.0f", view.world.terrain.squares.world_m);
    base_map_open(&base, &view.world);
    options.outputs.painter = base_map_service_painter(&base);
    if (!snapping && confine(&sandbox, &outputs, &options, &error) != 0)
        die_refused("%s", error.text);
    /* The heartbeat keeps its priority. The drawing thread, and the threads of the OpenGL driver
     * that it starts, yield to the frame loop. */
    if (!snapping && heartbeat_start(&heartbeat, &view) != 0)
        die_refused("cannot start a thread: %s", strerror(errno));
    if (process_lower_priority(NICENESS) != 0)
        log_warn("cannot lower its priority: %s", strerror(errno));
    if (!snapping && output_set_start(&outputs, &error) != 0)
        die_refused("%s", error.text);
    setenv("LP_NUM_THREADS", "1", 0);

    if (render_session_open(&session, &view, &heartbeat, snapping ? NULL : &outputs, &options,
                            &error) != 0 ||
        sandbox_enter(&sandbox, &error) != 0)
        die_refused("%s", error.text);
    int result;
    if (snapping) {
        result = snap(&session, &error);
    } else {
        segment_ready(&view);
        log_info("draws world \"%s\" into %s: %s%s, %ux%u, %.3g pictures a second", view.name,
                 options.out, session.pictures[0].spec.name,
                 session.picture_count > 1 ? ", ..." : "", session.options.width,
                 session.options.height, session.options.fps);
        result = run(&session, &view, &error);
        if (output_set_close(&outputs, result == 0 ? &error : &second) != 0)
            result = -1;
        heartbeat_stop(&heartbeat);
    }
    if (result != 0)
        die_refused("%s", error.text);
    render_session_close(&session);
    base_map_close(&base);
    segment_detach(&view);
    return EXIT_OK;
}
