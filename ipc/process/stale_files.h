/* Stale files: unfinished files of killed processes. A process writes a file under the name
 * "PREFIXpid" and renames it when it is whole. */
#ifndef JOLON_IPC_PROCESS_STALE_FILES_H
#define JOLON_IPC_PROCESS_STALE_FILES_H

/* Removes from folder every file whose name is prefix and the pid of a process that has ended, or
 * of this process. A file that cannot be removed stays. */
void stale_files_sweep(const char *folder, const char *prefix);

#endif
