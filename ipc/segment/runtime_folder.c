/* The search for the runtime folder, and the checks of what was found. */
#include "ipc/segment/runtime_folder.h"

#include "ipc/segment/segment.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <pwd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define OR_NAME_ANOTHER "or name a folder of your own with JOLON_RUNTIME_DIR"

enum found { FOUND, PASSED_OVER, REFUSED };

/* A search: the folder that was found, and why earlier places were passed over. */
struct search {
    char path[RUNTIME_FOLDER_MAX];
    int fd;
    char passed[320];
    struct error_text *error;
};

/* The path that this process found first, "" before. */
static pthread_mutex_t kept_lock = PTHREAD_MUTEX_INITIALIZER;
static char kept[RUNTIME_FOLDER_MAX];

static enum found refused(struct search *search, int code, const char *right)
{
    error_text_set(search->error, "%s: cannot be the runtime folder: %s; %s", search->path,
                   strerror(code), right);
    return REFUSED;
}

static enum found passed_over(struct search *search, const char *place, const char *detail)
{
    size_t used = strlen(search->passed);
    snprintf(search->passed + used, sizeof search->passed - used, "%s%s: %s", used ? ", " : "",
             place, detail);
    return PASSED_OVER;
}

/* Opens the folder without following a symbolic link, and checks owner and mode on the descriptor,
 * so that nothing can change between check and use. */
static enum found open_checked(struct search *search, int base, const char *name)
{
    struct stat status;
    int fd = openat(base, name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0)
        return refused(search, errno,
                       errno == ENOTDIR || errno == ELOOP
                           ? "it is no folder, or a symbolic link: remove it, " OR_NAME_ANOTHER
                           : "make it enterable, " OR_NAME_ANOTHER);
    if (fstat(fd, &status) != 0) {
        close(fd);
        return refused(search, errno, OR_NAME_ANOTHER);
    }
    if (status.st_uid != geteuid())
        error_text_set(
            search->error,
            "%s: cannot be the runtime folder: it belongs to user %u, not to user %u; name "
            "a folder of your own with JOLON_RUNTIME_DIR",
            search->path, (unsigned)status.st_uid, (unsigned)geteuid());
    else if ((status.st_mode & 0777) != 0700)
        error_text_set(
            search->error,
            "%s: cannot be the runtime folder: its mode is %04o, not 0700; run `chmod 700 "
            "%s`, " OR_NAME_ANOTHER,
            search->path, (unsigned)(status.st_mode & 0777), search->path);
    else {
        search->fd = fd;
        return FOUND;
    }
    close(fd);
    return REFUSED;
}

/* Makes the folder called name in base if it is missing, and opens it. */
static enum found make_and_open(struct search *search, int base, const char *name)
{
    if (mkdirat(base, name, 0700) != 0 && errno != EEXIST)
        return refused(search, errno, "make it yourself, " OR_NAME_ANOTHER);
    return open_checked(search, base, name);
}

static int set_path(struct search *search, const char *base, const char *name)
{
    int length =
        snprintf(search->path, sizeof search->path, "%s%s%s", base, *name ? "/" : "", name);
    if (length < (int)sizeof search->path)
        return 0;
    error_text_set(search->error,
                   "%.100s...: is too long for the runtime folder: %d bytes, at most %d; name a "
                   "shorter one with JOLON_RUNTIME_DIR",
                   base, length, RUNTIME_FOLDER_MAX - 1);
    return -1;
}

/* Opens a folder that belongs to this user and in which no other user may write. Returns -1 and
 * sets detail if it is not such a folder. */
static int open_base(const char *path, const char **detail)
{
    struct stat status;
    int fd = open(path, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) {
        *detail = strerror(errno);
        return -1;
    }
    if (fstat(fd, &status) == 0 && status.st_uid == geteuid() &&
        (status.st_mode & (S_IWGRP | S_IWOTH)) == 0)
        return fd;
    *detail = status.st_uid != geteuid() ? "belongs to another user" : "others may write in it";
    close(fd);
    return -1;
}

