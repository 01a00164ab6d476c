/* Libraries of devices, opened when a device is asked for: who has neither needs neither. */
#ifndef JOLON_CLIENTS_DRIVE_DEVICE_LIBRARY_H
#define JOLON_CLIENTS_DRIVE_DEVICE_LIBRARY_H

#include "ipc/segment/segment.h"

#include <stddef.h>

/* A function of the library and where to put its address. */
struct device_library_function {
    const char *name;
    void *to; /* a pointer to a function */
};

/* Opens the library called name and finds all its functions; -1 with the reason, which says what to
 * install. It stays open. */
int device_library_open(const char *name, const char *package,
                        const struct device_library_function *functions, size_t count,
                        struct error_text *error);

#endif
