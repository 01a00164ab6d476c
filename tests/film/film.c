/* Reads a video as a player does, for system tests: every picture decoded. Prints one JSON object;
 * exit 0 when it could be read from the beginning, even if its end is missing. */
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>

#include <stdio.h>
#include <stdlib.h>

struct film {
    AVFormatContext *file;
    AVCodecContext *codec;
    AVStream *stream;
    int pictures, damaged;
    double first_s, last_s, gap_s; /* gap_s: the longest between two */
    double brightness;             /* mean of the last one's */
};

static void look(struct film *film, const AVFrame *frame)
{
    double at_s = (double)frame->best_effort_timestamp * av_q2d(film->stream->time_base), sum = 0.0;
    if (film->pictures == 0)
        film->first_s = at_s;
    else if (at_s - film->last_s > film->gap_s)
        film->gap_s = at_s - film->last_s;
    film->last_s = at_s;
    film->damaged += frame->decode_error_flags != 0;
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++)
            sum += frame->data[0][y * frame->linesize[0] + x];
    film->brightness = sum / frame->width / frame->height;
    film->pictures++;
}

static void decode(struct film *film, const AVPacket *packet)
{
    AVFrame *frame = av_frame_alloc();
    int result = frame == NULL ? -1 : avcodec_send_packet(film->codec, packet);
    while (result >= 0 && (result = avcodec_receive_frame(film->codec, frame)) >= 0)
        look(film, frame);
    if (result < 0 && result != AVERROR(EAGAIN) && result != AVERROR_EOF)
        film->damaged++;
    av_frame_free(&frame);
}

static int open_film(struct film *film, const char *path)
{
    const AVCodec *codec;
    if (avformat_open_input(&film->file, path, NULL, NULL) < 0 ||
        avformat_find_stream_info(film->file, NULL) < 0)
        return -1;
    int number = av_find_best_stream(film->file, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (number < 0)
        return -1;
    film->stream = film->file->streams[number];
    film->codec = avcodec_alloc_context3(codec);
    return film->codec != NULL &&
                   avcodec_parameters_to_context(film->codec, film->stream->codecpar) >= 0 &&
                   avcodec_open2(film->codec, codec, NULL) >= 0
               ? 0
               : -1;
}

int main(int argc, char **argv)
{
    struct film film = {.pictures = 0};
    av_log_set_level(AV_LOG_QUIET);
    if (argc != 2 || open_film(&film, argv[1]) != 0) {
        fprintf(stderr, "film: %s: cannot be read as a video\n", argc > 1 ? argv[1] : "FILE");
        return 1;
    }
    AVPacket *packet = av_packet_alloc();
    while (packet != NULL && av_read_frame(film.file, packet) >= 0) {
        if (packet->stream_index == film.stream->index)
            decode(&film, packet);
        av_packet_unref(packet);
    }
    decode(&film, NULL);
    av_packet_free(&packet);
    printf("{\"codec\":\"%s\",\"width\":%d,\"height\":%d,\"pictures\":%d,\"damaged\":%d,"
           "\"first_s\":%.4f,\"last_s\":%.4f,\"gap_s\":%.4f,\"duration_s\":%.4f,"
           "\"brightness\":%.1f}\n",
           avcodec_get_name(film.codec->codec_id), film.codec->width, film.codec->height,
           film.pictures, film.damaged, film.first_s, film.last_s, film.gap_s,
           (double)film.file->duration / AV_TIME_BASE, film.brightness);
    avcodec_free_context(&film.codec);
    avformat_close_input(&film.file);
    return 0;
}
