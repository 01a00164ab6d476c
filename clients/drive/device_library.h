/* Device libraries are loaded at run time, so that a user without such a device need not install
 * them. */
#ifndef JOLON_CLIENTS_DRIVE_DEVICE_LIBRARY_H
#define JOLON_CLIENTS_DRIVE_DEVICE_LIBRARY_H

#include "ipc/segment/segment.h"

#include <stddef.h>

/* A function of the library. */
struct device_library_function {
    const char *name;
    void *to; /* address of the function pointer to set */
};

/* Loads the library called name for good and sets the pointers to its functions. Returns 0, or -1
 * with an error that says which package to install. */
int device_library_open(const char *name, const char *package,
                        const struct device_library_function *functions, size_t count,
                        struct error_text *error);

#endif
