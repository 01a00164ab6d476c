/* Encoding and writing video with FFmpeg's libraries. */
#include "renderer/output/video.h"

#include "renderer/image/yuv.h"
#include "renderer/output/libav.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Ticks a second: a multiple of the usual rates 24, 25, 30, 50 and 60. MPEG-4 allows at most 65535.
 */
#define TICKS        60000
#define WRITE_BYTES  65536
#define SETTINGS_MAX 8
#define LIVE_GOP_S   1.0 /* between key frames: what is lost at most when it is killed */
#define REPLAY_GOP_S 4.0
#define EARLY_SLOTS  1e-6 /* tolerance for rounding of times */

struct setting {
    const char *key, *value;
};

struct encoder {
    const char *name;
    struct setting live[SETTINGS_MAX], replay[SETTINGS_MAX];
};

static const struct encoder x264 = {
    "libx264",
    {{"preset", "superfast"}, {"crf", "23"}, {"x264-params", "bframes=0:rc-lookahead=0"}},
    {{"preset", "fast"}, {"crf", "19"}}};
/* A quality of 3 (1 is the best of 31), in the library's 118ths. */
static const struct encoder mpeg4 = {"mpeg4",
                                     {{"flags", "+qscale"}, {"global_quality", "354"}},
                                     {{"flags", "+qscale"}, {"global_quality", "354"}}};
static const struct encoder vp8 = {
    "libvpx",
    {{"deadline", "realtime"}, {"cpu-used", "8"}, {"crf", "12"}, {"b", "6M"}},
    {{"deadline", "good"}, {"cpu-used", "5"}, {"crf", "8"}, {"b", "12M"}}};

static const struct container {
    const char *ending, *format;
    const struct encoder *encoder[2]; /* the better one first */
    struct setting live[SETTINGS_MAX];
} containers[] = {
    {".mkv", "matroska", {&x264, &mpeg4}, {{"cluster_time_limit", "1000"}}},
    {".mp4", "mp4", {&x264, &mpeg4}, {{"movflags", "frag_keyframe+empty_moov+default_base_moof"}}},
    {".webm", "webm", {&vp8, NULL}, {{"cluster_time_limit", "1000"}}},
};

struct video {
    const struct container *container;
    const struct encoder *encoder;
    enum video_purpose purpose;
    double fps;
    int fd, write_error; /* errno of a failed write; 0: none */
    AVFormatContext *file;
    AVCodecContext *codec;
    AVStream *stream;
    AVFrame *frame;
    AVPacket *packet;
    double start_s;
    int64_t slot; /* of the last picture, in 1/fps s from the first */
    uint64_t pictures;
};

/* --- format and encoder ------------------------------------------------------------------------*/

static const struct container *find_container(const char *path)
{
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof containers / sizeof containers[0]; i++) {
        size_t ending = strlen(containers[i].ending);
        if (length > ending && strcmp(path + length - ending, containers[i].ending) == 0)
            return &containers[i];
    }
    return NULL;
}

static const struct encoder *find_encoder(const struct container *container)
{
    for (size_t i = 0; i < sizeof container->encoder / sizeof container->encoder[0]; i++) {
        const struct encoder *encoder = container->encoder[i];
        if (encoder != NULL && libav.avcodec_find_encoder_by_name(encoder->name) != NULL)
            return encoder;
    }
    return NULL;
}

struct video *video_open(const char *path, double fps, enum video_purpose purpose,
                         struct error_text *error)
{
    const struct container *container = find_container(path);
    if (container == NULL) {
        error_text_set(error, "video %s: must end in .mkv, .mp4 or .webm", path);
        return NULL;
    }
    if (libav_open(error) != 0)
        return NULL;
    const struct encoder *encoder = find_encoder(container);
    if (encoder == NULL) {
        error_text_set(error, "video %s: the machine's libavcodec has no encoder for it", path);
        return NULL;
    }
    struct video *video = malloc(sizeof *video);
    if (video == NULL) {
        error_text_set(error, "video %s: no memory", path);
        return NULL;
    }
    *video = (struct video){.container = container,
                            .encoder = encoder,
                            .purpose = purpose,
                            .fps = fps,
                            .fd = -1,
                            .slot = -1};
    return video;
}

void video_write_to(struct video *video, int fd)
{
    video->fd = fd;
}

/* --- the file ----------------------------------------------------------------------------------*/

