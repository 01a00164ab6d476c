/* Leftovers: what processes that were killed left half made under a name of their own,
 * "PREFIXpid", until they would have renamed it. */
#ifndef JOLON_IPC_PROCESS_STALE_FILES_H
#define JOLON_IPC_PROCESS_STALE_FILES_H

/* Removes from folder every file called prefix and the number of a process that is gone, or of
 * this one. What cannot be removed stays. */
void stale_files_sweep(const char *folder, const char *prefix);

#endif
