/* The outlets of one renderer. */
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

#define STILLS_DEPTH  2u    /* of a view: half a second of stills at the usual rate */
#define FILM_DEPTH    4u    /* an encoder's hiccup */
#define NUMBERS_MAX   10000 /* of files with one name */
#define STILL_SLACK_S 0.01  /* pictures come a little early or late */

/* --- opening -----------------------------------------------------------------------------------*/

/* "dir/film.mkv", "dir/film-2.mkv", ... */
static int name_video(char path[OUTPUT_SET_PATH_BYTES], const char *wish, int number)
{
    const char *slash = strrchr(wish, '/'), *dot = strrchr(wish, '.');
    if (dot == NULL || (slash != NULL && dot < slash))
        dot = wish + strlen(wish);
    int length = number == 1 ? snprintf(path, OUTPUT_SET_PATH_BYTES, "%s", wish)
                             : snprintf(path, OUTPUT_SET_PATH_BYTES, "%.*s-%d%s", (int)(dot - wish),
                                        wish, number, dot);
    return length < OUTPUT_SET_PATH_BYTES ? 0 : -1;
}

static int make_video_file(struct output_set *outputs, struct error_text *error)
{
    const char *wish = outputs->wish.video;
    int fd = -1;
    errno = EEXIST;
    for (int number = 1; fd < 0 && errno == EEXIST && number < NUMBERS_MAX; number++) {
        if (name_video(outputs->video_path, wish, number) != 0)
            return error_text_set(error, "--video %s: the path is too long", wish);
        fd = open(outputs->video_path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    }
    if (fd < 0)
        return error_text_set(error, "--video %s: cannot make the file: %s", outputs->video_path,
                              strerror(errno));
    return outputs->video_fd = fd;
}

static int open_video(struct output_set *outputs, struct error_text *error)
{
    const struct output_set_wish *wish = &outputs->wish;
    outputs->video =
        video_open(wish->video, wish->video_fps, wish->replay ? VIDEO_REPLAY : VIDEO_LIVE, error);
    if (outputs->video == NULL)
        return -1;
    int fd = wish->replay ? wish->video_fd : make_video_file(outputs, error);
    if (fd < 0)
        return -1;
    video_write_to(outputs->video, fd);
    if (wish->video_view != NULL)
        snprintf(outputs->video_view, sizeof outputs->video_view, "%s", wish->video_view);
    if (!wish->replay)
        log_info("video of %s goes to %s (%s): a second of it is a second of simulation, of at "
                 "most %.3g pictures",
                 wish->video_view != NULL ? wish->video_view : "the first view",
                 outputs->video_path, video_codec(outputs->video), wish->video_fps);
    return 0;
}

/* Without a socket of its own the renderer draws all the same: it says so and goes on. */
static int open_stream(struct output_set *outputs, struct error_text *error)
{
    const struct output_set_wish *wish = &outputs->wish;
    struct error_text socket_reason;
    outputs->stream = stream_open(wish->world, &wish->painter, error);
    if (outputs->stream == NULL)
        return -1;
    if (wish->asked && stream_listen_here(outputs->stream, wish->role, &socket_reason) != 0)
        log_warn("%s; nobody can ask for pictures there", socket_reason.text);
    if (wish->stream_port < 0)
        return 0;
    if (stream_listen(outputs->stream, wish->stream_address, (uint16_t)wish->stream_port, error) !=
        0)
        return -1;
    log_info("stream: %s shows every view", stream_url(outputs->stream));
    return 0;
}

int output_set_open(struct output_set *outputs, const struct output_set_wish *wish,
                    struct error_text *error)
{
    *outputs = (struct output_set){.wish = *wish, .output.folder = -1, .video_fd = -1};
    picture_pool_init(&outputs->pool);
    picture_pool_init(&outputs->asked);
    if (wish->folder != NULL && picture_folder_open(&outputs->output, wish->folder, error) != 0)
        return -1;
    if ((wish->stream_port >= 0 || wish->asked) && open_stream(outputs, error) != 0)
        return -1;
    return wish->video != NULL ? open_video(outputs, error) : 0;
}

/* --- what the threads do -----------------------------------------------------------------------*/

static int write_still(void *self, const struct picture *picture, struct error_text *error)
{
    struct output_set *outputs = self;
    return picture_folder_picture(&outputs->output, picture->view, &picture->image, picture->frame,
                                  picture->words, error);
}

static int write_film(void *self, const struct picture *picture, struct error_text *error)
{
    struct output_set *outputs = self;
    return video_put(outputs->video, picture, error);
}

int output_set_start(struct output_set *outputs, struct error_text *error)
{
    const struct output_queue_work stills = {
        .self = outputs, .take = write_still, .depth = STILLS_DEPTH};
    const struct output_queue_work film = {
        .self = outputs, .take = write_film, .depth = FILM_DEPTH, .patient = outputs->wish.replay};
    if ((outputs->wish.folder != NULL && output_queue_start(&outputs->stills, &stills) != 0) ||
        (outputs->video != NULL && output_queue_start(&outputs->film, &film) != 0))
        return error_text_set(error, "cannot start a thread for pictures: %s", strerror(errno));
    if (outputs->stream != NULL && stream_start(outputs->stream, error) != 0)
        return -1;
    outputs->started = true;
    return 0;
}

/* --- pictures ----------------------------------------------------------------------------------*/

/* NULL: there are more views than rows; every picture of such a one is a still. */
static struct output_set_row *row_of(struct output_set *outputs, const char *view)
{
    for (uint32_t i = 0; i < OUTPUT_SET_VIEWS_MAX; i++) {
        struct output_set_row *row = &outputs->row[i];
        if (row->view[0] == '\0')
            snprintf(row->view, sizeof row->view, "%s", view);
        if (strcmp(row->view, view) == 0)
            return row;
    }
    return NULL;
}

static void put_still(struct output_set *outputs, struct picture *picture)
{
    struct output_set_row *row = row_of(outputs, picture->view);
    double fps = outputs->wish.stills_fps;
    uint64_t now_ns = clock_now_ns();
    if (row != NULL) {
        bool early = fps > 0.0 && row->still_ns != 0 &&
                     (double)(now_ns - row->still_ns) / 1e9 < 1.0 / fps - STILL_SLACK_S;
        picture_release(row->left);
        row->left = early ? picture_hold(picture) : NULL;
        if (early)
            return;
        row->still_ns = now_ns;
    }
    output_queue_put(&outputs->stills, picture);
}

/* 0, or -1 with the reason when there can be no more video. */
static int put_film(struct output_set *outputs, struct picture *picture, struct error_text *error)
{
    if (outputs->video_view[0] == '\0')
        snprintf(outputs->video_view, sizeof outputs->video_view, "%s", picture->view);
    if (strcmp(outputs->video_view, picture->view) == 0)
        output_queue_put(&outputs->film, picture);
    return output_queue_failed(&outputs->film, error) ? -1 : 0;
}

static int hand_out(struct output_set *outputs, struct picture *picture, struct error_text *error)
{
    if (outputs->stream != NULL)
        stream_put(outputs->stream, picture);
    if (outputs->video != NULL && !outputs->video_over && put_film(outputs, picture, error) != 0) {
        if (outputs->wish.replay)
            return -1;
        log_warn("%s: %s; no more of it", outputs->video_path, error->text);
        outputs->video_over = true;
    }
    if (outputs->wish.folder == NULL)
        return 0;
    put_still(outputs, picture);
    return output_queue_failed(&outputs->stills, error) ? -1 : 0;
}

int output_set_put(struct output_set *outputs, const char *view, struct image *image,
                   uint64_t frame, double time_s, const char *words, struct error_text *error)
{
    struct picture *picture = picture_make(&outputs->pool, image, view, words);
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

void output_set_grant(struct output_set *outputs, uint32_t row, uint64_t generation,
                      struct image *image, uint64_t frame, double time_s)
{
    struct picture *picture = NULL;
    if (image != NULL) {
        picture = picture_make(&outputs->asked, image, "asked", "");
        if (picture == NULL)
            return; /* whoever waits asks again */
        picture->frame = frame;
        picture->time_s = time_s;
    }
    stream_grant(outputs->stream, row, generation, picture);
    picture_release(picture);
}

/* --- the end -----------------------------------------------------------------------------------*/

static int close_stills(struct output_set *outputs, struct error_text *error)
{
    for (uint32_t i = 0; i < OUTPUT_SET_VIEWS_MAX; i++) {
        if (outputs->row[i].left != NULL)
            output_queue_put(&outputs->stills, outputs->row[i].left);
        picture_release(outputs->row[i].left);
    }
    int result = output_queue_end(&outputs->stills, error);
    unsigned long long dropped = outputs->stills.dropped + outputs->lost;
    if (dropped > 0)
        log_info("%llu pictures were drawn faster than they could be written", dropped);
    return result;
}

static int close_video(struct output_set *outputs, struct error_text *error)
{
    int result = output_queue_end(&outputs->film, error);
    uint64_t pictures = video_pictures(outputs->video);
    struct error_text second;
    if (video_close(outputs->video, result == 0 ? error : &second) != 0)
        result = -1;
    outputs->video = NULL;
    if (outputs->video_fd >= 0 && close(outputs->video_fd) != 0 && result == 0)
        result = error_text_set(error, "video: cannot complete the file: %s", strerror(errno));
    if (outputs->wish.replay)
        return result;
    if (result != 0 && !outputs->video_over)
        log_warn("%s: %s", outputs->video_path, error->text);
    log_info("%s: %llu pictures%s; %llu came faster than they could be encoded",
             outputs->video_path, (unsigned long long)pictures,
             result == 0 ? "" : ", not completed", (unsigned long long)outputs->film.dropped);
    return 0;
}

int output_set_close(struct output_set *outputs, struct error_text *error)
{
    int result = 0;
    struct error_text second;
    if (!outputs->started)
        return 0;
    stream_close(outputs->stream);
    if (outputs->wish.folder != NULL) {
        result = close_stills(outputs, error);
        picture_folder_close(&outputs->output);
    }
    if (outputs->video != NULL && close_video(outputs, result == 0 ? error : &second) != 0)
        result = -1;
    picture_pool_free(&outputs->pool);
    picture_pool_free(&outputs->asked);
    return result;
}
