/* video_probe: decodes every picture of a video, as a player does, for system tests. Prints one
 * JSON object. Exits with 0 if the video can be read from its beginning, even if its end is
 * missing. */
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>

#include <stdio.h>
#include <stdlib.h>

struct video {
    AVFormatContext *file;
    AVCodecContext *codec;
    AVStream *stream;
    int pictures, damaged;
    double first_s, last_s, gap_s; /* gap_s: longest time between two pictures */
    double brightness;             /* mean brightness of the last picture */
};

static void count_picture(struct video *video, const AVFrame *frame)
{
    double at_s = (double)frame->best_effort_timestamp * av_q2d(video->stream->time_base),
           sum = 0.0;
    if (video->pictures == 0)
        video->first_s = at_s;
    else if (at_s - video->last_s > video->gap_s)
        video->gap_s = at_s - video->last_s;
    video->last_s = at_s;
    video->damaged += frame->decode_error_flags != 0;
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++)
            sum += frame->data[0][y * frame->linesize[0] + x];
    video->brightness = sum / frame->width / frame->height;
    video->pictures++;
}

static void decode(struct video *video, const AVPacket *packet)
{
    AVFrame *frame = av_frame_alloc();
    int result = frame == NULL ? -1 : avcodec_send_packet(video->codec, packet);
    while (result >= 0 && (result = avcodec_receive_frame(video->codec, frame)) >= 0)
        count_picture(video, frame);
    if (result < 0 && result != AVERROR(EAGAIN) && result != AVERROR_EOF)
        video->damaged++;
    av_frame_free(&frame);
}

static int open_video(struct video *video, const char *path)
{
    const AVCodec *codec;
    if (avformat_open_input(&video->file, path, NULL, NULL) < 0 ||
        avformat_find_stream_info(video->file, NULL) < 0)
        return -1;
    int number = av_find_best_stream(video->file, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (number < 0)
        return -1;
    video->stream = video->file->streams[number];
    video->codec = avcodec_alloc_context3(codec);
    return video->codec != NULL &&
                   avcodec_parameters_to_context(video->codec, video->stream->codecpar) >= 0 &&
                   avcodec_open2(video->codec, codec, NULL) >= 0
               ? 0
               : -1;
}

int main(int argc, char **argv)
{
    struct video video = {.pictures = 0};
    av_log_set_level(AV_LOG_QUIET);
    if (argc != 2 || open_video(&video, argv[1]) != 0) {
        fprintf(stderr, "video_probe: %s: cannot be read as a video\n",
                argc > 1 ? argv[1] : "FILE");
        return 1;
    }
    AVPacket *packet = av_packet_alloc();
    while (packet != NULL && av_read_frame(video.file, packet) >= 0) {
        if (packet->stream_index == video.stream->index)
            decode(&video, packet);
        av_packet_unref(packet);
    }
    decode(&video, NULL);
    av_packet_free(&packet);
    printf("{\"codec\":\"%s\",\"width\":%d,\"height\":%d,\"pictures\":%d,\"damaged\":%d,"
           "\"first_s\":%.4f,\"last_s\":%.4f,\"gap_s\":%.4f,\"duration_s\":%.4f,"
           "\"brightness\":%.1f}\n",
           avcodec_get_name(video.codec->codec_id), video.codec->width, video.codec->height,
           video.pictures, video.damaged, video.first_s, video.last_s, video.gap_s,
           (double)video.file->duration / AV_TIME_BASE, video.brightness);
    avcodec_free_context(&video.codec);
    avformat_close_input(&video.file);
    return 0;
}
