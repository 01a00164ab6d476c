/* The verb show, and writing of rasters. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_PICTURE_H
#define JOLON_SUPERVISOR_GROUND_PICTURE_H

#include <gdal.h>

int picture_show(int argc, char **argv);

/* Writes a dataset aside by a driver of GDAL, and gives the file its name when it is whole. Ends
 * the process (exit 1) if it cannot be written. */
void picture_save(GDALDatasetH dataset, const char *driver, const char *path, char **options);

#endif
