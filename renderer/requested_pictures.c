/* Drawing requested pictures. */
#include "renderer/requested_pictures.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/render_session.h"

#include <string.h>

#define INTERVAL_NS          ((uint64_t)((double)NS_PER_S / REQUESTED_PICTURES_FPS))
#define TEXTURE_BUDGET       8u       /* textures that a picture may make, 1 ms each */
#define TEXTURE_BUDGET_FIRST 32u      /* textures that the first picture of a request may make */
#define RATE_PAUSE_NS        NS_PER_S /* after such a pause the rate is measured anew */

void requested_pictures_open(struct render_session *session)
{
    memset(&session->requested, 0, sizeof session->requested);
    quality_control_init(&session->requested.quality,
                         session->options.hold ? REQUESTED_PICTURES_HOLD_FPS : 0.0);
}

static void clear_row(struct requested_pictures_row *row)
{
    if (row->annotated.text != NULL)
        annotated_picture_close(&row->annotated);
    image_free(&row->image);
    *row = (struct requested_pictures_row){.generation = 0};
}

void requested_pictures_close(struct render_session *session)
{
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++)
        clear_row(&session->requested.row[i]);
}

static uint64_t row_due_ns(const struct requested_pictures *requested, uint32_t i)
{
    const struct requested_pictures_row *row = &requested->row[i];
    if (!requested->requests[i].waiting)
        return UINT64_MAX;
    return row->generation == requested->requests[i].generation ? row->begun_ns + INTERVAL_NS : 0;
}

uint64_t requested_pictures_due_ns(struct render_session *session)
{
    struct requested_pictures *requested = &session->requested;
    uint64_t due_ns = UINT64_MAX;
    if (session->outputs == NULL || session->outputs->stream == NULL)
        return due_ns;
    requested->waiting = stream_requests_read(session->outputs->stream, requested->requests);
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++) {
        /* A request that has ended gives its memory back. */
        if (requested->requests[i].generation == 0 && requested->row[i].generation != 0)
            clear_row(&requested->row[i]);
        due_ns = row_due_ns(requested, i) < due_ns ? row_due_ns(requested, i) : due_ns;
    }
    return due_ns;
}

/* Returns -1 when there is no memory. Then nothing is drawn, and the request times out. */
static int begin_row(struct render_session *session, struct requested_pictures_row *row,
                     const struct stream_request *request)
{
    const struct picture_requests_key *key = &request->key;
    clear_row(row);
    if (image_init(&row->image, key->width, key->height) != 0)
        return -1;
    if (key->bar)
        annotated_picture_open_shared(&row->annotated, &session->annotated, key->width,
                                      key->height);
    row->generation = request->generation;
    row->ahead_s = -1.0;
    row->picture = (struct view_picture){
        .spec = {.mode = key->view, .vehicle = key->vehicle},
        .camera_options = {.view = key->view, .field_rad = session->options.field_rad}};
    return 0;
}

static void note_rate(struct requested_pictures_row *row, uint64_t now_ns)
{
    uint64_t interval_ns = now_ns - row->begun_ns;
    bool measured = row->begun_ns != 0 && interval_ns <= RATE_PAUSE_NS;
    row->rate = measured ? view_pictures_rate(row->rate, interval_ns) : 0.0;
    row->begun_ns = now_ns;
}

static int draw_row(struct render_session *session, uint32_t i, struct error_text *error)
{
    struct requested_pictures *requested = &session->requested;
    struct requested_pictures_row *row = &requested->row[i];
    bool first = row->begun_ns == 0;
    uint64_t begun_ns = clock_now_ns();
    note_rate(row, begun_ns);
    struct frame_view frame_view = view_pictures_frame(session, false);
    bool paused = frame_view.head->paused != 0;
    bool same = row->frame == frame_view.head->frame && row->ahead_s == frame_view.ahead_s;
    bool complete = same && paused; /* an unchanged picture is drawn once more, at full quality */
    if (same && !requested->requests[i].again && (row->complete || !paused))
        return 0;
    row->picture.slot = view_pictures_vehicle(session, &frame_view, row->picture.spec.vehicle);
    if (row->picture.spec.vehicle != 0 && row->picture.slot == SLOT_NONE) {
        output_set_answer(session->outputs, i, row->generation, NULL, 0, 0.0);
        return 0;
    }
    const struct quality_control_level *level =
        &quality_control_levels[complete ? 0 : requested->quality.level];
    session->draw_list.detail = (float)level->detail;
    session->draw_list.texture_budget = complete ? TERRAIN_TILES_ALL
                                        : first  ? TEXTURE_BUDGET_FIRST
                                                 : TEXTURE_BUDGET;
    articulation_note(&session->articulation, &frame_view);
    const struct view_picture_target target = {
        .image = &row->image,
        .annotated = row->annotated.text != NULL ? &row->annotated : NULL,
        .rate = row->rate};
    if (view_pictures_camera(session, &row->picture, &frame_view, level, &target, error) != 0)
        return -1;
    row->frame = frame_view.head->frame;
    row->ahead_s = frame_view.ahead_s;
    row->complete = complete;
    output_set_answer(session->outputs, i, row->generation, &row->image, frame_view.head->frame,
                      frame_view_time_s(&frame_view));
    heartbeat_stage(session->heartbeat);
    /* Each picture that a client waits for counts as if it took as long as this one. */
    if (!complete && !first)
        view_pictures_adjust_quality(&requested->quality, begun_ns, requested->waiting,
                                     " that are asked for", " of them");
    return 0;
}

int requested_pictures_draw(struct render_session *session, struct error_text *error)
{
    struct requested_pictures *requested = &session->requested;
    uint32_t next = 0;
    for (uint32_t i = 1; i < PICTURE_REQUESTS_MAX; i++)
        if (row_due_ns(requested, i) < row_due_ns(requested, next))
            next = i;
    if (row_due_ns(requested, next) > clock_now_ns())
        return 0;
    if (requested->row[next].generation != requested->requests[next].generation &&
        begin_row(session, &requested->row[next], &requested->requests[next]) != 0)
        return 0;
    return draw_row(session, next, error);
}
