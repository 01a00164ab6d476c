/* From a committed frame to files. */
#include "renderer/render_session.h"

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "renderer/back_end.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define EVENT_BATCH   256u
#define EVENTS_BEFORE 2048u /* read at the start, for what still burns */
#define COMPLAINT_NS  10000000000ull

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

static void take_shots(struct render_session *studio)
{
    const struct options *options = &studio->options;
    for (uint32_t i = 0; i < options->views.count; i++)
        studio->shots[i] = (struct view_picture){.wish = options->views.wish[i],
                                                 .aim_wish = {.view = options->views.wish[i].mode,
                                                              .field_rad = options->field_rad,
                                                              .stand = options->stand},
                                                 .slot = SLOT_NONE};
    studio->shot_count = options->views.count;
}

/* May clients ask for pictures, of their own sizes? */
static bool is_asked(const struct render_session *studio)
{
    return studio->outlets != NULL && studio->outlets->stream != NULL;
}

static bool wants_cameras(const struct render_session *studio)
{
    if (is_asked(studio))
        return true;
    for (uint32_t i = 0; i < studio->shot_count; i++)
        if (studio->shots[i].wish.mode != VIEW_MAP)
            return true;
    return false;
}

/* The world as it is copied: two frames, and what is known beside them. */
static int open_world(struct render_session *studio, struct view *view)
{
    if (snapshot_init(&studio->snapshot[0], view) != 0)
        return -1;
    if (snapshot_init(&studio->snapshot[1], view) != 0)
        goto err_first;
    if (frame_interpolation_init(&studio->blend, view->header->capacity) != 0)
        goto err_second;
    if (crater_index_init(&studio->craters, view->w[0].craters) != 0)
        goto err_blend;
    if (dent_index_init(&studio->dents, view->w[0].dents, view->world.params->dent_slots) != 0)
        goto err_craters;
    if (tracks_init(&studio->tracks, view->world.params->capacity) != 0)
        goto err_dents;
    if (articulation_init(&studio->gear, view->world.params->capacity) == 0)
        return 0;
    tracks_free(&studio->tracks);
err_dents:
    dent_index_free(&studio->dents);
err_craters:
    crater_index_free(&studio->craters);
err_blend:
    frame_interpolation_free(&studio->blend);
err_second:
    snapshot_free(&studio->snapshot[1]);
err_first:
    snapshot_free(&studio->snapshot[0]);
    return -1;
}

static void close_world(struct render_session *studio)
{
    articulation_free(&studio->gear);
    tracks_free(&studio->tracks);
    dent_index_free(&studio->dents);
    crater_index_free(&studio->craters);
    frame_interpolation_free(&studio->blend);
    snapshot_free(&studio->snapshot[1]);
    snapshot_free(&studio->snapshot[0]);
}

/* The options for whatever picture may be drawn. Memory that no picture needs is not touched. */
static struct options largest_pictures(const struct render_session *studio)
{
    struct options options = studio->options;
    if (is_asked(studio)) {
        options.width = options.width > QUERY_WIDTH_MAX ? options.width : QUERY_WIDTH_MAX;
        options.height = options.height > QUERY_HEIGHT_MAX ? options.height : QUERY_HEIGHT_MAX;
    }
    return options;
}

/* What pictures are made of. */
static int open_canvas(struct render_session *studio, struct view *view)
{
    uint32_t width = studio->options.width, height = studio->options.height;
    if (static_scene_init(&studio->scenery, &view->world) != 0)
        return -1;
    if (scene_init(&studio->scene) != 0)
        goto err_scenery;
    if (image_init(&studio->image, width, height) != 0)
        goto err_scene;
    struct options largest = largest_pictures(studio);
    if (image_init(&studio->small, largest.width, largest.height) == 0)
        return 0;
    image_free(&studio->image);
err_scene:
    scene_free(&studio->scene);
err_scenery:
    static_scene_free(&studio->scenery);
    return -1;
}

static void close_canvas(struct render_session *studio)
{
    image_free(&studio->small);
    image_free(&studio->image);
    scene_free(&studio->scene);
    static_scene_free(&studio->scenery);
}

static void begin(struct render_session *studio, struct view *view, struct heartbeat *pulse,
                  struct output_set *outlets, const struct options *options)
{
    const struct params *params = view->world.params;
    memset(studio, 0, sizeof *studio);
    studio->view = view;
    studio->pulse = pulse;
    studio->outlets = outlets;
    studio->options = *options;
    studio->drawn = UINT64_MAX;
    studio->at_s = -1.0;
    take_defaults(&studio->options, &params->renderer);
    take_shots(studio);
    double fps = outlets != NULL ? studio->options.fps : 0.0;
    studio->smooth =
        fps >= RENDER_SESSION_SMOOTH_FPS && !options->exact && params->pace == PACE_REAL;
    quality_control_init(&studio->governor, studio->options.hold ? fps : 0.0);
}

/* Is the view of the video among those that are drawn? 0, or -1 with the reason. */
static int check_video_view(const struct render_session *studio, struct reason *reason)
{
    const char *wanted = studio->outlets != NULL ? studio->options.outlets.video_view : NULL;
    char drawn[VIEWS_MAX * (VIEW_NAME_BYTES + 2)] = "";
    for (uint32_t i = 0; i < studio->shot_count && wanted != NULL; i++) {
        const char *name = studio->shots[i].wish.name;
        if (strcmp(name, wanted) == 0)
            return 0;
        size_t used = strlen(drawn);
        snprintf(drawn + used, sizeof drawn - used, "%s%s", used > 0 ? ", " : "", name);
    }
    return wanted == NULL
               ? 0
               : reason_set(reason, "--video-view %s: is not drawn; there is %s", wanted, drawn);
}

