/* Reading the command line. */
#include "renderer/options.h"

#include "ipc/http/listen.h"
#include "ipc/process/log.h"
#include "world/maths/maths.h"
#include "world/view_mode.h"
#include "world/runtime/parse_number.h"
#include "world/terrain/gridsquare.h"

#include <stdio.h>
#include <string.h>

#define FPS_MAX          120.0
#define EYE_HEIGHT_M     20.0 /* default of --eye */
#define EYE_HEIGHT_MAX_M 50000.0
#define LIVE_STILLS_FPS  2.0

static const char usage[] =
    "[options] --out DIR\n"
    "       jolon-renderer [options] --snap FILE\n"
    "       jolon-renderer --list-devices\n"
    "Draws a running world off-screen into PNG files: VIEW.png is always the latest picture of a\n"
    "view, VIEW-FRAME.png are the last 120.";

static struct options given = {.world = "default",
                               .fps = -1.0,
                               .field_rad = CAMERA_FIELD_OF_VIEW_RAD,
                               .pose.pitch_rad = -6.0 * RAD_PER_DEG,
                               .back_end = -1,
                               .hold = -1,
                               .outputs = {.stills_fps = -1.0,
                                           .video_fps = 30.0,
                                           .stream_port = -1,
                                           .stream_address = HTTP_LISTEN_ADDRESS}};
static int role = ROLE_RENDERER;
static struct option_size size;
static double field_deg;

static int take_views(const char *text, struct error_text *error)
{
    return views_read(&given.views, text, error);
}

/* Text of digits alone is an id, any other text a name. */
static int take_follow(const char *text, struct error_text *error)
{
    uint64_t id = 0;
    bool named = text[strspn(text, "0123456789")] != '\0';
    if (!named && !parse_whole(text, 0, UINT32_MAX, &id))
        return error_text_set(error, "not a vehicle's id, which is from 0 to %u", UINT32_MAX);
    given.follow = (uint32_t)id;
    given.follow_name = named ? text : NULL;
    given.follow_given = true;
    return 0;
}

/* One number of a list separated by commas. */
struct list_number {
    const char *name;
    double low, high;
    double *value;
};

static int read_list(const char *text, const struct list_number *part, int least, int most,
                     const char *form, struct error_text *error)
{
    double value[3];
    int used = 0,
        count = sscanf(text, "%lf,%lf%n,%lf%n", &value[0], &value[1], &used, &value[2], &used);
    if (count < least || count > most || text[used] != '\0')
        return error_text_set(error, "not %s", form);
    for (int i = 0; i < count; i++) {
        if (!(value[i] >= part[i].low && value[i] <= part[i].high))
            return error_text_set(error, "%s is from %.0f to %.0f", part[i].name, part[i].low,
                                  part[i].high);
        *part[i].value = value[i];
    }
    return 0;
}

static int take_eye(const char *text, struct error_text *error)
{
    static const struct list_number part[] = {
        {"X", 0.0, WORLD_SIDE_MAX_M, &given.pose.x},
        {"Z", 0.0, WORLD_SIDE_MAX_M, &given.pose.z},
        {"HEIGHT", 0.0, EYE_HEIGHT_MAX_M, &given.pose.above_m}};
    given.pose.above_m = EYE_HEIGHT_M;
    given.pose.given = true;
    return read_list(text, part, 2, 3, "X,Z or X,Z,HEIGHT", error);
}

static int take_look(const char *text, struct error_text *error)
{
    double heading = 0.0, pitch = 0.0;
    const struct list_number part[] = {{"HEADING", -360.0, 360.0, &heading},
                                       {"PITCH", -90.0, 90.0, &pitch}};
    int result = read_list(text, part, 2, 2, "HEADING,PITCH", error);
    given.pose.heading_rad = heading * RAD_PER_DEG;
    given.pose.pitch_rad = pitch * RAD_PER_DEG;
    given.look_given = true;
    return result;
}

