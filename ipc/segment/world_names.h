/* Names of worlds: the object of a name, the list of names, and the removal of a world. */
#ifndef JOLON_IPC_SEGMENT_WORLD_NAMES_H
#define JOLON_IPC_SEGMENT_WORLD_NAMES_H

#include "ipc/segment/runtime_folder.h"

#include <stdbool.h>

struct error_text;

#define SEGMENT_NAME_MAX 32 /* of a world, with the NUL */
#define SEGMENT_PATH_MAX (RUNTIME_FOLDER_MAX + 64)

/* Returns true if a world may have this name: 1..31 of a-z A-Z 0-9 _ -. segment_name_check()
 * returns 0, or -1 with the reason. */
bool segment_name_ok(const char *name);
int segment_name_check(const char *name, struct error_text *error);

/* The check of an option's value (struct option_row.take): the reason does not repeat the name. */
int segment_name_option(const char *name, struct error_text *detail);

/* The paths of a world. */
struct segment_paths {
    char name[SEGMENT_PATH_MAX];   /* the link in the runtime folder */
    char lock[SEGMENT_PATH_MAX];   /* the lock file beside it */
    char object[SEGMENT_PATH_MAX]; /* in /dev/shm; "" when the name leads to no world */
};

/* Looks up a world's name. Returns 0, also when the name leads to no world. Returns -1 with the
 * reason when it is no valid name, when there is no runtime folder, or when something else has the
 * name. */
int segment_paths(struct segment_paths *paths, const char *name, struct error_text *error);

/* Removes the world's object, its name, its sockets, and its lock file unless a supervisor holds
 * it. A name that leads to no world is removed too. Refuses while a role is held, unless force is
 * set. segment_remove_own() is for the supervisor that holds the lock file, and removes that too.
 * segment_sweep() leaves a world as it is, and removes the remains around a name that leads to
 * none. Each returns 0, or -1 with the reason. */
int segment_remove(const char *name, bool force, struct error_text *error);
int segment_remove_own(const char *name, struct error_text *error);
int segment_sweep(const char *name, struct error_text *error);

/* Lists the names of the worlds in this user's runtime folder; with all, also names of which only
 * remains are left. Writes at most max names and returns their number, or -1 with the reason. */
int segment_list(char names[][SEGMENT_NAME_MAX], int max, bool all, struct error_text *error);

/* Lists this user's files in /dev/shm to which no name in the runtime folder leads: of an earlier
 * version, of another runtime folder, or of one that is gone. They cannot be told apart, so they
 * are only listed. Writes at most max names and returns their number. */
#define SEGMENT_LOST_MAX 128
int segment_list_lost(char files[][SEGMENT_LOST_MAX], int max);

/* Gives the object behind fd a name in /dev/shm and links the world's name to it. Refuses when the
 * world exists. Returns 0, or -1 with the reason. */
int segment_give_names(const char *name, int fd, struct error_text *error);

#endif
