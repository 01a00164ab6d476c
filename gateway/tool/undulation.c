/* The verb undulation. */
#include "gateway/tool/undulation.h"

#include "gateway/earth/geoid_grid.h"
#include "ipc/process/log.h"
#include "ipc/process/option_table.h"
#include "world/runtime/parse_number.h"

#include <stdio.h>
#include <string.h>

#define ARGUMENTS_MAX 16

static const char *grid = GEOID_GRID_PATH;

/* Puts "--" before the first number, because a number below 0 looks like an option. Returns the
 * new count. */
static int mark_numbers(int argc, char **argv, char **marked)
{
    static char end[] = "--";
    double number;
    int count = 0;
    bool found = false;
    for (int i = 0; i < argc && count < ARGUMENTS_MAX; i++) {
        if (!found && parse_real(argv[i], -1e9, 1e9, &number) &&
            (i == 0 || strcmp(argv[i - 1], "--grid") != 0)) {
            found = true;
            marked[count++] = end;
        }
        marked[count++] = argv[i];
    }
    marked[count] = NULL;
    return count;
}

int undulation_run(int argc, char **argv)
{
    static const struct option_row rows[] = {
        {"grid", "FILE",
         "a grid in PROJ's format GTX (default " GEOID_GRID_PATH ", of Debian's proj-data)",
         .text = &grid},
        OPTION_ROWS_END};
    static const struct option_table table = {
        .program = "jolon-dis undulation",
        .usage = "[--grid FILE] LATITUDE LONGITUDE\nPrints the height of the sea level above the "
                 "ellipsoid there [degrees, WGS 84], for --set.",
        .rows = rows,
        .plain = 2};
    char *marked[ARGUMENTS_MAX + 2];
    double latitude_deg, longitude_deg, undulation_m;
    struct error_text error;
    int count = mark_numbers(argc, argv, marked);
    if (option_table_read(&table, count, marked) != 2 ||
        !parse_real(marked[count - 2], -90.0, 90.0, &latitude_deg) ||
        !parse_real(marked[count - 1], -180.0, 180.0, &longitude_deg))
        die_usage(
            "dis undulation: needs a latitude from -90 to 90 and a longitude from -180 to 180, "
            "as in: jolon dis undulation 35.95 -121.25");
    if (geoid_grid_read(grid, latitude_deg, longitude_deg, &undulation_m, &error) != 0)
        die_refused("%s; Debian's package proj-data has one, and --grid names another", error.text);
    printf("gateway.undulation_m=%.2f\n", undulation_m);
    return EXIT_OK;
}