static int write_bytes(void *context, uint8_t *bytes, int count)
{
    struct video *video = context;
    for (int done = 0; done < count;) {
        ssize_t written = write(video->fd, bytes + done, (size_t)(count - done));
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0) {
            video->write_error = errno;
            return AVERROR(errno);
        }
        done += (int)written;
    }
    return count;
}

static int64_t seek_bytes(void *context, int64_t offset, int whence)
{
    const struct video *video = context;
    if (whence != SEEK_SET && whence != SEEK_CUR && whence != SEEK_END)
        return AVERROR(EINVAL); /* FFmpeg's own values of whence */
    int64_t at = lseek(video->fd, offset, whence);
    return at < 0 ? AVERROR(errno) : at;
}

/* Sets the text of a library's error code, or that of a failed write. Returns -1. */
static int failed(const struct video *video, const char *what, int code, struct error_text *error)
{
    char text[128];
    libav.av_strerror(code, text, sizeof text);
    return error_text_set(error, "video: %s: %s", what,
                          video->write_error != 0 ? strerror(video->write_error) : text);
}

static int set(AVDictionary **options, const struct setting *setting)
{
    int result = 0;
    for (int i = 0; i < SETTINGS_MAX && setting[i].key != NULL && result >= 0; i++)
        result = libav.av_dict_set(options, setting[i].key, setting[i].value, 0);
    return result;
}

static int open_file(struct video *video)
{
    AVDictionary *options = NULL;
    int result =
        libav.avformat_alloc_output_context2(&video->file, NULL, video->container->format, NULL);
    if (result < 0)
        return result;
    uint8_t *buffer = libav.av_malloc(WRITE_BYTES);
    if (buffer == NULL)
        return AVERROR(ENOMEM);
    video->file->pb =
        libav.avio_alloc_context(buffer, WRITE_BYTES, 1, video, NULL, write_bytes, seek_bytes);
    if (video->file->pb == NULL) {
        libav.av_free(buffer);
        return AVERROR(ENOMEM);
    }
    /* Without random identifiers, for which the library would open a device. */
    video->file->flags |= AVFMT_FLAG_BITEXACT;
    video->stream = libav.avformat_new_stream(video->file, NULL);
    if (video->stream == NULL)
        return AVERROR(ENOMEM);
    video->stream->time_base = video->codec->time_base;
    video->stream->avg_frame_rate = video->codec->framerate;
    result = libav.avcodec_parameters_from_context(video->stream->codecpar, video->codec);
    if (result >= 0 && video->purpose == VIDEO_LIVE)
        result = set(&options, video->container->live);
    if (result >= 0)
        result = libav.avformat_write_header(video->file, &options);
    libav.av_dict_free(&options);
    return result;
}

/* --- encoding ----------------------------------------------------------------------------------*/

static int open_codec(struct video *video, uint32_t width, uint32_t height)
{
    const AVCodec *codec = libav.avcodec_find_encoder_by_name(video->encoder->name);
    const bool live = video->purpose == VIDEO_LIVE;
    AVDictionary *options = NULL;
    AVCodecContext *context = video->codec = libav.avcodec_alloc_context3(codec);
    if (context == NULL)
        return AVERROR(ENOMEM);
    context->width = (int)(width & ~1u);
    context->height = (int)(height & ~1u);
    context->pix_fmt = AV_PIX_FMT_YUV420P;
    context->time_base = (AVRational){1, TICKS};
    context->framerate = (AVRational){(int)lround(video->fps * 1000.0), 1000};
    context->gop_size = (int)ceil(video->fps * (live ? LIVE_GOP_S : REPLAY_GOP_S));
    context->max_b_frames = 0;
    context->thread_count = live ? 1 : 2;
    context->colorspace = AVCOL_SPC_BT709;
    context->color_primaries = AVCOL_PRI_BT709;
    context->color_trc = AVCOL_TRC_BT709;
    context->color_range = AVCOL_RANGE_MPEG;
    context->chroma_sample_location = AVCHROMA_LOC_CENTER;
    context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    int result = set(&options, live ? video->encoder->live : video->encoder->replay);
    if (result >= 0)
        result = libav.avcodec_open2(context, codec, &options);
    libav.av_dict_free(&options);
    return result;
}

