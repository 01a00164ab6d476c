/* Names of worlds: where a name leads, which names there are, and a world's removal. */
#ifndef JOLON_IPC_SEGMENT_WORLD_NAMES_H
#define JOLON_IPC_SEGMENT_WORLD_NAMES_H

#include "ipc/segment/runtime_folder.h"

#include <stdbool.h>

struct error_text;
struct error_text;

#define SEGMENT_NAME_MAX 32 /* of a world, with the NUL */
#define SEGMENT_PATH_MAX (RUNTIME_FOLDER_MAX + 64)

/* Is this a name a world may have: 1..31 of a-z A-Z 0-9 _ - ? The second says so: 0, or -1 with the
 * reason. */
bool segment_name_ok(const char *name);
int segment_name_check(const char *name, struct error_text *error);

/* The same as the check of an option's value: why does not repeat the name. */
int segment_name_option(const char *name, struct error_text *detail);

/* Where a world is in the file system. */
struct segment_paths {
    char name[SEGMENT_PATH_MAX];   /* the link in the runtime folder */
    char lock[SEGMENT_PATH_MAX];   /* the lock file beside it */
    char object[SEGMENT_PATH_MAX]; /* in /dev/shm; "" when the name leads to no world */
};

/* Looks where a world's name leads now. 0, also when it leads to no world. -1 with the reason when
 * it is no name, when there is no runtime folder, or when something else lies under the name. */
int segment_paths(struct segment_paths *paths, const char *name, struct error_text *error);

/* Removes the world's object, its name and its sockets, and its lock file unless a supervisor holds
 * that. A name that leads to no world is removed too. Refuses while a role is held, unless force.
 * 0, or -1 with the reason. segment_remove_own() is for the supervisor that holds the lock file: it
 * removes that too. segment_sweep() leaves a world as it is, and removes only what lies around a
 * name that leads to none. */
int segment_remove(const char *name, bool force, struct error_text *error);
int segment_remove_own(const char *name, struct error_text *error);
int segment_sweep(const char *name, struct error_text *error);

/* Names in this user's runtime folder: of worlds, or, with all, of whatever is left of one too.
 * Writes at most max of them and returns how many it wrote; -1 with the reason. */
int segment_list(char names[][SEGMENT_NAME_MAX], int max, bool all, struct error_text *error);

/* Objects and lock files of this user in /dev/shm to which no name in the runtime folder leads: of
 * an earlier version, of another runtime folder, or of one that is gone. Nobody can tell which, so
 * they are only listed. At most max names of files; how many it wrote. */
#define SEGMENT_LOST_MAX 128
int segment_list_lost(char files[][SEGMENT_LOST_MAX], int max);

/* Gives the object behind fd a name in /dev/shm and the world's name to it.
 * Refuses when the world exists. 0, or -1 with the reason. */
int segment_give_names(const char *name, int fd, struct error_text *error);

#endif
