/* Finds a scenario's ground file. */
#include "config/ground_source.h"

#include "world/making/scenario_settings.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Writes the absolute path of the file that name means into found. Returns false if there is none.
 */
static bool find(const char *name, const char *scenario, const char *data_dir, bool from_here,
                 char found[PATH_MAX])
{
    char path[PATH_MAX];
    const char *slash = strrchr(scenario, '/');
    const char *const folders[] = {from_here ? "." : NULL, slash ? scenario : ".", ".", NULL};
    if (name[0] == '/')
        return realpath(name, found) != NULL;
    for (int i = 0; i < 5; i++) {
        int length = -1;
        if (i < 3 && folders[i])
            length =
                snprintf(path, sizeof path, "%.*s/%s",
                         folders[i] == scenario ? (int)(slash - scenario) : 1, folders[i], name);
        else if (i >= 3)
            length = snprintf(path, sizeof path, "%s/grounds/%s%s", data_dir, name,
                              i == 3 ? "" : ".ground");
        if (length > 0 && (size_t)length < sizeof path && realpath(path, found) &&
            access(found, F_OK) == 0)
            return true;
    }
    return false;
}

static int check(const struct ground_file *file, double side_m, const char *name,
                 struct key_place place, struct error_text *error)
{
    double offset_m;
    uint32_t posts_side;
    if (file->header.side_m > side_m)
        return key_table_refuse(error, place, GROUND_SOURCE_KEY, name,
                                "its square has a side of %g m, and terrain.side_m is %g; allowed: "
                                "from the side of the square, or no terrain.side_m",
                                file->header.side_m, side_m);
    if (!ground_file_fits_world(&file->header, side_m, &offset_m, &posts_side))
        return key_table_refuse(
            error, place, GROUND_SOURCE_KEY, name,
            "its posts are %g m apart, which are no posts of a world of %g km "
            "with at most %u along an edge around the square: give another terrain.side_m, or "
            "make it again by jolon ground make with other --posts",
            file->header.spacing_m, side_m / 1000.0, GROUND_WORLD_POSTS_MAX);
    return 0;
}

int ground_source_read(struct scenario_settings *settings, const char *scenario,
                       const char *data_dir, struct key_place place, double middle[3],
                       struct error_text *error)
{
    struct ground_file file;
    struct error_text reason;
    char found[PATH_MAX], name[GROUND_FILE_TEXT_MAX];
    snprintf(name, sizeof name, "%s", settings->ground_file);
    if (settings->terrain != TERRAIN_FILE)
        return name[0] == '\0' ? 0
                               : key_table_refuse(error, place, GROUND_SOURCE_KEY, name,
                                                  "needs terrain.source = \"file\" beside it");
    if (name[0] == '\0')
        return key_table_refuse(error, place, "terrain.source", "file",
                                "needs a ground file; right would be: " GROUND_SOURCE_KEY
                                " = \"NAME.ground\" beside it");
    if (!find(name, scenario, data_dir, place.line == 0, found))
        return key_table_refuse(error, place, GROUND_SOURCE_KEY, name,
                                "no such file beside the scenario, here or in %s/grounds; jolon "
                                "ground make makes one",
                                data_dir);
    if (strlen(found) >= sizeof settings->ground_file)
        return key_table_refuse(error, place, GROUND_SOURCE_KEY, name, "is too long for a path");
    if (ground_file_open(&file, found, &reason) != 0)
        return key_table_refuse(error, place, GROUND_SOURCE_KEY, NULL, "%s", reason.text);
    memset(settings->ground_file, 0, sizeof settings->ground_file);
    memcpy(settings->ground_file, found, strlen(found));
    settings->ground_hash = file.header.hash;
    middle[0] = file.header.latitude_deg;
    middle[1] = file.header.longitude_deg;
    middle[2] = file.header.undulation_m;
    if (settings->side_m == 0.0)
        settings->side_m = ground_file_world_side(&file.header);
    int result = check(&file, settings->side_m, name, place, error);
    ground_file_close(&file);
    return result;
}