static int open_frame(struct video *video)
{
    video->packet = libav.av_packet_alloc();
    video->frame = libav.av_frame_alloc();
    if (video->packet == NULL || video->frame == NULL)
        return AVERROR(ENOMEM);
    video->frame->format = video->codec->pix_fmt;
    video->frame->width = video->codec->width;
    video->frame->height = video->codec->height;
    return libav.av_frame_get_buffer(video->frame, 0);
}

static int begin(struct video *video, const struct picture *picture)
{
    int result = open_codec(video, picture->image.width, picture->image.height);
    if (result >= 0)
        result = open_frame(video);
    if (result >= 0)
        result = open_file(video);
    video->start_s = picture->time_s;
    return result;
}

/* Encodes a frame, NULL at the end, and writes the packets that are ready. Returns 0, or an error
 * code below 0. */
static int encode(struct video *video, const AVFrame *frame)
{
    int result = libav.avcodec_send_frame(video->codec, frame);
    while (result >= 0) {
        result = libav.avcodec_receive_packet(video->codec, video->packet);
        if (result == AVERROR(EAGAIN) || result == AVERROR_EOF)
            break;
        if (result < 0)
            return result;
        if (video->packet->duration == 0)
            video->packet->duration = llround(TICKS / video->fps);
        libav.av_packet_rescale_ts(video->packet, video->codec->time_base,
                                   video->stream->time_base);
        video->packet->stream_index = video->stream->index;
        result = libav.av_interleaved_write_frame(video->file, video->packet);
    }
    if (result < 0 && result != AVERROR(EAGAIN) && result != AVERROR_EOF)
        return result;
    if (video->purpose == VIDEO_LIVE)
        libav.avio_flush(video->file->pb);
    return video->file->pb->error;
}

static int put_frame(struct video *video, const struct image *image, double after_s)
{
    int result = libav.av_frame_make_writable(video->frame);
    if (result < 0)
        return result;
    struct yuv yuv;
    for (int i = 0; i < 3; i++) {
        yuv.plane[i] = video->frame->data[i];
        yuv.stride[i] = video->frame->linesize[i];
    }
    yuv_of_image(&yuv, image);
    video->frame->pts = llround(after_s * TICKS);
    video->frame->quality = video->codec->global_quality;
    return encode(video, video->frame);
}

int video_put(struct video *video, const struct picture *picture, struct error_text *error)
{
    if (video->codec == NULL) {
        int result = begin(video, picture);
        if (result < 0)
            return failed(video, "cannot begin", result, error);
    }
    if ((picture->image.width & ~1u) != (uint32_t)video->codec->width ||
        (picture->image.height & ~1u) != (uint32_t)video->codec->height)
        return error_text_set(error, "video: a picture of %ux%u comes after those of %dx%d",
                              picture->image.width, picture->image.height, video->codec->width,
                              video->codec->height);
    double after_s = picture->time_s - video->start_s;
    int64_t slot = (int64_t)floor(after_s * video->fps + EARLY_SLOTS);
    if (slot <= video->slot)
        return 0;
    video->slot = slot;
    int result = put_frame(video, &picture->image, after_s);
    if (result < 0)
        return failed(video, "cannot go on", result, error);
    video->pictures++;
    return 0;
}

uint64_t video_pictures(const struct video *video)
{
    return video->pictures;
}

const char *video_codec(const struct video *video)
{
    return video->encoder->name;
}

/* --- the end -----------------------------------------------------------------------------------*/

static void free_file(struct video *video)
{
    if (video->file == NULL)
        return;
    if (video->file->pb != NULL) {
        libav.av_free(video->file->pb->buffer);
        libav.avio_context_free(&video->file->pb);
    }
    libav.avformat_free_context(video->file);
}

int video_close(struct video *video, struct error_text *error)
{
    if (video == NULL)
        return 0;
    int result = video->write_error != 0 ? AVERROR(video->write_error) : 0, told = 0;
    if (video->pictures > 0) {
        int encoded = encode(video, NULL);
        int written = libav.av_write_trailer(video->file);
        libav.avio_flush(video->file->pb);
        result = encoded < 0 ? encoded : written < 0 ? written : video->file->pb->error;
    }
    if (result < 0)
        told = failed(video, "cannot complete the file", result, error);
    free_file(video);
    if (video->codec != NULL) {
        libav.avcodec_free_context(&video->codec);
        libav.av_packet_free(&video->packet);
        libav.av_frame_free(&video->frame);
    }
    free(video);
    return told;
}
