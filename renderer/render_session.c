/* What a renderer keeps, and copying frames and events into it. */
#include "renderer/render_session.h"

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "renderer/back_end.h"
#include "world/entity/event.h"
#include "world/params.h"
#include "world/view_mode.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define EVENT_BATCH         256u
#define EVENTS_BEFORE       2048u /* read at the start: their fires may still burn */
#define WARNING_INTERVAL_NS 10000000000ull

static void take_defaults(struct options *options, const struct renderer_params *params)
{
    if (options->fps < 0.0)
        options->fps = params->fps;
    if (options->views.count == 0)
        views_of_bits(&options->views, params->views);
    if (options->width == 0) {
        options->width = params->width;
        options->height = params->height;
    }
    if (!options->follow_given)
        options->follow = params->follow;
    if (options->back_end < 0)
        options->back_end = (int)params->back_end;
    if (options->hold < 0)
        options->hold = params->hold != 0;
}

static void init_pictures(struct render_session *session)
{
    const struct options *options = &session->options;
    for (uint32_t i = 0; i < options->views.count; i++)
        session->pictures[i] =
            (struct view_picture){.spec = options->views.spec[i],
                                  .camera_options = {.view = options->views.spec[i].mode,
                                                     .field_rad = options->field_rad,
                                                     .pose = options->pose},
                                  .slot = SLOT_NONE};
    session->picture_count = options->views.count;
}

/* Returns true if clients may request pictures, of their own sizes. */
static bool takes_requests(const struct render_session *session)
{
    return session->outputs != NULL && session->outputs->stream != NULL;
}

static bool needs_back_end(const struct render_session *session)
{
    if (takes_requests(session))
        return true;
    for (uint32_t i = 0; i < session->picture_count; i++)
        if (session->pictures[i].spec.mode != VIEW_MAP)
            return true;
    return false;
}

/* Makes room for the snapshots and what is derived from them. Returns 0, or -1 with errno. */
static int open_world(struct render_session *session, struct view *view)
{
    if (snapshot_init(&session->snapshot[0], view) != 0)
        return -1;
    if (snapshot_init(&session->snapshot[1], view) != 0)
        goto err_first;
    if (frame_interpolation_init(&session->interpolation, view->header->capacity) != 0)
        goto err_second;
    if (crater_index_init(&session->craters, &view->world.terrain.squares, view->w[0].craters) != 0)
        goto err_interpolation;
    if (dent_index_init(&session->dents, view->w[0].dents, view->world.params->dent_slots) != 0)
        goto err_craters;
    if (tracks_init(&session->tracks, view->world.params->capacity) != 0)
        goto err_dents;
    if (articulation_init(&session->articulation, view->world.params->capacity) == 0)
        return 0;
    tracks_free(&session->tracks);
err_dents:
    dent_index_free(&session->dents);
err_craters:
    crater_index_free(&session->craters);
err_interpolation:
    frame_interpolation_free(&session->interpolation);
err_second:
    snapshot_free(&session->snapshot[1]);
err_first:
    snapshot_free(&session->snapshot[0]);
    return -1;
}

static void close_world(struct render_session *session)
{
    articulation_free(&session->articulation);
    tracks_free(&session->tracks);
    dent_index_free(&session->dents);
    crater_index_free(&session->craters);
    frame_interpolation_free(&session->interpolation);
    snapshot_free(&session->snapshot[1]);
    snapshot_free(&session->snapshot[0]);
}

/* Returns options with the largest size of a picture. Memory that no picture needs is not touched.
 */
static struct options largest_pictures(const struct render_session *session)
{
    struct options options = session->options;
    if (takes_requests(session)) {
        options.width = options.width > QUERY_WIDTH_MAX ? options.width : QUERY_WIDTH_MAX;
        options.height = options.height > QUERY_HEIGHT_MAX ? options.height : QUERY_HEIGHT_MAX;
    }
    return options;
}

static int open_images(struct render_session *session, struct view *view)
{
    uint32_t width = session->options.width, height = session->options.height;
    if (static_scene_init(&session->static_scene, &view->world) != 0)
        return -1;
    if (scene_init(&session->draw_list) != 0)
        goto err_static_scene;
    if (image_init(&session->image, width, height) != 0)
        goto err_draw_list;
    struct options largest = largest_pictures(session);
    if (image_init(&session->small, largest.width, largest.height) == 0)
        return 0;
    image_free(&session->image);
err_draw_list:
    scene_free(&session->draw_list);
err_static_scene:
    static_scene_free(&session->static_scene);
    return -1;
}

static void close_images(struct render_session *session)
{
    image_free(&session->small);
    image_free(&session->image);
    scene_free(&session->draw_list);
    static_scene_free(&session->static_scene);
}

static void begin(struct render_session *session, struct view *view, struct heartbeat *heartbeat,
                  struct output_set *outputs, const struct options *options)
{
    const struct params *params = view->world.params;
    memset(session, 0, sizeof *session);
    session->view = view;
    session->heartbeat = heartbeat;
    session->outputs = outputs;
    session->options = *options;
    session->drawn = UINT64_MAX;
    session->at_s = -1.0;
    take_defaults(&session->options, &params->renderer);
    init_pictures(session);
    double fps = outputs != NULL ? session->options.fps : 0.0;
    session->smooth =
        fps >= RENDER_SESSION_SMOOTH_FPS && !options->exact && params->pace == PACE_REAL;
    quality_control_init(&session->quality, session->options.hold ? fps : 0.0);
}

