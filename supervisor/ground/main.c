/* jolon-ground: makes ground files from maps, and shows them. jolon ground VERB runs it. It is the
 * only program that links GDAL and PROJ. */
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/process/program_verbs.h"
#include "supervisor/ground/describe.h"
#include "supervisor/ground/ground_export.h"
#include "supervisor/ground/make.h"
#include "supervisor/ground/picture.h"

#include <cpl_error.h>
#include <gdal.h>

#include <stddef.h>

static const struct program_verb verbs[] = {
    {"make", make_run},     {"info", describe_info},       {"check", describe_check},
    {"show", picture_show}, {"export", ground_export_run}, {NULL, NULL}};

static const char usage[] =
    "usage: jolon ground VERB [options]\n"
    "  make INPUT...                  make a ground file from rasters of heights\n"
    "    --center LAT,LON  --side METRES  --posts METRES  --out FILE  --cover FILE\n"
    "    --classes TABLE  --roads FILE  --features FILE  --trees N  --seed N  --feet\n"
    "    --undulation METRES  --licence TEXT  --threads N\n"
    "  info FILE                      say what a ground file holds, and what it was made from\n"
    "    --json\n"
    "  check FILE                     read all of a ground file and check it\n"
    "  show FILE PICTURE.png          draw it, or a part of it, as a shaded picture\n"
    "    --size PIXELS  --at PLACE  --metres M  --grey\n"
    "  export FILE OUT.tif            write its heights, or its cover, as a GeoTIFF\n"
    "    --cover  --world NAME  --area PLACE,PLACE  --step METRES\n"
    "jolon ground VERB --help explains the options of a verb.\n"
    "A scenario runs on a ground file by: terrain = { source = \"file\"; file = \"x.ground\"; };\n";

int main(int argc, char **argv)
{
    log_open("ground");
    process_guard();
    const struct program_verb *verb = program_verbs_find(verbs, usage, argc, argv);
    /* Refusals name GDAL's last error themselves. */
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALAllRegister();
    return verb->run(argc - 1, argv + 1);
}
