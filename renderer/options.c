/* Reading the command line. */
#include "renderer/options.h"

#include "ipc/log.h"
#include "ipc/process.h"
#include "world/world.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FPS_MAX 60.0

static const char usage_text[] =
    "usage: jolon-renderer [options] --out DIR\n"
    "       jolon-renderer [options] --snap FILE\n"
    "Draws a running world off-screen into PNG files: chase.png and map.png are always the latest\n"
    "pictures, chase-FRAME.png and map-FRAME.png the last 120 of each.\n"
    "  -w, --world NAME    the world (default \"default\")\n"
    "      --out DIR       where the pictures go; made if it is not there\n"
    "      --snap FILE     draw the present frame into FILE and end; takes no role\n"
    "      --role ROLE     renderer, renderer-2, renderer-3 or renderer-4 (default renderer)\n"
    "      --fps F         pictures a second, 0 to 60; 0 draws one at the end (default: the\n"
    "                      scenario's renderer.fps)\n"
    "      --view VIEW     chase, map or both (default: the scenario's renderer.view)\n"
    "      --size WxH      64 to 4096 pixels each (default: the scenario's)\n"
    "      --follow ID     the vehicle to follow; 0 picks a lively one (default: the scenario's,\n"
    "                      until it is destroyed)\n"
    "      --parent PID    end when this process does\n"
    "      --no-sandbox    give up no privileges\n"
    "      --help          this text\n";

static const struct option long_options[] = {
    {"world", required_argument, NULL, 'w'},  {"out", required_argument, NULL, 'o'},
    {"snap", required_argument, NULL, 's'},   {"role", required_argument, NULL, 'r'},
    {"fps", required_argument, NULL, 'f'},    {"view", required_argument, NULL, 'v'},
    {"size", required_argument, NULL, 'z'},   {"follow", required_argument, NULL, 'F'},
    {"parent", required_argument, NULL, 'p'}, {"no-sandbox", no_argument, NULL, 'S'},
    {"help", no_argument, NULL, 'h'},         {NULL, 0, NULL, 0},
};

static int view_of(const char *text)
{
    for (int view = 0; view < VIEW_COUNT; view++)
        if (strcmp(text, view_mode_name((enum view_mode)view)) == 0)
            return view;
    die_usage("--view %s: not one of chase, map, both", text);
}

static void read_size(struct options *options, const char *text)
{
    unsigned width, height;
    int used = 0;
    if (sscanf(text, "%4ux%4u%n", &width, &height, &used) != 2 || text[used] != '\0' ||
        width < OPTIONS_SIDE_MIN || width > OPTIONS_SIDE_MAX || height < OPTIONS_SIDE_MIN ||
        height > OPTIONS_SIDE_MAX)
        die_usage("--size %s: not WxH with each from %u to %u, as 1280x720", text, OPTIONS_SIDE_MIN,
                  OPTIONS_SIDE_MAX);
    options->width = width;
    options->height = height;
}

static enum role role_of(const char *text)
{
    enum role role = role_find(text);
    if (role < ROLE_RENDERER || role > ROLE_RENDERER_4)
        die_usage("--role %s: not one of renderer, renderer-2, renderer-3, renderer-4", text);
    return role;
}

static void take(struct options *options, int letter, const char *value)
{
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
        options->view = view_of(value);
        break;
    case 'z':
        read_size(options, value);
        break;
    case 'F':
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
        /* getopt has said which option it does not know. */
        fputs(usage_text, stderr);
        exit(EXIT_USAGE);
    }
}

void options_read(struct options *options, int argc, char **argv)
{
    *options = (struct options){.world = "default", .role = ROLE_RENDERER, .fps = -1.0, .view = -1};
    int letter;
    while ((letter = getopt_long(argc, argv, "w:", long_options, NULL)) != -1)
        take(options, letter, optarg);
    if (optind < argc)
        die_usage("%s: not an option; see --help", argv[optind]);
    if ((options->out == NULL) == (options->snap == NULL))
        die_usage("give --out DIR or --snap FILE; see --help");
}
