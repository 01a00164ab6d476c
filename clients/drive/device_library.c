/* Loads a library at run time. */
#include "clients/drive/device_library.h"

#include <dlfcn.h>
#include <string.h>

int device_library_open(const char *name, const char *package,
                        const struct device_library_function *functions, size_t count,
                        struct error_text *error)
{
    void *library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return error_text_set(
            error, "%s is not installed; on Debian and Ubuntu: apt-get install %s", name, package);
    for (size_t i = 0; i < count; i++) {
        /* C has no conversion from the object pointer of dlsym() to a function pointer. */
        void *found = dlsym(library, functions[i].name);
        if (!found)
            return error_text_set(error, "%s lacks %s; a newer %s has it", name, functions[i].name,
                                  package);
        memcpy(functions[i].to, &found, sizeof found);
    }
    return 0;
}
