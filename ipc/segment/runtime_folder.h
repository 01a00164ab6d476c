/* The runtime folder: one private folder of a user, in which the names of the user's worlds lie,
 * their lock files and their sockets. Nobody else can enter it, so nobody else can take a name in
 * it. Programs of one user find the same folder, also when they are started in another way.
 *
 * The first of these that is there, or can be made, is taken:
 *   1. $JOLON_RUNTIME_DIR         for tests and unusual set-ups; must be an absolute path
 *   2. $RUNTIME_DIRECTORY         the first entry; systemd sets it for RuntimeDirectory=
 *   3. /run/jolon                 for root only
 *   4. $XDG_RUNTIME_DIR/jolon     of a login session
 *   5. /run/user/UID/jolon        the same folder, when a program was not given the variable
 *   6. HOME/.jolon/run            HOME is $HOME, or the home that the system knows for the user
 *
 * A place that belongs to another user, or in which others may write, is passed over: so neither
 * `sudo` nor `su` leads into a folder of somebody else. $JOLON_RUNTIME_DIR is never passed over.
 * /tmp is not in the list, because there anybody could make the folder first. The folder itself
 * must belong to the user (geteuid()), have mode 0700 and be no symbolic link; any other is
 * refused. */
#ifndef JOLON_IPC_SEGMENT_RUNTIME_FOLDER_H
#define JOLON_IPC_SEGMENT_RUNTIME_FOLDER_H

struct error_text;

#define RUNTIME_FOLDER_MAX 192 /* the longest path, with the NUL */

/* Finds this user's runtime folder, and makes it when it is missing. 0, or -1 with the reason. The
 * process keeps the path that it has found first, and no descriptor; each call checks the folder
 * again. Any thread may call this. After the first call it asks the kernel for openat(), fstat()
 * and close() only, so that it works within a sandbox. */
int runtime_folder(char path[RUNTIME_FOLDER_MAX], struct error_text *error);

/* The same as a descriptor (O_PATH | O_DIRECTORY | O_CLOEXEC) that the caller closes, for openat()
 * and the like. -1 with the reason. */
int runtime_folder_open(struct error_text *error);

#endif