_Static_assert(ROLE_RENDERER_4 == ROLE_RENDERER + 3 && BACK_END_COUNT == 3,
               "words of --role and --backend, in the order of their enums");

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, NULL),
    {"out", "DIR", "folder for the pictures; made if it does not exist", .text = &given.out},
    {"snap", "FILE", "draw the present frame into FILE and end; needs no role",
     .text = &given.snap},
    {"role", "renderer|renderer-2|renderer-3|renderer-4", "(default renderer)", .choice = &role,
     .least = ROLE_RENDERER},
    {"fps", "F",
     "pictures a second, 0 to 120; 0 draws one at the end (default: the scenario's renderer.fps)",
     .real = &given.fps, .high = FPS_MAX},
    {"view", "VIEW[,VIEW...]",
     "chase, map, inside, orbit, free, overhead; both is chase,map; VIEW:ID shows another vehicle "
     "(default: the scenario's renderer.view)",
     .take = take_views},
    {"size", "WxH", "width and height, 64 to 4096 pixels (default: the scenario's)", .size = &size,
     .least = OPTIONS_SIDE_MIN, .most = OPTIONS_SIDE_MAX},
    {"follow", "VEHICLE",
     "vehicle to follow, by id or name, also --vehicle; 0: the renderer chooses one (default: the "
     "scenario's, until it is destroyed)",
     .take = take_follow},
    {"vehicle", "VEHICLE", NULL, .take = take_follow},
    {"field", "DEG", "horizontal field of view of a 16:9 picture, 10 to 120 degrees (default 60)",
     .real = &field_deg, .low = 10.0, .high = 120.0},
    {"eye", "X,Z[,HEIGHT]", "place of the free camera [m]; HEIGHT is above the ground (default 20)",
     .take = take_eye},
    {"look", "HEADING,PITCH",
     "direction of the free camera [degrees]: clockwise from north, up (default 0,-6)",
     .take = take_look},
    {"backend", "auto|gl|soft",
     "gl (OpenGL), soft (the own rasteriser), or auto: OpenGL where there is graphics hardware "
     "(default: the scenario's)",
     .choice = &given.back_end},
    {"device", "D", "OpenGL device: its number, or part of its name, in --list-devices",
     .text = &given.device},
    {"list-devices", NULL, NULL, .flag = &given.list_devices},
    {"threads", "N",
     "threads of the own rasteriser, 1 to 16 (default: one for every two cores, 4 at most)",
     .u32 = &given.threads, .least = 1, .most = 16},
    {"quality", "fixed|hold",
     "hold: draw less detail, then smaller pictures, to keep the rate (default: the scenario's "
     "renderer.hold)",
     .choice = &given.hold},
    {"exact", NULL, "draw committed frames only: no interpolation, however high the rate",
     .flag = &given.exact},
    {"stills", "F",
     "PNG files a second, at most (default: all pictures; 2 with --video or --stream)",
     .real = &given.outputs.stills_fps, .low = 0.01, .high = FPS_MAX},
    {"video", "FILE",
     "also record a video: .mkv, .mp4 or .webm; a second of it is a second of simulation; an "
     "existing file is kept, and the new one is numbered",
     .text = &given.outputs.video},
    {"video-view", "V", "view of the video (default: the first)",
     .text = &given.outputs.video_view},
    {"video-fps", "F", "pictures a second of the video, at most (default 30)",
     .real = &given.outputs.video_fps, .low = 1.0, .high = FPS_MAX},
    {"stream", "PORT", "show every view to browsers at http://127.0.0.1:PORT/; 0: any free port",
     .integer = &given.outputs.stream_port, .most = UINT16_MAX},
    {"stream-address", "A", "address to listen on instead; other machines need no password then",
     .text = &given.outputs.stream_address},
    OPTION_ROW_PARENT(given),
    OPTION_ROW_NO_SANDBOX(given),
    OPTION_ROWS_END};

/* A video or a stream needs a higher rate than PNG files, and fewer of those. */
static void take_live_defaults(struct options *options)
{
    struct output_set_options *outputs = &options->outputs;
    bool live = outputs->video != NULL || outputs->stream_port >= 0;
    if (live && options->snap != NULL)
        die_usage("--snap makes one picture: --video and --stream are for --out");
    if (live && options->fps < 0.0)
        options->fps = outputs->video_fps;
    if (outputs->stills_fps < 0.0)
        outputs->stills_fps = live ? LIVE_STILLS_FPS : 0.0;
    outputs->world = options->world;
    outputs->folder = options->out;
    outputs->serves_requests = options->out != NULL;
    outputs->role = options->role;
}

/* Ends the process when options contradict each other or need another one. */
static void check(const struct options *options)
{
    if ((options->out == NULL) == (options->snap == NULL))
        die_usage("give --out DIR or --snap FILE; see jolon-renderer --help");
    if (options->look_given && !options->pose.given)
        die_usage("--look: give --eye X,Z too, the place of the free camera");
    bool free_view = false;
    for (uint32_t i = 0; i < options->views.count; i++)
        free_view |= options->views.spec[i].mode == VIEW_FREE;
    if (options->pose.given && !free_view)
        die_usage("--eye: it is the place of the free camera; give --view free too");
    if (options->device != NULL && options->back_end == BACK_END_SOFT)
        die_usage("--device: the own rasteriser needs none; give --backend gl");
}

int options_read(struct options *options, const struct option_table *own, int argc, char **argv)
{
    struct option_table table = {.program = "jolon-renderer", .usage = usage, .rows = rows};
    if (own) {
        table = *own;
        table.more = rows;
        given.out = ".";
    }
    int arguments = option_table_read(&table, argc, argv);
    if (given.views.count == 0 && (given.pose.given || own))
        views_of_bits(&given.views, 1u << (given.pose.given ? VIEW_FREE : VIEW_CHASE));
    given.role = (enum role)role;
    given.width = size.width;
    given.height = size.height;
    if (field_deg > 0.0)
        given.field_rad = field_deg * RAD_PER_DEG;
    if (!given.list_devices)
        check(&given);
    take_live_defaults(&given);
    *options = given;
    return arguments;
}