/* Tries the folder base/name, or base/name/deeper. */
static enum found within(struct search *search, const char *base, const char *name,
                         const char *deeper)
{
    const char *detail = "";
    char both[64];
    snprintf(both, sizeof both, "%s%s%s", name, deeper ? "/" : "", deeper ? deeper : "");
    int fd = open_base(base, &detail);
    if (fd < 0)
        return passed_over(search, base, detail);
    enum found found = REFUSED;
    if (set_path(search, base, both) == 0) {
        bool made = mkdirat(fd, name, 0700) == 0 || errno == EEXIST;
        if (!made && (errno == EROFS || errno == EACCES || errno == EPERM))
            found = passed_over(search, base, strerror(errno));
        else if (!made)
            found = refused(search, errno, OR_NAME_ANOTHER);
        else
            found = deeper ? make_and_open(search, fd, both) : open_checked(search, fd, name);
    }
    close(fd);
    return found;
}

static enum found from_own_variable(struct search *search)
{
    const char *value = getenv("JOLON_RUNTIME_DIR");
    if (!value || value[0] == '\0')
        return PASSED_OVER;
    if (value[0] != '/') {
        error_text_set(search->error,
                       "JOLON_RUNTIME_DIR=%.200s: must be an absolute path, as /run/jolon", value);
        return REFUSED;
    }
    if (set_path(search, value, "") != 0)
        return REFUSED;
    /* With a slash at the path's end openat() would follow a symbolic link. */
    for (size_t end = strlen(search->path); end > 1 && search->path[end - 1] == '/'; end--)
        search->path[end - 1] = '\0';
    return make_and_open(search, AT_FDCWD, search->path);
}

static enum found from_service(struct search *search)
{
    char first[RUNTIME_FOLDER_MAX + 1];
    const char *detail = "", *value = getenv("RUNTIME_DIRECTORY");
    if (!value || value[0] != '/')
        return PASSED_OVER;
    snprintf(first, sizeof first, "%.*s", (int)strcspn(value, ":"), value);
    int fd = open_base(first, &detail);
    if (fd < 0)
        return passed_over(search, first, detail);
    close(fd);
    return set_path(search, first, "") == 0 ? open_checked(search, AT_FDCWD, first) : REFUSED;
}

static enum found from_session(struct search *search)
{
    char base[64];
    const char *value = getenv("XDG_RUNTIME_DIR");
    enum found found = PASSED_OVER;
    if (value && value[0] == '/')
        found = within(search, value, "jolon", NULL);
    snprintf(base, sizeof base, "/run/user/%u", (unsigned)geteuid());
    return found == PASSED_OVER ? within(search, base, "jolon", NULL) : found;
}

/* After `sudo -E` or `su` $HOME is another user's. Then the home in the user database is taken. */
static enum found from_home(struct search *search)
{
    struct passwd entry, *known = NULL;
    char text[4096];
    const char *value = getenv("HOME");
    enum found found = PASSED_OVER;
    if (value && value[0] == '/')
        found = within(search, value, ".jolon", "run");
    if (found == PASSED_OVER && getpwuid_r(geteuid(), &entry, text, sizeof text, &known) == 0 &&
        known && (!value || strcmp(known->pw_dir, value) != 0))
        found = within(search, known->pw_dir, ".jolon", "run");
    return found;
}

static enum found find(struct search *search)
{
    enum found found = from_own_variable(search);
    if (found == PASSED_OVER)
        found = from_service(search);
    if (found == PASSED_OVER && geteuid() == 0)
        found = within(search, "/run", "jolon", NULL);
    if (found == PASSED_OVER && geteuid() != 0)
        found = from_session(search);
    if (found == PASSED_OVER)
        found = from_home(search);
    if (found == PASSED_OVER)
        error_text_set(
            search->error,
            "there is no private folder for names and sockets (%s); name a folder of your "
            "own with JOLON_RUNTIME_DIR",
            search->passed);
    return found;
}

int runtime_folder_open(struct error_text *error)
{
    struct search search = {.fd = -1, .error = error};
    pthread_mutex_lock(&kept_lock);
    memcpy(search.path, kept, sizeof kept);
    pthread_mutex_unlock(&kept_lock);
    if (search.path[0] != '\0')
        return open_checked(&search, AT_FDCWD, search.path) == FOUND ? search.fd : -1;
    if (find(&search) != FOUND)
        return -1;
    pthread_mutex_lock(&kept_lock);
    memcpy(kept, search.path, sizeof kept);
    pthread_mutex_unlock(&kept_lock);
    return search.fd;
}

int runtime_folder(char path[RUNTIME_FOLDER_MAX], struct error_text *error)
{
    int fd = runtime_folder_open(error);
    if (fd < 0)
        return -1;
    close(fd);
    pthread_mutex_lock(&kept_lock);
    memcpy(path, kept, sizeof kept);
    pthread_mutex_unlock(&kept_lock);
    return 0;
}