/* Checks that the view of the video is drawn. Returns 0, or -1 with the reason. */
static int check_video_view(const struct render_session *session, struct error_text *error)
{
    const char *view = session->outputs != NULL ? session->options.outputs.video_view : NULL;
    char drawn[VIEWS_MAX * (VIEW_NAME_BYTES + 2)] = "";
    for (uint32_t i = 0; i < session->picture_count && view != NULL; i++) {
        const char *name = session->pictures[i].spec.name;
        if (strcmp(name, view) == 0)
            return 0;
        size_t used = strlen(drawn);
        snprintf(drawn + used, sizeof drawn - used, "%s%s", used > 0 ? ", " : "", name);
    }
    return view == NULL
               ? 0
               : error_text_set(error, "--video-view %s: is not drawn; there is %s", view, drawn);
}

int render_session_open(struct render_session *session, struct view *view,
                        struct heartbeat *heartbeat, struct output_set *outputs,
                        const struct options *options, struct error_text *error)
{
    begin(session, view, heartbeat, outputs, options);
    if (check_video_view(session, error) != 0)
        return -1;
    uint32_t width = session->options.width, height = session->options.height;
    if (open_world(session, view) != 0)
        goto err_memory;
    if (open_images(session, view) != 0)
        goto err_world;
    heartbeat_stage(heartbeat);
    if (annotated_picture_open(&session->annotated, &view->world, width, height, error) != 0)
        goto err_canvas;
    heartbeat_stage(heartbeat);
    struct options largest = largest_pictures(session);
    if (needs_back_end(session) &&
        back_end_open(&session->draw, &largest, &session->static_scene, error) != 0)
        goto err_chart;
    heartbeat_stage(heartbeat);
    requested_pictures_open(session);
    struct state_head head;
    if (snapshot_head(&head, view) == 0 && head.event_end > EVENTS_BEFORE)
        session->events.next = head.event_end - EVENTS_BEFORE;
    return 0;

err_chart:
    annotated_picture_close(&session->annotated);
err_canvas:
    close_images(session);
    close_world(session);
    return -1;
err_world:
    close_world(session);
err_memory:
    return error_text_set(error, "no memory for a renderer of %ux%u pictures", width, height);
}

void render_session_close(struct render_session *session)
{
    requested_pictures_close(session);
    if (session->draw.self != NULL)
        session->draw.close(session->draw.self);
    annotated_picture_close(&session->annotated);
    close_images(session);
    close_world(session);
}

uint64_t render_session_due_ns(const struct render_session *session)
{
    if (session->options.fps <= 0.0)
        return UINT64_MAX;
    return session->drawn_ns + (uint64_t)((double)NS_PER_S / session->options.fps);
}

static void take_events(struct render_session *session, const struct frame_view *frame_view)
{
    struct event events[EVENT_BATCH];
    uint32_t count;
    do {
        count = events_read(session->view, &session->events, events, EVENT_BATCH);
        /* Events after the snapshot's frame are read again with a later snapshot. */
        uint32_t old = 0;
        while (old < count && events[old].frame <= frame_view->head->frame)
            old++;
        effects_take(&session->effects, frame_view, events, old);
        session->events.next -= count - old;
        count = old;
    } while (count == EVENT_BATCH);
}

struct frame_view render_session_frame_view(const struct render_session *session, uint32_t which)
{
    const struct snapshot *snapshot = &session->snapshot[which];
    return (struct frame_view){.world = &session->view->world,
                               .head = &snapshot->head,
                               .entities = &snapshot->entities,
                               .fixed_damage = snapshot->fixed_damage,
                               .craters = &session->craters,
                               .dents = &session->dents,
                               .roads = &session->static_scene.roads,
                               .articulation = &session->articulation};
}

/* Takes a snapshot of the latest frame if that is new. Returns 0, or -1 with errno. */
static int take_frame(struct render_session *session)
{
    uint32_t other = 1 - session->latest;
    if (session->snapshots_taken > 0 &&
        segment_load(&session->view->commit->commit) == session->seen)
        return 0;
    if (snapshot_take_poses(&session->snapshot[other], session->view) != 0) {
        session->snapshots_taken = session->snapshots_taken > 0; /* the older one was overwritten */
        return -1;
    }
    session->latest = other;
    session->snapshots_taken = session->snapshots_taken > 0 ? 2 : 1;
    return 0;
}

int render_session_update(struct render_session *session, struct error_text *error)
{
    if (take_frame(session) != 0) {
        if (errno == EBADMSG)
            return error_text_set(error, "world \"%s\" is damaged: its checksum is wrong",
                                  session->view->name);
        if (log_due(&session->warned_ns, WARNING_INTERVAL_NS))
            log_warn("the world goes on faster than it can be copied; the picture stays");
        return 0;
    }
    struct frame_view frame_view = render_session_frame_view(session, session->latest);
    crater_index_update(&session->craters, frame_view.head->crater_count);
    dent_index_update(&session->dents, frame_view.head->dent_count);
    session->seen = frame_view.head->frame;
    log_frame(session->seen);
    take_events(session, &frame_view);
    tracks_note(&session->tracks, &frame_view);
    heartbeat_stage(session->heartbeat);
    return 0;
}

int render_session_check_vehicles(const struct render_session *session, struct error_text *error)
{
    struct frame_view frame_view = render_session_frame_view(session, session->latest);
    uint32_t ids[VIEWS_MAX + 1] = {session->options.follow_given ? session->options.follow : 0};
    for (uint32_t i = 0; i < session->picture_count; i++)
        ids[i + 1] = session->pictures[i].spec.vehicle;
    for (uint32_t i = 0; i <= session->picture_count; i++)
        if (ids[i] != 0 &&
            entities_find(frame_view.entities, frame_view.head->used, ids[i]) == SLOT_NONE)
            return error_text_set(
                error,
                "vehicle %u: world \"%s\" has none of that number; jolon world dump "
                "-w %s lists them",
                ids[i], session->view->name, session->view->name);
    return 0;
}
