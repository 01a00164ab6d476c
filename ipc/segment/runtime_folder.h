/* The runtime folder: a private folder of a user that holds the names, lock files and sockets of
 * the user's worlds. No other user can enter it, so no other user can take a name in it. All
 * programs of one user find the same folder, however they are started.
 *
 * The first of these that exists, or can be made, is taken:
 *
 *   1. $JOLON_RUNTIME_DIR         for tests and unusual set-ups; must be an absolute path
 *   2. $RUNTIME_DIRECTORY         the first entry; systemd sets it for RuntimeDirectory=
 *   3. /run/jolon                 for root only
 *   4. $XDG_RUNTIME_DIR/jolon     of a login session
 *   5. /run/user/UID/jolon        the same folder, when a program was not given the variable
 *   6. HOME/.jolon/run            HOME is $HOME, or the home in the system's user database
 *
 * A place that belongs to another user, or in which others may write, is passed over. So neither
 * `sudo` nor `su` leads into another user's folder. $JOLON_RUNTIME_DIR is never passed over. /tmp
 * is not in the list, because any user could make the folder there first. The folder itself must
 * belong to the user (geteuid()), have mode 0700 and be no symbolic link; any other is refused. */
#ifndef JOLON_IPC_SEGMENT_RUNTIME_FOLDER_H
#define JOLON_IPC_SEGMENT_RUNTIME_FOLDER_H

struct error_text;

#define RUNTIME_FOLDER_MAX 192 /* the longest path, with the NUL */

/* Finds this user's runtime folder, and makes it when it is missing. Returns 0, or -1 with the
 * reason. The process keeps the path that it found first, but no descriptor; each call checks the
 * folder again. Any thread may call this. After the first call only openat(), fstat() and close()
 * are used, so that it works within a sandbox. */
int runtime_folder(char path[RUNTIME_FOLDER_MAX], struct error_text *error);

/* Finds the folder and returns it as a descriptor (O_PATH | O_DIRECTORY | O_CLOEXEC) for openat(),
 * which the caller closes. Returns -1 with the reason. */
int runtime_folder_open(struct error_text *error);

#endif
