/* GDAL is silent about files that no driver takes. */
#include "supervisor/ground/open_reason.h"

#include <cpl_error.h>

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

const char *open_reason(const char *path)
{
    const char *text = CPLGetLastErrorMsg();
    struct stat status;
    if (text[0] != '\0')
        return text;
    if (stat(path, &status) != 0)
        return strerror(errno);
    if (S_ISDIR(status.st_mode))
        return "it is a folder";
    return status.st_size == 0 ? "it is empty" : "it has no format that GDAL knows";
}
