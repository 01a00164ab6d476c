/* jolon-ground: makes ground files from maps, and shows them. jolon ground VERB runs it. It is the
 * only program that links GDAL and PROJ. */
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "supervisor/ground/describe.h"
#include "supervisor/ground/make.h"
#include "supervisor/ground/picture.h"

#include <cpl_error.h>
#include <gdal.h>

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
} verbs[] = {{"make", make_run},
             {"info", describe_info},
             {"check", describe_check},
             {"show", picture_show},
             {"export", picture_export}};

static const char usage[] =
    "usage: jolon ground VERB [options]\n"
    "  make INPUT...                  make a ground file from rasters of heights\n"
    "    --center LAT,LON  --side METRES  --posts METRES  --out FILE  --cover FILE\n"
    "    --classes TABLE  --roads FILE  --feet  --undulation METRES  --licence TEXT  --threads N\n"
    "  info FILE                      say what a ground file holds, and what it was made from\n"
    "    --json\n"
    "  check FILE                     read all of a ground file and check it\n"
    "  show FILE PICTURE.png          draw it as a shaded picture\n"
    "    --size PIXELS  --grey\n"
    "  export FILE OUT.tif            write its heights, or its cover, as a GeoTIFF\n"
    "    --cover\n"
    "jolon ground VERB --help explains the options of a verb.\n"
    "A scenario runs on a ground file by: terrain = { source = \"file\"; file = \"x.ground\"; };\n";

int main(int argc, char **argv)
{
    log_open("ground");
    process_guard();
    if (argc < 2) {
        fputs(usage, stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0 ||
        strcmp(argv[1], "-h") == 0) {
        fputs(usage, stdout);
        return EXIT_OK;
    }
    for (unsigned i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        if (strcmp(argv[1], verbs[i].name) != 0)
            continue;
        /* Refusals name GDAL's last error themselves. */
        CPLPushErrorHandler(CPLQuietErrorHandler);
        GDALAllRegister();
        return verbs[i].run(argc - 1, argv + 1);
    }
    die_usage("%s: no such verb; there are make, info, check, show, export", argv[1]);
}
