/* Reading the command line. */
#include "renderer/options.h"

#include "ipc/http/listen.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FPS_MAX         120.0
#define FIELD_LEAST     10.0
#define FIELD_MOST      120.0
#define EYE_HEIGHT_M    20.0 /* of a free camera, when none is given */
#define LOOK_PITCH_DEG  -6.0
#define UP_MOST_M       50000.0
#define VIDEO_FPS       30.0
#define LIVE_STILLS_FPS 2.0

static const char usage_text[] =
    "usage: jolon-renderer [options] --out DIR\n"
    "       jolon-renderer [options] --snap FILE\n"
    "       jolon-renderer --list-devices\n"
    "Draws a running world off-screen into PNG files: VIEW.png is always the latest picture of a\n"
    "view, VIEW-FRAME.png are the last 120.\n"
    "  -w, --world NAME    the world (default \"default\")\n"
    "      --out DIR       where the pictures go; made if it is not there\n"
    "      --snap FILE     draw the present frame into FILE and end; takes no role\n"
    "      --role ROLE     renderer, renderer-2, renderer-3 or renderer-4 (default renderer)\n"
    "      --fps F         pictures a second, 0 to 120; 0 draws one at the end (default: the\n"
    "                      scenario's renderer.fps)\n"
    "      --view VIEW[,VIEW...]\n"
    "                      chase, map, inside, orbit, free, overhead; both: chase,map; VIEW:ID is\n"
    "                      that of another vehicle (default: the scenario's renderer.view)\n"
    "      --size WxH      64 to 4096 pixels each (default: the scenario's)\n"
    "      --follow VEHICLE\n"
    "                      whom to follow, by id or name, --vehicle likewise; 0 picks a lively "
    "one\n"
    "                      (default: the scenario's, until it is destroyed)\n"
    "      --field DEG     of view, from left to right of a 16:9 picture: 10 to 120 (default 60)\n"
    "      --eye X,Z[,HEIGHT]\n"
    "                      where the free camera stands [m], and how high above the ground (20)\n"
    "      --look HEADING,PITCH\n"
    "                      and looks [degrees]: clockwise from north, up (default 0,-6)\n"
    "      --backend B     what draws: gl (OpenGL), soft (the own rasteriser), or auto: OpenGL\n"
    "                      where there is graphics hardware (default: the scenario's)\n"
    "      --device D      of OpenGL: its number or part of its name in --list-devices\n"
    "      --threads N     of the own rasteriser, 1 to 16 (default: one for every two cores, 4 at\n"
    "                      most)\n"
    "      --quality Q     hold: less detail, then smaller, rather than fewer pictures; fixed\n"
    "                      (default: the scenario's renderer.hold)\n"
    "      --exact         committed frames alone: nothing in between, however high the rate\n"
    "      --stills F      PNG files a second, at most (default: every picture; 2 with --video or\n"
    "                      --stream)\n"
    "      --video FILE    a video too: .mkv, .mp4 or .webm; a second of it is a second of\n"
    "                      simulation; a file that is there is left, and the new one numbered\n"
    "      --video-view V  of this view (default: the first)\n"
    "      --video-fps F   pictures a second of it, at most (default 30)\n"
    "      --stream PORT   show every view to browsers: http://127.0.0.1:PORT/; 0: any port\n"
    "      --stream-address A\n"
    "                      where to listen instead: others may come then, without a password\n"
    "      --parent PID    end when this process does\n"
    "      --no-sandbox    give up no privileges\n"
    "      --help          this text\n";

enum {
    OPTION_LIST = 256,
    OPTION_FIELD,
    OPTION_EYE,
    OPTION_LOOK,
    OPTION_BACK_END,
    OPTION_DEVICE,
    OPTION_THREADS,
    OPTION_QUALITY,
    OPTION_EXACT,
    OPTION_STILLS,
    OPTION_VIDEO,
    OPTION_VIDEO_VIEW,
    OPTION_VIDEO_FPS,
    OPTION_STREAM,
    OPTION_STREAM_ADDRESS
};