int render_session_open(struct render_session *studio, struct view *view, struct heartbeat *pulse,
                        struct output_set *outlets, const struct options *options,
                        struct reason *reason)
{
    begin(studio, view, pulse, outlets, options);
    if (check_video_view(studio, reason) != 0)
        return -1;
    uint32_t width = studio->options.width, height = studio->options.height;
    if (open_world(studio, view) != 0)
        goto err_memory;
    if (open_canvas(studio, view) != 0)
        goto err_world;
    heartbeat_stage(pulse);
    if (annotated_picture_open(&studio->chart, &view->world, width, height, reason) != 0)
        goto err_canvas;
    heartbeat_stage(pulse);
    struct options largest = largest_pictures(studio);
    if (wants_cameras(studio) &&
        back_end_open(&studio->draw, &largest, &studio->scenery, reason) != 0)
        goto err_chart;
    heartbeat_stage(pulse);
    requested_pictures_open(studio);
    struct state_head head;
    if (snapshot_head(&head, view) == 0 && head.event_end > EVENTS_BEFORE)
        studio->events.next = head.event_end - EVENTS_BEFORE;
    return 0;

err_chart:
    annotated_picture_close(&studio->chart);
err_canvas:
    close_canvas(studio);
    close_world(studio);
    return -1;
err_world:
    close_world(studio);
err_memory:
    return reason_set(reason, "no memory for a renderer of %ux%u pictures", width, height);
}

void render_session_close(struct render_session *studio)
{
    requested_pictures_close(studio);
    if (studio->draw.self != NULL)
        studio->draw.close(studio->draw.self);
    annotated_picture_close(&studio->chart);
    close_canvas(studio);
    close_world(studio);
}

uint64_t render_session_due_ns(const struct render_session *studio)
{
    if (studio->options.fps <= 0.0)
        return UINT64_MAX;
    return studio->drawn_ns + (uint64_t)((double)NS_PER_S / studio->options.fps);
}

static void take_events(struct render_session *studio, const struct frame_view *moment)
{
    struct event events[EVENT_BATCH];
    uint32_t count;
    do {
        count = events_read(studio->view, &studio->events, events, EVENT_BATCH);
        /* The ring may be ahead of the snapshot: what is not yet in it comes with the next. */
        uint32_t old = 0;
        while (old < count && events[old].frame <= moment->head->frame)
            old++;
        effects_take(&studio->effects, moment, events, old);
        studio->events.next -= count - old;
        count = old;
    } while (count == EVENT_BATCH);
}

struct frame_view render_session_moment(const struct render_session *studio, uint32_t which)
{
    const struct snapshot *snapshot = &studio->snapshot[which];
    return (struct frame_view){.world = &studio->view->world,
                               .head = &snapshot->head,
                               .entities = &snapshot->entities,
                               .fixed_damage = snapshot->fixed_damage,
                               .craters = &studio->craters,
                               .dents = &studio->dents,
                               .gear = &studio->gear};
}

/* Takes a frame in beside the one before it, unless it is that one. */
static int take_frame(struct render_session *studio)
{
    uint32_t other = 1 - studio->latest;
    if (studio->whole > 0 && segment_load(&studio->view->commit->commit) == studio->seen)
        return 0;
    if (snapshot_take(&studio->snapshot[other], studio->view) != 0) {
        studio->whole = studio->whole > 0; /* the earlier one was written over */
        return -1;
    }
    studio->latest = other;
    studio->whole = studio->whole > 0 ? 2 : 1;
    return 0;
}

int render_session_look(struct render_session *studio, struct reason *reason)
{
    if (take_frame(studio) != 0) {
        if (errno == EBADMSG)
            return reason_set(reason, "world \"%s\" is damaged: its checksum is wrong",
                              studio->view->name);
        if (log_due(&studio->complained_ns, COMPLAINT_NS))
            log_warn("the world goes on faster than it can be copied; the picture stays");
        return 0;
    }
    struct frame_view moment = render_session_moment(studio, studio->latest);
    crater_index_update(&studio->craters, moment.head->crater_count);
    dent_index_update(&studio->dents, moment.head->dent_count);
    studio->seen = moment.head->frame;
    log_frame(studio->seen);
    take_events(studio, &moment);
    tracks_note(&studio->tracks, &moment);
    heartbeat_stage(studio->pulse);
    return 0;
}

int render_session_check_vehicles(const struct render_session *studio, struct reason *reason)
{
    struct frame_view moment = render_session_moment(studio, studio->latest);
    uint32_t wanted[VIEWS_MAX + 1] = {studio->options.follow_given ? studio->options.follow : 0};
    for (uint32_t i = 0; i < studio->shot_count; i++)
        wanted[i + 1] = studio->shots[i].wish.vehicle;
    for (uint32_t i = 0; i <= studio->shot_count; i++)
        if (wanted[i] != 0 &&
            entities_find(moment.entities, moment.head->used, wanted[i]) == SLOT_NONE)
            return reason_set(reason,
                              "vehicle %u: world \"%s\" has none of that number; jolon world dump "
                              "-w %s lists them",
                              wanted[i], studio->view->name, studio->view->name);
    return 0;
}
