/* Why GDAL could not open a map. Main thread only. */
#ifndef JOLON_SUPERVISOR_GROUND_OPEN_REASON_H
#define JOLON_SUPERVISOR_GROUND_OPEN_REASON_H

/* Returns GDAL's last message, or, where GDAL is silent, what is wrong with the file: it does not
 * exist, is a folder, is empty, or has another format. Valid until GDAL's next message. */
const char *open_reason(const char *path);

#endif