static const struct option long_options[] = {
    {"world", required_argument, NULL, 'w'},
    {"out", required_argument, NULL, 'o'},
    {"snap", required_argument, NULL, 's'},
    {"role", required_argument, NULL, 'r'},
    {"fps", required_argument, NULL, 'f'},
    {"view", required_argument, NULL, 'v'},
    {"size", required_argument, NULL, 'z'},
    {"follow", required_argument, NULL, 'F'},
    {"vehicle", required_argument, NULL, 'F'},
    {"field", required_argument, NULL, OPTION_FIELD},
    {"eye", required_argument, NULL, OPTION_EYE},
    {"look", required_argument, NULL, OPTION_LOOK},
    {"backend", required_argument, NULL, OPTION_BACK_END},
    {"device", required_argument, NULL, OPTION_DEVICE},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"quality", required_argument, NULL, OPTION_QUALITY},
    {"exact", no_argument, NULL, OPTION_EXACT},
    {"stills", required_argument, NULL, OPTION_STILLS},
    {"video", required_argument, NULL, OPTION_VIDEO},
    {"video-view", required_argument, NULL, OPTION_VIDEO_VIEW},
    {"video-fps", required_argument, NULL, OPTION_VIDEO_FPS},
    {"stream", required_argument, NULL, OPTION_STREAM},
    {"stream-address", required_argument, NULL, OPTION_STREAM_ADDRESS},
    {"list-devices", no_argument, NULL, OPTION_LIST},
    {"parent", required_argument, NULL, 'p'},
    {"no-sandbox", no_argument, NULL, 'S'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

static void read_views(struct options *options, const char *text)
{
    struct reason reason;
    if (views_read(&options->views, text, &reason) != 0)
        die_usage("--view %s: %s", text, reason.text);
}

/* "a,b" or, where a third may follow, "a,b,c"; how many there were. */
static int read_numbers(const char *option, const char *text, double value[3], int most)
{
    int used = 0,
        count = sscanf(text, "%lf,%lf%n,%lf%n", &value[0], &value[1], &used, &value[2], &used);
    if (count < 2 || count > most || text[used] != '\0')
        die_usage("--%s %s: not %s", option, text,
                  most == 3 ? "X,Z or X,Z,HEIGHT" : "HEADING,PITCH");
    return count;
}

static void check_range(const char *option, const char *text, const char *what, double value,
                        double low, double high)
{
    if (!(value >= low && value <= high))
        die_usage("--%s %s: %s is from %.0f to %.0f", option, text, what, low, high);
}

static void read_eye(struct options *options, const char *text)
{
    double value[3] = {0.0, 0.0, EYE_HEIGHT_M};
    read_numbers("eye", text, value, 3);
    check_range("eye", text, "X", value[0], 0.0, WORLD_SIDE_M);
    check_range("eye", text, "Z", value[1], 0.0, WORLD_SIDE_M);
    check_range("eye", text, "HEIGHT", value[2], 0.0, UP_MOST_M);
    options->stand.given = true;
    options->stand.x = value[0];
    options->stand.z = value[1];
    options->stand.above_m = value[2];
}

static void read_look(struct options *options, const char *text)
{
    double value[3];
    read_numbers("look", text, value, 2);
    check_range("look", text, "HEADING", value[0], -360.0, 360.0);
    check_range("look", text, "PITCH", value[1], -90.0, 90.0);
    options->stand.heading_rad = value[0] * RAD_PER_DEG;
    options->stand.pitch_rad = value[1] * RAD_PER_DEG;
    options->look_given = true;
}

static int back_end_of(const char *text)
{
    for (int i = 0; i < BACK_END_COUNT; i++)
        if (strcmp(text, back_end_name((enum back_end)i)) == 0)
            return i;
    die_usage("--backend %s: not one of auto, gl, soft", text);
}

static int hold_of(const char *text)
{
    if (strcmp(text, "hold") != 0 && strcmp(text, "fixed") != 0)
        die_usage("--quality %s: not one of hold, fixed", text);
    return text[0] == 'h';
}

static enum role role_of(const char *text)
{
    enum role role = role_find(text);
    if (role < ROLE_RENDERER || role > ROLE_RENDERER_4)
        die_usage("--role %s: not one of renderer, renderer-2, renderer-3, renderer-4", text);
    return role;
}

/* Options of how it draws; false when it is none of them. */
static bool take_drawing(struct options *options, int letter, const char *value)
{
    switch (letter) {
    case OPTION_FIELD:
        options->field_rad = process_number("field", value, FIELD_LEAST, FIELD_MOST) * RAD_PER_DEG;
        return true;
    case OPTION_EYE:
        read_eye(options, value);
        return true;
    case OPTION_LOOK:
        read_look(options, value);
        return true;
    case OPTION_BACK_END:
        options->back_end = back_end_of(value);
        return true;
    case OPTION_DEVICE:
        options->device = value;
        return true;
    case OPTION_THREADS:
        options->threads = (uint32_t)process_whole("threads", value, 1, 16);
        return true;
    case OPTION_QUALITY:
        options->hold = hold_of(value);
        return true;
    case OPTION_EXACT:
        options->exact = true;
        return true;
    case OPTION_LIST:
        options->list_devices = true;
        return true;
    default:
        return false;
    }
}

/* Options of where pictures go beside PNG files; false when it is none of them. */
static bool take_outlet(struct options *options, int letter, const char *value)
{
    switch (letter) {
    case OPTION_STILLS:
        options->outlets.stills_fps = process_number("stills", value, 0.01, FPS_MAX);
        return true;
    case OPTION_VIDEO:
        options->outlets.video = value;
        return true;
    case OPTION_VIDEO_VIEW:
        options->outlets.video_view = value;
        return true;
    case OPTION_VIDEO_FPS:
        options->outlets.video_fps = process_number("video-fps", value, 1.0, FPS_MAX);
        return true;
    case OPTION_STREAM:
        options->outlets.stream_port = (int)process_whole("stream", value, 0, UINT16_MAX);
        return true;
    case OPTION_STREAM_ADDRESS:
        options->outlets.stream_address = value;
        return true;
    default:
        return false;
    }
}

/* Somebody watches: more than a still now and then. */
static void take_live_defaults(struct options *options)
{
    struct output_set_wish *wish = &options->outlets;
    bool live = wish->video != NULL || wish->stream_port >= 0;
    if (live && options->snap != NULL)
        die_usage("--snap makes one picture: --video and --stream are for --out");
    if (live && options->fps < 0.0)
        options->fps = wish->video_fps;
    if (wish->stills_fps < 0.0)
        wish->stills_fps = live ? LIVE_STILLS_FPS : 0.0;
    wish->world = options->world;
    wish->folder = options->out;
    wish->asked = options->out != NULL;
    wish->role = options->role;
}

/* said: the argument as it was given */
static void take(struct options *options, int letter, const char *value, const char *said)
{
    struct process_size size;
    if (take_drawing(options, letter, value) || take_outlet(options, letter, value))
        return;
    switch (letter) {
    case 'w':
        options->world = value;
        break;
    case 'o':
        options->out = value;
        break;
    case 's':
        options->snap = value;
        break;
    case 'r':
        options->role = role_of(value);
        break;
    case 'f':
        options->fps = process_number("fps", value, 0.0, FPS_MAX);
        break;
    case 'v':
        read_views(options, value);
        break;
    case 'z':
        size = process_size("size", value, OPTIONS_SIDE_MIN, OPTIONS_SIDE_MAX);
        options->width = size.width;
        options->height = size.height;
        break;
    case 'F':
        options->follow_name = value[strspn(value, "0123456789")] != '\0' ? value : NULL;
        if (options->follow_name == NULL)
            options->follow = (uint32_t)process_whole("follow", value, 0, UINT32_MAX);
        options->follow_given = true;
        break;
    case 'p':
        options->parent_pid = (int)process_whole("parent", value, 1, INT32_MAX);
        break;
    case 'S':
        options->sandbox_off = true;
        break;
    case 'h':
        fputs(usage_text, stdout);
        exit(EXIT_OK);
    default:
        die_usage("%s: no such option, or its value is missing; see --help", said);
    }
}

/* What of the command line must go together. */
static void check(const struct options *options)
{
    if ((options->out == NULL) == (options->snap == NULL))
        die_usage("give --out DIR or --snap FILE; see --help");
    if (options->look_given && !options->stand.given)
        die_usage("--look: give --eye X,Z too, the free camera's place");
    bool free_view = false;
    for (uint32_t i = 0; i < options->views.count; i++)
        free_view |= options->views.wish[i].mode == VIEW_FREE;
    if (options->stand.given && !free_view)
        die_usage("--eye: it is the free camera's place; give --view free too");
    if (options->device != NULL && options->back_end == BACK_END_SOFT)
        die_usage("--device: the own rasteriser needs none; give --backend gl");
}

void options_read(struct options *options, int argc, char **argv)
{
    *options = (struct options){.world = "default",
                                .role = ROLE_RENDERER,
                                .fps = -1.0,
                                .field_rad = CAMERA_FIELD_OF_VIEW_RAD,
                                .stand.pitch_rad = LOOK_PITCH_DEG * RAD_PER_DEG,
                                .back_end = -1,
                                .hold = -1,
                                .outlets = {.stills_fps = -1.0,
                                            .video_fps = VIDEO_FPS,
                                            .stream_port = -1,
                                            .stream_address = HTTP_LISTEN_ADDRESS}};
    int letter;
    opterr = 0; /* we say it, in one line */
    while ((letter = getopt_long(argc, argv, "w:h", long_options, NULL)) != -1)
        take(options, letter, optarg, argv[optind - 1]);
    if (optind < argc)
        die_usage("%s: not an option; see --help", argv[optind]);
    if (options->stand.given && options->views.count == 0)
        read_views(options, "free");
    if (!options->list_devices)
        check(options);
    take_live_defaults(options);
}
