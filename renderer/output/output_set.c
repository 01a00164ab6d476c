/* The outputs of one renderer. */
#include "renderer/output/output_set.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "renderer/output/stream_listen.h"
#include "renderer/output/stream_requests.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define STILLS_DEPTH  2u    /* of a view */
#define VIDEO_DEPTH   4u    /* bridges short delays of the encoder */
#define NUMBERS_MAX   10000 /* of files with one name */
#define STILL_SLACK_S 0.01  /* pictures may come a little early */

/* --- opening -----------------------------------------------------------------------------------*/

/* "dir/film.mkv", "dir/film-2.mkv", ... */
static int name_video(char path[OUTPUT_SET_PATH_BYTES], const char *options, int number)
{
    const char *slash = strrchr(options, '/'), *dot = strrchr(options, '.');
    if (dot == NULL || (slash != NULL && dot < slash))
        dot = options + strlen(options);
    int length = number == 1 ? snprintf(path, OUTPUT_SET_PATH_BYTES, "%s", options)
                             : snprintf(path, OUTPUT_SET_PATH_BYTES, "%.*s-%d%s",
                                        (int)(dot - options), options, number, dot);
    return length < OUTPUT_SET_PATH_BYTES ? 0 : -1;
}

static int make_video_file(struct output_set *outputs, struct error_text *error)
{
    const char *options = outputs->options.video;
    int fd = -1;
    errno = EEXIST;
    for (int number = 1; fd < 0 && errno == EEXIST && number < NUMBERS_MAX; number++) {
        if (name_video(outputs->video_path, options, number) != 0)
            return error_text_set(error, "--video %s: the path is too long", options);
        fd = open(outputs->video_path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    }
    if (fd < 0)
        return error_text_set(error, "--video %s: cannot make the file: %s", outputs->video_path,
                              strerror(errno));
    return outputs->video_fd = fd;
}

static int open_video(struct output_set *outputs, struct error_text *error)
{
    const struct output_set_options *options = &outputs->options;
    outputs->video = video_open(options->video, options->video_fps,
                                options->replay ? VIDEO_REPLAY : VIDEO_LIVE, error);
    if (outputs->video == NULL)
        return -1;
    int fd = options->replay ? options->video_fd : make_video_file(outputs, error);
    if (fd < 0)
        return -1;
    video_write_to(outputs->video, fd);
    if (options->video_view != NULL)
        snprintf(outputs->video_view, sizeof outputs->video_view, "%s", options->video_view);
    if (!options->replay)
        log_info("video of %s goes to %s (%s): a second of it is a second of simulation, of at "
                 "most %.3g pictures",
                 options->video_view != NULL ? options->video_view : "the first view",
                 outputs->video_path, video_codec(outputs->video), options->video_fps);
    return 0;
}

/* Opens the stream. A missing Unix socket is only logged: the renderer draws without it. */
static int open_stream(struct output_set *outputs, struct error_text *error)
{
    const struct output_set_options *options = &outputs->options;
    struct error_text socket_reason;
    outputs->stream = stream_open(options->world, &options->painter, error);
    if (outputs->stream == NULL)
        return -1;
    if (options->serves_requests &&
        stream_listen_here(outputs->stream, options->role, &socket_reason) != 0)
        log_warn("%s; clients cannot request pictures", socket_reason.text);
    if (options->stream_port < 0)
        return 0;
    if (stream_listen(outputs->stream, options->stream_address, (uint16_t)options->stream_port,
                      error) != 0)
        return -1;
    log_info("stream: %s shows every view", stream_url(outputs->stream));
    return 0;
}

int output_set_open(struct output_set *outputs, const struct output_set_options *options,
                    struct error_text *error)
{
    *outputs = (struct output_set){.options = *options, .output.folder = -1, .video_fd = -1};
    picture_pool_init(&outputs->pool);
    picture_pool_init(&outputs->request_pool);
    if (options->folder != NULL &&
        picture_folder_open(&outputs->output, options->folder, error) != 0)
        return -1;
    if ((options->stream_port >= 0 || options->serves_requests) && open_stream(outputs, error) != 0)
        return -1;
    return options->video != NULL ? open_video(outputs, error) : 0;
}

/* --- what the threads do -----------------------------------------------------------------------*/

static int write_still(void *self, const struct picture *picture, struct error_text *error)
{
    struct output_set *outputs = self;
    return picture_folder_picture(&outputs->output, picture->view, &picture->image, picture->frame,
                                  picture->comment, error);
}

static int write_video(void *self, const struct picture *picture, struct error_text *error)
{
    struct output_set *outputs = self;
    return video_put(outputs->video, picture, error);
}

int output_set_start(struct output_set *outputs, struct error_text *error)
{
    const struct output_queue_work stills = {
        .self = outputs, .take = write_still, .depth = STILLS_DEPTH};
    const struct output_queue_work video_queue = {.self = outputs,
                                                  .take = write_video,
                                                  .depth = VIDEO_DEPTH,
                                                  .lossless = outputs->options.replay};
    if ((outputs->options.folder != NULL && output_queue_start(&outputs->stills, &stills) != 0) ||
        (outputs->video != NULL && output_queue_start(&outputs->video_queue, &video_queue) != 0))
        return error_text_set(error, "cannot start a thread for pictures: %s", strerror(errno));
    if (outputs->stream != NULL && stream_start(outputs->stream, error) != 0)
        return -1;
    outputs->started = true;
    return 0;
}

/* --- pictures ----------------------------------------------------------------------------------*/

/* Returns the view's row; NULL when all are in use. Then each of its pictures is written. */
static struct output_set_view *row_of(struct output_set *outputs, const char *view)
{
    for (uint32_t i = 0; i < OUTPUT_SET_VIEWS_MAX; i++) {
        struct output_set_view *row = &outputs->row[i];
        if (row->view[0] == '\0')
            snprintf(row->view, sizeof row->view, "%s", view);
        if (strcmp(row->view, view) == 0)
            return row;
    }
    return NULL;
}

static void put_still(struct output_set *outputs, struct picture *picture)
{
    struct output_set_view *row = row_of(outputs, picture->view);
    double fps = outputs->options.stills_fps;
    uint64_t now_ns = clock_now_ns();
    if (row != NULL) {
        bool early = fps > 0.0 && row->still_ns != 0 &&
                     (double)(now_ns - row->still_ns) / 1e9 < 1.0 / fps - STILL_SLACK_S;
        picture_release(row->pending);
        row->pending = early ? picture_hold(picture) : NULL;
        if (early)
            return;
        row->still_ns = now_ns;
    }
    output_queue_put(&outputs->stills, picture);
}

/* Returns 0, or -1 with the reason when the video has failed. */
static int put_video(struct output_set *outputs, struct picture *picture, struct error_text *error)
{
    if (outputs->video_view[0] == '\0')
        snprintf(outputs->video_view, sizeof outputs->video_view, "%s", picture->view);
    if (strcmp(outputs->video_view, picture->view) == 0)
        output_queue_put(&outputs->video_queue, picture);
    return output_queue_failed(&outputs->video_queue, error) ? -1 : 0;
}

static int hand_out(struct output_set *outputs, struct picture *picture, struct error_text *error)
{
    if (outputs->stream != NULL)
        stream_put(outputs->stream, picture);
    if (outputs->video != NULL && !outputs->video_over && put_video(outputs, picture, error) != 0) {
        if (outputs->options.replay)
            return -1;
        log_warn("%s: %s; no more of it", outputs->video_path, error->text);
        outputs->video_over = true;
    }
    if (outputs->options.folder == NULL)
        return 0;
    put_still(outputs, picture);
    return output_queue_failed(&outputs->stills, error) ? -1 : 0;
}

int output_set_put(struct output_set *outputs, const char *view, struct image *image,
                   uint64_t frame, double time_s, const char *comment, struct error_text *error)
{
    struct picture *picture = picture_make(&outputs->pool, image, view, comment);
    if (picture == NULL) {
        outputs->lost++;
        return 0;
    }
    picture->frame = frame;
    picture->time_s = time_s;
    int result = hand_out(outputs, picture, error);
    picture_release(picture);
    return result;
}

void output_set_answer(struct output_set *outputs, uint32_t row, uint64_t generation,
                       struct image *image, uint64_t frame, double time_s)
{
    struct picture *picture = NULL;
    if (image != NULL) {
        picture = picture_make(&outputs->request_pool, image, "asked", "");
        if (picture == NULL)
            return; /* the client's wait times out */
        picture->frame = frame;
        picture->time_s = time_s;
    }
    stream_requests_answer(outputs->stream, row, generation, picture);
    picture_release(picture);
}

/* --- the end -----------------------------------------------------------------------------------*/

static int close_stills(struct output_set *outputs, struct error_text *error)
{
    for (uint32_t i = 0; i < OUTPUT_SET_VIEWS_MAX; i++) {
        if (outputs->row[i].pending != NULL)
            output_queue_put(&outputs->stills, outputs->row[i].pending);
        picture_release(outputs->row[i].pending);
    }
    int result = output_queue_end(&outputs->stills, error);
    unsigned long long dropped = outputs->stills.dropped + outputs->lost;
    if (dropped > 0)
        log_info("%llu pictures were drawn faster than they could be written", dropped);
    return result;
}

static int close_video(struct output_set *outputs, struct error_text *error)
{
    int result = output_queue_end(&outputs->video_queue, error);
    uint64_t pictures = video_pictures(outputs->video);
    struct error_text second;
    if (video_close(outputs->video, result == 0 ? error : &second) != 0)
        result = -1;
    outputs->video = NULL;
    if (outputs->video_fd >= 0 && close(outputs->video_fd) != 0 && result == 0)
        result = error_text_set(error, "video: cannot complete the file: %s", strerror(errno));
    if (outputs->options.replay)
        return result;
    if (result != 0 && !outputs->video_over)
        log_warn("%s: %s", outputs->video_path, error->text);
    log_info("%s: %llu pictures%s; %llu came faster than they could be encoded",
             outputs->video_path, (unsigned long long)pictures,
             result == 0 ? "" : ", not completed",
             (unsigned long long)outputs->video_queue.dropped);
    return 0;
}

int output_set_close(struct output_set *outputs, struct error_text *error)
{
    int result = 0;
    struct error_text second;
    if (!outputs->started)
        return 0;
    stream_close(outputs->stream);
    if (outputs->options.folder != NULL) {
        result = close_stills(outputs, error);
        picture_folder_close(&outputs->output);
    }
    if (outputs->video != NULL && close_video(outputs, result == 0 ? error : &second) != 0)
        result = -1;
    picture_pool_free(&outputs->pool);
    picture_pool_free(&outputs->request_pool);
    return result;
}
